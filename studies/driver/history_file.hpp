#pragma once
// Columns of a run's history.csv.

#include <filesystem>
#include <string>
#include <vector>

namespace concord::studies {

/// Time and one column.
struct Record {
  std::vector<double> t, x;
  std::string reason;  ///< why there is none: no file, no such column (with those there are)
};

/// Time is the first column. Cells that are no numbers become NaN.
Record read_record(const std::filesystem::path& file, const std::string& column);

}  // namespace concord::studies
