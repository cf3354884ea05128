#include "particle/core/body.hpp"

#include "particle/core/body_cache.hpp"
#include "particle/core/sweep_order.hpp"
#include "scene/mesh_parts.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace concord::particle {
namespace {

/// Numbers of the nodes in sweep order.
std::vector<Index> node_order(const scene::Mesh& mesh, const Executor& executor) {
  Vec3 low = Vec3::Constant(1e300), high = Vec3::Constant(-1e300);
  for (const Vec3& X : mesh.nodes) {
    low = low.cwiseMin(X);
    high = high.cwiseMax(X);
  }
  return sweep_order(mesh.dim, mesh.h, mesh.nodes, low, high, executor);
}

/// V_a and the shortest edge, from the triangulation.
void measure(Body& body, const Executor& executor) {
  const Triangulation& t = body.triangulation;
  const int nv = t.dim + 1;
  body.V.assign(body.n, 0.0);
  for (std::size_t s = 0; s < t.size(); ++s) {
    const double share = body.simplex_volume(s) * body.thickness / nv;
    for (int i = 0; i < nv; ++i) body.V[t.simplices[s * nv + i]] += share;
  }
  std::vector<double> shortest(Executor::pieces(t.size()), 1e300);  // squared
  executor.for_pieces(t.size(), [&](std::size_t begin, std::size_t end) {
    double least = 1e300;
    for (std::size_t s = begin; s < end; ++s) {
      const Index* v = &t.simplices[s * nv];
      for (int i = 0; i < nv; ++i) {
        for (int j = 0; j < i; ++j)
          least = std::min(least, (body.position(v[i]) - body.position(v[j])).squaredNorm());
      }
    }
    shortest[begin / Executor::piece] = least;
  });
  body.h_min = 1e300;
  for (const double least : shortest) body.h_min = std::min(body.h_min, std::sqrt(least));
}

}  // namespace

scene::Mesh arrangement(const scene::Problem& problem, double h, CellSource cells) {
  scene::MeshRequest request;
  request.h = h;
  request.layout = problem.layout;
  if (cells == CellSource::mesh || problem.layout != scene::Layout::lattice ||
      problem.dim() == 2)
    return scene::make_mesh(problem, request);
  request.shape = scene::CellShape::hypercube;
  try {
    return scene::make_mesh(problem, request);
  } catch (const InputError& first) {
    if (first.key() != "geometry") throw;  // the scene's conditions, not what gmsh can do
    request.shape = scene::CellShape::simplex;
    return scene::make_mesh(problem, request);
  }
}

namespace {

/// Gives memory that was set free back to the system: gmsh's many small pieces would stay, and
/// columns too once the threshold above which glibc maps pages for them has risen.
void return_free_memory() {
#ifdef __GLIBC__
  constexpr int mapped_above = 1 << 18;  // bytes; all columns of bodies that need much
  mallopt(M_MMAP_THRESHOLD, mapped_above);
  malloc_trim(0);
#endif
}

/// Everything that follows from mesh, node order and triangulation.
void complete(const scene::Problem& problem, Body& body, const Executor& executor) {
  const scene::Mesh& mesh = body.mesh;
  body.dim = mesh.dim;
  body.stride = stride_of(mesh.dim);
  body.n = body.bulk = static_cast<Index>(mesh.nodes.size());
  body.h = mesh.h;
  body.thickness = problem.thickness;
  body.particle.resize(body.n);
  for (Index a = 0; a < body.n; ++a) body.particle[body.node[a]] = a;
  body.X.assign(static_cast<std::size_t>(body.n) * body.stride, 0.0);
  for (Index a = 0; a < body.n; ++a) {
    for (int i = 0; i < body.dim; ++i)
      body.X[static_cast<std::size_t>(a) * body.stride + i] = mesh.nodes[body.node[a]][i];
  }
  measure(body, executor);
  body.m.resize(body.n);
  for (Index a = 0; a < body.n; ++a) body.m[a] = problem.material.rho0 * body.V[a];
}

/// Node order and triangulation.
void divide(const scene::Problem& problem, CellSource cells, Body& body,
            const Executor& executor) {
  body.node = node_order(body.mesh, executor);
  std::vector<Index> particle(body.node.size());
  for (std::size_t a = 0; a < particle.size(); ++a)
    particle[body.node[a]] = static_cast<Index>(a);
  body.triangulation = cells == CellSource::delaunay
                           ? triangulate(body.mesh, problem, particle, executor)
                           : mesh_triangulation(body.mesh, problem, particle);
  std::vector<double>().swap(body.triangulation.volume);  // = {} would keep its memory
}

}  // namespace

Body make_body(const scene::Problem& problem, scene::Mesh mesh, CellSource cells,
               const Executor& executor) {
  Body body;
  body.mesh = std::move(mesh);
  divide(problem, cells, body, executor);
  complete(problem, body, executor);
  return body;
}

Body make_body(const scene::Problem& problem, double h, double perturb, std::uint64_t seed,
               CellSource cells, const Executor& executor) {
  const auto begin = std::chrono::steady_clock::now();
  const auto seconds = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  return_free_memory();
  const auto cache = BodyCache::from_environment();
  const std::string key = cache ? cache->key(problem, {h, perturb, seed, cells}) : "";
  Body body;
  double made_s = 0;
  if (!key.empty() && cache->fetch(key, body, made_s)) {
    scene::check_groups(body.mesh, problem);  // the scene's conditions are not in the key
    complete(problem, body, executor);
    body.saved_s = std::max(0.0, made_s - seconds());
    return body;
  }
  body.mesh = arrangement(problem, h, cells);
  if (cells == CellSource::delaunay) std::vector<Index>().swap(body.mesh.cells);
  return_free_memory();
  if (perturb > 0) scene::perturb(body.mesh, problem, perturb, seed);
  divide(problem, cells, body, executor);
  return_free_memory();
  complete(problem, body, executor);
  if (!key.empty() && seconds() > BodyCache::worthwhile_s) cache->store(key, body, seconds());
  return body;
}

double Body::simplex_volume(std::size_t s) const {
  std::array<Vec3, 4> P, g;
  for (int k = 0; k <= dim; ++k) P[k] = position(triangulation.simplices[s * (dim + 1) + k]);
  return std::abs(volume_gradients(dim, P, g));
}

}  // namespace concord::particle
