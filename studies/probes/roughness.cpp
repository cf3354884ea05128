#include "studies/probes/roughness.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace concord::probes {
namespace {

/// The `count` points nearest to point a, itself left out.
std::vector<int> nearest(std::span<const Vec3> points, std::size_t a, std::size_t count) {
  std::vector<int> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  std::erase(order, static_cast<int>(a));
  count = std::min(count, order.size());
  std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count),
                    order.end(), [&](int p, int q) {
                      const double dp = (points[p] - points[a]).squaredNorm(),
                                   dq = (points[q] - points[a]).squaredNorm();
                      return dp < dq || (dp == dq && p < q);
                    });
  order.resize(count);
  return order;
}

}  // namespace

Parts split_roughness(int dim, std::span<const Vec3> points, std::span<const double> values) {
  const std::size_t count = dim == 3 ? 18 : 8;
  Parts parts;
  for (std::size_t a = 0; a < points.size(); ++a) {
    const std::vector<int> around = nearest(points, a, count);
    Vec3 centre = Vec3::Zero();
    double distance = 0;
    for (const int b : around) {
      centre += (points[b] - points[a]) / static_cast<double>(around.size());
      distance += (points[b] - points[a]).norm() / static_cast<double>(around.size());
    }
    if (centre.norm() > 0.25 * distance) continue;
    Eigen::MatrixXd A(around.size(), dim + 1);
    Eigen::VectorXd y(around.size());
    for (std::size_t k = 0; k < around.size(); ++k) {
      const auto row = static_cast<Eigen::Index>(k);
      A(row, 0) = 1;
      for (int i = 0; i < dim; ++i)
        A(row, 1 + i) = (points[around[k]][i] - points[a][i]) / distance;
      y[row] = values[around[k]];
    }
    parts.smooth.push_back(A.colPivHouseholderQr().solve(y)[0]);
    parts.rough.push_back(values[a] - parts.smooth.back());
  }
  return parts;
}

double trimmed_rms(std::vector<double> values) {
  for (double& value : values) value = std::abs(value);
  std::sort(values.begin(), values.end());
  const std::size_t kept = values.size() - values.size() / 20;
  double sum = 0;
  for (std::size_t k = 0; k < kept; ++k) sum += values[k] * values[k];
  return kept == 0 ? 0.0 : std::sqrt(sum / static_cast<double>(kept));
}

}  // namespace concord::probes
