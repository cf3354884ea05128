// Tables of chosen cases: pools, differences to another case run by run, what is absent.

#include "sample_study.hpp"
#include "studies/driver/run_table.hpp"
#include "studies/driver/study_output.hpp"
#include "studies/driver/tables.hpp"

#include <gtest/gtest.h>

using namespace concord::studies;

namespace {

/// Two cases: errors (1 + seed/10)/N^2, and the other's 1e-3 seed more, without a third seed.
class ChosenCases : public testing::Test {
 protected:
  void SetUp() override {
    study = sample_study();
    study.cases.push_back(study.cases[0]);
    study.cases[1].variant = "other";
    study.cases[0].seeds = {1, 2, 3};
    rows = sample_rows(study);
    for (Row& row : rows)
      if (row.case_index == 1)
        row.summary["errors"]["displacement_l2"] =
            row.summary["errors"]["displacement_l2"].get<double>() +
            1e-3 * static_cast<double>(row.seed);
    line.label = "other";
    line.selector.variant = "other";
    line.resolution = 4;
    column.label = "error";
    column.quantity = "errors.displacement_l2";
    column.unit = "%";
  }
  TableCell cell() { return table_cell(study, rows, line, column); }

  Study study;
  std::vector<Row> rows;
  TableLine line;
  TableColumn column;
};

}  // namespace

TEST_F(ChosenCases, MeanAndRangeInTheColumnsUnit) {
  EXPECT_NEAR(*cell().value, 100 * (1.15 / 16 + 1.5e-3), 1e-12);
  EXPECT_EQ(cell().runs, 2u);
  column.over_seeds = Pool::range;
  EXPECT_NEAR(*cell().value, 100 * (0.1 / 16 + 1e-3), 1e-12);
}

TEST_F(ChosenCases, DifferencesAreOfEqualSeeds) {
  column.difference = true;
  EXPECT_FALSE(cell().value) << "nothing to compare with";
  line.against = Selector{{}, {}, "xi 1", {}};
  EXPECT_NEAR(*cell().value, 100 * 1.5e-3, 1e-12);
  EXPECT_EQ(cell().runs, 2u);
  line.selector.variant = "xi 1";
  line.against = Selector{{}, {}, "other", {}};
  EXPECT_NEAR(*cell().value, -100 * 1.5e-3, 1e-12) << "seed 3 has no partner";
  EXPECT_EQ(cell().runs, 2u);
  line.against = Selector{{}, {}, "gone", {}};
  EXPECT_FALSE(cell().value);
  EXPECT_EQ(cell().reason, "no run with a partner to compare with");
}

TEST_F(ChosenCases, WhatIsAbsentSaysWhy) {
  column.quantity = "quantities.gone";
  EXPECT_FALSE(cell().value);
  EXPECT_EQ(cell().reason, "no quantities.gone");
  line.resolution = 32;
  EXPECT_EQ(cell().reason, "no run in this report");
}

TEST_F(ChosenCases, StandInTheFiles) {
  study.tables.push_back({"T", "a note", {column}, {line}, {}});
  study.tables.push_back(study.tables[0]);
  study.tables[1].lines[0].resolution = 32;
  study.tables[0].lines.push_back(study.tables[1].lines[0]);
  study.tables[0].lines[0].source_value = "12 %";
  StudyResult result;
  result.study = &study;
  result.rows = rows;
  const auto json = study_json(result);
  ASSERT_EQ(json["tables"].size(), 1u) << "the other one has no line that runs";
  EXPECT_EQ(json["tables"][0]["rows"].size(), 1u);
  EXPECT_EQ(json["tables"][0]["title"], "T");
  EXPECT_EQ(json["tables"][0]["columns"][0]["unit"], "%");
  const auto& row = json["tables"][0]["rows"][0];
  EXPECT_EQ(row["source_value"], "12 %");
  EXPECT_EQ(row["cells"][0]["runs"], 2);
  EXPECT_NEAR(row["cells"][0]["value"].get<double>(), 7.3375, 1e-12);
  for (const Table& table : tables_of(result))
    if (table.name == "table-1") {
      EXPECT_EQ(table.csv(), ",source,error [%]\nother,12 %,7.34\n");
      return;
    }
  FAIL() << "no table-1";
}
