#pragma once
// The body's surface as the mesh states it: which points lie on which of its faces, and what is
// inside.

#include "scene/geometry.hpp"

#include <span>
#include <vector>

namespace concord::particle {

/// Area vector of a facet (length vector in the plane), to the right of its orientation.
Vec3 facet_area(int dim, std::span<const Vec3> X, const Index* v);

/// The mesh's boundary as simplices (quadrilateral facets split). Points are numbered by
/// `number`, one a mesh node; X holds their positions by that number. X must outlive the
/// object.
class BodySurface {
 public:
  BodySurface(const scene::Mesh& mesh, std::span<const Index> number, std::span<const Vec3> X);

  bool holds(Index a) const { return m_slot[a] >= 0; }
  /// Whether some face of the body (gmsh entity) holds all the points.
  bool share_a_face(const Index* v, int count) const;
  /// The entity that a facet lies on: the one that holds all its points; where several do (at
  /// corners), the one whose nearest facets have the most similar normal. -1 if there is none.
  Index entity_of(const Index* facet) const;
  /// 1 inside, 0 outside.
  double winding_number(const Vec3& x) const;

  double volume() const { return m_volume; }  ///< enclosed [m^dim]
  double area() const { return m_area; }      ///< [m^(dim-1)]
  /// Largest difference in volume between this surface and another through the same points:
  /// about h A/4 on curved faces, 0 elsewhere [m^dim].
  double slack() const { return m_slack; }

 private:
  /// A face at a point: the sum of its facets' area vectors there.
  struct Face {
    Index entity;
    Vec3 normal;
  };
  std::span<const Face> faces_at(Index a) const;
  void collect_faces(const std::vector<Index>& entity);

  int m_dim;
  std::span<const Vec3> m_X;
  std::vector<Index> m_facets;  ///< dim points each
  std::vector<Index> m_slot;    ///< per point: its place in m_begin, -1 inside
  std::vector<Index> m_begin;
  std::vector<Face> m_faces;
  double m_volume = 0, m_area = 0, m_slack = 0;
};

}  // namespace concord::particle
