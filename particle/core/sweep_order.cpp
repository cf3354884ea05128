#include "particle/core/sweep_order.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace concord::particle {
namespace {

/// Axes of a box, longest first.
std::array<int, 3> axes_by_length(int dim, const Vec3& size) {
  std::array<int, 3> axis{0, 1, 2};
  std::stable_sort(axis.begin(), axis.begin() + dim,
                   [&](int i, int j) { return size[i] > 1.0001 * size[j]; });
  return axis;
}

}  // namespace

std::vector<Index> sweep_order(int dim, double h, std::span<const Vec3> X, const Vec3& low,
                               const Vec3& high, const Executor& executor) {
  const std::array<int, 3> axis = axes_by_length(dim, high - low);
  const auto layer = [&](int i, const Vec3& at) {
    const double x = std::clamp(at[axis[i]], low[axis[i]], high[axis[i]]);
    return static_cast<std::size_t>(std::lround((x - low[axis[i]]) / h));
  };
  const std::size_t per_slab = dim == 3 ? layer(1, high) + 1 : 1;
  const auto row_of = [&](std::size_t a) {
    return layer(0, X[a]) * per_slab + (dim == 3 ? layer(1, X[a]) : 0);
  };
  std::vector<Index> begin((layer(0, high) + 1) * per_slab + 1, 0), order(X.size());
  for (std::size_t a = 0; a < order.size(); ++a) ++begin[row_of(a) + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<Index> next(begin.begin(), begin.end() - 1);
  for (std::size_t a = 0; a < order.size(); ++a)
    order[next[row_of(a)]++] = static_cast<Index>(a);
  const int along = axis[dim - 1];
  constexpr std::size_t rows_at_once = 256;
  executor.for_each((next.size() + rows_at_once - 1) / rows_at_once, [&](std::size_t k) {
    const std::size_t last = std::min(next.size(), (k + 1) * rows_at_once);
    for (std::size_t row = k * rows_at_once; row < last; ++row) {
      std::sort(order.begin() + begin[row], order.begin() + begin[row + 1],
                [&](Index a, Index b) {
                  const double X_a = X[a][along], X_b = X[b][along];
                  return X_a < X_b || (X_a == X_b && a < b);
                });
    }
  });
  return order;
}

}  // namespace concord::particle
