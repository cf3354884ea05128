#pragma once
// The two ways in which a run can fail, each with what a user needs to mend it.

#include <stdexcept>
#include <string>

namespace concord {

/// Where in a text file something was found; line and column count from 1, 0 means unknown.
struct SourcePosition {
  std::string file;
  int line = 0;
  int column = 0;
};

/// Bad input: one message with file, line, column, key, what was found and what is allowed.
/// Exit code 2.
class InputError : public std::runtime_error {
 public:
  InputError(SourcePosition where, std::string key, std::string found, std::string allowed);
  const SourcePosition& where() const noexcept { return m_where; }
  const std::string& key() const noexcept { return m_key; }
  const std::string& found() const noexcept { return m_found; }
  const std::string& allowed() const noexcept { return m_allowed; }

 private:
  SourcePosition m_where;
  std::string m_key, m_found, m_allowed;
};

/// The numerics failed (NaN, det F <= 0, no convergence). Exit code 3.
/// `particle` is the particle or element number, -1 when the failure belongs to none.
class SolveError : public std::runtime_error {
 public:
  SolveError(std::string quantity, long step, double time, long particle,
             const std::string& detail = "");
  const std::string& quantity() const noexcept { return m_quantity; }
  long step() const noexcept { return m_step; }
  double time() const noexcept { return m_time; }
  long particle() const noexcept { return m_particle; }

 private:
  std::string m_quantity;
  long m_step;
  double m_time;
  long m_particle;
};

/// Thrown at the next step boundary after Ctrl-C or SIGTERM; results so far are on disk. Exit
/// code 130.
class Interrupted : public std::runtime_error {
 public:
  Interrupted() : std::runtime_error("interrupted: everything computed so far is on disk") {}
};

}  // namespace concord
