// Memory of a run, as summary.json reports it.

#include "studies/driver/memory.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <vector>

namespace concord::studies {
namespace {

TEST(Memory, CountsWhatARunHeldAtOnceEvenIfItGaveItBack) {
  constexpr std::size_t bytes = 256u << 20;  // far above what the rest of the process does
  constexpr long particles = 1000;
  const MemoryUse use;
  {
    const std::vector<char> held(bytes, 1);
    EXPECT_EQ(held.back(), 1);
  }
  EXPECT_NEAR(use.bytes_per_particle(particles), static_cast<double>(bytes) / particles,
              0.05 * bytes / particles);
  // A second run does not count the peak of the first, where the kernel lets it be reset.
  const MemoryUse later;
  const double after = later.bytes_per_particle(particles);
  EXPECT_GE(after, 0);
  EXPECT_LT(after, 0.05 * bytes / particles);
}

TEST(Memory, IsNotDefinedWithoutParticles) {
  EXPECT_TRUE(std::isnan(MemoryUse().bytes_per_particle(0)));
}

TEST(Memory, EntersTheSummaryBesideThePeakAndLeavesTheRest) {
  const std::string summary = R"({"scene": "s", "peak_rss_mb": 12.5, "threads": 2})";
  const auto with = nlohmann::ordered_json::parse(with_memory(summary, 1234.4));
  EXPECT_EQ(with.dump(),
            R"({"scene":"s","peak_rss_mb":12.5,"bytes_per_particle":1234.0,"threads":2})");
  EXPECT_EQ(with_memory(summary, std::nan("")), summary);
}

}  // namespace
}  // namespace concord::studies
