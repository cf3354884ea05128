#pragma once
// What a study.toml says, checked. Its keys are described in studies/README.md.

#include "scene/errors.hpp"
#include "studies/driver/measures.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace concord::studies {

/// Largest perturbation, as a fraction of the spacing: beyond it neighbours may change places.
inline constexpr double max_perturb = 0.45;

/// One curve: a scene, a method with settings, resolutions and seeds.
struct Case {
  std::string scene, method, variant;
  std::map<std::string, std::string> set;        ///< settings of the method
  std::map<std::string, std::string> scene_set;  ///< dotted keys of the scene
  double perturb = 0;                            ///< fraction of h
  std::vector<double> resolutions;               ///< ascending
  std::vector<std::uint64_t> seeds{1};
  bool frames = false;                         ///< kept of the finest resolution
  std::vector<double> frames_at;               ///< and of these
  std::string probe;                           ///< a test of `concord probe`; empty: runs
  std::map<std::string, std::string> options;  ///< of the probe
  int repeats = 0;                             ///< timed warm runs; 0: the run itself is timed
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

/// Points close to two planes across an axis do not count: there a comparison says nothing.
struct LeaveOut {
  int axis = 0;              ///< 0, 1, 2: x, y, z of the reference position
  double low = 0, high = 0;  ///< of the planes [m]
  double spacings = 0;       ///< how far from them, in h of the run compared
};

/// Fields of runs against those of a reference run, Eq. (29) of the Continuum Bond Method
/// paper.
struct Comparison {
  std::string name = "difference";             ///< of the errors and of the file
  std::vector<std::string> fields;             ///< scalar point fields of frames
  Selector reference;                          ///< one case
  std::optional<double> reference_resolution;  ///< absent: its finest
  Selector selector;  ///< cases compared; of the reference's scene where none is given
  std::optional<LeaveOut> leave_out;
  SourcePosition where;
};

enum class ClaimKind { slope, value, ratio, gci, minimum, matched_ratio };

struct Claim {
  std::string id, statement, source, source_value;
  ClaimKind kind = ClaimKind::value;
  Selector selector;
  std::string quantity;
  std::optional<double> resolution;
  Selector other;  ///< ratio, minimum: the denominator's case, parts left out as in `selector`;
                   ///< matched_ratio: the numerator's
  bool divided = false;  ///< minimum: there is a denominator
  std::string other_quantity;
  std::optional<double> other_resolution;
  Pool over_seeds = Pool::max;
  std::optional<Pool> over_resolutions;  ///< of what `over_seeds` makes of each; absent: all
                                         ///< runs are pooled at once
  std::optional<Pool> other_over_seeds;  ///< of the denominator; absent: as `over_seeds`
  std::optional<Pool> other_over_resolutions;
  std::string unit = "1";                  ///< of min, max and the shown value
  std::optional<double> minimum, maximum;  ///< in `unit`
  std::string setting;  ///< minimum: the setting whose value at the minimum is bounded
  std::optional<double> setting_minimum, setting_maximum;
  double level = 0;                ///< matched_ratio: of the error
  WorkTime time = WorkTime::wall;  ///< matched_ratio
  bool full_only = false;
  SourcePosition where;
};

/// A horizontal line of a sweep: what a case without the setting reaches; of a history: a run
/// to compare with.
struct Baseline {
  Selector selector;
  std::optional<double> resolution;
  std::string quantity, label;
};

using Range = std::array<double, 2>;

/// Part of a plane: low and high end along x and y.
struct Window {
  std::optional<Range> x, y;
};

/// Published values, drawn as markers in the units of the plot.
struct Points {
  std::string label;
  std::vector<double> x, y;
};

struct Plot {
  std::string kind, quantity, title, setting, setting_y, note;
  std::string statement, source;  ///< what the paper says of it, and where
  Selector selector;
  std::optional<double> resolution, slope;
  std::vector<double> resolutions;    ///< curve, history; empty: all
  std::vector<std::string> columns;   ///< history: several columns in one plot
  bool change = false;                ///< history: value minus the first one
  std::optional<double> change_from;  ///< history: minus the one at this time [s], from then on
  bool norm = false;                  ///< history: length of the vector of the columns
  std::vector<std::string>
      share_of;  ///< history: sum of the columns over that of these at the end
  std::optional<double> rate_over;  ///< history: change over a window of this width [s]
  bool log = false;                 ///< history, curve: magnitudes on a logarithmic axis
  std::string x, y;                 ///< curve: columns of history.csv
  std::string x_label, y_label, label;
  std::optional<double> x_scale, y_scale;
  std::vector<Baseline> baseline;
  std::vector<Points> points;      ///< history, curve
  std::optional<Window> inset;     ///< curve: enlarged in a corner
  WorkTime time = WorkTime::wall;  ///< work_precision
  SourcePosition where;
};

/// What picks a frame and its values.
struct Panel {
  Selector selector;
  std::optional<double> resolution;  ///< absent: the finest that has frames
  std::string color, caption;      ///< color: a point field; of a panel: absent, the picture's
  std::optional<bool> difference;  ///< the run's difference.hdf instead of its last frame
  std::optional<double> time;      ///< of the frame, the nearest one [s]; absent: the last
  std::string draw;                ///< "body" (where empty), "cells" or "spheres"
};

/// Frames of runs one after the other.
struct Animation {
  std::optional<double> from, to;  ///< instants [s]; absent: the first and the last frame
  double frames = 24;              ///< at most
  double seconds = 4;              ///< that they play
};

struct Picture {
  Panel body;
  double scale_displacement = 1;
  std::vector<Panel> panels;      ///< bodies side by side; empty: one body
  std::optional<double> columns;  ///< panels in a row
  std::vector<double> times;      ///< a row of panels each [s]; empty: the panels as they are
  bool common_range = false;      ///< one scale for all panels
  bool robust_range = false;      ///< and its ends are percentiles
  std::optional<Animation> animate;
  std::optional<Range> range;  ///< ends of the scale
  std::optional<Window> crop;  ///< part of the plane shown [m]
};

struct Study {
  std::string name, title, question, source, paper_statement;
  bool timing = false;  ///< one run at a time
  /// Largest invariants.energy_drift of a run whose energy balance closes; absent: not judged.
  std::optional<double> balance_tolerance;
  bool full = false;
  std::vector<Case> cases;  ///< those of the chosen mode only
  std::vector<Fit> fits;
  std::vector<Reference> references;
  std::vector<Comparison> comparisons;
  std::vector<Signal> signals;
  std::vector<ErrorEntry> errors;
  std::vector<Matched> matched;
  std::vector<Heatmap> heatmaps;
  std::vector<RunTable> tables;
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

/// "wall_s" or "total".
const char* to_text(WorkTime time);

/// Factor from SI to `unit` ("mm" -> 1e3). Throws InputError at `where` for an unknown unit.
double display_factor(const std::string& unit, const SourcePosition& where = {});

}  // namespace concord::studies
