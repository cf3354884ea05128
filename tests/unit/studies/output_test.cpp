// study.json and tables.

#include "sample_study.hpp"
#include "studies/driver/runner.hpp"
#include "studies/driver/study_output.hpp"
#include "studies/driver/tables.hpp"

#include <gtest/gtest.h>

using namespace concord::studies;

namespace {

StudyResult judged(const Study& study) {
  StudyResult result;
  result.study = &study;
  result.rows = sample_rows(study);
  result.fits = fit_all(study, result.rows);
  result.references = references_of(study, result.rows);
  result.claims = judge(study, result.rows, result.fits, result.references);
  return result;
}

Study with_claim(double minimum) {
  Study study = sample_study();
  Claim claim;
  claim.id = "order";
  claim.kind = ClaimKind::slope;
  claim.quantity = "errors.displacement_l2";
  claim.minimum = minimum;
  study.claims.push_back(claim);
  return study;
}

}  // namespace

TEST(StudyJson, CarriesTheContract) {
  const Study study = with_claim(1.8);
  const auto json = study_json(judged(study));
  EXPECT_EQ(json["name"], "sample");
  EXPECT_EQ(json["verdict"], "pass");
  const auto& claim = json["claims"].at(0);
  for (const char* key : {"id", "statement", "source_value", "measured", "bound", "verdict"})
    EXPECT_TRUE(claim.contains(key)) << key;
  EXPECT_NEAR(claim["measured"].get<double>(), 2, 1e-9);
  ASSERT_EQ(json["rows"].size(), 6u);
  EXPECT_FALSE(json["rows"][0].contains("local_order")) << "none on the coarsest level";
  EXPECT_NEAR(json["rows"][2]["local_order"].get<double>(), 2, 1e-9);
  EXPECT_EQ(json["rows"][0]["variant"], "xi 1");
  EXPECT_NEAR(json["fits"].at(0)["slope"].get<double>(), 2, 1e-9);
}

TEST(StudyJson, OneFailedClaimFailsTheStudy) {
  const Study study = with_claim(2.5);
  EXPECT_EQ(study_json(judged(study))["verdict"], "fail");
}

TEST(StudyJson, AnInterruptedStudyDoesNotPass) {
  const Study study = with_claim(1.8);
  StudyResult result = judged(study);
  result.interrupted = true;
  EXPECT_EQ(study_json(result)["verdict"], "fail");
}

TEST(StudyJson, AFailedRunIsARowWithItsError) {
  const Study study = with_claim(1.8);
  StudyResult result = judged(study);
  result.rows[0].error = "det F <= 0";
  EXPECT_EQ(study_json(result)["rows"][0]["error"], "det F <= 0");
}

TEST(StudyJson, MarksRunsWhoseBalanceDoesNotClose) {
  Study study = with_claim(1.8);
  study.balance_tolerance = 1e-2;
  StudyResult result = judged(study);
  result.rows[0].summary["invariants"]["energy_drift"] = 1e-3;
  result.rows[1].summary["invariants"]["energy_drift"] = 0.1;
  const auto json = study_json(result);
  EXPECT_EQ(json["rows"][0]["balance"], "closes");
  EXPECT_EQ(json["rows"][1]["balance"], "does not close");
  EXPECT_FALSE(json["rows"][2].contains("balance")) << "no drift, no verdict";
  const Table runs = tables_of(result).front();
  ASSERT_EQ(runs.columns[runs.columns.size() - 2], "energy balance");
  EXPECT_EQ(runs.cells[1][runs.columns.size() - 2], "does not close");
}

TEST(StudyJson, PatternsOfPlotsBecomeTheCasesTheyStandFor) {
  Study study = sample_study();
  study.cases.push_back(study.cases[0]);
  study.cases.back().variant = "xi 0";
  Plot plot;
  plot.kind = "curve";
  plot.x = "a";
  plot.selector.variant = "xi*";
  study.plots.push_back(plot);
  const auto json = study_json(judged(study))["plots"][0];
  EXPECT_EQ(json["variant"], (std::vector<std::string>{"xi 1", "xi 0"}));
  EXPECT_EQ(json["x"], "a");
  EXPECT_FALSE(json.contains("quantity"));
}

TEST(StudyJson, PicturesCarryTheirPanelsRangeAndCrop) {
  Study study = sample_study();
  Picture picture;
  picture.body.color = "s";
  picture.range = Range{0, 0.5};
  picture.crop = Window{Range{-1, 1}, std::nullopt};
  Panel panel;
  panel.selector.method = "delaunay";
  panel.difference = true;
  panel.time = 0.25;
  picture.times = {0.1, 0.2};
  picture.panels.push_back(panel);
  study.pictures.push_back(picture);
  const auto json = study_json(judged(study))["pictures"][0];
  EXPECT_EQ(json["range"], (std::vector<double>{0, 0.5}));
  EXPECT_EQ(json["crop"]["x"], (std::vector<double>{-1, 1}));
  EXPECT_FALSE(json["crop"].contains("y"));
  EXPECT_EQ(json["panels"][0]["method"], "delaunay");
  EXPECT_EQ(json["panels"][0]["difference"], true);
  EXPECT_EQ(json["panels"][0]["time"], 0.25);
  EXPECT_EQ(json["times"], (std::vector<double>{0.1, 0.2}));
  EXPECT_FALSE(json.contains("time"));
  EXPECT_EQ(json["color"], "s");
  EXPECT_FALSE(json["panels"][0].contains("color")) << "the picture's";
}

TEST(StudyJson, QuickReportsLeaveOutPanelsThatHaveNoRun) {
  Study study = sample_study();
  Panel run, none;
  run.selector.method = study.cases[0].method;
  none.selector.method = "of the full report";
  Picture picture;
  picture.panels = {none, run};
  Picture nothing;
  nothing.panels = {none};
  study.pictures = {picture, nothing};
  study.full = false;
  const auto quick = study_json(judged(study))["pictures"];
  ASSERT_EQ(quick.size(), 1u);
  EXPECT_EQ(quick[0]["panels"].size(), 1u);
  study.full = true;
  const auto full = study_json(judged(study))["pictures"];
  ASSERT_EQ(full.size(), 2u);
  EXPECT_EQ(full[0]["panels"].size(), 2u) << "the report tells what is missing";
}

TEST(Tables, CellsAreEscaped) {
  const Table table{"t", {"a", "b"}, {{"x, y", "p|q"}, {"say \"so\"", ""}}};
  EXPECT_EQ(table.csv(), "a,b\n\"x, y\",p|q\n\"say \"\"so\"\"\",\n");
  EXPECT_EQ(table.markdown(),
            "| a | b |\n| --- | --- |\n| x, y | p\\|q |\n| say \"so\" |  |\n");
}

TEST(Tables, CostStandsOnlyInTimedStudies) {
  Study study = with_claim(1.8);
  const auto has_cost = [&study] {
    const auto columns = tables_of(judged(study)).front().columns;
    return std::find(columns.begin(), columns.end(), "wall_s") != columns.end();
  };
  study.timing = true;
  EXPECT_TRUE(has_cost());
  study.timing = false;
  EXPECT_FALSE(has_cost());
}

TEST(Tables, ConvergenceHasALineALevel) {
  const Study study = with_claim(1.8);
  for (const Table& table : tables_of(judged(study)))
    if (table.name == "convergence-errors.displacement_l2") {
      ASSERT_EQ(table.cells.size(), 3u);
      EXPECT_EQ(table.cells[1][10], "2.00");
      return;
    }
  FAIL() << "no convergence table";
}

TEST(Slug, IsAFileName) {
  EXPECT_EQ(slug("xi 1, 25 %"), "xi-1-25");
  EXPECT_EQ(slug("block-delaunay-"), "block-delaunay");
}
