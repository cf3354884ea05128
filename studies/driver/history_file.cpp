#include "studies/driver/history_file.hpp"

#include "scene/suggest.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

namespace concord::studies {
namespace {

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::stringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  return cells;
}

double number_of(const std::vector<std::string>& cells, std::size_t index) {
  if (index >= cells.size()) return std::nan("");
  char* end = nullptr;
  const double value = std::strtod(cells[index].c_str(), &end);
  return end == cells[index].c_str() ? std::nan("") : value;
}

}  // namespace

Record read_record(const std::filesystem::path& file, const std::string& column) {
  std::ifstream stream(file);
  std::string line;
  if (!stream || !std::getline(stream, line)) return {{}, {}, "the run left no history.csv"};
  auto columns = cells_of(line);
  const auto found = std::find(columns.begin(), columns.end(), column);
  if (found == columns.end())
    return {{},
            {},
            "history.csv has no column " + scene::in_quotes(column) + " but " +
                scene::allowed_words(column, columns)};
  const auto index = static_cast<std::size_t>(found - columns.begin());
  Record record;
  while (std::getline(stream, line)) {
    const auto cells = cells_of(line);
    record.t.push_back(number_of(cells, 0));
    record.x.push_back(number_of(cells, index));
  }
  return record;
}

}  // namespace concord::studies
