// history.csv, and files that are never half written.

#include "scene/output.hpp"

#include "scene/safe_file.hpp"

#include <cassert>
#include <fmt/format.h>

namespace concord::scene {

HistoryWriter::HistoryWriter(const std::filesystem::path& file,
                             const std::vector<std::string>& columns)
    : m_columns(columns.size()) {
  if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path());
  m_stream.exceptions(std::ios::badbit | std::ios::failbit);
  m_stream.open(file, std::ios::trunc);
  m_stream << fmt::format("{}\n", fmt::join(columns, ",")) << std::flush;
}

void HistoryWriter::append(std::span<const double> row) {
  if (!active()) return;
  assert(row.size() == m_columns);
  m_stream << fmt::format("{}\n", fmt::join(row, ",")) << std::flush;
}

void write_file(const std::filesystem::path& file, const std::string& text) {
  if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path());
  write_whole(file, {text}, Reach::system);
}

}  // namespace concord::scene
