#pragma once
// The displacement of particles as a function of reference position.

#include "particle/core/body.hpp"
#include "scene/method.hpp"

#include <memory>

namespace concord::particle {

/// u(X) = sum_i w_i(X) [u_i + H_i (X - X_i) / 2] over the vertices of the simplex at X, w_i its
/// linear shape functions. With exact H_i it reproduces quadratic fields: for quadratic u the
/// bracket is u(X) - (grad u(X)) (X - X_i)/2, and the sum over w_i of (X - X_i) vanishes. The
/// particles' own gradients are thus part of the answer that is judged, and the interpolation
/// adds no second-order error where they are accurate. The gradient is that of this function.
///
/// Where particles lie inside the body, the simplices end half a spacing before its faces.
/// There the function of a simplex near by goes on: of those whose box touches the cell of a
/// grid of spacing h at X (or the nearest cells that any touches), the one that X lies least
/// outside of. It is the same algebra, so that quadratic fields are still reproduced. Particles
/// in one layer have no simplices: then u(X) is the first-order expansion of the nearest
/// particle.
class ParticleField final : public scene::Field {
 public:
  /// Takes the body's simplices: they are gone from it afterwards. X, u, H: one a particle.
  ParticleField(Body& body, std::vector<Vec3> X, std::vector<Vec3> u, std::vector<Mat3> H);
  void evaluate(std::span<const Vec3> X, std::span<Vec3> u,
                std::span<Mat3> gradient) const override;

 private:
  void expand(std::span<const Vec3> X, std::span<Vec3> u, std::span<Mat3> gradient) const;
  template <class Search, class Enough>
  void look_around(const Vec3& X, const Search& search, const Enough& enough) const;
  std::size_t locate(const Vec3& X, std::array<double, 4>& w) const;
  void weights(std::size_t simplex, const Vec3& X, std::array<double, 4>& w) const;

  int m_dim;
  std::vector<Index> m_simplices;
  std::vector<Vec3> m_X, m_u;
  std::vector<Mat3> m_H;
  Vec3 m_low;
  double m_cell;
  std::array<int, 3> m_cells{1, 1, 1};
  std::vector<Index> m_begin,
      m_inside;  ///< simplices whose box touches a grid cell, or particles
};

}  // namespace concord::particle
