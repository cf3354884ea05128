#pragma once
// Heat maps: a number and a score for every method and test, each with its evidence.

#include "studies/driver/rows.hpp"

namespace concord::studies {

/// What a row and a column of a heat map give together.
struct HeatCell {
  std::optional<double> value;  ///< in the row's unit
  std::optional<double> score;  ///< 1: good or better, 0: bad or worse
  std::string reason;           ///< why there is no value
  std::string run;              ///< folder of the run that holds it (the first one for a mean)
  std::string command;          ///< one line that reproduces that run
  bool closes = true;           ///< no run used whose energy balance does not close
};

/// Pools the row's quantity over all runs that row and column select together. A run without
/// the quantity leaves the cell without a value, but is its evidence.
HeatCell heat_cell(const Study& study, const std::vector<Row>& rows, const HeatColumn& column,
                   const HeatRow& row);

/// Score of a value in the row's unit: linear between bad and good, or linear in the logarithm
/// (a value at or below 0 then counts as far beyond the lower end).
double score_of(const HeatRow& row, double value);

}  // namespace concord::studies
