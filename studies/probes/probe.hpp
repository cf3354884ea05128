#pragma once
// A probe: one test of a method that is no plain run, and the numbers it answers with.

#include "scene/discrete_body.hpp"

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace concord::probes {

/// One number that a probe gives.
struct QuantityInfo {
  std::string name, unit, meaning;
};

struct ProbeInfo {
  std::string name, title, source;
  std::vector<scene::ParameterInfo> options;
  std::vector<QuantityInfo> quantities;
};

/// What a probe is asked for. `run.out` is the folder for evidence, or empty.
struct ProbeRequest {
  const scene::Problem& problem;
  const scene::Method& method;
  scene::RunRequest run;
  scene::Settings options;
  /// Where a probe may keep what probes of other methods need too (reference solutions), under
  /// names that tell its content; the folder changes with the code. Empty: nowhere.
  std::filesystem::path keep{};

  /// The method's body of this request, or of `other` (another seed, perturbation, spacing).
  /// Throws InputError for a method that cannot show one.
  std::unique_ptr<scene::DiscreteBody> body() const { return body(run); }
  std::unique_ptr<scene::DiscreteBody> body(const scene::RunRequest& other) const;
};

/// A probe. Stateless. It fills `quantities`, `particles`, `unknowns` and `notes` of the
/// result. A method that fails where the probe asks how far it goes is a result; elsewhere
/// SolveError is thrown.
class Probe {
 public:
  virtual ~Probe() = default;
  virtual const ProbeInfo& info() const = 0;
  virtual void run(const ProbeRequest& request, scene::Result& result) const = 0;
};

/// The probes linked into this program, by name. Each registers itself.
class ProbeRegistry {
 public:
  static ProbeRegistry& instance();
  void add(std::unique_ptr<Probe> probe);
  /// Throws InputError naming the probes there are.
  const Probe& find(const std::string& name) const;
  std::vector<const Probe*> all() const;  ///< sorted by name

 private:
  std::map<std::string, std::unique_ptr<Probe>> m_probes;
};

template <class P> struct RegisterProbe {
  RegisterProbe() { ProbeRegistry::instance().add(std::make_unique<P>()); }
};

/// Options of a probe: a number, a word.
scene::ParameterInfo number_option(std::string key, std::string unit, std::string value,
                                   double minimum, double maximum, std::string range,
                                   std::string meaning);
scene::ParameterInfo word_option(std::string key, std::string value,
                                 std::vector<std::string> choices, std::string meaning);

}  // namespace concord::probes
