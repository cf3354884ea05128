// Probe stable_step: the largest stable step against the method's own estimate, over many
// arrangements of the particles.

#include "studies/probes/states.hpp"
#include "studies/probes/stepping.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>

namespace concord::probes {
namespace {

ProbeInfo stable_step_info() {
  ProbeInfo info{
      "stable_step",
      "Largest stable step of central differences over the method's estimate",
      "linear stability of central differences: dt < 2/omega_max",
      {number_option("arrangements", "1", "1", 1, 100000, ">= 1",
                     "how many, with seeds SEED, SEED + 1, ... of the request"),
       number_option("perturb_from", "1", "-1", -1, 0.45, "-1 .. 0.45",
                     "perturbation of the first arrangement; that of the last is --perturb; "
                     "-1: --perturb for all"),
       word_option("spacing", "linear", {"linear", "log"},
                   "perturbations between the first and the last; tiny ones on a lattice make "
                   "slivers: its cubes' faces hold four points on a circle"),
       number_option("steps", "1", "300", 10, 1000000, ">= 10", "time steps of a trial"),
       number_option("tolerance", "1", "5e-4", 1e-8, 0.1, "1e-8 .. 0.1",
                     "of the bisection, relative")},
      {{"ratio_min", "1", "least stable step over the method's estimate 2/omega_max"},
       {"ratio_mean", "1", "mean of it"},
       {"ratio_max", "1", "largest of it"},
       {"courant_min", "1", "least stable step times c_p over the shortest distance"},
       {"courant_mean", "1", "mean of it"},
       {"courant_max", "1", "largest of it"},
       {"accepted", "1", "arrangements that the method took"},
       {"refused", "1", "arrangements that it refused (inverted cells)"},
       {"refused_share", "1", "refused over all"},
       {"worst_seed", "1", "seed of the least ratio"},
       {"worst_perturb", "1", "perturbation of the least ratio"}}};
  for (const scene::ParameterInfo& option : deformation_options())
    info.options.push_back(option);
  return info;
}

/// Perturbation of arrangement k of n.
double perturbation(const ProbeRequest& request, int k, int n) {
  const double from = request.options.number("perturb_from"), to = request.run.perturb;
  if (from < 0 || n == 1) return to;
  const double s = static_cast<double>(k) / (n - 1);
  if (request.options.word("spacing") == "linear") return from + s * (to - from);
  if (!(from > 0 && to > 0)) {
    throw InputError({"command line"}, "stable_step.perturb_from", fmt::format("{:g}", from),
                     "above 0, and --perturb too, for spacing = log");
  }
  return from * std::pow(to / from, s);
}

struct Measured {
  double perturb, ratio, courant, step;
  std::uint64_t seed;
};

/// Least, mean and largest of a member.
void tell(const std::vector<Measured>& all, double Measured::*member, const std::string& name,
          scene::Result& result) {
  double least = 1e300, largest = -1e300, sum = 0;
  for (const Measured& m : all) {
    least = std::min(least, m.*member);
    largest = std::max(largest, m.*member);
    sum += m.*member;
  }
  result.quantities[name + "_min"] = least;
  result.quantities[name + "_max"] = largest;
  result.quantities[name + "_mean"] = sum / static_cast<double>(all.size());
}

class StableStep final : public Probe {
 public:
  const ProbeInfo& info() const override { return m_info; }

  void run(const ProbeRequest& request, scene::Result& result) const override {
    const int n = static_cast<int>(request.options.number("arrangements"));
    std::vector<Measured> all;
    std::string refusal;
    for (int k = 0; k < n; ++k) {
      scene::RunRequest one = request.run;
      one.seed += static_cast<std::uint64_t>(k);
      one.perturb = perturbation(request, k, n);
      if (request.run.progress)
        request.run.progress(static_cast<double>(k) / n, fmt::format("arrangement {}", k + 1));
      std::unique_ptr<scene::DiscreteBody> body;
      try {
        body = request.body(one);
      } catch (const InputError& error) {  // of the arrangement, unless it is of every one
        refusal = error.what();
        continue;
      }
      all.push_back(measure(request, one, *body));
      tell_size(*body, result);
    }
    if (all.empty()) throw SolveError("every arrangement refused", 0, 0, -1, refusal);
    if (!refusal.empty()) result.notes["refused"] = refusal;
    write(request, all);
    tell(all, &Measured::ratio, "ratio", result);
    tell(all, &Measured::courant, "courant", result);
    result.quantities["accepted"] = static_cast<double>(all.size());
    result.quantities["refused"] = n - static_cast<double>(all.size());
    result.quantities["refused_share"] = result.quantities["refused"] / n;
    const Measured& worst =
        *std::min_element(all.begin(), all.end(), [](const Measured& p, const Measured& q) {
          return p.ratio < q.ratio;
        });
    result.quantities["worst_seed"] = static_cast<double>(worst.seed);
    result.quantities["worst_perturb"] = worst.perturb;
  }

 private:
  static Measured measure(const ProbeRequest& request, const scene::RunRequest& one,
                          scene::DiscreteBody& body) {
    const std::vector<double> u = deformed(body, request.options);
    const double estimate = body.critical_step(u);
    SteppingOptions options;
    options.steps = static_cast<long>(request.options.number("steps"));
    options.tolerance = request.options.number("tolerance");
    const double found = stable_step(body, u, estimate, options);
    const double c_p = request.problem.material.longitudinal_wave_speed();
    return {one.perturb, found / estimate, found * c_p / shortest_distance(body.positions()),
            found, one.seed};
  }

  static void write(const ProbeRequest& request, const std::vector<Measured>& all) {
    if (request.run.out.empty()) return;
    std::ofstream csv(request.run.out / "arrangements.csv");
    csv << "seed,perturb,stable_step_s,ratio,courant\n";
    for (const Measured& m : all)
      csv << fmt::format("{},{:.6g},{:.8g},{:.6g},{:.6g}\n", m.seed, m.perturb, m.step, m.ratio,
                         m.courant);
  }

  ProbeInfo m_info = stable_step_info();
};

const RegisterProbe<StableStep> registered;

}  // namespace
}  // namespace concord::probes
