#pragma once
// Readers of the entries of a study file, one function an entry.

#include "studies/driver/strict_table.hpp"
#include "studies/driver/study_file.hpp"

#include <vector>

namespace concord::studies {

/// A [[case]] with its sweep expanded; `in_mode` is false when quick reports leave it out and
/// `full` is false.
struct CaseEntry {
  std::vector<Case> cases;
  bool in_mode = true;
};
CaseEntry read_case(StrictTable table, bool full);
Fit read_fit(StrictTable table);
Reference read_reference(StrictTable table);
Claim read_claim(StrictTable table);
Plot read_plot(StrictTable table);
Picture read_picture(StrictTable table);

}  // namespace concord::studies
