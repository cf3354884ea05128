// Registration of the method `cbm`.

#include "particle/core/particle_method.hpp"
#include "particle/delaunay/delaunay.hpp"
#include "particle/delaunay/fracture.hpp"

#include <fmt/format.h>

namespace concord::particle::cbm {
namespace {

constexpr double default_beta = 0.5;  ///< Tables 3 and 4

scene::ParameterInfo cells_parameter() {
  scene::ParameterInfo p;
  p.key = "cells", p.unit = "1", p.default_value = "mesh", p.range = "mesh | delaunay";
  p.meaning = "triangles (tetrahedra) between the particles: those of gmsh's mesh, as in the "
              "paper, or the Delaunay triangulation";
  p.choices = {"mesh", "delaunay"};
  return p;
}

scene::MethodInfo method_info() {
  return {
      "cbm",
      "Continuum Bond Method",
      "continuum_bond_method: S. O. Sperling et al., Comput. Methods Appl. Mech. Engrg. 390 "
      "(2022) 114460",
      {cells_parameter(),
       {"xi_n", "1", "0", ">= 0",
        "normal contact stiffness K_n = xi_n E A_ab / L_ab, Eq. (60) of the Delaunay paper; "
        "the "
        "Continuum Bond Method has none",
        0},
       {"xi_t", "1", "0", ">= 0",
        "tangential contact stiffness K_t = xi_t G A_ab / L_ab, Eq. (60) of the Delaunay "
        "paper; "
        "the Continuum Bond Method has none",
        0},
       {"beta", "1", fmt::format("{}", default_beta), ">= 0",
        "artificial damping control parameter beta (21), in scenes with [fracture] only", 0}}};
}

/// Bond vectors zeta_ip (9) are the gradient vectors B_ip of the Delaunay method, Omega_i (1)
/// its volumes, and -(18) its pair force: see README.md. What is left is the choice of cells,
/// that contact is off, and fracture.
class CbmMethod final : public ParticleMethod {
 public:
  CbmMethod() : ParticleMethod(method_info()) {}
  CellSource cells(const scene::Settings& settings) const override {
    return settings.word("cells") == "mesh" ? CellSource::mesh : CellSource::delaunay;
  }
  bool breaks() const override { return true; }
  std::unique_ptr<ForceModel> make_model(const Body& body, const scene::Problem& problem,
                                         const scene::Settings& settings,
                                         const Executor& executor) const override {
    const double xi_n = settings.number("xi_n"), xi_t = settings.number("xi_t"),
                 beta = settings.number("beta");
    if (problem.fracture) {
      return std::make_unique<delaunay::FractureModel>(
          body, problem, delaunay::FractureParameters{beta, xi_n, xi_t});
    }
    if (beta != default_beta) {
      throw InputError({problem.file.string(), 0, 0}, "cbm.beta", settings.word("beta"),
                       "0.5, its default, in a scene without [fracture]");
    }
    delaunay::Parameters parameters;
    parameters.xi_n = xi_n, parameters.xi_t = xi_t;
    return std::make_unique<delaunay::DelaunayModel>(body, problem, parameters, executor);
  }
};

const scene::RegisterMethod<CbmMethod> registered;

}  // namespace
}  // namespace concord::particle::cbm
