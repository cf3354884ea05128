#pragma once
// Results of a study's runs, and what follows from them level by level.

#include "studies/driver/fits.hpp"
#include "studies/driver/study_file.hpp"

#include <nlohmann/json.hpp>

#include <optional>
#include <string>
#include <vector>

namespace concord::studies {

/// One run of a case: its summary.json, or the reason why it failed, or both.
struct Row {
  std::size_t case_index = 0;
  double resolution = 0;
  std::uint64_t seed = 1;
  nlohmann::json summary = nlohmann::json::object();
  std::string error;          ///< empty when the run went to its end
  std::filesystem::path run;  ///< folder, relative to study.json
  std::string command;        ///< one line that reproduces it
};

/// The finite number at a dotted path of the summary ("errors.displacement_l2"); nothing if it
/// is absent or the run failed.
std::optional<double> value_of(const Row& row, const std::string& quantity);

/// Why a row has no such value: its error, why it was not compared or a signal not found, or
/// that it has none.
std::string why_absent(const Row& row, const std::string& quantity);

/// Whether |invariants.energy_drift| of a run is within the study's balance_tolerance; nothing
/// where the study sets none or the run has no drift.
std::optional<bool> balance_closes(const Study& study, const Row& row);
/// Whether no run of a case at these resolutions has a balance that does not close.
bool balances_close(const Study& study, const std::vector<Row>& rows, std::size_t case_index,
                    const std::vector<double>& resolutions);
/// "closes" or "does not close".
const char* balance_text(bool closes);

/// Greatest, least or mean of at least one value.
double pool_of(const std::vector<double>& values, Pool pool);

/// One resolution of a case: a quantity over its seeds. Exists only if every seed has a value.
struct Level {
  double resolution = 0, h = 0;
  double mean = 0, minimum = 0, maximum = 0;
  std::size_t seeds = 0;
  double unknowns = 0, wall_s = 0;  ///< means; NaN where a run gives none
};

/// Levels of a case from coarse to fine.
std::vector<Level> levels_of(const std::vector<Row>& rows, std::size_t case_index,
                             const std::string& quantity);

struct FitResult {
  std::size_t case_index = 0;
  std::string quantity;
  LineFit line;
  std::vector<double> resolutions;  ///< of the levels that entered
};

/// Fits of every [[fit]] and every case that matches and has at least three levels (or as many
/// as `finest` asks for) with means above 0.
std::vector<FitResult> fit_all(const Study& study, const std::vector<Row>& rows);

struct ReferenceResult {
  std::size_t case_index = 0;
  std::string quantity;
  double formal_order = 0;
  std::vector<double> resolutions;
  double value = 0;  ///< on the finest level
  GridConvergence convergence;
};

/// Discretisation errors of every [[reference]] whose case runs in this mode; with fewer than
/// three levels the statement says so.
std::vector<ReferenceResult> references_of(const Study& study, const std::vector<Row>& rows);

}  // namespace concord::studies
