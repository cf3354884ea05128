#include "scene/errors.hpp"

#include <fmt/format.h>

namespace concord {
namespace {

std::string position_text(const SourcePosition& where) {
  if (where.file.empty()) return "";
  if (where.line <= 0) return where.file + ": ";
  if (where.column <= 0) return fmt::format("{}:{}: ", where.file, where.line);
  return fmt::format("{}:{}:{}: ", where.file, where.line, where.column);
}

std::string input_message(const SourcePosition& where, const std::string& key,
                          const std::string& found, const std::string& allowed) {
  return fmt::format("{}{}: found {}; allowed: {}", position_text(where), key, found, allowed);
}

std::string solve_message(const std::string& quantity, long step, double time, long particle,
                          const std::string& detail) {
  std::string text =
      fmt::format("the numerics failed: {} at step {}, time {:.6g} s", quantity, step, time);
  if (particle >= 0) text += fmt::format(", particle {}", particle);
  if (!detail.empty()) text += ": " + detail;
  return text;
}

}  // namespace

InputError::InputError(SourcePosition where, std::string key, std::string found,
                       std::string allowed)
    : std::runtime_error(input_message(where, key, found, allowed)), m_where(std::move(where)),
      m_key(std::move(key)), m_found(std::move(found)), m_allowed(std::move(allowed)) {}

SolveError::SolveError(std::string quantity, long step, double time, long particle,
                       const std::string& detail)
    : std::runtime_error(solve_message(quantity, step, time, particle, detail)),
      m_quantity(std::move(quantity)), m_step(step), m_time(time), m_particle(particle) {}

}  // namespace concord
