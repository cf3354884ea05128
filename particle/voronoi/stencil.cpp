#include "particle/voronoi/stencil.hpp"

#include <algorithm>
#include <tuple>

namespace concord::particle::voronoi {
namespace {

template <int Dim> Vec<Dim> in_lanes(const Vec3& v) {
  Vec<Dim> r{};
  for (int i = 0; i < Dim; ++i) r[i] = v[i];
  return r;
}

template <int Dim> Tensor<Dim> in_lanes(const Mat3& m) {
  Tensor<Dim> t;
  for (int k = 0; k < Dim; ++k) t.column[k] = in_lanes<Dim>(Vec3(m.col(k)));
  return t;
}

bool is_diagonal(const Mat3& m) { return (m - Mat3(m.diagonal().asDiagonal())).isZero(0); }

/// Diagonal, or columns, of a map.
template <int Dim> void append(Column& column, const Mat3& map, bool diagonal) {
  const auto add = [&](const Vec3& v) {
    for (int i = 0; i < Lanes<Dim>::stride; ++i) column.push_back(i < Dim ? v[i] : 0.0);
  };
  if (diagonal) {
    add(map.diagonal());
  } else {
    for (int k = 0; k < Dim; ++k) add(map.col(k));
  }
}

template <int Dim>
GhostRecord<Dim> record_of(const Ghost& ghost, double normal, double tangential) {
  const double ratio = ghost.A / ghost.length();
  const Mat3 N = ghost.N * ghost.N.transpose();
  const Mat3 K =
      ratio * (normal * N + tangential * (Mat3::Identity() - N));  // (50) with A_ag, L_ag
  GhostRecord<Dim> record;
  record.D = in_lanes<Dim>(ghost.D);
  record.K = in_lanes<Dim>(Mat3(ghost.D * K * ghost.D));
  record.X = in_lanes<Dim>(ghost.X);
  record.t = in_lanes<Dim>(ghost.t);
  record.A = in_lanes<Dim>(Vec3(ghost.A * ghost.N));
  record.B = in_lanes<Dim>(ghost.gradient_vector());
  record.centroid = ghost.centroid_point;
  record.wall = ghost.wall_point;
  return record;
}

/// An entry of T on its way into the rows of bonds.
struct Entry {
  Index row, other, ghost;
  Mat3 T;
};

}  // namespace

Bonds make_bonds(const Body& body, const Cells& cells) {
  Bonds bonds;
  const auto n = static_cast<Index>(cells.V.size());
  bonds.begin.assign(n + 1, 0);
  bonds.other.reserve(cells.interior);
  bonds.shape.assign(cells.interior * shape_size, 0.0);
  for (std::size_t k = 0; k < cells.interior; ++k) {
    const Face& face = cells.faces[k];
    ++bonds.begin[face.a + 1];
    bonds.other.push_back(face.b);
    const Vec3 X_a = body.position(face.a), X_b = body.position(face.b);
    const Vec3 X_ab = X_b - X_a, t = offset_of(face, X_a, X_b);
    double* shape = &bonds.shape[k * shape_size];
    shape[ratio_at] = 0.5 * face.A / X_ab.norm();
    for (int i = 0; i < body.dim; ++i) shape[i] = 2 * t[i];
  }
  for (Index a = 0; a < n; ++a) bonds.begin[a + 1] += bonds.begin[a];
  return bonds;
}

template <int Dim>
Ghosts<Dim> make_ghosts(const Stars& stars, const GhostSystems& systems, double normal,
                        double tangential) {
  Ghosts<Dim> ghosts;
  for (const GhostSystem& system : systems.system) {
    const auto all = [&](const std::vector<Mat3>& maps) {
      return std::all_of(maps.begin(), maps.end(), is_diagonal);
    };
    ghosts.diagonal = ghosts.diagonal && all(system.T) && all(system.R);
  }
  std::vector<Entry> entries;
  ghosts.R_begin.push_back(0);
  for (Index a = 0; a < stars.particles(); ++a) {
    ghosts.begin.push_back(static_cast<Index>(ghosts.count()));
    if (!stars.at_wall(a)) continue;
    const Star star = stars(a);
    const GhostSystem& system = systems.system[systems.row[a]];
    const std::size_t real = star.neighbours.size(), count = star.ghosts.size();
    for (std::size_t g = 0; g < count; ++g) {
      const auto number = static_cast<Index>(ghosts.count());
      for (std::size_t c = 0; c < real; ++c) {
        const Index b = star.neighbours[c].b;
        const Mat3& T = system.T[g * real + c];
        if (T.isZero(0)) continue;
        entries.push_back({std::min(a, b), std::max(a, b), number, a < b ? T : Mat3(-T)});
      }
      for (std::size_t h = 0; h < count; ++h) {
        const Mat3& R = system.R[g * count + h];
        if (R.isZero(0)) continue;
        ghosts.R_wall.push_back(star.ghosts[h].wall_point);
        append<Dim>(ghosts.R, R, ghosts.diagonal);
      }
      ghosts.R_begin.push_back(static_cast<Index>(ghosts.R_wall.size()));
      ghosts.record.push_back(record_of<Dim>(star.ghosts[g], normal, tangential));
    }
  }
  ghosts.begin.push_back(static_cast<Index>(ghosts.count()));
  std::sort(entries.begin(), entries.end(), [](const Entry& p, const Entry& q) {
    return std::tie(p.row, p.other, p.ghost) < std::tie(q.row, q.other, q.ghost);
  });
  for (const Entry& entry : entries) {
    if (ghosts.particle.empty() || ghosts.particle.back() != entry.row) {
      ghosts.particle.push_back(entry.row);
      ghosts.T_begin.push_back(static_cast<Index>(ghosts.T_other.size()));
    }
    ghosts.T_other.push_back(entry.other);
    ghosts.T_ghost.push_back(entry.ghost);
    append<Dim>(ghosts.T, entry.T, ghosts.diagonal);
  }
  ghosts.particle.push_back(stars.particles());
  ghosts.T_begin.push_back(static_cast<Index>(ghosts.T_other.size()));
  return ghosts;
}

template Ghosts<2> make_ghosts<2>(const Stars&, const GhostSystems&, double, double);
template Ghosts<3> make_ghosts<3>(const Stars&, const GhostSystems&, double, double);

}  // namespace concord::particle::voronoi
