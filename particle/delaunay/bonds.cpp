#include "particle/delaunay/bonds.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <numeric>

namespace concord::particle::delaunay {
namespace {

/// Simplices at each particle, ascending.
struct Stars {
  std::vector<Index> begin, simplex;

  explicit Stars(const Body& body) : begin(body.n + 1, 0) {
    const Triangulation& t = body.triangulation;
    const int nv = t.dim + 1;
    for (const Index a : t.simplices) ++begin[a + 1];
    for (Index a = 0; a < body.n; ++a) begin[a + 1] += begin[a];
    simplex.resize(t.simplices.size());
    std::vector<Index> next(begin.begin(), begin.end() - 1);
    for (std::size_t s = 0; s < t.size(); ++s) {
      for (int i = 0; i < nv; ++i)
        simplex[next[t.simplices[s * nv + i]]++] = static_cast<Index>(s);
    }
  }
};

/// Appends the bonds of particle a with b > a, ascending. Both ends of a bond see the same
/// simplices in the same order.
void append_row(const Body& body, const Stars& stars, Index a, std::vector<Bond>& bonds) {
  const Triangulation& t = body.triangulation;
  const int nv = t.dim + 1;
  const auto row = static_cast<std::ptrdiff_t>(bonds.size());
  std::array<Vec3, 4> X, g;
  for (Index k = stars.begin[a]; k < stars.begin[a + 1]; ++k) {
    const Index* v = &t.simplices[static_cast<std::size_t>(stars.simplex[k]) * nv];
    for (int i = 0; i < nv; ++i) X[i] = body.position(v[i]);
    // B_ab is the integral over a positively oriented simplex; a flat one may carry either sign
    // and the same areas.
    (void)volume_gradients(t.dim, X, g);
    const double scale = body.thickness / nv;
    const auto own = std::find(v, v + nv, a) - v;
    for (int i = 0; i < nv; ++i) {
      if (v[i] <= a) continue;
      auto bond = std::find_if(bonds.begin() + row, bonds.end(),
                               [&](const Bond& known) { return known.b == v[i]; });
      if (bond == bonds.end())
        bond = bonds.insert(bonds.end(), {a, v[i], Vec3::Zero(), Vec3::Zero()});
      bond->B_ab += scale * g[i];
      bond->B_ba += scale * g[own];
    }
  }
  std::sort(bonds.begin() + row, bonds.end(),
            [](const Bond& p, const Bond& q) { return p.b < q.b; });
  // Off the boundary B_ba = -B_ab holds exactly (30); make it hold to the last bit.
  for (auto bond = bonds.begin() + row; bond != bonds.end(); ++bond) {
    if (t.on_boundary[bond->a] && t.on_boundary[bond->b]) continue;
    bond->B_ab = 0.5 * (bond->B_ab - bond->B_ba);
    bond->B_ba = -bond->B_ab;
  }
}

/// Edges of the triangulation: bonds with b > a, over all a.
std::size_t edge_count(const Body& body, const Stars& stars, const Executor& executor) {
  const Triangulation& t = body.triangulation;
  const int nv = t.dim + 1;
  std::vector<std::size_t> counts(Executor::pieces(body.n));
  executor.for_pieces(body.n, [&](std::size_t first, std::size_t last) {
    std::size_t count = 0;
    std::vector<Index> others;
    for (std::size_t a = first; a < last; ++a) {
      others.clear();
      for (Index k = stars.begin[a]; k < stars.begin[a + 1]; ++k) {
        const Index* v = &t.simplices[static_cast<std::size_t>(stars.simplex[k]) * nv];
        std::copy_if(v, v + nv, std::back_inserter(others),
                     [a](Index b) { return b > static_cast<Index>(a); });
      }
      std::sort(others.begin(), others.end());
      count += std::unique(others.begin(), others.end()) - others.begin();
    }
    counts[first / Executor::piece] = count;
  });
  return std::accumulate(counts.begin(), counts.end(), std::size_t{0});
}

/// Rows of a range of particles, before they are put together.
struct Piece {
  std::vector<Index> length, other, surface_length, surface_other;
  Column B, area_over_length, B_symmetric;
};

void append(Column& column, int dim, const Vec3& v) {
  for (int i = 0; i < dim; ++i) column.push_back(v[i]);
}

void append_bond(const Body& body, const Bond& bond, bool contact, Piece& piece) {
  piece.other.push_back(bond.b);
  append(piece.B, body.dim, 0.5 * (bond.B_ab - bond.B_ba));
  if (contact) {
    const double L = (body.position(bond.b) - body.position(bond.a)).norm();
    piece.area_over_length.push_back(interface_area(body.dim, bond) / L);
  }
  const std::vector<char>& on_boundary = body.triangulation.on_boundary;
  if (!on_boundary[bond.a] || !on_boundary[bond.b]) return;
  piece.surface_other.push_back(bond.b);
  append(piece.B_symmetric, body.dim, 0.5 * (bond.B_ab + bond.B_ba));
}

Piece make_piece(const Body& body, const Stars& stars, Index first, Index last, bool contact) {
  Piece piece;
  std::vector<Bond> row;
  for (Index a = first; a < last; ++a) {
    row.clear();
    append_row(body, stars, a, row);
    const std::size_t before = piece.surface_other.size();
    for (const Bond& bond : row) append_bond(body, bond, contact, piece);
    piece.length.push_back(static_cast<Index>(row.size()));
    if (body.triangulation.on_boundary[a])
      piece.surface_length.push_back(static_cast<Index>(piece.surface_other.size() - before));
  }
  return piece;
}

template <class T> void take(T& all, T& part) {
  all.insert(all.end(), part.begin(), part.end());
  T().swap(part);
}

/// B_aa = -sum_b B_ab of the boundary particles.
void close_surface(const Body& body, Bonds& bonds) {
  SurfaceBonds& s = bonds.surface;
  const int dim = body.dim;
  std::vector<Index> place(body.n, -1);
  for (std::size_t k = 0; k < s.particle.size(); ++k)
    place[s.particle[k]] = static_cast<Index>(k);
  s.B_self.assign(s.particle.size() * dim, 0.0);
  const auto subtract = [&](Index a, double sign, const double* B) {
    if (place[a] < 0) return;
    for (int i = 0; i < dim; ++i)
      s.B_self[static_cast<std::size_t>(place[a]) * dim + i] -= sign * B[i];
  };
  for (Index a = 0; a < body.n; ++a) {
    for (Index k = bonds.begin[a]; k < bonds.begin[a + 1]; ++k) {
      const double* B = &bonds.B[static_cast<std::size_t>(k) * dim];
      subtract(a, 1, B);
      subtract(bonds.other[k], -1, B);
    }
  }
  for (std::size_t p = 0; p < s.particle.size(); ++p) {
    for (Index k = s.begin[p]; k < s.begin[p + 1]; ++k) {
      const double* B = &s.B_symmetric[static_cast<std::size_t>(k) * dim];
      subtract(s.particle[p], 1, B);
      subtract(s.other[k], 1, B);
    }
  }
  s.particle.push_back(body.n);
}

}  // namespace

std::vector<Bond> gradient_vectors(const Body& body) {
  const Stars stars(body);
  std::vector<Bond> bonds;
  for (Index a = 0; a < body.n; ++a) append_row(body, stars, a, bonds);
  return bonds;
}

double interface_area(int dim, const Bond& bond) {
  return (dim + 1) * 0.5 * (bond.B_ab.norm() + bond.B_ba.norm());
}

Bonds make_bonds(const Body& body, bool contact, const Executor& executor) {
  const Stars stars(body);
  const std::size_t count = edge_count(body, stars, executor);
  Bonds bonds;
  bonds.begin.assign(1, 0);
  bonds.begin.reserve(body.n + 1);
  bonds.other.reserve(count + bond_padding);
  bonds.B.reserve(count * body.dim + bond_padding);
  if (contact) bonds.area_over_length.reserve(count + bond_padding);
  SurfaceBonds& s = bonds.surface;
  s.begin.assign(1, 0);
  const auto add = [&](Piece& piece) {
    for (const Index length : piece.length) bonds.begin.push_back(bonds.begin.back() + length);
    for (const Index length : piece.surface_length) s.begin.push_back(s.begin.back() + length);
    take(bonds.other, piece.other);
    take(bonds.B, piece.B);
    take(bonds.area_over_length, piece.area_over_length);
    take(s.other, piece.surface_other);
    take(s.B_symmetric, piece.B_symmetric);
  };
  const std::size_t all = Executor::pieces(body.n),
                    batch = 4 * static_cast<std::size_t>(executor.threads());
  for (std::size_t done = 0; done < all; done += batch) {  // few pieces in memory at a time
    std::vector<Piece> pieces(std::min(batch, all - done));
    executor.for_each(pieces.size(), [&](std::size_t k) {
      const auto first = static_cast<Index>((done + k) * Executor::piece),
                 last = std::min(body.n, first + static_cast<Index>(Executor::piece));
      pieces[k] = make_piece(body, stars, first, last, contact);
    });
    for (Piece& piece : pieces) add(piece);
  }
  if (contact) bonds.area_over_length.insert(bonds.area_over_length.end(), bond_padding, 0.0);
  for (Index a = 0; a < body.n; ++a) {
    if (body.triangulation.on_boundary[a]) s.particle.push_back(a);
  }
  close_surface(body, bonds);
  return bonds;
}

Bond bond_of(const Bonds& bonds, int dim, Index a, Index k) {
  Bond bond{a, bonds.other[k], Vec3::Zero(), Vec3::Zero()};
  const auto vector = [&](const Column& column, std::size_t at) {
    Vec3 v = Vec3::Zero();
    for (int i = 0; i < dim; ++i) v[i] = column[at * dim + i];
    return v;
  };
  bond.B_ab = vector(bonds.B, k);
  bond.B_ba = -bond.B_ab;
  const SurfaceBonds& s = bonds.surface;
  const auto row = std::lower_bound(s.particle.begin(), s.particle.end(), a);
  if (row == s.particle.end() || *row != a) return bond;
  const auto r = row - s.particle.begin();
  if (static_cast<std::size_t>(r) + 1 >= s.begin.size()) return bond;
  for (Index m = s.begin[r]; m < s.begin[r + 1]; ++m) {
    if (s.other[m] != bond.b) continue;
    const Vec3 symmetric = vector(s.B_symmetric, m);
    bond.B_ab += symmetric;
    bond.B_ba += symmetric;
  }
  return bond;
}

GradientRows directed_rows(const Body& body, const Bonds& bonds) {
  GradientRows rows;
  rows.begin.assign(body.n + 1, 0);
  for (Index a = 0; a < body.n; ++a) {
    for (Index k = bonds.begin[a]; k < bonds.begin[a + 1]; ++k)
      ++rows.begin[a + 1], ++rows.begin[bonds.other[k] + 1];
  }
  for (Index a = 0; a < body.n; ++a) rows.begin[a + 1] += rows.begin[a];
  rows.neighbour.resize(rows.begin.back());
  rows.g.resize(rows.begin.back());
  std::vector<std::size_t> next(rows.begin.begin(), rows.begin.end() - 1);
  const auto add = [&](Index a, Index b, const Vec3& B) {
    rows.neighbour[next[a]] = b;
    rows.g[next[a]++] = B / body.V[a];
  };
  for (Index a = 0; a < body.n; ++a) {
    for (Index k = bonds.begin[a]; k < bonds.begin[a + 1]; ++k) {
      const Bond bond = bond_of(bonds, body.dim, a, k);
      add(bond.a, bond.b, bond.B_ab);
      add(bond.b, bond.a, bond.B_ba);
    }
  }
  return rows;
}

}  // namespace concord::particle::delaunay
