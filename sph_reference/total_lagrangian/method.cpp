// Registration of the method `tlsph`.

#include "particle/core/particle_method.hpp"
#include "sph_reference/total_lagrangian/fracture.hpp"
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

constexpr const char* default_damping = "0.5";  ///< Tables 3 and 4 of the Continuum Bond Method

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
       choice("smoothing", "uniform", {"uniform", "local"},
              "uniform: one support radius; local: it follows the local spacing where that is "
              "above the mean one, a pair has the mean of its ends"),
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
              "quadratic coefficient of Monaghan's artificial viscosity (TLS.12)"),
       choice("springs", "edges", {"edges", "pairs"},
              "what breaks, in scenes with [fracture] only: springs on the triangulation's "
              "edges, longer pairs with those on their way; or every pair by itself, (TLS.18)"),
       number("pair_damping", default_damping, 0, 1e6, ">= 0",
              "artificial damping control parameter beta of the Continuum Bond Method's (21), "
              "in scenes with [fracture] only, (TLS.21)")},
      {{"equilibrium patch test",
        "gradients of affine fields are exact, but the gradient vectors (TLS.5) do not meet "
        "the integration "
        "constraint sum_a V_a g_ab = 0 off a lattice, so that constant stress leaves forces"},
       {"potential", "with psi > 0 and penalty = ganzenmuller the penalty force (TLS.10) has "
                     "no potential"}}};
}

TlsphOptions options_of(const scene::Settings& settings) {
  TlsphOptions options;
  options.kernel = settings.word("kernel") == "wendland-c2" ? KernelShape::wendland_c2
                                                            : KernelShape::cubic_spline;
  options.support = settings.number("support");
  options.psi = settings.number("psi");
  options.penalty = settings.word("penalty") == "potential" ? PenaltyForm::potential
                                                            : PenaltyForm::ganzenmueller;
  options.alpha = settings.number("alpha");
  options.beta = settings.number("beta");
  options.local = settings.word("smoothing") == "local";
  return options;
}

[[noreturn]] void refuse(const scene::Problem& problem, const std::string& key,
                         const std::string& found, const std::string& allowed) {
  throw InputError({problem.file.string(), 0, 0}, "tlsph." + key, found, allowed);
}

/// Settings of pairs that break, on a scene without [fracture].
void check_unbroken(const scene::Problem& problem, const scene::Settings& settings) {
  if (settings.word("springs") != "edges")
    refuse(problem, "springs", settings.word("springs"),
           "edges, its default, without [fracture]");
  if (settings.word("pair_damping") != default_damping)
    refuse(problem, "pair_damping", settings.word("pair_damping"),
           "0.5, its default, without [fracture]");
}

std::unique_ptr<particle::ForceModel> make_fracturing(const Body& body,
                                                      const scene::Problem& problem,
                                                      const scene::Settings& settings,
                                                      const Executor& executor) {
  FractureOptions options;
  options.sph = options_of(settings);
  for (const char* key : {"alpha", "beta"}) {
    if (settings.number(key) != 0)
      refuse(problem, key, settings.word(key),
             "0 beside [fracture], whose damping is pair_damping");
  }
  if (settings.word("planes") == "mirror" && !symmetry_planes(problem, body).empty())
    refuse(problem, "planes", "mirror", "truncated beside [fracture]: images do not break");
  options.springs =
      settings.word("springs") == "edges" ? SpringLayout::edges : SpringLayout::pairs;
  options.beta = settings.number("pair_damping");
  return std::make_unique<FracturingSph>(body, problem, options, executor);
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

  bool breaks() const override { return true; }

  std::unique_ptr<particle::ForceModel> make_model(const Body& body,
                                                   const scene::Problem& problem,
                                                   const scene::Settings& settings,
                                                   const Executor& executor) const override {
    if (problem.fracture) return make_fracturing(body, problem, settings, executor);
    check_unbroken(problem, settings);
    TlsphOptions options = options_of(settings);
    if (settings.word("planes") == "mirror" && !problem.is_static)
      options.planes = symmetry_planes(problem, body);
    return std::make_unique<TotalLagrangianSph>(body, problem, options, executor);
  }
};

const scene::RegisterMethod<TlsphMethod> registration;

}  // namespace
}  // namespace concord::sph
