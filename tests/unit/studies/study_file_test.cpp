// Reading study files: ladders, sweeps, selections, and errors with their place.

#include "scratch_study.hpp"

#include <cstdlib>

using namespace concord::studies;
using concord::InputError;

TEST_F(StudyFile, LaddersOfBothModes) {
  const std::string text =
      one_case + "seeds = [1, 2, 3]\nquick = { resolutions = [2], seeds = [7] }\n";
  const Study full = read(text, true), quick = read(text, false);
  EXPECT_EQ(full.cases.at(0).resolutions, (std::vector<double>{4, 8})) << "ascending";
  EXPECT_EQ(full.cases.at(0).seeds.size(), 3u);
  EXPECT_EQ(quick.cases.at(0).resolutions, std::vector<double>{2});
  EXPECT_EQ(quick.cases.at(0).seeds, std::vector<std::uint64_t>{7});
  EXPECT_TRUE(read(one_case + "quick = false\n", false).cases.empty());
  EXPECT_EQ(read(one_case + "quick = false\n", true).cases.size(), 1u);
}

TEST_F(StudyFile, SweepMakesACaseAValue) {
  const Study study =
      read(one_case + "variant = \"v\"\nset = { xi_n = 0.5, force = \"static\" }\n"
                      "sweep = { psi = [0, 0.1], \"parameters.U\" = [\"1 mm\"] }\n");
  ASSERT_EQ(study.cases.size(), 2u);
  EXPECT_EQ(study.cases[1].variant, "v, U 1 mm, psi 0.1");
  EXPECT_EQ(study.cases[1].set.at("psi"), "0.1");
  EXPECT_EQ(study.cases[1].set.at("xi_n"), "0.5");
  EXPECT_EQ(study.cases[1].set.at("force"), "static");
  EXPECT_EQ(study.cases[1].scene_set.at("parameters.U"), "1 mm");
}

TEST_F(StudyFile, ErrorsTellTheirPlace) {
  expect_error(one_case + "resolution = [8]\n", 8, "resolution");
  expect_error(one_case + "perturb = 0.6\n", 8, "perturb");
  expect_error(one_case + "seeds = [1.5]\n", 8, "seeds");
  expect_error(head + "[[case]]\nscene = \"b\"\nmethod = \"m\"\nresolutions = [0]\n", 7,
               "resolutions");
  expect_error(head + "[[case]]\nscene = 3\n", 5, "scene");
  expect_error(head + "colour = 1\n", 4, "colour");
  const std::string claim = one_case +
                            "[[claim]]\nid = \"a\"\nstatement = \"s\"\nsource = \"s\"\n"
                            "quantity = \"h\"\n";
  expect_error(claim + "kind = \"value\"\n", 8, "max");
  expect_error(claim + "kind = \"worth\"\nmax = 1\n", 13, "kind");
  expect_error(claim + "kind = \"value\"\nmax = 1\nunit = \"furlong\"\n", 8, "unit");
  expect_error(claim + "kind = \"value\"\nmax = 1\nmethod = \"tlsph\"\n", 8, "claim");
  expect_error(claim + "kind = \"value\"\nmax = 1\nother = { variant = \"x\" }\n", 15, "other");
  expect_error(claim + "kind = \"ratio\"\nmax = 1\n", 8, "other");
}

TEST_F(StudyFile, AClaimOfASlopeNeedsOneCase) {
  const std::string two =
      one_case + "[[case]]\nscene = \"block\"\nmethod = \"fem\"\nresolutions = [4]\n";
  const std::string claim =
      "[[claim]]\nid = \"a\"\nstatement = \"s\"\nsource = \"s\"\nkind = \"slope\"\n"
      "quantity = \"h\"\nmin = 1\n";
  expect_error(two + claim, 12, "claim");
  EXPECT_NO_THROW(read(two + claim + "method = \"fem\"\n"));
}

TEST_F(StudyFile, NamesOfCasesAndClaimsAreUnique) {
  expect_error(one_case +
                   "[[case]]\nscene = \"block\"\nmethod = \"delaunay\"\nresolutions = [2]\n",
               8, "variant");
}

TEST_F(StudyFile, AnUnknownStudyNamesThoseThereAre) {
  read(one_case);
  try {
    read_study("t", true, m_home);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(error.allowed().find('s'), std::string::npos);
  }
}

// Every study of this repository reads in both modes.
TEST(Studies, OfTheRepositoryRead) {
  const std::filesystem::path home = std::getenv("CONCORD_HOME");
  const auto names = study_names(home);
  ASSERT_GE(names.size(), 3u);
  for (const std::string& name : names)
    for (const bool full : {false, true}) {
      const Study study = read_study(name, full, home);
      EXPECT_FALSE(study.cases.empty()) << name;
      EXPECT_FALSE(study.claims.empty()) << name << " says nothing that could fail";
    }
}

TEST_F(StudyFile, AStarInASelectorStandsForAnyText) {
  EXPECT_TRUE(matches_pattern("xi 0*", "xi 0, algorithm 5"));
  EXPECT_TRUE(matches_pattern("*grips*", "xi 0, grips 12"));
  EXPECT_TRUE(matches_pattern("a*b*c", "a-b-bc"));
  EXPECT_TRUE(matches_pattern("fem\ncbm", "cbm")) << "alternatives";
  EXPECT_FALSE(matches_pattern("a*b", "a-b-c"));
  EXPECT_FALSE(matches_pattern("xi 0", "xi 0, algorithm 5"));
  const std::string claim = one_case +
                            "sweep = { psi = [0, 1] }\n[[claim]]\nid = \"a\"\n"
                            "statement = \"s\"\nsource = \"s\"\nquantity = \"h\"\nmax = 1\n";
  EXPECT_NO_THROW(read(claim + "kind = \"value\"\nvariant = \"psi*\"\n"));
  EXPECT_NO_THROW(read(claim + "kind = \"value\"\nvariant = [\"psi 0\", \"psi 1\"]\n"));
  expect_error(claim + "kind = \"slope\"\nvariant = \"psi*\"\n", 9, "claim");
  expect_error(claim + "kind = \"value\"\nvariant = \"xi*\"\n", 9, "claim");
}

TEST_F(StudyFile, ReadsComparisons) {
  const std::string compare = one_case +
                              "[[compare]]\nfields = [\"s\"]\n"
                              "reference = { method = \"delaunay\", scene = \"block\" }\n";
  const Study study = read(compare + "leave_out = { axis = \"y\", low = \"1 mm\", high = "
                                     "\"40 mm\", spacings = 4 }\n");
  ASSERT_EQ(study.comparisons.size(), 1u);
  EXPECT_EQ(study.comparisons[0].selector.scene, "block")
      << "the reference's where none is given";
  EXPECT_EQ(study.comparisons[0].leave_out->axis, 1);
  EXPECT_DOUBLE_EQ(study.comparisons[0].leave_out->low, 1e-3);
  EXPECT_DOUBLE_EQ(study.comparisons[0].leave_out->high, 40e-3);
  expect_error(compare + "method = \"fem\"\n", 8, "compare");
  expect_error(compare + "leave_out = { axis = \"w\" }\n", 11, "axis");
  expect_error(compare + "leave_out = { axis = \"y\", low = \"1 s\" }\n", 11, "low");
  expect_error(one_case + "[[compare]]\nfields = []\n", 9, "fields");
  expect_error(one_case + "[[compare]]\nfields = [\"s\"]\nreference = { method = \"x\" }\n", 8,
               "compare.reference");
}

TEST_F(StudyFile, ReadsHistoriesOfSeveralColumnsAndPicturesAtInstants) {
  const Study drawn =
      read(one_case +
           "[[plot]]\nkind = \"history\"\ncolumns = [\"a_J\", \"b_J\"]\nresolutions = [4, 8]\n"
           "change = true\nbaseline = [{ method = \"delaunay\" }]\n"
           "[[picture]]\ncolor = \"s\"\ntimes = [0.1, 0.2]\ntime = 0.3\n"
           "panels = [{ method = \"delaunay\", time = 0.1 }, { method = \"delaunay\" }]\n");
  EXPECT_EQ(drawn.plots[0].columns, (std::vector<std::string>{"a_J", "b_J"}));
  EXPECT_EQ(drawn.plots[0].resolutions, (std::vector<double>{4, 8}));
  EXPECT_TRUE(drawn.plots[0].change);
  EXPECT_EQ(drawn.plots[0].baseline.size(), 1);
  EXPECT_EQ(drawn.pictures[0].times, (std::vector<double>{0.1, 0.2}));
  EXPECT_EQ(drawn.pictures[0].body.time, 0.3);
  EXPECT_EQ(drawn.pictures[0].panels.at(0).time, 0.1);
  EXPECT_FALSE(drawn.pictures[0].panels.at(1).time) << "the picture's";
  expect_error(one_case + "[[plot]]\nkind = \"history\"\n", 8, "quantity");
  expect_error(one_case + "[[plot]]\nkind = \"cost\"\nquantity = \"h\"\ncolumns = [\"a\"]\n",
               11, "columns");
}

TEST_F(StudyFile, ReadsMinimaCurvesMapsAndPanels) {
  const std::string claim = one_case + "sweep = { psi = [0.1, 1] }\n[[claim]]\nid = \"a\"\n"
                                       "statement = \"s\"\nsource = \"s\"\nquantity = \"h\"\n";
  const Study least =
      read(claim + "kind = \"minimum\"\nsetting = \"psi\"\nsetting_max = 0.2\n");
  EXPECT_EQ(least.claims[0].setting_maximum, 0.2);
  EXPECT_FALSE(least.claims[0].divided);
  expect_error(claim + "kind = \"minimum\"\nsetting = \"psi\"\n", 9, "max");
  expect_error(claim + "kind = \"minimum\"\nsetting_max = 1\n", 9, "setting");
  expect_error(claim + "kind = \"value\"\nmax = 1\nsetting = \"psi\"\n", 16, "setting");

  const Study drawn =
      read(one_case +
           "[[plot]]\nkind = \"curve\"\nx = \"a\"\ny = \"b\"\ny_scale = -1\n"
           "[[plot]]\nkind = \"map\"\nquantity = \"h\"\nsetting = \"psi\"\nsetting_y = \"r\"\n"
           "[[plot]]\nkind = \"sweep\"\nquantity = \"h\"\nsetting = \"psi\"\n"
           "baseline = [{ method = \"delaunay\" }]\n"
           "[[picture]]\ncolor = \"s\"\nrange = \"common\"\ndifference = true\n"
           "panels = [{ method = \"delaunay\", resolution = 4, caption = \"c\" }]\n");
  EXPECT_EQ(drawn.plots[0].y_scale, -1);
  EXPECT_EQ(drawn.plots[1].setting_y, "r");
  EXPECT_EQ(drawn.plots[2].baseline.at(0).selector.method, "delaunay");
  EXPECT_EQ(drawn.pictures[0].body.difference, true);
  EXPECT_TRUE(drawn.pictures[0].common_range);
  EXPECT_EQ(drawn.pictures[0].panels.at(0).resolution, 4);
  const Study windows =
      read(one_case + "[[picture]]\ncolor = \"s\"\nrange = [0, 0.5]\ncrop = { y = [-1, 1] }\n");
  EXPECT_EQ(windows.pictures[0].range->at(1), 0.5);
  EXPECT_FALSE(windows.pictures[0].crop->x);
  expect_error(one_case + "[[picture]]\ncolor = \"s\"\nrange = [1, 0]\n", 10, "range");
  expect_error(one_case + "[[picture]]\ncolor = \"s\"\nrange = \"own\"\n", 10, "range");
  expect_error(one_case + "[[picture]]\ncolor = \"s\"\npanels = [{ metod = \"fem\" }]\n", 10,
               "metod");
}
