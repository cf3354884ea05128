#include "studies/probes/states.hpp"

#include <algorithm>
#include <cmath>

namespace concord::probes {

std::vector<scene::ParameterInfo> deformation_options() {
  return {number_option("stretch", "1", "1", 0.05, 20, "0.05 .. 20",
                        "stretch along X of the state looked at; 1: undeformed"),
          number_option("shear", "1", "0", -10, 10, "-10 .. 10",
                        "simple shear of X along Y of the state looked at")};
}

std::vector<double> deformed(const scene::DiscreteBody& body, const scene::Settings& options) {
  const double stretch = options.number("stretch"), shear = options.number("shear");
  const auto dim = static_cast<std::size_t>(body.dim());
  std::vector<double> u(body.positions().size() * dim, 0.0);
  for (std::size_t a = 0; a < body.positions().size(); ++a) {
    const Vec3& X = body.positions()[a];
    u[a * dim] = (stretch - 1) * X[0] + shear * X[1];
  }
  return u;
}

double shortest_distance(std::span<const Vec3> points) {
  std::vector<Vec3> sorted(points.begin(), points.end());
  std::sort(sorted.begin(), sorted.end(),
            [](const Vec3& p, const Vec3& q) { return p[0] < q[0]; });
  double shortest = 1e300;
  for (std::size_t a = 0; a < sorted.size(); ++a) {
    for (std::size_t b = a + 1; b < sorted.size(); ++b) {
      if (sorted[b][0] - sorted[a][0] >= shortest) break;
      shortest = std::min(shortest, (sorted[b] - sorted[a]).norm());
    }
  }
  return shortest;
}

std::vector<int> free_components(const scene::DiscreteBody& body) {
  std::vector<int> free;
  const auto count = static_cast<int>(body.positions().size());
  for (int a = 0; a < count; ++a) {
    for (int i = 0; i < body.dim(); ++i) {
      if ((body.prescribed(a) >> static_cast<unsigned>(i) & 1U) == 0)
        free.push_back(a * body.dim() + i);
    }
  }
  return free;
}

void tell_size(const scene::DiscreteBody& body, scene::Result& result) {
  result.particles = static_cast<long>(body.positions().size());
  result.unknowns = static_cast<long>(free_components(body).size());
}

std::vector<std::vector<double>> checkerboards(const scene::DiscreteBody& body, double h) {
  const std::span<const Vec3> X = body.positions();
  Vec3 low = Vec3::Constant(1e300);
  for (const Vec3& p : X) low = low.cwiseMin(p);
  const int dim = body.dim();
  std::vector<std::vector<double>> patterns;
  for (unsigned k = 1; k < 1U << static_cast<unsigned>(dim); ++k) {
    std::vector<double> sign(X.size(), 1.0);
    for (std::size_t a = 0; a < X.size(); ++a) {
      for (int i = 0; i < dim; ++i) {
        const bool waves = (k >> static_cast<unsigned>(i) & 1U) != 0;
        if (waves && std::lround((X[a][i] - low[i]) / h) % 2 != 0) sign[a] = -sign[a];
      }
    }
    patterns.push_back(std::move(sign));
  }
  return patterns;
}

}  // namespace concord::probes
