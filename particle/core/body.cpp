#include "particle/core/body.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace concord::particle {
namespace {

/// Numbers of the nodes in sweep order.
std::vector<Index> sweep_order(const scene::Mesh& mesh) {
  Vec3 low = Vec3::Constant(1e300), high = Vec3::Constant(-1e300);
  for (const Vec3& X : mesh.nodes) {
    low = low.cwiseMin(X);
    high = high.cwiseMax(X);
  }
  std::array<int, 3> axis{0, 1, 2};  // longest first
  std::stable_sort(axis.begin(), axis.begin() + mesh.dim, [&](int i, int j) {
    return high[i] - low[i] > 1.0001 * (high[j] - low[j]);
  });
  struct Key {
    long slab, row;
    double place;
    Index node;
  };
  std::vector<Key> keys;
  keys.reserve(mesh.nodes.size());
  for (std::size_t a = 0; a < mesh.nodes.size(); ++a) {
    const Vec3 X = mesh.nodes[a] - low;
    const auto cell = [&](int i) { return std::lround(X[axis[i]] / mesh.h); };
    keys.push_back(
        {cell(0), mesh.dim == 3 ? cell(1) : 0, X[axis[mesh.dim - 1]], static_cast<Index>(a)});
  }
  std::sort(keys.begin(), keys.end(), [](const Key& p, const Key& q) {
    return std::tie(p.slab, p.row, p.place, p.node) < std::tie(q.slab, q.row, q.place, q.node);
  });
  std::vector<Index> order;
  order.reserve(keys.size());
  for (const Key& k : keys) order.push_back(k.node);
  return order;
}

void renumber(Triangulation& t, const std::vector<Index>& particle) {
  for (Index& v : t.simplices) v = particle[v];
  for (Index& v : t.boundary) v = particle[v];
  std::vector<char> on(t.on_boundary.size());
  for (std::size_t a = 0; a < on.size(); ++a) on[particle[a]] = t.on_boundary[a];
  t.on_boundary = std::move(on);
}

}  // namespace

Body make_body(const scene::Problem& problem, scene::Mesh mesh, CellSource cells) {
  Body body;
  body.dim = mesh.dim;
  body.stride = stride_of(mesh.dim);
  body.n = static_cast<Index>(mesh.nodes.size());
  body.h = mesh.h;
  body.thickness = problem.thickness;
  body.triangulation = cells == CellSource::delaunay ? triangulate(mesh, problem)
                                                     : mesh_triangulation(mesh, problem);
  body.node = sweep_order(mesh);
  body.particle.resize(body.n);
  for (Index a = 0; a < body.n; ++a) body.particle[body.node[a]] = a;
  renumber(body.triangulation, body.particle);

  body.X.assign(static_cast<std::size_t>(body.n) * body.stride, 0.0);
  for (Index a = 0; a < body.n; ++a) {
    for (int i = 0; i < body.dim; ++i)
      body.X[a * body.stride + i] = mesh.nodes[body.node[a]][i];
  }
  body.V.assign(body.n, 0.0);
  body.h_min = 1e300;
  const Triangulation& t = body.triangulation;
  const int nv = t.dim + 1;
  for (std::size_t s = 0; s < t.size(); ++s) {
    const Index* v = &t.simplices[s * nv];
    for (int i = 0; i < nv; ++i) {
      body.V[v[i]] += t.volume[s] * problem.thickness / nv;
      for (int j = 0; j < i; ++j) {
        body.h_min = std::min(body.h_min, (body.position(v[i]) - body.position(v[j])).norm());
      }
    }
  }
  body.m.resize(body.n);
  for (Index a = 0; a < body.n; ++a) body.m[a] = problem.material.rho0 * body.V[a];
  body.mesh = std::move(mesh);
  return body;
}

Body make_body(const scene::Problem& problem, double h, double perturb, std::uint64_t seed,
               CellSource cells) {
  scene::MeshRequest request;
  request.h = h;
  request.layout = problem.layout;
  scene::Mesh mesh = scene::make_mesh(problem, request);
  if (perturb > 0) scene::perturb(mesh, problem, perturb, seed);
  return make_body(problem, std::move(mesh), cells);
}

std::vector<Index> fixed_blocks(Index n) {
  const Index count = std::clamp<Index>(n / 16384, 1, 16);
  std::vector<Index> begin(count + 1);
  for (Index k = 0; k <= count; ++k) {
    begin[k] = static_cast<Index>(static_cast<std::int64_t>(n) * k / count);
  }
  return begin;
}

}  // namespace concord::particle
