// Timed runs: quantiles, and what a method is asked for when it is timed.

#include "studies/driver/timed_runs.hpp"

#include <nlohmann/json.hpp>

#include <gtest/gtest.h>

using namespace concord;
using namespace concord::studies;

namespace {

/// Takes 1, 2, 3, ... s as it says, and notes whether it was asked for output.
class Clockwork : public scene::Method {
 public:
  const scene::MethodInfo& info() const override { return m_info; }
  void run(const scene::Problem&, const scene::RunRequest& request,
           scene::Result& result) const override {
    result.wall_s = ++m_runs;
    result.setup_s = 0.1 * m_runs;
    silent = silent && request.out.empty() && !request.write_frames && !request.progress;
    h = request.h;
  }
  mutable bool silent = true;
  mutable double h = 0;

 private:
  scene::MethodInfo m_info;
  mutable int m_runs = 0;
};

}  // namespace

TEST(TimedRuns, QuantilesOfOrderedValues) {
  EXPECT_DOUBLE_EQ(quantile({3}, 0.25), 3);
  EXPECT_DOUBLE_EQ(quantile({5, 1, 3, 4, 2}, 0.5), 3);
  EXPECT_DOUBLE_EQ(quantile({5, 1, 3, 4, 2}, 0.25), 2);
  EXPECT_DOUBLE_EQ(quantile({4, 1, 2, 3}, 0.75), 3.25);
  EXPECT_DOUBLE_EQ(quantile({4, 1, 2, 3}, 0), 1);
  EXPECT_DOUBLE_EQ(quantile({4, 1, 2, 3}, 1), 4);
  EXPECT_THROW((void)quantile({}, 0.5), std::invalid_argument);
}

TEST(TimedRuns, AreAsManyAsAskedForAndWriteNothing) {
  const Clockwork method;
  scene::RunRequest request;
  request.h = 0.5;
  request.out = "folder";
  request.progress = [](double, const std::string&) {};
  const Timings timings = time_runs(method, {}, request, 5);
  EXPECT_EQ(timings.wall_s, (std::vector<double>{1, 2, 3, 4, 5}));
  EXPECT_TRUE(method.silent);
  EXPECT_EQ(method.h, 0.5);
  const auto summary = nlohmann::json::parse(with_timings("{\"wall_s\": 3}", timings));
  EXPECT_EQ(summary["repeats"], 5);
  EXPECT_EQ(summary["wall_s_quartiles"], (std::vector<double>{2, 4}));
  EXPECT_NEAR(summary["setup_s_quartiles"][1].get<double>(), 0.4, 1e-15);
  EXPECT_EQ(with_timings("{}", {}), "{}") << "none were timed";
}
