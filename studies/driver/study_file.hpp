#pragma once
// What a study.toml says, checked. Its keys are described in studies/README.md.

#include "scene/errors.hpp"

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace concord::studies {

/// Largest perturbation, as a fraction of the spacing: beyond it neighbours may change places.
inline constexpr double max_perturb = 0.45;

/// Scene, method and variant of a case; a part left out matches any.
struct Selector {
  std::optional<std::string> scene, method, variant;
};

/// One curve: a scene, a method with settings, resolutions and seeds.
struct Case {
  std::string scene, method, variant;
  std::map<std::string, std::string> set;        ///< settings of the method
  std::map<std::string, std::string> scene_set;  ///< dotted keys of the scene
  double perturb = 0;                            ///< fraction of h
  std::vector<double> resolutions;               ///< ascending
  std::vector<std::uint64_t> seeds{1};
  bool frames = false;
  SourcePosition where;

  bool matches(const Selector& selector) const;
  std::string title() const;  ///< "delaunay (xi 1, 25 %) on swinging_cube"
};

struct Fit {
  Selector selector;
  std::string quantity;
  std::size_t finest = 0;  ///< how many of the finest levels enter; 0: all
};

struct Reference {
  Selector selector;
  std::string quantity;
  double formal_order = 2;
  SourcePosition where;
};

enum class ClaimKind { slope, value, ratio, gci };
enum class Pool { max, min, mean };

struct Claim {
  std::string id, statement, source, source_value;
  ClaimKind kind = ClaimKind::value;
  Selector selector;
  std::string quantity;
  std::optional<double> resolution;
  Selector other;  ///< ratio: the denominator's case, parts left out as in `selector`
  std::string other_quantity;
  std::optional<double> other_resolution;
  Pool over_seeds = Pool::max;
  std::string unit = "1";                  ///< of min, max and the shown value
  std::optional<double> minimum, maximum;  ///< in `unit`
  bool full_only = false;
  SourcePosition where;
};

struct Plot {
  std::string kind, quantity, title, setting;
  Selector selector;
  std::optional<double> resolution, slope;
};

struct Picture {
  Selector selector;
  std::optional<double> resolution;  ///< absent: the finest that has frames
  std::string color, caption;
  double scale_displacement = 1;
};

struct Study {
  std::string name, title, question, source, paper_statement;
  bool timing = false;  ///< one run at a time
  bool full = false;
  std::vector<Case> cases;  ///< those of the chosen mode only
  std::vector<Fit> fits;
  std::vector<Reference> references;
  std::vector<Claim> claims;
  std::vector<Plot> plots;
  std::vector<Picture> pictures;
};

/// Reads studies/NAME/study.toml below `home`. `full` chooses between the quick and the full
/// ladders. Throws InputError: unknown study (naming those there are), unknown key, wrong type,
/// a claim that selects no case in either mode or more than one where one is needed.
Study read_study(const std::string& name, bool full, const std::filesystem::path& home);

/// Names of the studies below `home`, sorted.
std::vector<std::string> study_names(const std::filesystem::path& home);

/// Factor from SI to `unit` ("mm" -> 1e3). Throws InputError at `where` for an unknown unit.
double display_factor(const std::string& unit, const SourcePosition& where = {});

}  // namespace concord::studies
