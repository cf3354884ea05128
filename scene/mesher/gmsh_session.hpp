#pragma once
// gmsh keeps one global model and is not thread-safe: all use of it goes through one session.

#include "scene/problem.hpp"

#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace concord::scene {

/// Holds the lock on gmsh, with an empty model and the options that every mesh starts from.
/// gmsh writes nothing to the terminal and leaves signals alone.
class GmshSession {
 public:
  GmshSession();
  ~GmshSession();
  GmshSession(const GmshSession&) = delete;
  GmshSession& operator=(const GmshSession&) = delete;

  /// Opens the problem's .geo with h, structured and the scene's parameters set beforehand.
  /// Throws InputError with gmsh's file and line.
  void open_geometry(const Problem& problem, double h, bool structured);
  /// InputError made of what gmsh last reported; `stage` is "cannot read" or "cannot mesh".
  [[noreturn]] void fail(const Problem& problem, const std::string& stage,
                         const std::string& report) const;
  /// Errors that gmsh logged and threw no exception for; empty if none.
  std::string logged_error() const;

 private:
  std::unique_lock<std::mutex> m_lock;
};

/// Runs a gmsh call and turns what it throws (gmsh 4.8 throws text) into an InputError.
template <class Call>
void gmsh_guard(const GmshSession& session, const Problem& problem, const std::string& stage,
                Call&& call) {
  std::string report;
  try {
    call();
    return;
  } catch (const InputError&) {
    throw;
  } catch (const std::string& text) {
    report = text;
  } catch (const std::exception& error) {
    report = error.what();
  } catch (int code) {
    report = "error " + std::to_string(code);
  }
  session.fail(problem, stage, report);
}

}  // namespace concord::scene
