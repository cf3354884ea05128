// summary.json.

#include "scene/build_info.hpp"
#include "scene/output.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

namespace concord::scene {
namespace {

using Json = nlohmann::ordered_json;

/// Numbers that are not finite are "not defined for this run": left out.
void put(Json& out, const std::string& key, double value) {
  if (std::isfinite(value)) out[key] = value;
}

Json map_of(const std::map<std::string, double>& values) {
  Json out = Json::object();
  for (const auto& [key, value] : values) put(out, key, value);
  return out;
}

}  // namespace

std::string summary_json(const RunIdentity& id, const Result& result,
                         const std::string& error) {
  Json out;
  out["scene"] = id.scene;
  out["method"] = id.method;
  out["variant"] = id.variant;
  out["dim"] = id.dim;
  put(out, "resolution", id.resolution);
  put(out, "h", result.h);
  put(out, "perturb", id.perturb);
  out["unknowns"] = result.unknowns;
  out["particles"] = result.particles;
  out["seed"] = id.seed;
  out["steps"] = result.steps;
  put(out, "dt", result.dt > 0 ? result.dt : std::nan(""));
  put(out, "t_end", result.t_end);
  put(out, "setup_s", result.setup_s);
  put(out, "wall_s", result.wall_s);
  const double updates =
      static_cast<double>(result.particles) * static_cast<double>(result.steps);
  if (result.dt > 0 && updates > 0)
    put(out, "ns_per_particle_step", 1e9 * result.wall_s / updates);
  out["peak_rss_mb"] = peak_rss_mb();
  out["threads"] = result.threads;
  out["errors"] = map_of(result.errors);
  out["invariants"] = map_of(result.invariants);
  out["quantities"] = map_of(result.quantities);
  out["notes"] = result.notes;
  out["machine"] = {{"cpu", cpu_name()}, {"simd", simd_name()}, {"threads", result.threads}};
  const BuildInfo& build = build_info();
  out["build"] = {{"version", build.version},
                  {"commit", build.commit},
                  {"compiler", build.compiler},
                  {"flags", build.flags}};
  if (!error.empty()) out["error"] = error;
  return out.dump(2) + "\n";
}

}  // namespace concord::scene
