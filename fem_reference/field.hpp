#pragma once
// The finished displacement field as a function of reference position; free of deal.II.

#include "fem_reference/shape.hpp"
#include "scene/method.hpp"

#include <array>
#include <vector>

namespace concord::fem {

/// Isoparametric evaluation: the cell by a grid of bins, the reference coordinates by Newton.
/// A point outside takes the polynomial of the cell whose reference cell it misses least.
class MeshField : public scene::Field {
 public:
  MeshField(const scene::Mesh& mesh, std::vector<Vec3> u);
  void evaluate(std::span<const Vec3> X, std::span<Vec3> u,
                std::span<Mat3> gradient) const override;

  struct Place {
    Index cell = -1;
    Vec3 xi = Vec3::Zero();  ///< reference coordinates
    double excess = 1e300;   ///< how far outside, in reference units
  };
  /// Throws SolveError where no cell can be inverted at X.
  Place locate(const Vec3& X) const;
  /// Weights N_a(xi) of the cell's nodes.
  std::vector<double> weights(const Place& place) const;

 private:
  void build_bins();
  bool invert(Index cell, const Vec3& X, Place& place) const;
  void search(const Vec3& X, int ring, const std::array<int, 3>& centre, Place& best) const;
  Mat3 jacobian(Index cell, std::span<const Vec3> dN) const;

  int m_dim;
  LagrangeShape m_shape;
  std::vector<Vec3> m_nodes, m_u;
  std::vector<Index> m_cells;
  int m_nodes_per_cell;
  Vec3 m_low, m_bin;
  std::array<int, 3> m_count{1, 1, 1};
  std::vector<Index> m_first, m_members;  ///< cells whose box meets a bin
  std::vector<std::array<Vec3, 2>> m_box;
};

}  // namespace concord::fem
