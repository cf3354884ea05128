#pragma once
// A study's tables, for spreadsheets (CSV) and for reading (Markdown).

#include "studies/driver/study_output.hpp"

#include <string>
#include <vector>

namespace concord::studies {

/// Text cells in columns; a cell left out is empty.
struct Table {
  std::string name;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> cells;
  std::string csv() const;       ///< RFC 4180, one header line
  std::string markdown() const;  ///< a pipe table
};

/// runs, claims, fits, references, convergence-QUANTITY for every fit and those of
/// measure_tables; those without a line are left out.
std::vector<Table> tables_of(const StudyResult& result);

/// work-precision-N, matched-N, matched-N-sentences, heatmap-N and table-N.
std::vector<Table> measure_tables(const StudyResult& result);

}  // namespace concord::studies
