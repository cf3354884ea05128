#include "studies/driver/timed_runs.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <stdexcept>

namespace concord::studies {

Timings time_runs(const scene::Method& method, const scene::Problem& problem,
                  const scene::RunRequest& request, int repeats) {
  scene::RunRequest silent = request;
  silent.out.clear();
  silent.write_frames = false;
  silent.progress = nullptr;
  Timings timings;
  for (int i = 0; i < repeats; ++i) {
    scene::Result result;
    result.threads = request.threads;
    method.run(problem, silent, result);
    timings.setup_s.push_back(result.setup_s);
    timings.wall_s.push_back(result.wall_s);
  }
  return timings;
}

double quantile(std::vector<double> values, double q) {
  if (values.empty() || !(q >= 0 && q <= 1))
    throw std::invalid_argument("a quantile needs a value and 0 <= q <= 1");
  std::sort(values.begin(), values.end());
  const double at = q * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (at - static_cast<double>(below)) * (values[above] - values[below]);
}

std::string with_timings(const std::string& summary, const Timings& timings) {
  if (timings.wall_s.empty()) return summary;
  auto json = nlohmann::ordered_json::parse(summary);
  const auto quartiles = [](const std::vector<double>& values) {
    return nlohmann::ordered_json{quantile(values, 0.25), quantile(values, 0.75)};
  };
  json["repeats"] = timings.wall_s.size();
  json["setup_s_quartiles"] = quartiles(timings.setup_s);
  json["wall_s_quartiles"] = quartiles(timings.wall_s);
  return json.dump(2) + "\n";
}

}  // namespace concord::studies
