#pragma once
// What a problem's elastic material is to the kernels.

#include "particle/core/stress_kernel.hpp"
#include "scene/material.hpp"
#include "scene/problem.hpp"

namespace concord::particle {

/// Constants and law of the stress kernels. In plane stress St Venant-Kirchhoff is the plane law with
/// lambda* = 2 lambda mu / (lambda + 2 mu) (from S_33 = 0); the neo-Hookean solid solves P_33 = 0.
struct KernelMaterial {
  LameConstants lame;
  StressLaw law;
};

inline KernelMaterial kernel_material(const scene::Problem& problem) {
  const scene::Material& m = problem.material;
  const bool plane_stress = problem.dimension == Dimension::plane_stress;
  if (m.model == scene::MaterialModel::st_venant_kirchhoff) {
    const double lambda = plane_stress ? 2 * m.lambda * m.mu / (m.lambda + 2 * m.mu) : m.lambda;
    return {{lambda, m.mu}, StressLaw::st_venant_kirchhoff};
  }
  return {{m.lambda, m.mu}, plane_stress ? StressLaw::neo_hookean_plane_stress : StressLaw::neo_hookean};
}

/// Calls f(std::integral_constant<StressLaw, law>) for the law at hand, so that loops know it at compile time.
template <class F>
auto with_law(StressLaw law, const F& f) {
  switch (law) {
    case StressLaw::neo_hookean_plane_stress:
      return f(std::integral_constant<StressLaw, StressLaw::neo_hookean_plane_stress>{});
    case StressLaw::st_venant_kirchhoff: return f(std::integral_constant<StressLaw, StressLaw::st_venant_kirchhoff>{});
    default: return f(std::integral_constant<StressLaw, StressLaw::neo_hookean>{});
  }
}

/// The tensor that a column of Dim vectors holds at particle a; the rest zero.
inline Mat3 tensor_at(const Column& column, int dim, Index a) {
  const int stride = stride_of(dim);
  Mat3 t = Mat3::Zero();
  for (int j = 0; j < dim; ++j) {
    for (int i = 0; i < dim; ++i) t(i, j) = column[(static_cast<std::size_t>(a) * dim + j) * stride + i];
  }
  return t;
}

}  // namespace concord::particle
