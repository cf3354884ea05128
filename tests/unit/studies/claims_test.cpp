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
  Claim all = value_claim(4, Pool::max);
  all.resolution.reset();
  EXPECT_NEAR(*judge_one(study, all, rows).measured, 1.2 / 16, 1e-15);
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
