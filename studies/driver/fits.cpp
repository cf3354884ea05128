#include "studies/driver/fits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace concord::studies {

LineFit fit_loglog(std::span<const double> x, std::span<const double> y) {
  if (x.size() != y.size() || x.size() < 2)
    throw std::invalid_argument("a fit needs two or more points");
  const double n = static_cast<double>(x.size());
  double mean_x = 0, mean_y = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!(x[i] > 0) || !(y[i] > 0))
      throw std::invalid_argument("a log-log fit needs values above 0");
    mean_x += std::log(x[i]) / n;
    mean_y += std::log(y[i]) / n;
  }
  double xx = 0, xy = 0, yy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double dx = std::log(x[i]) - mean_x, dy = std::log(y[i]) - mean_y;
    xx += dx * dx;
    xy += dx * dy;
    yy += dy * dy;
  }
  if (xx == 0) throw std::invalid_argument("a fit needs different x");
  const double slope = xy / xx;
  return {slope, mean_y - slope * mean_x, yy == 0 ? 1.0 : xy * xy / (xx * yy)};
}

double local_order(double coarse_h, double coarse_error, double fine_h, double fine_error) {
  if (!(coarse_error > 0) || !(fine_error > 0) || !(coarse_h > 0) || !(fine_h > 0) ||
      coarse_h == fine_h)
    return std::numeric_limits<double>::quiet_NaN();
  return std::log(coarse_error / fine_error) / std::log(coarse_h / fine_h);
}

namespace {

/// Observed order from e32/e21 > 1 and the refinement ratios, by fixed-point iteration.
double observed_order(double ratio, double r21, double r32) {
  double p = std::log(ratio) / std::log(r21);
  for (int i = 0; i < 100 && r21 != r32 && p > 0; ++i) {
    const double next =
        std::abs(std::log(ratio) + std::log((std::pow(r21, p) - 1) / (std::pow(r32, p) - 1))) /
        std::log(r21);
    if (std::abs(next - p) < 1e-12 * p) return next;
    p = next;
  }
  return p;
}

}  // namespace

GridConvergence grid_convergence(std::span<const double> h, std::span<const double> f,
                                 double formal_order) {
  if (h.size() != 3 || f.size() != 3 || !(h[0] > h[1]) || !(h[1] > h[2]) || !(h[2] > 0))
    throw std::invalid_argument("grid convergence needs three levels, coarse to fine");
  const double e32 = f[1] - f[0], e21 = f[2] - f[1];
  GridConvergence result;
  result.extrapolated = f[2];
  if (!(e32 * e21 > 0)) {
    result.statement =
        "not asymptotic: the three finest values do not approach a limit from one side";
    return result;
  }
  const double r21 = h[1] / h[2], r32 = h[0] / h[1];
  const double p = observed_order(e32 / e21, r21, r32);
  if (!(p > 0) || !std::isfinite(p)) {
    result.statement = "not asymptotic: the differences between levels do not shrink";
    return result;
  }
  const bool near = std::abs(p - formal_order) <= 0.1 * formal_order;
  const double used = near ? formal_order : std::min(std::max(0.5, p), formal_order);
  result.asymptotic = true;
  result.order = p;
  result.safety_factor = near ? 1.25 : 3.0;
  result.extrapolated = f[2] + e21 / (std::pow(r21, p) - 1);
  result.gci = result.safety_factor * std::abs(e21 / f[2]) / (std::pow(r21, used) - 1);
  result.statement = fmt::format(
      "observed order {:.2f} (formal {:g}), GCI {:.2g} % of {:.6g} with safety factor {:g}", p,
      formal_order, 100 * result.gci, f[2], result.safety_factor);
  return result;
}

}  // namespace concord::studies
