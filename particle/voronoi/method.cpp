// Registration of the method `voronoi`: its settings, and the body with particles inside.

#include "particle/core/inside_body.hpp"
#include "particle/core/particle_method.hpp"
#include "particle/voronoi/placement.hpp"
#include "particle/voronoi/voronoi.hpp"

#include <limits>

namespace concord::particle::voronoi {
namespace {

scene::ParameterInfo choice(std::string key, std::vector<std::string> words,
                            std::string meaning) {
  scene::ParameterInfo p;
  p.key = std::move(key), p.unit = "1", p.default_value = words.front();
  for (const std::string& word : words) p.range += (p.range.empty() ? "" : " | ") + word;
  p.meaning = std::move(meaning);
  p.choices = std::move(words);
  return p;
}

scene::MethodInfo method_info() {
  return {
      "voronoi",
      "Voronoi particle method with contact stabilisation",
      "voronoi_particle_method",
      {choice("force", {"face-compatible", "conserving", "static"},
              "form of the internal force: face-compatible, the gradient of a potential that "
              "passes all patch tests (VOR.15); conserving, Eq. (43); static, Eq. (41) with "
              "reactions D P A"),
       {"xi_n", "1", "1", ">= 0", "normal contact stiffness K_n = xi_n E A_ab / L_ab (50)", 0},
       {"xi_t", "1", "1", ">= 0", "tangential contact stiffness K_t = xi_t G A_ab / L_ab (50)",
        0},
       {"c1", "1", "0", ">= 0", "linear artificial viscosity (51)", 0},
       {"c2", "1", "0", ">= 0", "quadratic artificial viscosity (51)", 0},
       choice("cells", {"off", "on"},
              "on: writes the cells' polygons to cells.hdf in the run's folder")},
      {{"conditions on points and edges",
        "particles lie inside the body: displacements act through faces, or on the whole body"},
       {"curved faces", "ghosts are mirror images behind plane walls"},
       {"one layer between free faces, acute corners between free faces",
        "the neighbours of a cell there do not say where its ghosts move"},
       {"potential (force=conserving)", "(43) treats prescribed positions as constants and "
                                        "leaves the reaction D P A out of the "
                                        "potential: a gradient only where all faces are free"},
       {"potential (force=static)", "(41) with D P A is the gradient of nothing at faces"},
       {"angular momentum (force=static)",
        "(41) at free faces follows from no rotationally invariant potential"}}};
}

Form form_of(const scene::Settings& settings) {
  const std::string& word = settings.word("force");
  if (word == "conserving") return Form::conserving;
  return word == "static" ? Form::quasi_static : Form::face_compatible;
}

/// What the model needs of the body beside its columns.
struct Division final : FormulationData {
  Cells cells;
  Boundary boundary;
};

double shortest_branch(const Cells& cells, std::span<const Vec3> X, double h) {
  double shortest = std::numeric_limits<double>::infinity();
  for (std::size_t f = 0; f < cells.interior; ++f)
    shortest = std::min(shortest, (X[cells.faces[f].b] - X[cells.faces[f].a]).norm());
  return cells.interior > 0 ? shortest : h;
}

std::vector<SurfacePiece> surface_of(const Division& division) {
  std::vector<SurfacePiece> surface;
  for (const BoundaryPiece& piece : division.boundary.pieces) {
    const Face& face = division.cells.faces[piece.face];
    const Wall& wall = division.cells.walls[face.wall];
    surface.push_back({piece.particle, wall.entity, piece.centroid_point, piece.condition,
                       face.A, face.C, wall.N});
  }
  return surface;
}

class VoronoiMethod final : public ParticleMethod {
 public:
  VoronoiMethod() : ParticleMethod(method_info()) {}

  Body make_particles(const scene::Problem& problem, const scene::RunRequest& request,
                      const scene::Settings& settings,
                      const Executor& executor) const override {
    scene::Mesh mesh = arrangement(problem, request.h, CellSource::delaunay);
    std::vector<Index>().swap(mesh.cells);
    (void)conditions_everywhere(problem, mesh);  // says early what cannot be
    InsideParts parts;
    parts.X = in_sweep_order(
        mesh, place_particles(problem, request.h, request.perturb, request.seed, executor),
        request.h, executor);
    const auto division = std::make_shared<Division>();
    const bool draw = settings.flag("cells") && !request.out.empty();
    division->cells = make_cells(mesh, problem.dim(), problem.thickness, parts.X, executor,
                                 {draw, problem.geometry_where});
    if (draw) write_cells(request.out / "cells.hdf", division->cells);
    division->cells.polygons = {};
    division->boundary = boundary_pieces(problem, mesh, division->cells, parts.X);
    parts.V = division->cells.V;
    parts.h_min = shortest_branch(division->cells, parts.X, request.h);
    parts.surface = surface_of(*division);
    parts.points = division->boundary.points;
    parts.owner = division->boundary.owner;
    Body body = inside_body(problem, std::move(mesh), request.h, std::move(parts), executor);
    body.data = division;
    return body;
  }

  std::unique_ptr<ForceModel> make_model(const Body& body, const scene::Problem& problem,
                                         const scene::Settings& settings,
                                         const Executor& executor) const override {
    const auto& division = dynamic_cast<const Division&>(*body.data);
    Parameters parameters;
    parameters.xi_n = settings.number("xi_n"), parameters.xi_t = settings.number("xi_t");
    parameters.c1 = settings.number("c1"), parameters.c2 = settings.number("c2");
    parameters.form = form_of(settings);
    return std::make_unique<VoronoiModel>(body, problem, division.cells, division.boundary,
                                          parameters, executor);
  }
};

const scene::RegisterMethod<VoronoiMethod> registered;

}  // namespace
}  // namespace concord::particle::voronoi
