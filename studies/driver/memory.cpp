#include "studies/driver/memory.hpp"

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

namespace concord::studies {
namespace {

/// A line such as "VmRSS:  1234 kB" of /proc/self/status, in bytes; NaN if there is none.
double status_bytes(const std::string& name) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    double kibibytes = 0;
    if (word == name && status >> kibibytes) return 1024 * kibibytes;
  }
  return std::nan("");
}

}  // namespace

MemoryUse::MemoryUse() : m_start(status_bytes("RssAnon:")) {
  std::ofstream("/proc/self/clear_refs") << 5;  // proc(5): sets the peak to what is held now
}

double MemoryUse::bytes_per_particle(long particles) const {
  if (particles <= 0) return std::nan("");
  const double peak = status_bytes("VmHWM:") - status_bytes("RssFile:");
  return (peak - m_start) / static_cast<double>(particles);
}

std::string with_memory(const std::string& summary, double bytes_per_particle) {
  if (!std::isfinite(bytes_per_particle)) return summary;
  const auto given = nlohmann::ordered_json::parse(summary);
  nlohmann::ordered_json out;
  for (const auto& [key, value] : given.items()) {
    out[key] = value;
    if (key == "peak_rss_mb") out["bytes_per_particle"] = std::round(bytes_per_particle);
  }
  return out.dump(2) + "\n";
}

}  // namespace concord::studies
