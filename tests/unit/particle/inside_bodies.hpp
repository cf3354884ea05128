#pragma once
// Bodies of cubic cells with a particle in each, and springs between them: what core makes of
// particles inside the body, with solutions by hand.

#include "particle/core/inside_body.hpp"
#include "particle/core/leapfrog.hpp"
#include "scene/reader.hpp"

#include <array>
#include <cmath>
#include <map>

namespace concord::particle::test {

/// Cells of edge 1/N that fill the cube [0, 1]^3 of a problem whose .geo is such a cube, moved
/// by up to `perturb` h (the cells stay). Boundary points where `conditions` are asked for.
inline Body cubes(const scene::Problem& problem, int N, double perturb = 0) {
  const double h = problem.reference_length / N;
  scene::Mesh mesh = arrangement(problem, h, CellSource::delaunay);
  InsideParts parts;
  const auto shift = [&](std::size_t a, int i) {
    return perturb * h * (2 * scene::uniform_random(3, a, static_cast<std::uint64_t>(i)) - 1);
  };
  for (int k = 0; k < N * N * N; ++k) {
    const std::size_t a = parts.X.size();
    parts.X.push_back(h * Vec3(k % N + 0.5, k / N % N + 0.5, k / (N * N) + 0.5) +
                      Vec3(shift(a, 0), shift(a, 1), shift(a, 2)));
  }
  parts.X = in_sweep_order(mesh, parts.X, h, Executor(1));
  parts.V.assign(parts.X.size(), h * h * h);
  parts.h_min = h;
  const double L = problem.reference_length;
  for (Index a = 0; a < static_cast<Index>(parts.X.size()); ++a) {
    const Vec3 at = (parts.X[a] / h).array().floor();  // its cell
    for (int i = 0; i < 3; ++i) {
      for (const double side : {0.0, L}) {
        if (std::abs(h * (at[i] + 0.5) - side) > 0.6 * h) continue;
        SurfacePiece piece;
        piece.particle = a;
        piece.area = h * h;
        piece.C = h * (at + Vec3::Constant(0.5));
        piece.C[i] = side;
        piece.N = (side == 0 ? -1.0 : 1.0) * Vec3::Unit(i);
        for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
          const Index* v = &mesh.facets[f * mesh.nodes_per_facet];
          bool on = true;
          for (int c = 0; c < mesh.nodes_per_facet; ++c) on = on && mesh.nodes[v[c]][i] == side;
          if (on) piece.entity = mesh.facet_entity[f];
        }
        for (std::size_t k = 0; k < problem.boundaries.size(); ++k) {
          const scene::BoundaryCondition& bc = problem.boundaries[k];
          const auto& group = mesh.groups.at(bc.group).entities;
          if (std::find(group.begin(), group.end(), piece.entity) == group.end()) continue;
          const auto components = prescribed_components(bc, mesh);
          for (int c = 0; c < 3; ++c) {
            if (components[c] && piece.condition[c] < 0)
              piece.condition[c] = static_cast<Index>(k);
          }
        }
        if (piece.condition != Conditions{-1, -1, -1}) {
          piece.point = static_cast<Index>(parts.X.size() + parts.points.size());
          parts.points.push_back(piece.C);
          parts.owner.push_back(static_cast<Index>(parts.surface.size()));
        }
        parts.surface.push_back(piece);
      }
    }
  }
  return inside_body(problem, std::move(mesh), h, std::move(parts), Executor(1));
}

/// Springs of stiffness k between particles whose cells meet, and 2 k between a particle and
/// its boundary points, on the prescribed components: the line of X is stretched uniformly when
/// its ends are. Tractions act on the particle, A T.
class Springs final : public ForceModel {
 public:
  Springs(const Body& body, const scene::Problem& problem, double k)
      : ForceModel(body, problem) {
    for (Index a = 0; a < body.bulk; ++a) {
      for (Index b = 0; b < a; ++b) {
        if ((body.position(a) - body.position(b)).norm() < 1.2 * body.h)
          m_springs.push_back({a, b, Vec3::Constant(k)});
      }
    }
    for (Index p = body.bulk; p < body.n; ++p) {
      const BoundaryPoint& point = body.boundary[p - body.bulk];
      Vec3 stiffness = Vec3::Zero();
      for (int i = 0; i < 3; ++i) stiffness[i] = point.condition[i] >= 0 ? 2 * k : 0;
      m_springs.push_back({point.particle, p, stiffness});
    }
    for (const SurfacePiece& piece : body.surface) {
      for (std::size_t c = 0; c < problem.boundaries.size(); ++c) {
        const scene::BoundaryCondition& bc = problem.boundaries[c];
        const auto& group = body.mesh.groups.at(bc.group).entities;
        if (bc.kind == scene::BoundaryKind::traction &&
            std::find(group.begin(), group.end(), piece.entity) != group.end())
          m_loads.push_back({piece.particle, static_cast<Index>(c),
                             piece.area * Mat3::Identity(), piece.C, piece.N});
      }
    }
  }

  void forces(std::span<const double> u, std::span<const double>, std::span<double> f,
              const Executor&) override {
    std::fill(f.begin(), f.end(), 0.0);
    for (const Spring& s : m_springs) {
      for (std::size_t i = 0; i < 3; ++i) {
        const double pull = s.k[static_cast<int>(i)] * (u[4 * s.b + i] - u[4 * s.a + i]);
        f[4 * s.a + i] += pull;
        f[4 * s.b + i] -= pull;
      }
    }
  }
  Energies energies(std::span<const double> u, const Executor&) override {
    Energies e;
    for (const Spring& s : m_springs) {
      for (std::size_t i = 0; i < 3; ++i) {
        const double stretch = u[4 * s.b + i] - u[4 * s.a + i];
        e.internal += 0.5 * s.k[static_cast<int>(i)] * stretch * stretch;
      }
    }
    return e;
  }
  void gradients(std::span<const double>, std::span<Mat3> H) override {
    EXPECT_EQ(H.size(), static_cast<std::size_t>(m_body.bulk));
    for (Mat3& h : H) h.setZero();
  }
  const Stiffness& tangent(std::span<const double>) override {
    std::vector<Eigen::Triplet<double>> entries;
    for (const Spring& s : m_springs) {
      for (int i = 0; i < 3; ++i) {
        for (const Index p : {s.a, s.b}) {
          for (const Index q : {s.a, s.b})
            entries.emplace_back(3 * p + i, 3 * q + i, p == q ? s.k[i] : -s.k[i]);
        }
      }
    }
    m_K.resize(3 * m_body.n, 3 * m_body.n);
    m_K.setFromTriplets(entries.begin(), entries.end());
    return m_K;
  }
  const std::vector<LoadTerm>& load_terms() const override { return m_loads; }
  std::size_t interactions() const override { return m_springs.size(); }

 private:
  struct Spring {
    Index a, b;
    Vec3 k;
  };
  std::vector<Spring> m_springs;
  std::vector<LoadTerm> m_loads;
  Stiffness m_K;
};

}  // namespace concord::particle::test
