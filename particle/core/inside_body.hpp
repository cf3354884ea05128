#pragma once
// Bodies whose particles lie inside, none on the faces: each owns a cell, and displacement
// conditions act through points on the cells' pieces of the surface.

#include "particle/core/body.hpp"

namespace concord::particle {

/// Whether a group holds all of the body.
bool is_whole_body(const scene::Mesh::Group& group, const scene::Mesh& mesh);

/// The displacement conditions on every particle: those on the whole body. Throws InputError at
/// the [[boundary]] entry for displacements on part of the volumes, on points, and on curves in
/// 3D: no particle need lie there. Those on faces act through boundary points.
Conditions conditions_everywhere(const scene::Problem& problem, const scene::Mesh& mesh);

/// What a formulation knows of such a body, particles in the order in which they are numbered.
struct InsideParts {
  std::vector<Vec3> X;                ///< reference positions of the particles [m]
  std::vector<double> V;              ///< their volumes, thickness included [m^3]
  double h_min = 0;                   ///< shortest distance between neighbours [m]
  std::vector<SurfacePiece> surface;  ///< all pieces
  std::vector<Vec3> points;           ///< boundary points, after the particles [m]
  std::vector<Index> owner;           ///< the piece that each boundary point belongs to
};

/// Points in sweep order (sweep_order.hpp), layers about h/2 inside the faces.
std::vector<Vec3> in_sweep_order(const scene::Mesh& mesh, std::span<const Vec3> X, double h,
                                 const Executor& executor);

/// The body of these parts. Its triangulation joins the particles: Delaunay's, less what
/// crosses a face of the body; it does not reach the faces. on_boundary tells particles whose
/// cell has a piece of the surface.
Body inside_body(const scene::Problem& problem, scene::Mesh mesh, double h, InsideParts parts,
                 const Executor& executor);

}  // namespace concord::particle
