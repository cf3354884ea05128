// Signals and errors of rows, from history.csv files and numbers of a made-up study.

#include "sample_study.hpp"
#include "studies/driver/derive.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <numbers>

using namespace concord::studies;
namespace fs = std::filesystem;

namespace {

/// Two cases on the same block: delaunay at 4, 8, 16 and fem at 8. Their histories are
/// a sin(2 pi t) with a = 1 + 1/N^2 and 1.
class Derived : public testing::Test {
 protected:
  void SetUp() override {
    m_out = fs::path(testing::TempDir()) / ("concord-derive-" + std::to_string(::getpid()));
    m_study = sample_study();
    m_study.cases[0].seeds = {1};
    Case fem = m_study.cases[0];
    fem.method = "fem";
    fem.variant = "Q2";
    fem.resolutions = {8};
    m_study.cases.push_back(fem);
    m_rows = sample_rows(m_study);
    for (std::size_t i = 0; i < m_rows.size(); ++i) {
      Row& row = m_rows[i];
      row.run = "run" + std::to_string(i);
      const double n = row.resolution;
      write(row, row.case_index == 1 ? 1 : 1 + 1 / (n * n));
    }
  }
  void TearDown() override { fs::remove_all(m_out); }

  void write(const Row& row, double amplitude, double end = 1.5) {
    fs::create_directories(m_out / row.run);
    std::ofstream file(m_out / row.run / "history.csv");
    file << "t_s,tip_z_m\n";
    for (int i = 0; i <= 600; ++i) {
      const double t = end * i / 600;
      file << t << ',' << amplitude * std::sin(2 * std::numbers::pi * t) << '\n';
    }
  }

  ErrorEntry against_fem(const std::string& quantity) const {
    ErrorEntry entry;
    entry.name = "e";
    entry.quantity = quantity;
    entry.reference.method = "fem";
    return entry;
  }
  void derive() {
    add_signals(m_study, m_rows, m_out);
    add_errors(m_study, m_rows, m_out);
  }

  fs::path m_out;
  Study m_study;
  std::vector<Row> m_rows;
};

Signal tip() {
  Signal signal;
  signal.name = "tip";
  signal.column = "tip_z_m";
  signal.features = {"first_peak", "first_peak_time", "period"};
  return signal;
}

}  // namespace

TEST_F(Derived, SignalsAreNumbersOfTheRow) {
  m_study.signals = {tip()};
  derive();
  EXPECT_NEAR(*value_of(m_rows[0], "signals.tip.first_peak"), 1 + 1. / 16, 1e-4);
  EXPECT_NEAR(*value_of(m_rows[0], "signals.tip.first_peak_time"), 0.25, 1e-4);
  EXPECT_NEAR(*value_of(m_rows[0], "signals.tip.period"), 1, 1e-4);
}

TEST_F(Derived, SignalsOfTheLastPartOfARecord) {
  Signal late = tip();
  late.features = {"initial", "largest_change", "maximum"};
  late.from = 0.75;  // sin is -1 there: a sample, and the least
  m_study.signals = {late};
  derive();
  const double amplitude = 1 + 1. / 16;
  EXPECT_NEAR(*value_of(m_rows[0], "signals.tip.initial"), -amplitude, 1e-4);
  EXPECT_NEAR(*value_of(m_rows[0], "signals.tip.largest_change"), 2 * amplitude, 1e-4);
  m_study.signals[0].from.reset();
  m_study.signals[0].features = {"final", "maximum"};
  m_study.signals[0].to = 0.75;
  derive();
  EXPECT_NEAR(*value_of(m_rows[0], "signals.tip.final"), -amplitude, 1e-4);
  EXPECT_NEAR(*value_of(m_rows[0], "signals.tip.maximum"), amplitude, 1e-4);
  m_study.signals[0].to.reset();
  m_study.signals[0].from = 2;  // after the end
  derive();
  EXPECT_NE(why_absent(m_rows[0], "signals.tip.final").find("fewer than two"),
            std::string::npos);
}

TEST_F(Derived, WhatIsNotFoundSaysWhy) {
  m_study.signals = {tip()};
  m_study.signals[0].selector.method = "delaunay";
  write(m_rows[0], 1, 0.2);  // ends before its peak
  fs::remove(m_out / m_rows[1].run / "history.csv");
  derive();
  EXPECT_FALSE(value_of(m_rows[0], "signals.tip.first_peak"));
  EXPECT_NE(why_absent(m_rows[0], "signals.tip.first_peak").find("no maximum"),
            std::string::npos);
  EXPECT_NE(why_absent(m_rows[1], "signals.tip.period").find("no history.csv"),
            std::string::npos);
  EXPECT_FALSE(m_rows[3].summary.contains("signals")) << "not selected";
  m_study.signals[0].column = "tip_y_m";
  derive();
  EXPECT_NE(why_absent(m_rows[2], "signals.tip.period").find("did you mean tip_z_m"),
            std::string::npos);
}

TEST_F(Derived, ErrorsAgainstAReferenceRun) {
  m_study.signals = {tip()};
  m_study.errors = {against_fem("signals.tip.first_peak")};
  m_study.errors[0].is_signed = true;
  derive();
  EXPECT_NEAR(*value_of(m_rows[0], "errors.e"), 1. / 16, 1e-5);
  EXPECT_NEAR(*value_of(m_rows[2], "errors.e"), 1. / 256, 1e-5);
  EXPECT_FALSE(value_of(m_rows[3], "errors.e")) << "none against itself";
  EXPECT_EQ(m_rows[0].summary["error_sources"]["e"]["reference"],
            "fem (Q2) on block, resolution 8");
}

TEST_F(Derived, SignsOfErrors) {
  m_study.errors = {against_fem("quantities.tip")};  // 1 + h^2
  m_study.errors[0].is_signed = true;
  derive();
  const double reference = 1 + 1. / 64, value = 1 + 1. / 256;
  EXPECT_NEAR(*value_of(m_rows[2], "errors.e"), (value - reference) / reference, 1e-14);
  EXPECT_LT(*value_of(m_rows[2], "errors.e"), 0);
  m_study.errors[0].is_signed = false;
  derive();
  EXPECT_GT(*value_of(m_rows[2], "errors.e"), 0);
}

TEST_F(Derived, ErrorsAgainstAnExactValue) {
  ErrorEntry entry = against_fem("quantities.tip");
  entry.exact = 1.0;
  m_study.errors = {entry};
  derive();
  EXPECT_NEAR(*value_of(m_rows[1], "errors.e"), 1. / 64, 1e-14);
  EXPECT_NEAR(*value_of(m_rows[3], "errors.e"), 1. / 64, 1e-14) << "fem has it as well";
}

TEST_F(Derived, ErrorsOfHistories) {
  ErrorEntry entry = against_fem("");
  entry.of_history = true;
  entry.column = "tip_z_m";
  m_study.errors = {entry};
  write(m_rows[1], 1, 1.2);
  derive();
  EXPECT_NEAR(*value_of(m_rows[0], "errors.e"), 1. / 16, 1e-5);
  EXPECT_FALSE(value_of(m_rows[1], "errors.e"));
  EXPECT_NE(why_absent(m_rows[1], "errors.e").find("differ in time"), std::string::npos);
}

TEST_F(Derived, WithoutAReferenceThereIsNoError) {
  m_study.errors = {against_fem("quantities.tip")};
  m_study.errors[0].reference_resolution = 32;
  derive();
  EXPECT_NE(why_absent(m_rows[0], "errors.e").find("does not run in this mode"),
            std::string::npos);
  m_study.errors[0].reference_resolution.reset();
  m_rows[3].error = "det F <= 0";
  derive();
  EXPECT_NE(why_absent(m_rows[0], "errors.e").find("det F <= 0"), std::string::npos);
}
