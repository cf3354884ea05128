// Pareto fronts of made-up points, times at matched errors inside, below and beyond ladders.

#include "sample_study.hpp"
#include "studies/driver/claims.hpp"
#include "studies/driver/work_precision.hpp"

#include <gtest/gtest.h>

using namespace concord::studies;

namespace {

using Indices = std::vector<std::size_t>;

Indices front_of(const std::vector<double>& time, const std::vector<double>& error) {
  return pareto_front(std::span<const double>(time), std::span<const double>(error));
}

/// A curve of made-up points: resolution 2, 4, 8, ..., memory 1, 4, 16, ... MB.
WorkCurve curve(const std::vector<double>& error, const std::vector<double>& time) {
  WorkCurve made;
  for (std::size_t i = 0; i < error.size(); ++i) {
    WorkPoint point;
    point.resolution = std::pow(2., i + 1);
    point.error = error[i];
    point.time = point.wall_s = time[i];
    point.setup_s = 0;
    point.memory_mb = std::pow(4., i);
    made.points.push_back(point);
  }
  return made;
}

/// Cases on one scene whose errors are a h^2 and whose times are b N^3.
class Ladders : public testing::Test {
 protected:
  void SetUp() override {
    study = sample_study();
    study.cases.clear();
    add("delaunay", "xi 1", 1, 1e-4);
    add("tlsph", "support 2", 1, 8e-4);
    add("fem", "Q2", 0.01, 1.1e-3);
    entry.quantity = "errors.e";
    entry.levels = {0.1, 0.01};
  }
  void add(const std::string& method, const std::string& variant, double a, double b) {
    Case one;
    one.scene = "block";
    one.method = method;
    one.variant = variant;
    one.resolutions = {2, 4, 8, 16};
    for (const double n : one.resolutions) {
      Row row;
      row.case_index = study.cases.size();
      row.resolution = n;
      row.run = method + std::to_string(static_cast<int>(n));
      row.summary = {{"wall_s", b * n * n * n},
                     {"setup_s", 0.5 * b * n * n * n},
                     {"particles", n * n * n},
                     {"bytes_per_particle", 1000},
                     {"errors", {{"e", a / (n * n)}}}};
      rows.push_back(row);
    }
    study.cases.push_back(one);
  }
  Claim ratio_claim(const std::string& method, const std::string& other, double level) const {
    Claim claim;
    claim.id = "r";
    claim.kind = ClaimKind::matched_ratio;
    claim.selector.method = method;
    claim.other.method = other;
    claim.quantity = claim.other_quantity = "errors.e";
    claim.divided = true;
    claim.level = level;
    claim.minimum = 5;
    return claim;
  }
  ClaimResult judged(const Claim& claim) {
    study.claims = {claim};
    return judge(study, rows, {}, {}).at(0);
  }

  Study study;
  std::vector<Row> rows;
  Matched entry;
};

}  // namespace

TEST(Pareto, FrontOfMadeUpPoints) {
  // Slower and worse than 0 is 1; 2 is slower and better; 3 as fast as 2 but worse; 4 the best.
  EXPECT_EQ(front_of({1, 2, 3, 3, 9}, {5, 6, 4, 4.5, 1}), (Indices{0, 2, 4}));
  EXPECT_EQ(front_of({9, 3, 1}, {1, 4, 5}), (Indices{2, 1, 0})) << "in the order of time";
  EXPECT_EQ(front_of({1, 1, 2}, {3, 3, 3}), (Indices{0, 1})) << "twins do not dominate";
  EXPECT_EQ(front_of({2, 1}, {3, 3}), (Indices{1})) << "as precise, but slower";
  EXPECT_TRUE(front_of({}, {}).empty());
}

TEST_F(Ladders, FrontOverAllCases) {
  const auto curves = work_curves(study, rows, {}, "errors.e", WorkTime::wall);
  ASSERT_EQ(curves.size(), 3u);
  const auto front = pareto_front(curves);
  for (const auto& [c, p] : front)
    for (const auto& curve : curves)
      for (const WorkPoint& point : curve.points)
        EXPECT_FALSE(point.time < curves[c].points[p].time &&
                     point.error < curves[c].points[p].error);
  // delaunay at 2 costs .8 ms, fem at 2 has .25 %; tlsph is never best.
  EXPECT_EQ(front.at(0), (std::pair<std::size_t, std::size_t>{0, 0}));
  for (const auto& [c, p] : front) EXPECT_NE(c, 1u);
}

TEST(Matched, InterpolatesOnLogarithmicScales) {
  // error 1/N^2, time N^3: at error e N = e^-1/2 and time e^-3/2, exactly.
  const auto made = curve({0.25, 0.0625, 0.015625}, {8, 64, 512});
  const MatchedPoint at = match(made, 0.04);
  EXPECT_EQ(at.status, MatchStatus::met);
  EXPECT_NEAR(*at.time, 125, 1e-10);
  EXPECT_NEAR(*at.resolution, 5, 1e-12);
  EXPECT_NEAR(*at.memory_mb, std::pow(5, 2) / 4, 1e-12);
  EXPECT_NEAR(*match(made, 0.0625).time, 64, 1e-10) << "a point of the ladder";
}

TEST(Matched, OutsideTheLadderNothingIsMadeUp) {
  const auto made = curve({0.25, 0.0625, 0.015625}, {8, 64, 512});
  const MatchedPoint beyond = match(made, 0.01);
  EXPECT_EQ(beyond.status, MatchStatus::not_reached);
  EXPECT_FALSE(beyond.time);
  EXPECT_EQ(*beyond.finest_error, 0.015625);
  EXPECT_EQ(*beyond.finest_time, 512);
  const MatchedPoint before = match(made, 0.5);
  EXPECT_EQ(before.status, MatchStatus::met_by_coarsest);
  EXPECT_EQ(*before.time, 8);
  WorkCurve none;
  none.absent = {{4, "det F <= 0"}};
  EXPECT_EQ(match(none, 0.1).status, MatchStatus::no_value);
  EXPECT_EQ(match(none, 0.1).reason, "det F <= 0");
}

TEST(Matched, AnErrorThatComesBackIsNotMet) {
  // Below 1 % at the second level by accident, above again at the third.
  const auto dip = curve({0.2, 0.001, 0.05, 0.005}, {1, 10, 100, 1000});
  const MatchedPoint at = match(dip, 0.01);
  EXPECT_EQ(at.status, MatchStatus::met);
  EXPECT_GT(*at.time, 100);
  EXPECT_LT(*at.time, 1000);
  const auto late = curve({0.2, 0.001, 0.05}, {1, 10, 100});
  EXPECT_EQ(match(late, 0.01).status, MatchStatus::not_reached);
}

TEST_F(Ladders, PointsAreMeansOverSeedsAndSayWhatIsAbsent) {
  study.balance_tolerance = 0.01;
  study.cases[0].seeds = {1, 2};
  Row second = rows[0];
  second.seed = 2;
  second.summary["errors"]["e"] = -0.35;  // signed: its magnitude counts
  second.summary["invariants"]["energy_drift"] = 0.5;
  rows.push_back(second);
  rows[1].error = "no equilibrium";
  rows[2].summary["errors"]["e"] = 0;
  const auto made = work_curves(study, rows, {{}, "delaunay"}, "errors.e", WorkTime::total);
  ASSERT_EQ(made.at(0).points.size(), 2u);
  const WorkPoint& first = made[0].points[0];
  EXPECT_DOUBLE_EQ(first.error, 0.3);
  EXPECT_DOUBLE_EQ(first.error_max, 0.35);
  EXPECT_DOUBLE_EQ(first.time, 1.5 * 8e-4);
  EXPECT_DOUBLE_EQ(first.memory_mb, 8e-3);
  EXPECT_FALSE(first.closes);
  ASSERT_EQ(made[0].absent.size(), 2u);
  EXPECT_EQ(made[0].absent[0].second, "no equilibrium");
  EXPECT_EQ(made[0].absent[1].second, "the error is 0");
  // The mark goes where the point goes.
  EXPECT_FALSE(match(made[0], 0.1).closes);
  EXPECT_TRUE(match(made[0], 1e-3).closes);
}

TEST_F(Ladders, TheTableSaysWhoIsFastest) {
  const auto cases = matched_cases(study, rows, entry);
  // 10 %: N = sqrt(10), delaunay 3.2 ms, tlsph 25 ms; fem's coarsest, .25 %, costs 8.8 ms.
  EXPECT_TRUE(cases[0].at[0].fastest);
  EXPECT_NEAR(*cases[0].at[0].time, 1e-4 * std::pow(10, 1.5), 1e-9);
  EXPECT_EQ(cases[2].at[0].status, MatchStatus::met_by_coarsest);
  // 1 %: delaunay 100 ms, fem still 8.8 ms.
  EXPECT_TRUE(cases[2].at[1].fastest);
  const auto sentences = sentences_of(study, entry, cases);
  ASSERT_EQ(sentences.size(), 2u);
  EXPECT_EQ(sentences[0],
            "block, 10 %: delaunay (xi 1) is the fastest with 0.00316 s; tlsph (support 2) "
            "takes 8.0 times as long, fem (Q2) takes at most 2.8 times as long.");
  EXPECT_EQ(sentences[1],
            "block, 1 %: fem (Q2) is the fastest with at most 0.0088 s; delaunay (xi 1) takes "
            "at least 11 times as long, tlsph (support 2) takes at least 91 times as long.");
}

TEST_F(Ladders, RatiosOfTimesAtOneError) {
  const ClaimResult pass = judged(ratio_claim("delaunay", "tlsph", 0.01));
  EXPECT_EQ(pass.verdict, Verdict::pass) << pass.reason;
  EXPECT_NEAR(*pass.measured, 8, 1e-9);
  EXPECT_TRUE(pass.reason.empty());
  Claim more = ratio_claim("delaunay", "tlsph", 0.01);
  more.minimum = 9;
  EXPECT_EQ(judged(more).verdict, Verdict::fail);
  const ClaimResult beyond = judged(ratio_claim("delaunay", "tlsph", 1e-3));
  EXPECT_EQ(beyond.verdict, Verdict::fail) << "delaunay's finest has .39 %";
  EXPECT_NE(beyond.reason.find("not reached"), std::string::npos) << beyond.reason;
}

TEST_F(Ladders, BoundsOfRatiosAreToldAsSuch) {
  rows[7].error = rows[6].error = "out of time";  // tlsph's finest now has 6 %
  const ClaimResult other = judged(ratio_claim("delaunay", "tlsph", 0.05));
  EXPECT_EQ(other.verdict, Verdict::pass) << "at least 5.7 times";
  EXPECT_NEAR(*other.measured, 8e-4 * 64 / (1e-4 * std::pow(20, 1.5)), 1e-9);
  EXPECT_NE(other.reason.find("a lower bound: the other case does not reach 5 %"),
            std::string::npos)
      << other.reason;
  const auto dip = rows[4].summary["errors"]["e"];
  rows[4].summary["errors"]["e"] = 0.01;  // by accident
  const ClaimResult accident = judged(ratio_claim("delaunay", "tlsph", 0.05));
  EXPECT_FALSE(accident.measured);
  EXPECT_NE(accident.reason.find("not monotone"), std::string::npos) << accident.reason;
  rows[4].summary["errors"]["e"] = dip;
  Claim bounded = ratio_claim("delaunay", "tlsph", 0.05);
  bounded.maximum = 100;
  EXPECT_FALSE(judged(bounded).measured) << "a lower bound cannot meet a maximum";
  const ClaimResult coarsest = judged(ratio_claim("fem", "delaunay", 0.01));
  EXPECT_EQ(coarsest.verdict, Verdict::pass);
  EXPECT_NE(coarsest.reason.find("coarsest"), std::string::npos) << coarsest.reason;
  EXPECT_FALSE(judged(ratio_claim("delaunay", "fem", 0.01)).measured)
      << "the numerator is only an upper bound";
}
