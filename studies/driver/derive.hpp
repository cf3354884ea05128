#pragma once
// What a study draws from its runs: signals of their histories, errors against other runs.

#include "studies/driver/rows.hpp"

namespace concord::studies {

/// Adds signals.NAME.FEATURE of every [[signal]] to the rows that it selects, or
/// signals.NAME.not_found.FEATURE with the reason. `out`: the study's folder.
void add_signals(const Study& study, std::vector<Row>& rows, const std::filesystem::path& out);

/// Adds errors.NAME of every [[error]] to the rows that it selects, and error_sources.NAME with
/// `value` and `reference`, or with the `reason` why there is no error. Entries in order: a
/// later one may draw on an earlier one. A reference has no error against itself.
void add_errors(const Study& study, std::vector<Row>& rows, const std::filesystem::path& out);

}  // namespace concord::studies
