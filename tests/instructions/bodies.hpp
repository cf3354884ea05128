#pragma once
// Bodies for counting, made by hand: gmsh would spend a hundred times the instructions that are
// counted.

#include "particle/core/body.hpp"
#include "scene/geometry.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <vector>

namespace concord::instructions {

/// Cuts the unit square or cube of a lattice into dim! simplices along its main diagonal
/// (Kuhn): corners as sums of unit steps, positively oriented.
inline std::vector<std::vector<std::array<int, 3>>> kuhn_simplices(int dim) {
  std::vector<std::vector<std::array<int, 3>>> simplices;
  std::array<int, 3> order{0, 1, 2};
  do {
    std::vector<std::array<int, 3>> corners{{0, 0, 0}};
    for (int k = 0; k < dim; ++k) {
      corners.push_back(corners.back());
      ++corners.back()[order[k]];
    }
    int inversions = 0;
    for (int i = 0; i < dim; ++i) {
      for (int j = i + 1; j < dim; ++j) inversions += order[i] > order[j];
    }
    if (inversions % 2 != 0) std::swap(corners[dim - 1], corners[dim]);
    simplices.push_back(corners);
  } while (std::next_permutation(order.begin(), order.begin() + dim));
  return simplices;
}

/// Facets that one simplex alone has, outward by the right-hand rule.
inline std::vector<Index> outer_facets(int dim, const std::vector<Index>& cells) {
  static constexpr int corners[2][4][3] = {{{0, 1}, {1, 2}, {2, 0}, {}},
                                           {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
  std::map<std::vector<Index>, std::vector<Index>> once;
  for (std::size_t c = 0; c < cells.size(); c += dim + 1) {
    for (int k = 0; k <= dim; ++k) {
      std::vector<Index> facet;
      for (int i = 0; i < dim; ++i) facet.push_back(cells[c + corners[dim - 2][k][i]]);
      std::vector<Index> key = facet;
      std::sort(key.begin(), key.end());
      if (!once.emplace(key, facet).second) once.erase(key);
    }
  }
  std::vector<Index> facets;
  for (const auto& [key, facet] : once) facets.insert(facets.end(), facet.begin(), facet.end());
  return facets;
}

/// A brick (rectangle) of count[0] x count[1] (x count[2]) particles of spacing h, moved at
/// random by up to 10 % of it inside, in simplices.
inline particle::Body lattice(const scene::Problem& problem, const std::array<int, 3>& count,
                              double h) {
  const int dim = problem.dim();
  const std::array<Index, 3> step{1, count[0], count[0] * count[1]};
  scene::Mesh mesh;
  mesh.dim = dim;
  mesh.h = h;
  mesh.entities.push_back({dim, 1, true, -1, {}});
  mesh.nodes_per_cell = dim + 1;
  mesh.nodes_per_facet = dim;
  const auto simplices = kuhn_simplices(dim);
  std::array<int, 3> place{};
  for (place[2] = 0; place[2] < (dim == 3 ? count[2] : 1); ++place[2]) {
    for (place[1] = 0; place[1] < count[1]; ++place[1]) {
      for (place[0] = 0; place[0] < count[0]; ++place[0]) {
        const auto a = static_cast<Index>(mesh.nodes.size());
        bool opens_cell = true;
        Vec3 X = Vec3::Zero();
        for (int c = 0; c < dim; ++c) {
          const bool inside = place[c] > 0 && place[c] < count[c] - 1;
          const double shift = scene::uniform_random(1, a, c) - 0.5;
          X[c] = h * (place[c] + (inside ? 0.2 * shift : 0.0));
          opens_cell = opens_cell && place[c] < count[c] - 1;
        }
        mesh.nodes.push_back(X);
        if (!opens_cell) continue;
        for (const auto& simplex : simplices) {
          for (const auto& corner : simplex)
            mesh.cells.push_back(a + corner[0] * step[0] + corner[1] * step[1] +
                                 corner[2] * step[2]);
        }
      }
    }
  }
  mesh.node_entity.assign(mesh.nodes.size(), 0);
  mesh.facets = outer_facets(dim, mesh.cells);
  mesh.facet_entity.assign(mesh.facets.size() / dim, 0);
  return particle::make_body(problem, std::move(mesh), particle::CellSource::mesh);
}

}  // namespace concord::instructions
