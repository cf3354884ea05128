#pragma once
// Tables of chosen cases: a line a case, a column a pooled quantity, with differences to
// another case.

#include "studies/driver/rows.hpp"

namespace concord::studies {

/// What a line and a column of a [[table]] give together.
struct TableCell {
  std::optional<double> value;  ///< in the column's unit
  std::string reason;           ///< why there is no value
  std::size_t runs = 0;         ///< that entered
  bool closes = true;           ///< no run used whose energy balance does not close
};

/// The lines of a table whose cases run in this mode.
std::vector<const TableLine*> lines_of(const std::vector<Row>& rows, const Study& study,
                                       const RunTable& table);

/// Pools the column's quantity over all runs that the line selects. Of a difference: the pool
/// of value - value of the line's `against`, run by run of equal resolution and seed; runs
/// without such a partner do not enter, and a line without `against` has no value.
TableCell table_cell(const Study& study, const std::vector<Row>& rows, const TableLine& line,
                     const TableColumn& column);

}  // namespace concord::studies
