#include "particle/core/particle_method.hpp"
#include "particle/delaunay/delaunay.hpp"
#include "particle/delaunay/fracture.hpp"

#include <fmt/format.h>

namespace concord::particle::delaunay {
namespace {

constexpr double default_beta = 0.5;  ///< Tables 3 and 4 of the Continuum Bond Method paper

scene::MethodInfo method_info() {
  return {
      "delaunay",
      "Delaunay particle method with contact stabilisation",
      "delaunay_particle_method",
      {{"xi_n", "1", "1", ">= 0", "normal contact stiffness K_n = xi_n E A_ab / L_ab (60)", 0},
       {"xi_t", "1", "1", ">= 0", "tangential contact stiffness K_t = xi_t G A_ab / L_ab (60)",
        0},
       {"c1", "1", "0", ">= 0", "linear artificial viscosity (61)", 0},
       {"c2", "1", "0", ">= 0", "quadratic artificial viscosity (61)", 0},
       {"beta", "1", fmt::format("{}", default_beta), ">= 0",
        "artificial damping control parameter beta, Eq. (21) of the Continuum Bond Method "
        "paper, "
        "in scenes with [fracture] only, in place of c1 and c2",
        0}}};
}

[[noreturn]] void refuse(const scene::Problem& problem, const std::string& key,
                         const scene::Settings& settings, const std::string& allowed) {
  throw InputError({problem.file.string(), 0, 0}, "delaunay." + key, settings.word(key),
                   allowed);
}

class DelaunayMethod final : public ParticleMethod {
 public:
  DelaunayMethod() : ParticleMethod(method_info()) {}
  bool breaks() const override { return true; }
  std::unique_ptr<ForceModel> make_model(const Body& body, const scene::Problem& problem,
                                         const scene::Settings& settings,
                                         const Executor& executor) const override {
    const Parameters parameters{settings.number("xi_n"), settings.number("xi_t"),
                                settings.number("c1"), settings.number("c2")};
    const double beta = settings.number("beta");
    if (!problem.fracture) {
      if (beta != default_beta)
        refuse(problem, "beta", settings, "0.5, its default, in a scene without [fracture]");
      return std::make_unique<DelaunayModel>(body, problem, parameters, executor);
    }
    for (const char* key : {"c1", "c2"}) {
      if (settings.number(key) > 0)
        refuse(problem, key, settings, "0 in a scene with [fracture], whose damping is beta");
    }
    return std::make_unique<FractureModel>(
        body, problem, FractureParameters{beta, parameters.xi_n, parameters.xi_t});
  }
};

const scene::RegisterMethod<DelaunayMethod> registered;

}  // namespace
}  // namespace concord::particle::delaunay
