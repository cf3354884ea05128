// Features of records with known peaks and periods, noisy and monotone ones.

#include "studies/driver/signals.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

using namespace concord::studies;

namespace {

constexpr double pi = std::numbers::pi;

struct Made {
  std::vector<double> t, x;
};

Made made(const std::function<double(double)>& x, double end, int samples) {
  Made record;
  for (int i = 0; i <= samples; ++i) {
    record.t.push_back(end * i / samples);
    record.x.push_back(x(record.t.back()));
  }
  return record;
}

Feature feature(const std::string& name, const Made& record, FeatureOptions options = {}) {
  return feature_of(name, record.t, record.x, options);
}

}  // namespace

TEST(Signals, FirstPeakByAParabola) {
  // A parabola is found exactly, wherever its samples lie.
  const auto arch = made([](double t) { return 3 - 7 * (t - 0.43) * (t - 0.43); }, 1, 9);
  EXPECT_NEAR(feature("first_peak", arch).value, 3, 1e-13);
  EXPECT_NEAR(feature("first_peak_time", arch).value, 0.43, 1e-13);
  // A damped sine: maximum where tan(w t) = w/d. The parabola's error falls with dt^2.
  const double w = 2 * pi / 0.8, d = 0.5, at = std::atan(w / d) / w;
  const auto x = [&](double t) { return 2 * std::exp(-d * t) * std::sin(w * t); };
  const auto damped = made(x, 3, 300);
  EXPECT_NEAR(feature("first_peak_time", damped).value, at, 2e-5);
  EXPECT_NEAR(feature("first_peak", damped).value, x(at), 2e-5);
  // The second, higher maximum does not count.
  const double g = 0.3;
  const auto growing =
      made([&](double t) { return std::exp(g * t) * std::sin(w * t); }, 3, 3000);
  EXPECT_NEAR(feature("first_peak_time", growing).value, (pi - std::atan(w / g)) / w, 1e-5);
}

TEST(Signals, UnevenSamples) {
  Made record;
  for (const double t : {0.0, 0.1, 0.35, 0.4, 0.6, 0.7, 1.0}) {
    record.t.push_back(t);
    record.x.push_back(1 - (t - 0.45) * (t - 0.45));
  }
  EXPECT_NEAR(feature("first_peak_time", record).value, 0.45, 1e-13);
}

TEST(Signals, NoPeakWhereTheRecordDoesNotTurn) {
  for (const double slope : {1.0, -1.0}) {
    const Feature none =
        feature("first_peak", made([&](double t) { return slope * t; }, 2, 50));
    EXPECT_NE(none.reason.find("no maximum inside the record"), std::string::npos);
    EXPECT_NE(none.reason.find("t = 2 s"), std::string::npos) << none.reason;
  }
  EXPECT_FALSE(feature("first_peak", made([](double) { return 1; }, 2, 50)).reason.empty());
  // Falling from its start: the first maximum inside comes a period later.
  const auto cosine = made([](double t) { return std::cos(2 * pi * t); }, 1.5, 300);
  EXPECT_NEAR(feature("first_peak_time", cosine).value, 1, 1e-6);
}

TEST(Signals, NoiseBelowTheProminenceIsNoPeak) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> noise(-0.02, 0.02);
  const auto noisy =
      made([&](double t) { return std::sin(2 * pi * t) + noise(random); }, 2.2, 2000);
  EXPECT_NEAR(feature("first_peak", noisy).value, 1, 0.03);
  EXPECT_NEAR(feature("first_peak_time", noisy).value, 0.25, 0.05);
  EXPECT_NEAR(feature("period", noisy).value, 1, 0.01);
  // The negative control: with next to no prominence the first wiggle is taken for the peak.
  EXPECT_LT(feature("first_peak_time", noisy, {0, 1e-6}).value, 0.1);
}

TEST(Signals, PeriodFromTheLevel) {
  const double period = 0.37;
  const auto x = [&](double t) { return 5 + 2 * std::sin(2 * pi * (t / period + 0.1)); };
  const auto record = made(x, 2, 2000);
  EXPECT_NEAR(feature("period", record, {5, 0.05}).value, period, 1e-5);
  const Feature none = feature("period", record);  // never comes near 0
  EXPECT_NE(none.reason.find("0 crossing(s) of the level 0"), std::string::npos) << none.reason;
  // One period needs three crossings; a record that starts on the level starts with one.
  const auto sine = [](double t) { return std::sin(2 * pi * t); };
  EXPECT_FALSE(feature("period", made(sine, 0.9, 90)).reason.empty());
  EXPECT_NEAR(feature("period", made(sine, 1.1, 110)).value, 1, 1e-3);
  // Unequal halves: a period all the same.
  const auto lopsided = made([](double t) { return std::sin(2 * pi * t) + 0.4; }, 3.4, 3400);
  EXPECT_NEAR(feature("period", lopsided).value, 1, 1e-5);
}

TEST(Signals, ExtremesAndChanges) {
  const auto line = made([](double t) { return 2 - t; }, 3, 30);
  EXPECT_DOUBLE_EQ(feature("initial", line).value, 2);
  EXPECT_DOUBLE_EQ(feature("final", line).value, -1);
  EXPECT_DOUBLE_EQ(feature("minimum", line).value, -1);
  EXPECT_DOUBLE_EQ(feature("maximum", line).value, 2);
  EXPECT_NEAR(feature("mean", line).value, 0.5, 1e-14);
  EXPECT_DOUBLE_EQ(feature("largest_change", line).value, 3);
  EXPECT_DOUBLE_EQ(feature("relative_change", line).value, 1.5);
  const auto from_zero = made([](double t) { return t; }, 1, 10);
  EXPECT_FALSE(feature("relative_change", from_zero).reason.empty());
}

TEST(Signals, ABrokenRecordHasNone) {
  auto record = made([](double t) { return std::sin(t); }, 9, 90);
  record.x[40] = std::nan("");
  for (const std::string& name : feature_names()) {
    const Feature none = feature(name, record);
    EXPECT_NE(none.reason.find("line 42"), std::string::npos) << name << ": " << none.reason;
  }
  EXPECT_FALSE(feature("mean", {{0.0}, {1.0}}).reason.empty());
  EXPECT_THROW(feature("frequency", made([](double t) { return t; }, 1, 3)),
               std::invalid_argument);
}

TEST(Signals, HistoriesAgainstEachOther) {
  const auto sine = [](double t) { return std::sin(2 * pi * t); };
  const auto reference = made(sine, 2, 4000);
  const auto scaled = made([&](double t) { return 1.1 * sine(t); }, 2, 321);
  const auto difference = [&](const Made& record) {
    return history_difference(record.t, record.x, reference.t, reference.x);
  };
  EXPECT_NEAR(difference(scaled).value, 0.1, 1e-6);
  // A phase lag s: sqrt(2 (1 - cos(2 pi s))).
  const double lag = 0.01;
  const auto late = made([&](double t) { return sine(t - lag); }, 2, 4000);
  EXPECT_NEAR(difference(late).value, std::sqrt(2 * (1 - std::cos(2 * pi * lag))), 1e-6);
  EXPECT_FALSE(difference(made(sine, 1.9, 4000)).reason.empty()) << "ends before";
  const auto zero = made([](double) { return 0; }, 2, 10);
  EXPECT_FALSE(history_difference(scaled.t, scaled.x, zero.t, zero.x).reason.empty());
}
