// [[plot]] and [[picture]]: changes, vectors, published points, scales, cells, animations.

#include "scratch_study.hpp"
#include "studies/driver/drawing_json.hpp"

namespace concord::studies {
namespace {

TEST_F(StudyFile, PlotsOfChangesVectorsAndPublishedPoints) {
  const Study study = read(
      one_case + "[[plot]]\nkind = \"history\"\ncolumns = [\"a_J\", \"b_J\"]\nchange_from = 5\n"
                 "norm = true\nlog = true\nstatement = \"It stays.\"\nsource = \"Fig. 8b\"\n"
                 "[[plot]]\nkind = \"curve\"\nx = \"a\"\ny = \"b\"\n"
                 "baseline = [{ method = \"delaunay\" }]\n"
                 "points = [{ label = \"P\", x = [1, 2], y = [3, 4] }]\n");
  const auto history = plot_json(study, study.plots[0]),
             curve = plot_json(study, study.plots[1]);
  EXPECT_EQ(history["change_from"], 5);
  EXPECT_TRUE(history["norm"] && history["log"]);
  EXPECT_EQ(history["statement"], "It stays.");
  EXPECT_EQ(history["source"], "Fig. 8b");
  EXPECT_FALSE(curve.contains("log") || curve.contains("norm") || curve.contains("statement"));
  EXPECT_EQ(curve["points"][0]["label"], "P");
  EXPECT_EQ(curve["points"][0]["y"], (std::vector<double>{3, 4}));
  EXPECT_EQ(curve["baseline"].size(), 1);
  const std::string plot = one_case + "[[plot]]\nkind = \"curve\"\nx = \"a\"\ny = \"b\"\n";
  expect_error(plot + "points = [{ label = \"P\", x = [1, 2], y = [3] }]\n", 12, "points.y");
  expect_error(plot + "points = [{ label = \"P\" }]\n", 12, "x");
  expect_error(plot + "norm = true\n", 12, "norm");
}

TEST_F(StudyFile, PicturesOfCellsOnRobustScalesThatMove) {
  const Study study =
      read(one_case + "[[picture]]\ncolor = \"none\"\ndraw = \"cells\"\nrange = \"robust\"\n"
                      "panels = [{ draw = \"spheres\" }, {}]\n"
                      "animate = { frames = 12, from = 0.5 }\n");
  const auto json = picture_json(study, study.pictures[0]);
  EXPECT_EQ(json["draw"], "cells");
  EXPECT_EQ(json["range"], "robust");
  EXPECT_EQ(json["panels"][0]["draw"], "spheres");
  EXPECT_FALSE(json["panels"][1].contains("draw")) << "the picture's";
  EXPECT_EQ(json["animate"]["frames"], 12);
  EXPECT_EQ(json["animate"]["seconds"], 4);
  EXPECT_EQ(json["animate"]["from"], 0.5);
  EXPECT_FALSE(json["animate"].contains("to"));
  const std::string picture = one_case + "[[picture]]\ncolor = \"s\"\n";
  EXPECT_FALSE(picture_json(study, read(picture).pictures[0]).contains("animate"));
  expect_error(picture + "draw = \"lines\"\n", 10, "draw");
  expect_error(picture + "animate = { frames = 0 }\n", 10, "frames");
  expect_error(picture + "animate = { speed = 2 }\n", 10, "speed");
  expect_error(picture + "range = \"wide\"\n", 10, "range");
}

}  // namespace
}  // namespace concord::studies
