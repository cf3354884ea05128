#include "fem_reference/calculix/result_files.hpp"

#include "scene/errors.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cstdlib>
#include <optional>
#include <string_view>

namespace concord::calculix {
namespace {

[[noreturn]] void fail(const char* file, long line, const std::string& text) {
  throw SolveError("the results of CalculiX", 0, 0, -1,
                   fmt::format("{} file, line {}: cannot read \"{}\"", file, line, text));
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

/// A number as Fortran prints it: three-digit exponents come without their E.
std::optional<double> fortran_number(std::string_view text) {
  text = trimmed(text);
  double value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error == std::errc::result_out_of_range) return 0.0;  // below 1e-308
  if (error != std::errc()) return std::nullopt;
  if (stop == end) return value;
  if (*stop != '+' && *stop != '-') return std::nullopt;
  const std::string mended =
      std::string(text.data(), stop) + "E" + std::string(stop, end);  // 1.234567-101
  char* last = nullptr;
  value = std::strtod(mended.c_str(), &last);
  if (last != mended.c_str() + mended.size()) return std::nullopt;
  return value;
}

/// Appends the numbers of a row; false if it is none.
bool append_row(std::string_view line, std::vector<double>& values) {
  while (!(line = trimmed(line)).empty()) {
    const std::size_t end = std::min(line.find_first_of(" \t"), line.size());
    const auto value = fortran_number(line.substr(0, end));
    if (!value) return false;
    values.push_back(*value);
    line.remove_prefix(end);
  }
  return true;
}

/// " total force (fx,fy,fz) for set R0 and time  0.5000000E+00"
bool read_heading(const std::string& line, DatTable& table) {
  const std::size_t set = line.find("for set "), time = line.find(" and time ");
  if (set == std::string::npos || time == std::string::npos || time < set) return false;
  const auto value = fortran_number(std::string_view(line).substr(time + 10));
  if (!value) return false;
  table = DatTable();
  table.quantity = trimmed(std::string_view(line).substr(0, std::min(line.find('('), set)));
  table.set = trimmed(std::string_view(line).substr(set + 8, time - set - 8));
  table.time = *value;
  return true;
}

}  // namespace

void read_dat(std::istream& file, const std::function<void(const DatTable&)>& take) {
  DatTable table;
  bool open = false;
  long number = 0;
  for (std::string line; std::getline(file, line);) {
    ++number;
    if (trimmed(line).empty()) continue;
    DatTable next;
    if (read_heading(line, next)) {
      if (open) take(table);
      table = std::move(next);
      open = true;
      continue;
    }
    const bool cut = file.eof();  // the last line lacks its end: the row may be half a row
    if (!open) {
      if (cut) break;
      if (trimmed(line).starts_with("S T E P")) continue;
      fail(".dat", number, line);
    }
    const std::size_t before = table.values.size();
    if (!append_row(line, table.values)) {
      table.values.resize(before);
      if (cut) break;
      fail(".dat", number, line);
    }
    const std::size_t width = table.values.size() - before;
    if (table.columns == 0 && !cut) table.columns = width;
    if (width == table.columns && !cut) continue;
    table.values.resize(before);
    if (!cut) fail(".dat", number, line);
  }
  if (open) take(table);
}

void read_frd(std::istream& file, const std::function<void(const FrdBlock&)>& take) {
  FrdBlock block;
  bool results = false, named = false;  // within a "100C" block; its "-4" line seen
  long number = 0;
  for (std::string line; std::getline(file, line);) {
    ++number;
    if (file.eof()) return;  // the last line lacks its end
    const std::string_view view(line), key = trimmed(view.substr(0, 5));
    if (key == "100" && view.substr(5, 1) == "C") {
      const auto time = view.size() >= 24 ? fortran_number(view.substr(12, 12)) : std::nullopt;
      if (!time) fail(".frd", number, line);
      block = FrdBlock();
      block.time = *time;
      results = true;
      named = false;
    } else if (results && key == "-4") {
      block.name = trimmed(view.substr(5, 8));
      named = true;
    } else if (results && key == "-5") {
      // The last entry of a vector, ALL, is computed by the reader, not in the file.
      if (view.find("ALL") == std::string_view::npos) ++block.components;
    } else if (results && key == "-1") {
      const auto node = view.size() >= 13 ? fortran_number(view.substr(3, 10)) : std::nullopt;
      if (!node || !named || view.size() < 13 + 12 * block.components)
        fail(".frd", number, line);
      block.nodes.push_back(static_cast<int>(*node));
      for (std::size_t c = 0; c < block.components; ++c) {
        const auto value = fortran_number(view.substr(13 + 12 * c, 12));
        if (!value) fail(".frd", number, line);
        block.values.push_back(*value);
      }
    } else if (results && key == "-3") {
      take(block);
      results = false;
    } else if (results) {
      fail(".frd", number, line);
    }
  }
}

Progress read_sta(std::istream& file) {
  Progress progress;
  for (std::string line; std::getline(file, line);) {
    // STEP INC ATT ITRS TOT TIME STEP TIME INC TIME; headings are no row of numbers
    std::vector<double> row;
    if (!append_row(line, row) || row.size() < 7) continue;
    ++progress.increments;
    progress.iterations += static_cast<long>(row[3]);
    progress.time = row[4];
  }
  return progress;
}

}  // namespace concord::calculix
