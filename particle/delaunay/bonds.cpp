#include "particle/delaunay/bonds.hpp"

#include <algorithm>
#include <array>

namespace concord::particle::delaunay {
namespace {

/// One directed contribution |t| g_b / (n+1) of a simplex to B_ab, filed under the
/// lower-numbered particle.
struct Contribution {
  Index low, high;
  Vec3 B_low_high, B_high_low;
};

}  // namespace

std::vector<Bond> gradient_vectors(const Body& body) {
  const Triangulation& t = body.triangulation;
  const int nv = t.dim + 1;
  std::vector<Index> start(body.n + 1, 0);  // counting sort by the lower particle
  for (std::size_t s = 0; s < t.size(); ++s) {
    for (int i = 0; i < nv; ++i) {
      for (int j = 0; j < i; ++j)
        ++start[std::min(t.simplices[s * nv + i], t.simplices[s * nv + j]) + 1];
    }
  }
  for (Index a = 0; a < body.n; ++a) start[a + 1] += start[a];
  std::vector<Contribution> parts(start[body.n]);
  std::vector<Index> next(start.begin(), start.end() - 1);
  std::array<Vec3, 4> X, g;
  for (std::size_t s = 0; s < t.size(); ++s) {
    const Index* v = &t.simplices[s * nv];
    for (int i = 0; i < nv; ++i) X[i] = body.position(v[i]);
    // B_ab is the integral over a positively oriented simplex; a flat one may carry either sign
    // and the same areas.
    (void)volume_gradients(t.dim, X, g);
    const double scale = body.thickness / nv;
    for (int i = 0; i < nv; ++i) {
      for (int j = 0; j < i; ++j) {
        const int low = v[i] < v[j] ? i : j, high = low == i ? j : i;
        parts[next[v[low]]++] = {v[low], v[high], scale * g[high], scale * g[low]};
      }
    }
  }
  std::vector<Bond> bonds;
  bonds.reserve(parts.size() / 4);
  for (Index a = 0; a < body.n; ++a) {
    const auto first = parts.begin() + start[a], last = parts.begin() + start[a + 1];
    std::stable_sort(first, last, [](const Contribution& p, const Contribution& q) {
      return p.high < q.high;
    });
    for (auto p = first; p != last; ++p) {
      if (p == first || p->high != (p - 1)->high)
        bonds.push_back({a, p->high, Vec3::Zero(), Vec3::Zero()});
      bonds.back().B_ab += p->B_low_high;
      bonds.back().B_ba += p->B_high_low;
    }
  }
  // Off the boundary B_ba = -B_ab holds exactly (30); make it hold to the last bit.
  for (Bond& bond : bonds) {
    if (t.on_boundary[bond.a] && t.on_boundary[bond.b]) continue;
    bond.B_ab = 0.5 * (bond.B_ab - bond.B_ba);
    bond.B_ba = -bond.B_ab;
  }
  return bonds;
}

double interface_area(int dim, const Bond& bond) {
  return (dim + 1) * 0.5 * (bond.B_ab.norm() + bond.B_ba.norm());
}

namespace {

/// Where a bond goes: block and row, and whether it is kept there as a cut bond seen from
/// `own`.
struct Place {
  Index block, row;
  bool cut;
  Index other;
  const Bond* bond;
  bool reversed;  ///< seen from bond->b
  double area_over_length;
};

void append(const Body& body, BondRows& rows, const Place& p, bool surface) {
  const Vec3& forward = p.reversed ? p.bond->B_ba : p.bond->B_ab;
  const Vec3& backward = p.reversed ? p.bond->B_ab : p.bond->B_ba;
  rows.other.push_back(p.other);
  const auto record = [&](Column& column, const Vec3& B) {
    double r[bond_record] = {0, 0, 0, 0};
    for (int i = 0; i < body.dim; ++i) r[i] = B[i];
    r[body.dim] = p.area_over_length;
    column.insert(column.end(), r, r + bond_record);
  };
  record(rows.B, forward);
  if (surface) record(rows.B_reverse, backward);
}

void fill_rows(const Body& body, BondRows& rows, Index row_count,
               const std::vector<Place>& places, bool surface) {
  rows.begin.assign(1, 0);
  std::size_t next = 0;
  for (Index r = 0; r < row_count; ++r) {
    Index cut_begin = -1;
    for (; next < places.size() && places[next].row == r; ++next) {
      if (places[next].cut && cut_begin < 0) cut_begin = static_cast<Index>(rows.other.size());
      append(body, rows, places[next], surface);
    }
    const Index end = static_cast<Index>(rows.other.size());
    rows.cut.push_back(cut_begin < 0 ? end : cut_begin);
    rows.begin.push_back(end);
  }
}

}  // namespace

Bonds block_bonds(const Body& body, const std::vector<Bond>& bonds,
                  const std::vector<double>& area_over_length) {
  const std::vector<Index> begin = fixed_blocks(body.n);
  const Index block_count = static_cast<Index>(begin.size()) - 1;
  const auto block_of = [&](Index a) {
    return static_cast<Index>(std::upper_bound(begin.begin(), begin.end(), a) - begin.begin()) -
           1;
  };
  std::vector<std::array<std::vector<Place>, 2>> places(block_count);  // [regular, surface]
  for (std::size_t k = 0; k < bonds.size(); ++k) {
    const Bond& bond = bonds[k];
    const bool surface =
        body.triangulation.on_boundary[bond.a] && body.triangulation.on_boundary[bond.b];
    const double ratio = area_over_length.empty() ? 0.0 : area_over_length[k];
    const Index block_a = block_of(bond.a), block_b = block_of(bond.b);
    const bool cut = block_a != block_b;
    places[block_a][surface].push_back(
        {block_a, bond.a - begin[block_a], cut, bond.b, &bond, false, ratio});
    if (cut)
      places[block_b][surface].push_back(
          {block_b, bond.b - begin[block_b], true, bond.a, &bond, true, ratio});
  }
  Bonds result;
  result.count = bonds.size();
  result.blocks.resize(block_count);
  for (Index k = 0; k < block_count; ++k) {
    BondBlock& block = result.blocks[k];
    block.first = begin[k];
    block.last = begin[k + 1];
    for (auto& list : places[k]) {
      std::stable_sort(list.begin(), list.end(), [](const Place& p, const Place& q) {
        return std::tie(p.row, p.cut, p.other) < std::tie(q.row, q.cut, q.other);
      });
    }
    fill_rows(body, block.regular, block.last - block.first, places[k][0], false);
    fill_rows(body, block.surface, block.last - block.first, places[k][1], true);
  }
  return result;
}

GradientRows directed_rows(const Body& body, const std::vector<Bond>& bonds) {
  GradientRows rows;
  rows.begin.assign(body.n + 1, 0);
  for (const Bond& bond : bonds) ++rows.begin[bond.a + 1], ++rows.begin[bond.b + 1];
  for (Index a = 0; a < body.n; ++a) rows.begin[a + 1] += rows.begin[a];
  rows.neighbour.resize(rows.begin.back());
  rows.g.resize(rows.begin.back());
  std::vector<std::size_t> next(rows.begin.begin(), rows.begin.end() - 1);
  const auto add = [&](Index a, Index b, const Vec3& B) {
    rows.neighbour[next[a]] = b;
    rows.g[next[a]++] = B / body.V[a];
  };
  for (const Bond& bond : bonds) {
    add(bond.a, bond.b, bond.B_ab);
    add(bond.b, bond.a, bond.B_ba);
  }
  return rows;
}

}  // namespace concord::particle::delaunay
