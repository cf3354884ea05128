#include "particle/core/interpolant.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace concord::particle {

ParticleField::ParticleField(Body& body, std::vector<Vec3> X, std::vector<Vec3> u,
                             std::vector<Mat3> H)
    : m_dim(body.dim), m_simplices(std::exchange(body.triangulation.simplices, {})),
      m_X(std::move(X)), m_u(std::move(u)), m_H(std::move(H)) {
  Vec3 high = Vec3::Constant(-1e300);
  m_low = Vec3::Constant(1e300);
  for (const Vec3& x : m_X) {
    m_low = m_low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  m_cell = body.h;
  for (int i = 0; i < m_dim; ++i)
    m_cells[i] = std::max(1, static_cast<int>(std::ceil((high[i] - m_low[i]) / m_cell)));
  // In the grid: the simplices, or the particles of a body that has none.
  const std::size_t nv = m_simplices.empty() ? 1 : m_dim + 1,
                    count = m_simplices.empty() ? m_X.size() : m_simplices.size() / nv;
  const auto vertex = [&](std::size_t s, std::size_t k) {
    return m_simplices.empty() ? static_cast<Index>(s) : m_simplices[s * nv + k];
  };
  const auto grid_cell = [&](double x, int i) {
    return std::clamp(static_cast<int>((x - m_low[i]) / m_cell), 0, m_cells[i] - 1);
  };
  const auto for_cells = [&](std::size_t s, const auto& f) {
    std::array<int, 3> lo{0, 0, 0}, hi{0, 0, 0};
    for (int i = 0; i < m_dim; ++i) {
      double a = 1e300, b = -1e300;
      for (std::size_t k = 0; k < nv; ++k) {
        a = std::min(a, m_X[vertex(s, k)][i]);
        b = std::max(b, m_X[vertex(s, k)][i]);
      }
      lo[i] = grid_cell(a - 1e-9 * m_cell, i);
      hi[i] = grid_cell(b + 1e-9 * m_cell, i);
    }
    for (int z = lo[2]; z <= hi[2]; ++z) {
      for (int y = lo[1]; y <= hi[1]; ++y) {
        for (int x = lo[0]; x <= hi[0]; ++x)
          f((static_cast<std::size_t>(z) * m_cells[1] + y) * m_cells[0] + x);
      }
    }
  };
  m_begin.assign(static_cast<std::size_t>(m_cells[0]) * m_cells[1] * m_cells[2] + 1, 0);
  for (std::size_t s = 0; s < count; ++s)
    for_cells(s, [&](std::size_t c) { ++m_begin[c + 1]; });
  for (std::size_t c = 1; c < m_begin.size(); ++c) m_begin[c] += m_begin[c - 1];
  m_inside.resize(m_begin.back());
  std::vector<Index> next(m_begin.begin(), m_begin.end() - 1);
  for (std::size_t s = 0; s < count; ++s)
    for_cells(s, [&](std::size_t c) { m_inside[next[c]++] = static_cast<Index>(s); });
}

void ParticleField::weights(std::size_t simplex, const Vec3& X,
                            std::array<double, 4>& w) const {
  const Index* v = &m_simplices[simplex * (m_dim + 1)];
  std::array<Vec3, 4> P, g;
  for (int k = 0; k <= m_dim; ++k) P[k] = m_X[v[k]];
  shape_gradients(m_dim, P, g);
  for (int k = 1; k <= m_dim; ++k) w[k] = g[k].dot(X - P[0]);
  w[0] = 1;
  for (int k = 1; k <= m_dim; ++k) w[0] -= w[k];
}

/// search(item) for what is in the grid cell at X, then in the cells about it too, ring by
/// ring, until enough(ring).
template <class Search, class Enough>
void ParticleField::look_around(const Vec3& X, const Search& search,
                                const Enough& enough) const {
  std::array<int, 3> c{0, 0, 0};
  for (int i = 0; i < m_dim; ++i)
    c[i] = std::clamp(static_cast<int>((X[i] - m_low[i]) / m_cell), 0, m_cells[i] - 1);
  const int widest = std::max({m_cells[0], m_cells[1], m_cells[2]});
  for (int ring = 0; ring <= widest; ++ring) {
    for (int z = std::max(0, c[2] - ring); z <= std::min(m_cells[2] - 1, c[2] + ring); ++z) {
      for (int y = std::max(0, c[1] - ring); y <= std::min(m_cells[1] - 1, c[1] + ring); ++y) {
        for (int x = std::max(0, c[0] - ring); x <= std::min(m_cells[0] - 1, c[0] + ring);
             ++x) {
          const std::size_t cell =
              (static_cast<std::size_t>(z) * m_cells[1] + y) * m_cells[0] + x;
          for (Index k = m_begin[cell]; k < m_begin[cell + 1]; ++k) search(m_inside[k]);
        }
      }
    }
    if (enough(ring)) return;
  }
}

std::size_t ParticleField::locate(const Vec3& X, std::array<double, 4>& w) const {
  std::size_t best = 0;
  double best_least = -1e300;
  const auto try_simplex = [&](Index s) {
    if (best_least >= -1e-12) return;
    std::array<double, 4> trial{};
    weights(s, X, trial);
    const double least = *std::min_element(trial.begin(), trial.begin() + m_dim + 1);
    if (std::isfinite(trial[0] + trial[1] + trial[2] + trial[3]) && least > best_least)
      best_least = least, best = s, w = trial;
  };
  // The cell at X holds the simplex, unless X lies outside: then look further out.
  look_around(X, try_simplex, [&](int) { return best_least > -1e300; });
  return best;
}

void ParticleField::expand(std::span<const Vec3> X, std::span<Vec3> u,
                           std::span<Mat3> gradient) const {
  for (std::size_t q = 0; q < X.size(); ++q) {
    Index a = -1;
    double nearest = 1e300;  // squared
    look_around(
        X[q],
        [&](Index b) {
          const double d = (X[q] - m_X[b]).squaredNorm();
          if (d < nearest || (d == nearest && b < a)) nearest = d, a = b;
        },
        // What is beyond a ring is at least its width away.
        [&](int ring) { return nearest < ring * m_cell * ring * m_cell; });
    u[q] = m_u[a] + m_H[a] * (X[q] - m_X[a]);
    if (!gradient.empty()) gradient[q] = m_H[a];
  }
}

void ParticleField::evaluate(std::span<const Vec3> X, std::span<Vec3> u,
                             std::span<Mat3> gradient) const {
  if (m_simplices.empty()) return expand(X, u, gradient);
  std::array<double, 4> w{};
  std::array<Vec3, 4> P, g;
  for (std::size_t q = 0; q < X.size(); ++q) {
    const std::size_t s = locate(X[q], w);
    const Index* v = &m_simplices[s * (m_dim + 1)];
    u[q].setZero();
    for (int k = 0; k <= m_dim; ++k)
      u[q] += w[k] * (m_u[v[k]] + 0.5 * m_H[v[k]] * (X[q] - m_X[v[k]]));
    if (gradient.empty()) continue;
    for (int k = 0; k <= m_dim; ++k) P[k] = m_X[v[k]];
    shape_gradients(m_dim, P, g);
    gradient[q].setZero();
    for (int k = 0; k <= m_dim; ++k) {
      gradient[q] += (m_u[v[k]] + 0.5 * m_H[v[k]] * (X[q] - P[k])) * g[k].transpose() +
                     0.5 * w[k] * m_H[v[k]];
    }
  }
}

}  // namespace concord::particle
