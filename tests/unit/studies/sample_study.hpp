#pragma once
// A study in memory: second-order errors on three levels with two seeds.

#include "studies/driver/rows.hpp"

namespace concord::studies {

inline Study sample_study() {
  Study study;
  study.name = "sample";
  study.title = "Sample";
  Case entry;
  entry.scene = "block";
  entry.method = "delaunay";
  entry.variant = "xi 1";
  entry.resolutions = {4, 8, 16};
  entry.seeds = {1, 2};
  study.cases.push_back(entry);
  Fit fit;
  fit.quantity = "errors.displacement_l2";
  study.fits.push_back(fit);
  return study;
}

/// error = (1 + seed/10) h^2 with h = 1/N.
inline std::vector<Row> sample_rows(const Study& study) {
  std::vector<Row> rows;
  for (std::size_t c = 0; c < study.cases.size(); ++c)
    for (const double n : study.cases[c].resolutions)
      for (const std::uint64_t seed : study.cases[c].seeds) {
        Row row;
        row.case_index = c;
        row.resolution = n;
        row.seed = seed;
        const double h = 1 / n, factor = 1 + 0.1 * static_cast<double>(seed);
        row.summary = {{"h", h},
                       {"unknowns", 3 * n * n * n},
                       {"wall_s", 0.1},
                       {"errors", {{"displacement_l2", factor * h * h}}},
                       {"quantities", {{"tip", 1 + h * h}}}};
        rows.push_back(row);
      }
  return rows;
}

}  // namespace concord::studies
