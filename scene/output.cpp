// history.csv, and files that are never half written.

#include "scene/continued_output.hpp"

#include <cassert>
#include <cstdio>
#include <fmt/format.h>
#include <iterator>
#include <stdexcept>

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
  const std::filesystem::path temporary = file.string() + ".part";
  try {
    writing(file, [&] {
      std::ofstream stream;
      stream.exceptions(std::ios::badbit | std::ios::failbit);
      stream.open(temporary, std::ios::binary | std::ios::trunc);
      stream << text << std::flush;
      stream.close();
      std::filesystem::rename(temporary, file);
    });
  } catch (...) {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    throw;
  }
}

}  // namespace concord::scene
