#pragma once
// Loops over fixed blocks: the same work in the same order for every number of threads, hence
// the same bits.

#include "scene/types.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace concord::particle {

/// Where loops run: a number of threads, 1 meaning the calling thread with no scheduler
/// involved.
class Executor {
 public:
  explicit Executor(int threads = 1) : m_threads(std::max(1, threads)), m_arena(m_threads) {}
  int threads() const { return m_threads; }

  /// body(k) for k = 0 .. count-1, in any order, on all threads; returns when all are done.
  template <class Body> void for_each(std::size_t count, const Body& body) const {
    if (m_threads == 1 || count < 2) {
      for (std::size_t k = 0; k < count; ++k) body(k);
    } else {
      m_arena.execute(
          [&] { tbb::parallel_for(std::size_t{0}, count, body, tbb::simple_partitioner{}); });
    }
  }

  /// body(begin, end) over pieces of [0, n) of fixed size, so that sums by piece do not depend
  /// on threads.
  template <class Body> void for_pieces(std::size_t n, const Body& body) const {
    for_each(pieces(n), [&](std::size_t k) { body(k * piece, std::min(n, (k + 1) * piece)); });
  }

  /// Sum over pieces in order: term(begin, end) -> double.
  template <class Term> double sum(std::size_t n, const Term& term) const {
    std::vector<double> partial(pieces(n));
    for_each(partial.size(), [&](std::size_t k) {
      partial[k] = term(k * piece, std::min(n, (k + 1) * piece));
    });
    double total = 0;
    for (const double p : partial) total += p;
    return total;
  }

  static constexpr std::size_t piece = 8192;
  static std::size_t pieces(std::size_t n) { return (n + piece - 1) / piece; }

 private:
  int m_threads;
  mutable tbb::task_arena m_arena;
};

}  // namespace concord::particle
