#include "particle/core/particle_method.hpp"
#include "particle/delaunay/delaunay.hpp"

namespace concord::particle::delaunay {
namespace {

scene::MethodInfo method_info() {
  return {
      "delaunay",
      "Delaunay particle method with contact stabilisation",
      "delaunay_particle_method",
      {{"xi_n", "1", "1", ">= 0", "normal contact stiffness K_n = xi_n E A_ab / L_ab (60)", 0},
       {"xi_t", "1", "1", ">= 0", "tangential contact stiffness K_t = xi_t G A_ab / L_ab (60)",
        0},
       {"c1", "1", "0", ">= 0", "linear artificial viscosity (61)", 0},
       {"c2", "1", "0", ">= 0", "quadratic artificial viscosity (61)", 0}}};
}

class DelaunayMethod final : public ParticleMethod {
 public:
  DelaunayMethod() : ParticleMethod(method_info()) {}
  std::unique_ptr<ForceModel> make_model(const Body& body, const scene::Problem& problem,
                                         const scene::Settings& settings,
                                         const Executor& executor) const override {
    const Parameters parameters{settings.number("xi_n"), settings.number("xi_t"),
                                settings.number("c1"), settings.number("c2")};
    return std::make_unique<DelaunayModel>(body, problem, parameters, executor);
  }
};

const scene::RegisterMethod<DelaunayMethod> registered;

}  // namespace
}  // namespace concord::particle::delaunay
