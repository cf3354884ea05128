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
           {"deviation", "1", "standard deviation over |mean|"}}};
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
    std::vector<double> values;
    for (int k = 0; k < n; ++k) {
      ProbeRequest one = request;
      one.run.seed += static_cast<std::uint64_t>(k);
      one.run.progress = nullptr;
      if (request.run.progress)
        request.run.progress(static_cast<double>(k) / n, fmt::format("seed {}", one.run.seed));
      Attempt run = attempt(one, request.problem, {});
      if (run.failed)
        throw SolveError(run.quantity, run.result.steps, run.result.t_end, -1, run.error);
      scene::add_exact_errors(request.problem, run.result);
      values.push_back(value_of(run.result, request.options.word("quantity")));
      tell_run(run, result);
    }
    tell(values, result);
    if (request.run.out.empty()) return;
    std::ofstream csv(request.run.out / "seeds.csv");
    csv << "seed,value\n";
    for (std::size_t k = 0; k < values.size(); ++k)
      csv << fmt::format("{},{:.10g}\n", request.run.seed + k, values[k]);
  }

 private:
  static void tell(const std::vector<double>& values, scene::Result& result) {
    const auto n = static_cast<double>(values.size());
    double least = values[0], largest = values[0], sum = 0, squares = 0;
    for (const double value : values) {
      least = std::min(least, value);
      largest = std::max(largest, value);
      sum += value / n;
    }
    for (const double value : values) squares += (value - sum) * (value - sum) / (n - 1);
    result.quantities["mean"] = sum;
    result.quantities["least"] = least;
    result.quantities["largest"] = largest;
    result.quantities["spread"] = (largest - least) / std::abs(sum);
    result.quantities["deviation"] = std::sqrt(squares) / std::abs(sum);
  }

  ProbeInfo m_info = placement_info();
};

const RegisterProbe<Placement> registered;

}  // namespace
}  // namespace concord::probes
