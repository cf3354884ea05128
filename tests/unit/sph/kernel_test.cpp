#include "sph_reference/total_lagrangian/kernel.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace concord::sph {
namespace {

using std::numbers::pi;
constexpr KernelShape shapes[] = {KernelShape::cubic_spline, KernelShape::wendland_c2};

TEST(Kernel, IntegralIsOne) {
  for (const KernelShape shape : shapes) {
    for (const int dim : {2, 3}) {
      const double R = 0.7;
      const Kernel kernel(shape, dim, R);
      // Simpson's rule, exact to round-off on the cubic spline's pieces but for its fourth
      // derivative: h^4/180.
      const int n = 4000;
      double sum = 0;
      for (int i = 0; i <= n; ++i) {
        const double r = R * i / n, shell = dim == 3 ? 4 * pi * r * r : 2 * pi * r;
        sum += (i == 0 || i == n ? 1
                : i % 2 == 1     ? 4
                                 : 2) *
               shell * kernel.value(r) * R / n / 3;
      }
      EXPECT_NEAR(sum, 1, 1e-11);
    }
  }
}

TEST(Kernel, CurvatureAtTheOriginIsThatOfTheTextbook) {  // TXT-2: -3/(pi h^5), -105/(16 pi h^5)
  const double h = 0.3;
  EXPECT_NEAR(Kernel(KernelShape::cubic_spline, 3, 2 * h).second_derivative(0) * std::pow(h, 5),
              -3 / pi, 1e-14);
  EXPECT_NEAR(Kernel(KernelShape::wendland_c2, 3, 2 * h).second_derivative(0) * std::pow(h, 5),
              -105 / (16 * pi), 1e-14);
}

TEST(Kernel, DerivativesMatchDifferences) {
  for (const KernelShape shape : shapes) {
    const double R = 1.3, d = 1e-5;
    const Kernel kernel(shape, 2, R);
    for (double r = 0.01; r < R - 0.01; r += 0.017) {
      EXPECT_NEAR(kernel.derivative(r), (kernel.value(r + d) - kernel.value(r - d)) / (2 * d),
                  1e-8);
      if (std::abs(r - R / 2) < 2 * d)
        continue;  // the third derivative of the cubic spline jumps
      EXPECT_NEAR(kernel.second_derivative(r),
                  (kernel.derivative(r + d) - kernel.derivative(r - d)) / (2 * d), 1e-7);
    }
  }
}

TEST(Kernel, VanishesSmoothlyAtItsSupport) {
  for (const KernelShape shape : shapes) {
    const Kernel kernel(shape, 3, 0.9);
    EXPECT_GT(kernel.value(0.899), 0);
    EXPECT_LT(kernel.value(0.899), 1e-6 * kernel.value(0));
    for (const double r : {0.9, 0.95, 2.0}) {
      EXPECT_EQ(kernel.value(r), 0);
      EXPECT_EQ(kernel.slope(r), 0);
    }
  }
}

}  // namespace
}  // namespace concord::sph
