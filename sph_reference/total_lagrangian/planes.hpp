#pragma once
// Mirror particles at planes of symmetry and antisymmetry: equations (TLS.14) to (TLS.16) in
// README.md of this folder.

#include "particle/core/body.hpp"
#include "particle/core/parallel.hpp"

#include <array>
#include <span>
#include <vector>

namespace concord::sph {

using particle::Body;
using particle::Column;
using particle::Executor;

/// The plane X_axis = coordinate [m], on which the body ends.
struct Plane {
  int axis = 0;
  double coordinate = 0;
  bool antisymmetric = false;
};

/// Planes of the problem's symmetric and antisymmetric conditions. Throws InputError (key
/// tlsph.planes) where mirror particles would not continue the body: a plane with particles on
/// both sides, one whose condition holds on a part of the body's face there alone, or an
/// antisymmetric one that carries a traction.
std::vector<Plane> symmetry_planes(const scene::Problem& problem, const Body& body);

/// The particles of a body, numbered as there, and behind them their images at planes within
/// reach R; products of reflections at edges, corners and between parallel planes included. An
/// image lies at X' = R X + t with R = diag(+-1), and moves as u' = S u (TLS.14). A particle on
/// a plane has an image at its own place.
class Points {
 public:
  /// No planes: no images, and nothing allocated.
  Points(const Body& body)
      : m_body(&body) {}  // NOLINT(google-explicit-constructor): a body is a set of points
  Points(const Body& body, const std::vector<Plane>& planes, double R);

  const Body& body() const { return *m_body; }
  Index images() const { return static_cast<Index>(m_images.size()); }
  Index count() const { return m_body->n + images(); }
  /// The particle itself, or whose image it is.
  Index source(Index b) const { return b < m_body->n ? b : m_images[b - m_body->n].of; }
  /// Columns of all points.
  const double* positions() const { return m_X.empty() ? m_body->X.data() : m_X.data(); }
  Vec3 position(Index b) const {
    Vec3 X = Vec3::Zero();
    for (int i = 0; i < m_body->dim; ++i)
      X[i] = positions()[static_cast<std::size_t>(b) * m_body->stride + i];
    return X;
  }

  /// A column for vectors of all points; empty without images.
  Column make_column() const { return Column(m_X.size(), 0.0); }
  /// Vectors of all points from those of the particles: `values` itself without images, else
  /// `extended` with values copied and u' = S u behind them.
  const double* extend(std::span<const double> values, Column& extended,
                       const Executor& executor) const;
  /// Points [X | u] with u = 0; set_displacements() keeps X.
  Column make_points() const;
  /// u of particles [first, last) into the points.
  void set_displacements(std::span<const double> u, Index first, Index last,
                         Column& points) const;
  /// u' = S u of all images.
  void set_image_displacements(std::span<const double> u, Column& points,
                               const Executor& executor) const;
  /// Sets the images' tensors from the particles': T' = S T R, H' = S H R (TLS.15).
  void reflect_tensors(Column& tensors, const Executor& executor) const;

 private:
  /// X' = R X + t, S = sign R; a fourth lane for padding.
  struct Map {
    std::array<double, 4> R{1, 1, 1, 1}, t{};
    double sign = 1;
  };
  struct Image {
    Index of, map;
  };
  void find_maps(const std::vector<Plane>& planes, double R, const Vec3& low, const Vec3& high);
  bool reaches(const Map& map, double R, const Vec3& low, const Vec3& high) const;

  const Body* m_body;
  std::vector<Map> m_maps;  ///< the identity first
  std::vector<Image> m_images;
  Column m_X;
};

}  // namespace concord::sph
