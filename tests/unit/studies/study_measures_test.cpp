// Reading probes, signals, errors, matched errors and heat maps, and errors with their place.

#include "scratch_study.hpp"

using namespace concord::studies;

TEST_F(StudyFile, ReadsProbesAndTheirOptions) {
  const std::string probe = one_case + "probe = \"spectrum\"\n";
  const Study study = read(probe + "options = { pairs = 20, dense = true }\n"
                                   "sweep = { \"options.xi\" = [0, 1] }\n"
                                   "quick = { options = { pairs = 5 } }\n",
                           false);
  ASSERT_EQ(study.cases.size(), 2u);
  EXPECT_EQ(study.cases[1].probe, "spectrum");
  EXPECT_EQ(study.cases[1].options.at("pairs"), "5") << "of the quick report";
  EXPECT_EQ(study.cases[1].options.at("dense"), "on");
  EXPECT_EQ(study.cases[1].options.at("xi"), "1");
  EXPECT_TRUE(study.cases[1].set.empty());
  EXPECT_EQ(study.cases[1].variant, "xi 1");
  EXPECT_EQ(study.cases[1].title(), "spectrum of delaunay (xi 1) on block");
  // A run and a probe of the same name are two cases.
  const std::string both = one_case + "[[case]]\nscene = \"block\"\nmethod = \"delaunay\"\n"
                                      "resolutions = [2]\nprobe = \"spectrum\"\n";
  EXPECT_TRUE(read(both).cases[1].matches({{}, {}, {}, "spec*"}));
  EXPECT_FALSE(read(both).cases[0].matches({{}, {}, {}, "spec*"}));
  expect_error(one_case + "options = { xi = 1 }\n", 8, "options");
  expect_error(one_case + "sweep = { \"options.xi\" = [1] }\n", 8, "sweep");
  expect_error(probe + "repeats = 3\n", 9, "repeats");
  expect_error(probe + "quick = { repeats = 3 }\n", 9, "repeats");
  expect_error(one_case + "quick = { options = { xi = 1 } }\n", 8, "options");
  expect_error(probe + "frames = true\n", 9, "frames");
}

TEST_F(StudyFile, RepeatsNeedATimedStudy) {
  const std::string repeats = "repeats = 5\nquick = { repeats = 2 }\n";
  const std::string timed = "timing = true\n" + one_case + repeats;
  EXPECT_EQ(read(timed, true).cases[0].repeats, 5);
  EXPECT_EQ(read(timed, false).cases[0].repeats, 2);
  expect_error(one_case + repeats, 4, "repeats");
  expect_error("timing = true\n" + one_case + "repeats = 0\n", 9, "repeats");
  expect_error("timing = true\n" + one_case + "repeats = 2.5\n", 9, "repeats");
}

TEST_F(StudyFile, ReadsSignals) {
  const std::string signal = one_case + "[[signal]]\nname = \"tip\"\ncolumn = \"tip_z_m\"\n";
  const Study study = read(signal + "features = [\"first_peak\", \"period\"]\nlevel = 0.5\n");
  EXPECT_EQ(study.signals.at(0).features.size(), 2u);
  EXPECT_EQ(study.signals[0].level, 0.5);
  EXPECT_FALSE(study.signals[0].from);
  EXPECT_EQ(read(signal + "features = [\"initial\"]\nfrom = 5\n").signals.at(0).from, 5);
  expect_error(signal, 8, "features");
  expect_error(signal + "features = [\"first_peek\"]\n", 11, "features");
  expect_error(signal + "features = [\"period\"]\nprominence = 2\n", 12, "prominence");
  expect_error(signal + "features = [\"period\"]\nmethod = \"fem\"\n", 8, "signal");
  expect_error(one_case + "[[signal]]\nname = \"Tip z\"\n", 9, "name");
}

TEST_F(StudyFile, ReadsTables) {
  const std::string table = one_case + "[[table]]\ntitle = \"T\"\n";
  const std::string columns =
      "columns = [{ label = \"tip\", quantity = \"quantities.tip\" }]\n";
  const Study study = read(table + columns +
                           "rows = [{ label = \"a\", method = \"delaunay\", resolution = 4, "
                           "against = { method = \"delaunay\" } }]\n");
  EXPECT_EQ(study.tables.at(0).columns.at(0).over_seeds, Pool::mean);
  EXPECT_FALSE(study.tables[0].columns[0].difference);
  EXPECT_EQ(study.tables[0].lines.at(0).resolution, 4);
  EXPECT_EQ(study.tables[0].lines[0].against->method, "delaunay");
  expect_error(table, 8, "columns");
  expect_error(table + columns, 8, "rows");
  expect_error(table + columns + "rows = [{ label = \"a\", method = \"fem\" }]\n", 8, "table");
  expect_error(table + "columns = [{ label = \"x\", quantity = \"q\", digits = 0 }]\n", 10,
               "digits");
}

TEST_F(StudyFile, PoolsOfClaims) {
  const std::string claim = one_case +
                            "[[claim]]\nid = \"c\"\nstatement = \"s\"\nsource = \"t\"\n"
                            "kind = \"ratio\"\nquantity = \"quantities.tip\"\nmax = 1\n";
  const std::string pools = "over_seeds = \"mean\"\nover_resolutions = \"range\"\n";
  const Claim same =
      read(claim + pools + "other = { quantity = \"quantities.tip\" }\n").claims.at(0);
  EXPECT_EQ(same.other_over_seeds, Pool::mean);
  EXPECT_EQ(same.other_over_resolutions, Pool::range);
  const Claim own =
      read(claim + pools + "other = { over_seeds = \"range\", over_resolutions = \"mean\" }\n")
          .claims.at(0);
  EXPECT_EQ(own.over_seeds, Pool::mean);
  EXPECT_EQ(own.other_over_seeds, Pool::range);
  EXPECT_EQ(own.other_over_resolutions, Pool::mean);
  expect_error(claim + pools + "resolution = 4\nother = {}\n", 16, "over_resolutions");
}

TEST_F(StudyFile, ReadsErrors) {
  const std::string two =
      one_case + "[[case]]\nscene = \"block\"\nmethod = \"fem\"\nresolutions = [4]\n";
  const std::string error = two + "[[error]]\nname = \"tip\"\n";
  const std::string number = error + "quantity = \"quantities.tip\"\n";
  const Study exact = read(number + "exact = 14.74\nunit = \"mm\"\nsigned = true\n");
  EXPECT_DOUBLE_EQ(*exact.errors.at(0).exact, 14.74e-3);
  EXPECT_TRUE(exact.errors[0].is_signed);
  EXPECT_NO_THROW(read(number + "reference = { method = \"fem\" }\n"));
  EXPECT_TRUE(read(error + "kind = \"history\"\ncolumn = \"c\"\n"
                           "reference = { method = \"fem\" }\n")
                  .errors[0]
                  .of_history);
  expect_error(number, 12, "reference");
  expect_error(number + "exact = 1\nreference = { method = \"fem\" }\n", 16, "reference");
  expect_error(number + "exact = 0\n", 15, "exact");
  expect_error(number + "exact = 1\nunit = \"furlong\"\n", 12, "unit");
  expect_error(number + "unit = \"mm\"\nreference = { method = \"fem\" }\n", 15, "unit");
  expect_error(number + "reference = { method = \"mpm\" }\n", 12, "error.reference");
  expect_error(number + "reference = { variant = \"*\" }\n", 12, "error.reference");
  expect_error(error + "kind = \"history\"\ncolumn = \"c\"\nexact = 1\n", 12, "reference");
}

TEST_F(StudyFile, ReadsMatchedErrors) {
  const std::string matched = one_case + "[[matched]]\nquantity = \"errors.e\"\n";
  const Study study = read(matched + "levels = [0.01, 0.1]\ntime = \"total\"\n");
  EXPECT_EQ(study.matched.at(0).levels, (std::vector<double>{0.1, 0.01})) << "descending";
  EXPECT_EQ(study.matched[0].time, WorkTime::total);
  expect_error(matched, 8, "levels");
  expect_error(matched + "levels = [0]\n", 10, "levels");
  expect_error(matched + "levels = [0.1]\ntime = \"cpu\"\n", 11, "time");
  expect_error(matched + "levels = [0.1]\nmethod = \"fem\"\n", 8, "matched");
  const std::string claim = one_case + "[[claim]]\nid = \"a\"\nstatement = \"s\"\n"
                                       "source = \"s\"\nquantity = \"errors.e\"\nmin = 5\n";
  const std::string ratio = claim + "kind = \"matched_ratio\"\n";
  EXPECT_EQ(read(ratio + "level = 0.01\nother = { method = \"delaunay\" }\n").claims[0].level,
            0.01);
  expect_error(ratio + "level = 0.01\n", 8, "other");
  expect_error(ratio + "other = { method = \"delaunay\" }\n", 8, "level");
  expect_error(claim + "kind = \"value\"\nlevel = 0.01\n", 15, "level");
  const std::string plot = one_case + "[[plot]]\nkind = \"work_precision\"\n";
  EXPECT_EQ(read(plot + "quantity = \"errors.e\"\ntime = \"total\"\n").plots[0].time,
            WorkTime::total);
  expect_error(plot, 8, "quantity");
  expect_error("timing = true\n" + one_case +
                   "[[case]]\nscene = \"bar\"\nmethod = \"fem\"\nresolutions = [4]\n"
                   "[[plot]]\nkind = \"work_precision\"\nquantity = \"errors.e\"\n",
               13, "plot.scene");
  expect_error(one_case + "[[plot]]\nkind = \"cost\"\nquantity = \"h\"\ntime = \"total\"\n", 11,
               "time");
}

TEST_F(StudyFile, ReadsHeatmaps) {
  const std::string map = one_case + "[[heatmap]]\ncolumns = [{ label = \"D\", method = "
                                     "\"delaunay\" }]\n";
  const auto rows = [&](const std::string& keys) {
    return map + "rows = [{ label = \"r\", quantity = \"h\"" + keys + " }]\n";
  };
  const Study study = read(rows(", good = 1, bad = 0, better = \"high\", digits = 3"));
  EXPECT_EQ(study.heatmaps.at(0).rows.at(0).digits, 3);
  EXPECT_EQ(study.heatmaps[0].columns.at(0).label, "D");
  expect_error(map, 8, "rows");
  expect_error(rows(""), 10, "good");
  expect_error(rows(", good = 1, bad = 1"), 10, "bad");
  expect_error(rows(", good = 0, bad = 1, better = \"high\""), 10, "better");
  expect_error(rows(", good = 0, bad = 1, scale = \"log\""), 10, "scale");
  expect_error(rows(", good = 0, bad = 1, digits = 0"), 10, "digits");
  expect_error(rows(", good = 0, bad = 1, colour = 3"), 10, "colour");
  expect_error(rows(", good = 0, bad = 1, method = \"fem\""), 8, "heatmap.rows: r");
}
