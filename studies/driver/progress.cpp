#include "studies/driver/progress.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

namespace concord::studies {
namespace {

constexpr double terminal_period = 0.2;  ///< [s] between redraws
constexpr double plain_period = 30;      ///< [s] between plain lines

std::size_t terminal_width() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 20 ? size.ws_col : 80U;
}

}  // namespace

std::string duration_text(double seconds) {
  const long s = std::lround(std::max(0.0, seconds));
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{} min {:02} s", s / 60, s % 60);
  return fmt::format("{} h {:02} min", s / 3600, s % 3600 / 60);
}

Progress::Progress(std::string title)
    : m_title(std::move(title)), m_terminal(isatty(STDERR_FILENO) != 0), m_start(Clock::now()),
      m_last(m_start) {}

Progress::~Progress() { finish(); }

void Progress::update(double fraction, const std::string& what) {
  const auto now = Clock::now();
  const double since = std::chrono::duration<double>(now - m_last).count();
  const bool first = m_terminal && !m_drawn;
  if (!first && since < (m_terminal ? terminal_period : plain_period)) return;
  m_last = now;
  const double elapsed = std::chrono::duration<double>(now - m_start).count();
  const std::string left =
      fraction > 0.01 ? ", " + duration_text(elapsed * (1 - fraction) / fraction) + " left"
                      : "";
  if (!m_terminal) {
    fmt::print(stderr, "{}: {:.0f} %, {}{}\n", m_title, 100 * fraction, what, left);
    return;
  }
  constexpr int width = 20;
  const int filled = static_cast<int>(std::clamp(fraction, 0.0, 1.0) * width);
  std::string line = fmt::format("{} [{:#<{}}{:.<{}}] {:.0f} %{}  {}", m_title, "", filled, "",
                                 width - filled, 100 * fraction, left, what);
  line.resize(std::min(line.size(), terminal_width() - 1));
  fmt::print(stderr, "\r{}\x1b[K", line);
  std::fflush(stderr);
  m_drawn = true;
}

void Progress::finish() {
  if (m_drawn) fmt::print(stderr, "\r\x1b[K");
  m_drawn = false;
}

}  // namespace concord::studies
