#pragma once
// Orders of convergence and discretisation errors from sequences of results.

#include <span>
#include <string>

namespace concord::studies {

/// Straight line log(y) = slope log(x) + intercept by least squares; r2 is the share of the
/// variance that it explains.
struct LineFit {
  double slope = 0, intercept = 0, r2 = 0;
};

/// Fit through at least two points with x, y > 0, x not all equal. Throws std::invalid_argument
/// otherwise.
LineFit fit_loglog(std::span<const double> x, std::span<const double> y);

/// Order between two levels, log(coarse_error/fine_error)/log(coarse_h/fine_h); NaN where an
/// error is not above 0 or the spacings are equal.
double local_order(double coarse_h, double coarse_error, double fine_h, double fine_error);

/// Discretisation error of a sequence of three levels.
/// Roache, J. Fluids Eng. 116 (1994) 405: GCI = Fs |f2 - f1| / |f1| / (r^p - 1), f1 the finest.
/// The choice of p and Fs is that of Oberkampf and Roy, Verification and Validation in
/// Scientific Computing (2010), section 8.7: Fs = 1.25 with the formal order when the observed
/// one is within 10 % of it; else Fs = 3 with the smaller of the two, but not below 0.5.
struct GridConvergence {
  bool asymptotic = false;   ///< monotone and shrinking: an observed order exists
  double order = 0;          ///< observed
  double extrapolated = 0;   ///< Richardson's value with the observed order
  double gci = 0;            ///< relative to the finest value
  double safety_factor = 0;  ///< Fs
  std::string statement;     ///< one sentence for the report
};

/// h and f from coarse to fine, three each, h descending. For unequal ratios the order solves
/// p = |ln(e32/e21) + ln((r21^p - 1)/(r32^p - 1))| / ln r21 (Celik et al., J. Fluids Eng. 130
/// (2008) 078001). Throws std::invalid_argument for other sizes or spacings.
GridConvergence grid_convergence(std::span<const double> h, std::span<const double> f,
                                 double formal_order);

}  // namespace concord::studies
