#include "scene/continued_output.hpp"

#include "scene/crc64.hpp"
#include "scene/errors.hpp"
#include "scene/safe_file.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cstring>

namespace concord::scene {
namespace fs = std::filesystem;
namespace {

std::string reason_of_errno() { return errno != 0 ? std::strerror(errno) : "unknown reason"; }

InputError not_ours(const fs::path& file, int line, const std::string& found) {
  return {{file.string(), line}, "history", found, "the rows written before the checkpoint"};
}

std::string beginning(const fs::path& file, std::uintmax_t bytes, std::uint64_t digest) {
  std::error_code absent;
  const std::uintmax_t size = fs::file_size(file, absent);
  if (absent) throw not_ours(file, 0, "nothing");
  if (size < bytes) throw not_ours(file, 0, fmt::format("less: {} of {} bytes", size, bytes));
  if (digest != 0 && digest_of(file, bytes) != digest) throw not_ours(file, 0, "other rows");
  const std::vector<char> text = read_bytes(file, bytes);
  return {text.begin(), text.end()};
}

/// Numbers as HistoryWriter writes them: the shortest text that reads back to the same bits.
std::vector<double> numbers(const fs::path& file, int line, const std::string& text) {
  std::vector<double> row;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (true) {
    double value = 0;
    const auto [next, error] = std::from_chars(at, end, value);
    if (error != std::errc() || (next != end && *next != ','))
      throw not_ours(file, line, '"' + text + '"');
    row.push_back(value);
    if (next == end) return row;
    at = next + 1;
  }
}

}  // namespace

OutputError::OutputError(const fs::path& file, const std::string& reason)
    : std::runtime_error(fmt::format("cannot write {}: {}", file.string(),
                                     reason.empty() ? reason_of_errno() : reason)) {}

std::uint64_t digest_of(const fs::path& file, std::optional<std::uintmax_t> bytes) {
  try {
    return crc64_of(read_bytes(file, bytes ? *bytes : fs::file_size(file)));
  } catch (const std::runtime_error&) {  // of the file system too
    return 0;
  }
}

HistoryWriter continue_history(const fs::path& file, const std::vector<std::string>& columns,
                               std::uintmax_t bytes, std::uint64_t digest) {
  const std::string old = beginning(file, bytes, digest);
  std::vector<std::vector<double>> rows;
  int line = 0;
  for (std::size_t begin = 0; begin < old.size();) {
    const std::size_t end = old.find('\n', begin);
    const std::string text = old.substr(begin, end - begin);
    ++line;
    if (end == std::string::npos) throw not_ours(file, line, '"' + text + '"');
    begin = end + 1;
    if (line == 1 && text != fmt::format("{}", fmt::join(columns, ",")))
      throw not_ours(file, line, '"' + text + '"');
    if (line == 1) continue;
    rows.push_back(numbers(file, line, text));
    if (rows.back().size() != columns.size()) throw not_ours(file, line, '"' + text + '"');
  }
  const fs::path temporary = file.string() + ".part";
  HistoryWriter writer;
  writing(file, [&] {
    writer = HistoryWriter(temporary, columns);
    for (const std::vector<double>& row : rows) writer.append(row);
  });
  if (fs::file_size(temporary) != bytes) throw not_ours(file, line, "other digits");
  bring_to_disk(temporary);
  fs::rename(temporary, file);  // the writer goes on with it under that name
  return writer;
}

void cut_back(const fs::path& file, std::uintmax_t bytes) noexcept {
  std::error_code ignored;
  if (fs::file_size(file, ignored) > bytes && !ignored) fs::resize_file(file, bytes, ignored);
}

}  // namespace concord::scene
