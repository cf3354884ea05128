#pragma once
// How far a long job is: one line with a bar on a terminal, a plain line now and then
// elsewhere.

#include <chrono>
#include <string>

namespace concord::studies {

/// Writes to the standard error stream. Time left is the elapsed time scaled by what remains.
class Progress {
 public:
  explicit Progress(std::string title);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  /// fraction in [0, 1]; `what` says what runs now ("12/80 delaunay, 16").
  void update(double fraction, const std::string& what);
  /// Removes the line from a terminal.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;
  std::string m_title;
  bool m_terminal = false, m_drawn = false;
  Clock::time_point m_start, m_last;
};

/// "45 s", "3 min 20 s", "1 h 05 min".
std::string duration_text(double seconds);

}  // namespace concord::studies
