// Values, levels, fits and references from rows.

#include "sample_study.hpp"

#include <gtest/gtest.h>

#include <cmath>

using namespace concord::studies;

TEST(Rows, ValueAtADottedPath) {
  const Study study = sample_study();
  Row row = sample_rows(study).front();
  EXPECT_DOUBLE_EQ(*value_of(row, "h"), 0.25);
  EXPECT_DOUBLE_EQ(*value_of(row, "quantities.tip"), 1.0625);
  EXPECT_FALSE(value_of(row, "quantities.top"));
  EXPECT_FALSE(value_of(row, "errors"));
  EXPECT_FALSE(value_of(row, "h.x"));
  row.error = "failed";
  EXPECT_FALSE(value_of(row, "h")) << "values of a run that failed are not results";
}

TEST(Rows, LevelsAreMeansOverSeeds) {
  const Study study = sample_study();
  const auto levels = levels_of(sample_rows(study), 0, "errors.displacement_l2");
  ASSERT_EQ(levels.size(), 3u);
  EXPECT_EQ(levels[0].resolution, 4);
  EXPECT_NEAR(levels[0].mean, 1.15 / 16, 1e-15);
  EXPECT_NEAR(levels[0].minimum, 1.1 / 16, 1e-15);
  EXPECT_NEAR(levels[0].maximum, 1.2 / 16, 1e-15);
  EXPECT_EQ(levels[0].seeds, 2u);
}

TEST(Rows, ALevelWithAFailedSeedIsNone) {
  const Study study = sample_study();
  auto rows = sample_rows(study);
  rows.back().error = "det F <= 0";
  EXPECT_EQ(levels_of(rows, 0, "errors.displacement_l2").size(), 2u);
  EXPECT_TRUE(fit_all(study, rows).empty()) << "two levels are no fit";
}

TEST(Rows, FitsTheLevels) {
  Study study = sample_study();
  auto fits = fit_all(study, sample_rows(study));
  ASSERT_EQ(fits.size(), 1u);
  EXPECT_NEAR(fits[0].line.slope, 2, 1e-12);
  study.fits[0].finest = 2;
  fits = fit_all(study, sample_rows(study));
  EXPECT_EQ(fits.at(0).resolutions, (std::vector<double>{8, 16}));
  study.fits[0].selector.method = "tlsph";
  EXPECT_TRUE(fit_all(study, sample_rows(study)).empty());
}

TEST(Rows, ReferencesCarryTheirError) {
  Study study = sample_study();
  Reference reference;
  reference.quantity = "quantities.tip";
  study.references.push_back(reference);
  const auto references = references_of(study, sample_rows(study));
  ASSERT_EQ(references.size(), 1u);
  EXPECT_NEAR(references[0].convergence.order, 2, 1e-9);
  EXPECT_NEAR(references[0].value, 1 + 1.0 / 256, 1e-15);
  study.cases[0].resolutions = {4, 8};
  const auto two = references_of(study, sample_rows(study));
  EXPECT_FALSE(two.at(0).convergence.asymptotic);
}
