// Stress of particles by itself, for counting: every law in 3D, plane strain and plane stress,
// and plastic bodies of which none, half or all flows. count_stress [CASE ...]

#include "tests/instructions/counted.hpp"

#include "particle/core/constitution.hpp"
#include "scene/reader.hpp"

#include <cstdio>
#include <stdexcept>

namespace {

using namespace concord;
using namespace concord::particle;

constexpr Index particles = 512;
constexpr int repeats = 2;  ///< evaluations in the shorter count

/// H = volume V (1, as the kernels take it) times the gradient: a shear that differs from
/// particle to particle, and a stretch.
Column gradients(int dim, double flowing_part) {
  const int stride = stride_of(dim);
  Column H(static_cast<std::size_t>(particles) * dim * stride, 0.0);
  for (Index a = 0; a < particles; ++a) {
    const double shear =
        (a < flowing_part * particles ? 1e-2 : 1e-4) * (1 + 1e-3 * a / particles);
    double* h = &H[static_cast<std::size_t>(a) * dim * stride];
    h[0] = 0.1 * shear, h[stride] = shear;
  }
  return H;
}

/// One evaluation; H is scaled by 1 in place.
template <int Dim, StressLaw Law>
CONCORD_CLONES unsigned evaluate(const StressConstants& c, const double* one, double* H,
                                 double* P) {
  constexpr std::size_t size = Dim * Lanes<Dim>::stride;
  unsigned bad = 0;
  for (Index a = 0; a < particles; a += stress_width)
    bad |= stress_of_group<Dim, Law>(c, a, stress_width, one + a, H + a * size, P + a * size);
  return bad;
}

template <int Dim>
void count_stress(const std::string& name, const scene::Problem& problem, double flowing_part) {
  Constitution constitution(problem, particles);
  Column H = gradients(Dim, flowing_part), P(H.size(), 0.0);
  const std::vector<double> one(particles, 1.0);
  const auto evaluations = [&](int count) {
    with_law(constitution.kernel().law, [&](auto law) {
      for (int k = 0; k < count; ++k) {
        if (evaluate<Dim, decltype(law)::value>(constitution.kernel().constants, one.data(),
                                                H.data(), P.data()) != 0)
          throw std::logic_error("a particle without a stress");
      }
    });
  };
  evaluations(1);
  instructions::counted(name + " once", [&] { evaluations(repeats); });
  instructions::counted(name + " twice", [&] { evaluations(2 * repeats); });
  std::printf("case %s steps %d particles %d\n", name.c_str(), repeats, particles);
}

struct Case {
  const char* name;
  const char* scene;  ///< whose material constants it has
  scene::MaterialModel model;
  Dimension dimension;
  double flowing_part = 0;
};

using enum scene::MaterialModel;
using enum Dimension;
const Case cases[] = {
    {"stress_neo_hookean_3d", "swinging_cube", neo_hookean, three_d},
    {"stress_isochoric_3d", "swinging_cube", neo_hookean_isochoric, three_d},
    {"stress_st_venant_3d", "swinging_cube", st_venant_kirchhoff, three_d},
    {"stress_neo_hookean_plane", "swinging_cube", neo_hookean, plane_strain},
    {"stress_neo_hookean_plane_stress", "swinging_cube", neo_hookean, plane_stress},
    {"stress_plastic_plane_0", "tensile_bar", j2_hencky, plane_strain, 0},
    {"stress_plastic_plane_half", "tensile_bar", j2_hencky, plane_strain, 0.5},
    {"stress_plastic_plane_all", "tensile_bar", j2_hencky, plane_strain, 1},
    {"stress_plastic_3d_0", "tensile_bar", j2_hencky, three_d, 0},
    {"stress_plastic_3d_half", "tensile_bar", j2_hencky, three_d, 0.5},
    {"stress_plastic_3d_all", "tensile_bar", j2_hencky, three_d, 1},
};

}  // namespace

int main(int argc, char** argv) {
  instructions::tell_compiler();
  for (const Case& one : cases) {
    if (!instructions::wanted(one.name, argc, argv)) continue;
    scene::Problem problem = scene::read_problem(one.scene);
    problem.material.model = one.model;
    problem.dimension = one.dimension;
    if (problem.dim() == 3)
      count_stress<3>(one.name, problem, one.flowing_part);
    else
      count_stress<2>(one.name, problem, one.flowing_part);
  }
}
