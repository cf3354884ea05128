// Registration of the method `tlsph`.

#include "particle/core/particle_method.hpp"
#include "sph_reference/total_lagrangian/model.hpp"
#include "sph_reference/total_lagrangian/volumes.hpp"

namespace concord::sph {
namespace {

scene::ParameterInfo choice(const char* key, const char* value,
                            std::vector<std::string> choices, const char* meaning) {
  scene::ParameterInfo p;
  p.key = key, p.unit = "1", p.default_value = value, p.meaning = meaning;
  for (const std::string& c : choices) p.range += (p.range.empty() ? "" : " | ") + c;
  p.choices = std::move(choices);
  return p;
}

scene::ParameterInfo number(const char* key, const char* value, double minimum, double maximum,
                            const char* range, const char* meaning) {
  scene::ParameterInfo p;
  p.key = key, p.unit = "1", p.default_value = value, p.range = range, p.meaning = meaning;
  p.minimum = minimum, p.maximum = maximum;
  return p;
}

scene::MethodInfo tlsph_info() {
  return {
      "tlsph",
      "Total-Lagrangian smoothed particle hydrodynamics with corrected gradients",
      "G. C. Ganzenmueller, Comput. Methods Appl. Mech. Engrg. 286 (2015) 87-106; "
      "continuum_bond_method (27), (28); "
      "textbook_dem_sph_mpm",
      {choice("kernel", "cubic-spline", {"cubic-spline", "wendland-c2"},
              "smoothing kernel, (TLS.1), (TLS.2)"),
       number("support", "3", 1.01, 20, "1.01 .. 20",
              "support radius of the kernel in mean spacings"),
       number("psi", "0.07", 0, 1e6, ">= 0",
              "penalty factor against zero-energy modes, (TLS.9); 0 switches the penalty off"),
       choice("penalty", "ganzenmuller", {"ganzenmuller", "potential"},
              "form of the penalty: along the current bond and without potential (TLS.10), or "
              "from the energy "
              "1/2 k |u_loc|^2 a pair (TLS.11)"),
       choice("planes", "mirror", {"mirror", "truncated"},
              "mirror: images of particles continue the body behind symmetric and "
              "antisymmetric planes, (TLS.14) "
              "to (TLS.16); truncated: none. Static scenes are always truncated: the tangent "
              "knows no images"),
       choice("volumes", "voronoi", {"voronoi", "triangulation"},
              "V_a and the masses: of the Voronoi cells (TLS.17), equal on a lattice, or "
              "shares of the Delaunay simplices"),
       number("alpha", "0", 0, 1e6, ">= 0",
              "linear coefficient of Monaghan's artificial viscosity (TLS.12)"),
       number("beta", "0", 0, 1e6, ">= 0",
              "quadratic coefficient of Monaghan's artificial viscosity (TLS.12)")},
      {{"equilibrium patch test",
        "gradients of affine fields are exact, but the gradient vectors (TLS.5) do not meet "
        "the integration "
        "constraint sum_a V_a g_ab = 0 off a lattice, so that constant stress leaves forces"},
       {"potential", "with psi > 0 and penalty = ganzenmuller the penalty force (TLS.10) has "
                     "no potential"}}};
}

class TlsphMethod final : public particle::ParticleMethod {
 public:
  TlsphMethod() : ParticleMethod(tlsph_info()) {}

  void divide(Body& body, const scene::Problem& problem,
              const scene::Settings& settings) const override {
    if (settings.word("volumes") != "voronoi") return;
    body.V = voronoi_volumes(body);  // (TLS.17)
    for (Index a = 0; a < body.n; ++a) body.m[a] = problem.material.rho0 * body.V[a];
  }

  std::unique_ptr<particle::ForceModel> make_model(const Body& body,
                                                   const scene::Problem& problem,
                                                   const scene::Settings& settings,
                                                   const Executor& executor) const override {
    TlsphOptions options;
    options.kernel = settings.word("kernel") == "wendland-c2" ? KernelShape::wendland_c2
                                                              : KernelShape::cubic_spline;
    options.support = settings.number("support");
    options.psi = settings.number("psi");
    options.penalty = settings.word("penalty") == "potential" ? PenaltyForm::potential
                                                              : PenaltyForm::ganzenmueller;
    options.alpha = settings.number("alpha");
    options.beta = settings.number("beta");
    if (settings.word("planes") == "mirror" && !problem.is_static)
      options.planes = symmetry_planes(problem, body);
    return std::make_unique<TotalLagrangianSph>(body, problem, options, executor);
  }
};

const scene::RegisterMethod<TlsphMethod> registration;

}  // namespace
}  // namespace concord::sph
