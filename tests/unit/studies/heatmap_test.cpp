// Cells of heat maps: pooling, scores, evidence and what is absent; their place in study.json.

#include "sample_study.hpp"
#include "studies/driver/heatmap.hpp"
#include "studies/driver/study_output.hpp"
#include "studies/driver/tables.hpp"

#include <gtest/gtest.h>

using namespace concord::studies;

namespace {

HeatRow row_of(double good, double bad) {
  HeatRow row;
  row.label = "error";
  row.quantity = "errors.displacement_l2";
  row.unit = "%";
  row.good = good;
  row.bad = bad;
  return row;
}

class Heat : public testing::Test {
 protected:
  void SetUp() override {
    study = sample_study();
    rows = sample_rows(study);
    for (Row& row : rows) {
      row.run = "runs/" + std::to_string(&row - rows.data());
      row.command = "./concord run " + std::to_string(&row - rows.data());
    }
  }
  HeatCell cell(const HeatRow& row) { return heat_cell(study, rows, {"D", {}}, row); }

  Study study;
  std::vector<Row> rows;
};

}  // namespace

TEST(HeatScores, LinearOrLogarithmicFromBadToGood) {
  EXPECT_DOUBLE_EQ(score_of(row_of(0, 10), 2.5), 0.75);
  EXPECT_DOUBLE_EQ(score_of(row_of(0, 10), -1), 1);
  EXPECT_DOUBLE_EQ(score_of(row_of(0, 10), 11), 0);
  EXPECT_DOUBLE_EQ(score_of(row_of(10, 0), 2.5), 0.25) << "high is better";
  HeatRow decades = row_of(1e-12, 1e-2);
  decades.logarithmic = true;
  EXPECT_NEAR(score_of(decades, 1e-7), 0.5, 1e-12);
  EXPECT_EQ(score_of(decades, 0), 1) << "nothing at all is better than good";
}

TEST_F(Heat, PoolsOverRunsAndPointsToTheOneThatHoldsTheValue) {
  HeatRow row = row_of(0, 10);
  const HeatCell worst = cell(row);  // 1.2/16 of resolution 4, seed 2: row 1
  EXPECT_NEAR(*worst.value, 7.5, 1e-12);
  EXPECT_NEAR(*worst.score, 0.25, 1e-12);
  EXPECT_EQ(worst.run, "runs/1");
  EXPECT_EQ(worst.command, "./concord run 1");
  row.over_seeds = Pool::min;
  row.resolution = 8;
  EXPECT_EQ(cell(row).run, "runs/2");
  row.over_seeds = Pool::mean;
  EXPECT_NEAR(*cell(row).value, 100 * 1.15 / 64, 1e-12);
  EXPECT_EQ(cell(row).run, "runs/2") << "the first one";
}

TEST_F(Heat, WhatIsAbsentSaysWhy) {
  HeatRow row = row_of(0, 10);
  rows[3].error = "det F <= 0";
  const HeatCell failed = cell(row);
  EXPECT_FALSE(failed.value);
  EXPECT_FALSE(failed.score);
  EXPECT_EQ(failed.reason, "det F <= 0");
  EXPECT_EQ(failed.run, "runs/3") << "the evidence of the failure";
  EXPECT_EQ(heat_cell(study, {}, {"D", {}}, row).reason, "did not run");
  row.resolution = 32;
  EXPECT_EQ(cell(row).reason, "no run at resolution 32");
  row.selector.method = "fem";
  EXPECT_EQ(cell(row).reason, "no case in this report");
  row.absent = "it has no such setting";
  EXPECT_EQ(cell(row).reason, "it has no such setting");
}

TEST_F(Heat, MarksRunsWhoseBalanceDoesNotClose) {
  study.balance_tolerance = 0.01;
  EXPECT_TRUE(cell(row_of(0, 10)).closes);
  rows[5].summary["invariants"]["energy_drift"] = 1;
  EXPECT_FALSE(cell(row_of(0, 10)).closes);
}

TEST_F(Heat, StandsInStudyJsonAndTheTables) {
  Heatmap map;
  map.title = "Stability";
  map.columns = {{"D", {}}, {"F", {{}, "fem"}}};
  map.rows = {row_of(0, 10)};
  study.heatmaps = {map};
  Matched matched;
  matched.quantity = "errors.displacement_l2";
  matched.levels = {0.01};
  study.matched = {matched};
  Plot plot;
  plot.kind = "work_precision";
  plot.quantity = matched.quantity;
  study.plots = {plot};
  StudyResult result;
  result.study = &study;
  result.rows = rows;
  const auto json = study_json(result);
  const auto& cells = json["heatmap"].at(0)["rows"].at(0)["cells"];
  EXPECT_EQ(cells.at(0)["run"], "runs/1");
  EXPECT_TRUE(cells.at(1)["value"].is_null());
  EXPECT_EQ(json["matched"].at(0)["cases"].at(0)["at"].at(0)["status"], "met");
  const auto& curve = json["plots"].at(0)["curves"].at(0);
  EXPECT_EQ(curve["points"].size(), 3u);
  EXPECT_EQ(json["plots"][0]["front"].size(), 1u) << "equal times: the finest dominates";
  EXPECT_TRUE(curve["points"][2]["pareto"].get<bool>());
  std::vector<std::string> names;
  for (const Table& table : tables_of(result)) names.push_back(table.name);
  for (const char* name : {"work-precision-1", "matched-1", "matched-1-sentences", "heatmap-1"})
    EXPECT_NE(std::find(names.begin(), names.end(), name), names.end()) << name;
}
