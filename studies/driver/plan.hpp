#pragma once
// The runs that a study needs.

#include "studies/driver/rows.hpp"

namespace concord::studies {

/// One call of this program.
struct Job {
  std::size_t row = 0;  ///< index into the rows
  std::string key;
  std::filesystem::path folder;
  std::vector<std::string> arguments;
  double weight = 1;  ///< guess of the cost, for the time left
  std::string what;
};

/// Rows without results, and a job for each.
struct Plan {
  std::vector<Row> rows;
  std::vector<Job> jobs;
};

/// Expands cases to runs. Throws InputError when a scene, method or setting of the study is
/// wrong. `out`: the study's folder.
Plan make_plan(const Study& study, const std::filesystem::path& out);

/// Letters, digits, points and hyphens of a text, for file names: "xi 1, 25 %" -> "xi-1-25".
std::string slug(const std::string& text);

/// "./concord ARGUMENTS" as one types it into a shell, quoted where needed.
std::string shell_line(const std::vector<std::string>& arguments);

}  // namespace concord::studies
