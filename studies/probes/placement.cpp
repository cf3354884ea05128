// Probe placement: how much one number of a run depends on the random placement of particles.

#include "studies/probes/whole_run.hpp"

#include "scene/norms.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>

namespace concord::probes {
namespace {

ProbeInfo placement_info() {
  return {"placement",
          "Spread of one number of a run over random placements of the particles",
          "random displacements as in the Delaunay paper, section 8",
          {number_option("seeds", "1", "5", 2, 100000, ">= 2",
                         "runs, with seeds SEED, SEED + 1, ..."),
           {"quantity", "1", "errors.displacement_l2", "errors.NAME | quantities.NAME",
            "the number of summary.json that is looked at"}},
          {{"mean", "that of the number", "mean over the seeds"},
           {"least", "that of the number", "smallest value"},
           {"largest", "that of the number", "largest value"},
           {"spread", "1", "(largest - least) / |mean|"},
           {"deviation", "1", "standard deviation over |mean|"},
           {"accepted", "1", "arrangements that the method took"},
           {"refused", "1", "arrangements that it refused (inverted cells)"}}};
}

/// errors.NAME or quantities.NAME of a finished run.
double value_of(const scene::Result& result, const std::string& name) {
  const std::size_t dot = name.find('.');
  const std::string map = name.substr(0, dot), key = name.substr(dot + 1);
  const auto& values = map == "errors" ? result.errors : result.quantities;
  const auto found = values.find(key);
  if (dot == std::string::npos || (map != "errors" && map != "quantities") ||
      found == values.end()) {
    std::string known;
    for (const auto& [error, value] : result.errors) known += " errors." + error;
    for (const auto& [quantity, value] : result.quantities) known += " quantities." + quantity;
    throw InputError({"command line"}, "placement.quantity", '"' + name + '"',
                     "a number that this run has:" + known);
  }
  return found->second;
}

class Placement final : public Probe {
 public:
  const ProbeInfo& info() const override { return m_info; }

  void run(const ProbeRequest& request, scene::Result& result) const override {
    const int n = static_cast<int>(request.options.number("seeds"));
    std::vector<std::pair<std::uint64_t, double>> values;
    std::string refusal;
    for (int k = 0; k < n; ++k) {
      ProbeRequest one = request;
      one.run.seed += static_cast<std::uint64_t>(k);
      one.run.progress = nullptr;
      if (request.run.progress)
        request.run.progress(static_cast<double>(k) / n, fmt::format("seed {}", one.run.seed));
      Attempt run;
      try {
        run = attempt(one, request.problem, {});
      } catch (const InputError& error) {  // of the arrangement, unless it is of every one
        refusal = error.what();
        continue;
      }
      if (run.failed)
        throw SolveError(run.quantity, run.result.steps, run.result.t_end, -1, run.error);
      scene::add_exact_errors(request.problem, run.result);
      values.emplace_back(one.run.seed,
                          value_of(run.result, request.options.word("quantity")));
      tell_run(run, result);
    }
    if (values.empty()) throw SolveError("every arrangement refused", 0, 0, -1, refusal);
    if (!refusal.empty()) result.notes["refused"] = refusal;
    tell(values, result);
    result.quantities["accepted"] = static_cast<double>(values.size());
    result.quantities["refused"] = n - static_cast<double>(values.size());
    if (request.run.out.empty()) return;
    std::ofstream csv(request.run.out / "seeds.csv");
    csv << "seed,value\n";
    for (const auto& [seed, value] : values) csv << fmt::format("{},{:.10g}\n", seed, value);
  }

 private:
  static void tell(const std::vector<std::pair<std::uint64_t, double>>& values,
                   scene::Result& result) {
    const auto n = static_cast<double>(values.size());
    double least = values[0].second, largest = least, sum = 0, squares = 0;
    for (const auto& [seed, value] : values) {
      least = std::min(least, value);
      largest = std::max(largest, value);
      sum += value / n;
    }
    for (const auto& [seed, value] : values) squares += (value - sum) * (value - sum);
    result.quantities["mean"] = sum;
    result.quantities["least"] = least;
    result.quantities["largest"] = largest;
    if (values.size() < 2) {
      result.notes["not_measured"] = "one arrangement has no spread: the others were refused";
      return;
    }
    result.quantities["spread"] = (largest - least) / std::abs(sum);
    result.quantities["deviation"] = std::sqrt(squares / (n - 1)) / std::abs(sum);
  }

  ProbeInfo m_info = placement_info();
};

const RegisterProbe<Placement> registered;

}  // namespace
}  // namespace concord::probes
