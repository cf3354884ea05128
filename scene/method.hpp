#pragma once
// What a method is to the rest of the house: a name, a table of parameters, and a run from a
// Problem to a Result.

#include "scene/problem.hpp"

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace concord::scene {

/// One setting of a method, for `describe`, checking and defaults.
struct ParameterInfo {
  std::string key;            ///< without the method's name: "xi_n"
  std::string unit;           ///< "1" when dimensionless
  std::string default_value;  ///< as text
  std::string range;          ///< as text: ">= 0", "cubic-spline | wendland-c2"
  std::string meaning;        ///< one sentence with the formula or equation number
  double minimum = -1e300, maximum = 1e300;  ///< inclusive, for numbers
  std::vector<std::string> choices{};        ///< non-empty: one of these words
};

/// Settings of one method in one run: defaults from the table, replaced by what the user set.
class Settings {
 public:
  /// Throws InputError for a key that the table lacks, a value out of range, an unreadable
  /// number.
  Settings(std::string method, const std::vector<ParameterInfo>& table,
           const std::map<std::string, std::string>& given = {});
  double number(const std::string& key) const;
  const std::string& word(const std::string& key) const;
  bool flag(const std::string& key) const { return word(key) == "on"; }
  /// "xi_n=0.1 xi_t=0.1": what differs from the defaults; empty if nothing does.
  std::string variant() const;
  const std::map<std::string, std::string>& all() const { return m_values; }

 private:
  std::string m_method;
  std::map<std::string, std::string> m_values, m_defaults;
};

/// What a run is asked for beside the problem.
struct RunRequest {
  double h = 0;        ///< mean spacing [m]
  double perturb = 0;  ///< fraction of h
  std::uint64_t seed = 1;
  int threads = 1;
  std::map<std::string, std::string> settings;  ///< of this method, keys without its name
  std::filesystem::path out;  ///< folder for history and frames; empty: write nothing
  bool write_frames = true;
  std::function<void(double done, const std::string& what)>
      progress;  ///< fraction of the run; may be empty
};

/// Displacement field of a finished run as a function of reference position, for comparisons
/// anywhere in the body.
class Field {
 public:
  virtual ~Field() = default;
  /// u(X) for every point; `gradient`, when not empty, receives du_i/dX_j. Points on or (by
  /// round-off) outside the body take the nearest cell.
  virtual void evaluate(std::span<const Vec3> X, std::span<Vec3> u,
                        std::span<Mat3> gradient) const = 0;
};

/// The places where a method itself knows its solution: particles with their volumes, or Gauss
/// points with weights.
struct Samples {
  std::vector<Vec3> X, u, v;   ///< v empty in static runs
  std::vector<Mat3> F;         ///< deformation gradients; in plane problems F_33 included
  std::vector<double> weight;  ///< [m^dim], thickness included
};

/// Everything summary.json tells of a run. Absent entries of the maps mean "not defined for
/// this run".
struct Result {
  double h = 0;
  long unknowns = 0;
  long particles = 0;  ///< particles, or nodes of the FEM
  long steps = 0;      ///< time steps, or Newton iterations over all load steps
  double dt = 0;       ///< last time step [s]; 0 in static runs
  double t_end = 0;    ///< time reached [s]
  double setup_s = 0;  ///< mesh, neighbours, assembly: everything before the loop
  double wall_s = 0;   ///< time loop or solve alone, without output
  int threads = 1;
  std::map<std::string, double> errors, invariants, quantities;
  std::map<std::string, std::string> notes;  ///< e.g. "element": "Q2"; free text for tables
  Samples samples;
  std::shared_ptr<const Field> field;
};

struct MethodInfo {
  std::string name, title, source;
  std::vector<ParameterInfo> parameters{};
  /// Properties that the method by its nature does not have, with the reason, e.g.
  /// {"equilibrium patch test", "..."}. The property tests assert the failure, the report tells
  /// it.
  std::map<std::string, std::string> cannot{};
};

/// A method. Stateless: all state belongs to a run.
class Method {
 public:
  virtual ~Method() = default;
  virtual const MethodInfo& info() const = 0;
  /// Runs the problem. Throws InputError (this problem or setting cannot be done), SolveError
  /// (numerics), Interrupted; `result` then holds what was reached, and history and frames
  /// written so far are complete on disk. Fills everything of Result but `errors` that follow
  /// from the exact solution (see norms.hpp).
  virtual void run(const Problem& problem, const RunRequest& request, Result& result) const = 0;
};

/// The methods linked into this program, by name. Each formulation registers itself; there is
/// no central list.
class MethodRegistry {
 public:
  static MethodRegistry& instance();
  void add(std::unique_ptr<Method> method);
  /// Throws InputError naming the methods there are.
  const Method& find(const std::string& name) const;
  std::vector<const Method*> all() const;  ///< sorted by name

 private:
  std::map<std::string, std::unique_ptr<Method>> m_methods;
};

template <class M> struct RegisterMethod {
  RegisterMethod() { MethodRegistry::instance().add(std::make_unique<M>()); }
};

}  // namespace concord::scene
