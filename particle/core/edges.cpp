#include "particle/core/edges.hpp"

#include <algorithm>

namespace concord::particle {
namespace {

/// Simplices by their vertices: those of a are [begin[a], begin[a+1]).
struct Incidence {
  std::vector<std::size_t> begin;
  std::vector<Index> simplex;

  explicit Incidence(const Body& body) : begin(body.bulk + 1, 0) {
    const std::vector<Index>& vertices = body.triangulation.simplices;
    for (const Index a : vertices) ++begin[a + 1];
    for (Index a = 0; a < body.bulk; ++a) begin[a + 1] += begin[a];
    simplex.resize(vertices.size());
    std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
    const std::size_t per_simplex = body.triangulation.dim + 1;
    for (std::size_t k = 0; k < vertices.size(); ++k)
      simplex[next[vertices[k]]++] = static_cast<Index>(k / per_simplex);
  }
};

}  // namespace

Edges make_edges(const Body& body) {
  const Triangulation& t = body.triangulation;
  const int vertices = t.dim + 1;
  const double share = body.thickness / (0.5 * vertices * t.dim);  // of a simplex, an edge
  const Incidence around(body);
  Edges edges;
  edges.begin.reserve(body.bulk + 1);
  edges.begin.push_back(0);
  std::vector<std::pair<Index, double>> row;
  for (Index a = 0; a < body.bulk; ++a) {
    row.clear();
    for (std::size_t k = around.begin[a]; k < around.begin[a + 1]; ++k) {
      const Index s = around.simplex[k];
      const double V_s = body.simplex_volume(static_cast<std::size_t>(s));
      for (int v = 0; v < vertices; ++v) {
        const Index b = t.simplices[static_cast<std::size_t>(s) * vertices + v];
        if (b <= a) continue;
        const auto known =
            std::find_if(row.begin(), row.end(), [b](const auto& e) { return e.first == b; });
        if (known == row.end())
          row.emplace_back(b, share * V_s);
        else
          known->second += share * V_s;
      }
    }
    std::sort(row.begin(), row.end());
    for (const auto& [b, V_ab] : row) {
      edges.other.push_back(b);
      edges.weight.push_back(
          static_cast<float>(V_ab / (body.position(b) - body.position(a)).squaredNorm()));
    }
    edges.begin.push_back(edges.other.size());
  }
  return edges;
}

}  // namespace concord::particle
