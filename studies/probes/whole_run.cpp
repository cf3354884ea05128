#include "studies/probes/whole_run.hpp"

#include "scene/frame_reader.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace concord::probes {
namespace fs = std::filesystem;
namespace {

bool finite(const std::vector<double>& values) {
  for (const double value : values)
    if (!std::isfinite(value)) return false;
  return true;
}

/// A cell as a number; "nan" and "inf" too, NaN for anything unreadable.
double number(const std::string& cell) {
  try {
    return std::stod(cell);
  } catch (const std::exception&) {
    return std::numeric_limits<double>::quiet_NaN();
  }
}

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  return cells;
}

/// Total energy in the rows of history.csv: what moves, what is stored, less work done.
std::vector<double> energies(const fs::path& folder) {
  const auto columns = read_columns(folder / "history.csv");
  std::vector<double> total(columns.at("t_s").size(), 0.0);
  for (const auto& [name, sign] : {std::pair{"kinetic_energy_J", 1.0},
                                   {"internal_energy_J", 1.0},
                                   {"stabilisation_energy_J", 1.0},
                                   {"viscous_dissipation_J", 1.0},
                                   {"external_work_J", -1.0}}) {
    const auto found = columns.find(name);
    if (found == columns.end()) continue;
    for (std::size_t k = 0; k < total.size(); ++k) total[k] += sign * found->second[k];
  }
  return total;
}

double mean(const std::vector<double>& values, std::size_t begin, std::size_t end) {
  double sum = 0;
  for (std::size_t k = begin; k < end; ++k) sum += values[k];
  return sum / static_cast<double>(end - begin);
}

}  // namespace

Attempt attempt(const ProbeRequest& request, const scene::Problem& problem,
                const fs::path& folder, bool frames) {
  Attempt attempt;
  scene::RunRequest run = request.run;
  run.out = folder;
  run.write_frames = frames;
  if (!folder.empty()) fs::create_directories(folder);
  try {
    request.method.run(problem, run, attempt.result);
  } catch (const SolveError& error) {
    attempt.failed = true;
    attempt.error = error.what();
    attempt.quantity = error.quantity();
  }
  return attempt;
}

std::map<std::string, std::vector<double>> read_columns(const fs::path& csv) {
  std::ifstream stream(csv);
  std::string line;
  if (!std::getline(stream, line)) throw std::runtime_error("cannot read " + csv.string());
  const std::vector<std::string> names = split(line);
  std::map<std::string, std::vector<double>> columns;
  while (std::getline(stream, line)) {
    const std::vector<std::string> cells = split(line);
    if (cells.size() != names.size())
      throw std::runtime_error("a row of " + csv.string() + " has other columns");
    for (std::size_t k = 0; k < names.size(); ++k)
      columns[names[k]].push_back(number(cells[k]));
  }
  return columns;
}

bool all_finite(const fs::path& folder) {
  try {
    for (const auto& [name, values] : read_columns(folder / "history.csv"))
      if (!finite(values)) return false;
    if (!fs::exists(folder / "fields.hdf.series")) return true;
    for (const scene::FrameEntry& entry : scene::read_frame_series(folder)) {
      const scene::Frame frame = scene::read_frame(entry.file);
      for (const scene::NodalField& field : frame.fields)
        if (!finite(field.values)) return false;
    }
  } catch (const std::runtime_error&) {
    return false;
  }
  return true;
}

void tell_energy(const fs::path& folder, std::map<std::string, double>& quantities) {
  const std::vector<double> energy = energies(folder);
  double change = 0, largest = 0;
  for (const double e : energy) {
    change = std::max(change, std::abs(e - energy.front()));
    largest = std::max(largest, std::abs(e));
  }
  quantities["drift"] = change / largest;
  const std::size_t tenth = std::max<std::size_t>(1, energy.size() / 10);
  const double first = mean(energy, 0, tenth);
  quantities["trend"] = (mean(energy, energy.size() - tenth, energy.size()) - first) / first;
}

void tell_momenta(const Attempt& attempt, std::map<std::string, double>& quantities) {
  for (const char* name : {"linear_momentum_drift", "angular_momentum_drift"}) {
    const auto found = attempt.result.invariants.find(name);
    if (found != attempt.result.invariants.end()) quantities[name] = found->second;
  }
}

void tell_run(const Attempt& attempt, scene::Result& result) {
  result.particles = attempt.result.particles;
  result.unknowns = attempt.result.unknowns;
  result.steps = attempt.result.steps;
  result.dt = attempt.result.dt;
  result.t_end = attempt.result.t_end;
  result.invariants = attempt.result.invariants;
  result.notes = attempt.result.notes;
  if (attempt.failed) result.notes["failure"] = attempt.error;
}

}  // namespace concord::probes
