// Judging: bounds, units, pooling over seeds, and claims without a value.

#include "sample_study.hpp"
#include "studies/driver/claims.hpp"

#include <gtest/gtest.h>

using namespace concord::studies;

namespace {

ClaimResult judge_one(Study& study, const Claim& claim, const std::vector<Row>& rows) {
  study.claims = {claim};
  return judge(study, rows, fit_all(study, rows), references_of(study, rows)).at(0);
}

Claim value_claim(double resolution, Pool pool) {
  Claim claim;
  claim.id = "c";
  claim.quantity = "errors.displacement_l2";
  claim.resolution = resolution;
  claim.over_seeds = pool;
  claim.maximum = 1;
  return claim;
}

}  // namespace

TEST(Claims, PoolOverSeeds) {
  Study study = sample_study();
  const auto rows = sample_rows(study);
  EXPECT_NEAR(*judge_one(study, value_claim(4, Pool::max), rows).measured, 1.2 / 16, 1e-15);
  EXPECT_NEAR(*judge_one(study, value_claim(4, Pool::min), rows).measured, 1.1 / 16, 1e-15);
  EXPECT_NEAR(*judge_one(study, value_claim(4, Pool::mean), rows).measured, 1.15 / 16, 1e-15);
  EXPECT_NEAR(*judge_one(study, value_claim(4, Pool::range), rows).measured, 0.1 / 16, 1e-15);
  Claim all = value_claim(4, Pool::max);
  all.resolution.reset();
  EXPECT_NEAR(*judge_one(study, all, rows).measured, 1.2 / 16, 1e-15);
}

// Errors are (1 + seed/10)/N^2: means 1.15/N^2, ranges .1/N^2.
TEST(Claims, PoolOverSeedsThenOverResolutions) {
  Study study = sample_study();
  const auto rows = sample_rows(study);
  Claim claim = value_claim(4, Pool::mean);
  claim.resolution.reset();
  claim.over_resolutions = Pool::range;
  EXPECT_NEAR(*judge_one(study, claim, rows).measured, 1.15 * (1. / 16 - 1. / 256), 1e-15);
  claim.kind = ClaimKind::ratio;
  claim.other_quantity = claim.quantity;
  claim.other_over_seeds = Pool::range;
  claim.other_over_resolutions = Pool::mean;
  EXPECT_NEAR(*judge_one(study, claim, rows).measured,
              11.5 * (1. / 16 - 1. / 256) / ((1. / 16 + 1. / 64 + 1. / 256) / 3), 1e-12);
}

TEST(Claims, BoundsAreInTheClaimsUnit) {
  Study study = sample_study();
  const auto rows = sample_rows(study);
  Claim claim = value_claim(4, Pool::max);  // 0.075
  claim.unit = "%";
  claim.maximum = 7.6;
  EXPECT_EQ(judge_one(study, claim, rows).verdict, Verdict::pass);
  EXPECT_EQ(bound_text(claim), "<= 7.6 %");
  claim.maximum = 7.4;
  const ClaimResult failed = judge_one(study, claim, rows);
  EXPECT_EQ(failed.verdict, Verdict::fail);
  EXPECT_NEAR(*failed.measured, 7.5, 1e-12);
  EXPECT_FALSE(failed.reason.empty());
  claim.minimum = 7.0;
  EXPECT_EQ(bound_text(claim), ">= 7 % and <= 7.4 %");
}

TEST(Claims, SlopeWithinItsBand) {
  Study study = sample_study();
  const auto rows = sample_rows(study);
  Claim claim;
  claim.kind = ClaimKind::slope;
  claim.quantity = "errors.displacement_l2";
  claim.minimum = 1.8;
  EXPECT_EQ(judge_one(study, claim, rows).verdict, Verdict::pass);
  claim.minimum = 2.1;
  EXPECT_EQ(judge_one(study, claim, rows).verdict, Verdict::fail);
}

TEST(Claims, RatioOfTwoRuns) {
  Study study = sample_study();
  const auto rows = sample_rows(study);
  Claim claim = value_claim(4, Pool::mean);
  claim.kind = ClaimKind::ratio;
  claim.other_quantity = claim.quantity;
  claim.other_resolution = 8;
  claim.maximum = 4.1;
  EXPECT_NEAR(*judge_one(study, claim, rows).measured, 4, 1e-12);
}

TEST(Claims, WithoutAValueItFailsAndSaysWhy) {
  Study study = sample_study();
  auto rows = sample_rows(study);
  const ClaimResult absent = judge_one(study, value_claim(32, Pool::max), rows);
  EXPECT_EQ(absent.verdict, Verdict::fail);
  EXPECT_NE(absent.reason.find("32"), std::string::npos);
  rows[1].error = "the numerics failed: det F";
  const ClaimResult failed = judge_one(study, value_claim(4, Pool::max), rows);
  EXPECT_EQ(failed.verdict, Verdict::fail) << "one seed failed: the others do not speak for it";
  EXPECT_NE(failed.reason.find("det F"), std::string::npos);
}

TEST(Claims, OfTheFullReportAreListedInTheQuickOne) {
  Study study = sample_study();
  Claim claim = value_claim(32, Pool::max);
  claim.full_only = true;
  EXPECT_EQ(judge_one(study, claim, sample_rows(study)).verdict, Verdict::full_report_only);
  study.full = true;
  EXPECT_EQ(judge_one(study, claim, sample_rows(study)).verdict, Verdict::fail);
}

namespace {

/// Three cases with psi .01, .1, 1 whose error is least at .1, and one without psi.
Study swept() {
  Study study = sample_study();
  Case base = study.cases[0];
  base.method = "tlsph";
  base.resolutions = {4};
  base.seeds = {1};
  for (const char* psi : {"0.01", "0.1", "1"}) {
    Case one = base;
    one.variant = std::string("r 3, psi ") + psi;
    one.set["psi"] = psi;
    study.cases.push_back(one);
  }
  return study;
}

std::vector<Row> swept_rows(const Study& study) {
  auto rows = sample_rows(study);
  const double error[] = {0.07, 0.03, 0.05};
  for (Row& row : rows)
    if (row.case_index > 0)
      row.summary["errors"]["displacement_l2"] = error[row.case_index - 1];
  return rows;
}

Claim least_claim() {
  Claim claim;
  claim.id = "least";
  claim.kind = ClaimKind::minimum;
  claim.selector = {std::nullopt, "tlsph", "r 3*"};
  claim.quantity = "errors.displacement_l2";
  claim.setting = "psi";
  claim.setting_minimum = 0.05;
  claim.setting_maximum = 0.15;
  return claim;
}

}  // namespace

TEST(Claims, MinimumOverASweepAndItsPlace) {
  Study study = swept();
  const auto rows = swept_rows(study);
  Claim claim = least_claim();
  claim.minimum = 0.02;
  claim.maximum = 0.04;
  const ClaimResult result = judge_one(study, claim, rows);
  EXPECT_EQ(result.verdict, Verdict::pass) << result.reason;
  EXPECT_DOUBLE_EQ(*result.measured, 0.03);
  EXPECT_DOUBLE_EQ(*result.place, 0.1);
  EXPECT_EQ(bound_text(claim), ">= 0.02 and <= 0.04, at psi 0.05 to 0.15");
  claim.setting_minimum = 0.2;
  claim.setting_maximum.reset();
  const ClaimResult elsewhere = judge_one(study, claim, rows);
  EXPECT_EQ(elsewhere.verdict, Verdict::fail);
  EXPECT_NE(elsewhere.reason.find("at psi 0.1"), std::string::npos) << elsewhere.reason;
  claim.setting = "absent";
  EXPECT_EQ(judge_one(study, claim, rows).verdict, Verdict::fail) << "a place is asked for";
}

TEST(Claims, MinimumOverAnotherCase) {
  Study study = swept();
  Claim claim = least_claim();
  claim.divided = true;
  claim.other = {std::nullopt, "delaunay", std::nullopt};
  claim.other_quantity = claim.quantity;
  claim.other_resolution = 4;
  claim.minimum = 0.1;
  EXPECT_DOUBLE_EQ(*judge_one(study, claim, swept_rows(study)).measured, 0.03 / (1.2 / 16));
}

TEST(Claims, ACaseWithoutAValueCannotHoldTheMinimumAndIsNamed) {
  Study study = swept();
  auto rows = swept_rows(study);
  rows.back().error = "no equilibrium";
  const ClaimResult result = judge_one(study, least_claim(), rows);
  EXPECT_EQ(result.verdict, Verdict::pass);
  EXPECT_NE(result.reason.find("no equilibrium"), std::string::npos) << result.reason;
  for (Row& row : rows) row.error = "no equilibrium";
  EXPECT_EQ(judge_one(study, least_claim(), rows).verdict, Verdict::fail);
}

TEST(Claims, SayWhenTheEnergyBalanceOfARunDoesNotClose) {
  Study study = sample_study();
  auto rows = sample_rows(study);
  rows[1].summary["invariants"] = {{"energy_drift", -0.5}};
  EXPECT_FALSE(balance_closes(study, rows[1])) << "not judged without a tolerance";
  study.balance_tolerance = 0.01;
  EXPECT_EQ(balance_closes(study, rows[1]), false);
  EXPECT_EQ(balance_closes(study, rows[0]), std::nullopt);
  const ClaimResult result = judge_one(study, value_claim(4, Pool::max), rows);
  EXPECT_EQ(result.verdict, Verdict::pass);
  EXPECT_NE(
      result.reason.find("does not close: delaunay (xi 1) on block, resolution 4, seed 2"),
      std::string::npos)
      << result.reason;
  EXPECT_TRUE(judge_one(study, value_claim(8, Pool::max), rows).reason.empty());
}
