#pragma once
// What a problem's material is to the kernels.

#include "particle/core/features.hpp"
#include "particle/core/stress_kernel.hpp"
#include "scene/material.hpp"
#include "scene/problem.hpp"

#include <stdexcept>
#include <type_traits>

namespace concord::particle {

/// Constants and law of the stress kernels. In plane stress St Venant-Kirchhoff is the plane
/// law with lambda* = 2 lambda mu / (lambda + 2 mu) (from S_33 = 0); the neo-Hookean solids
/// solve P_33 = 0.
struct KernelMaterial {
  StressConstants constants;
  StressLaw law;
};

inline KernelMaterial kernel_material(const scene::Problem& problem) {
  const scene::Material& m = problem.material;
  const bool plane_stress = problem.dimension == Dimension::plane_stress;
  const double plane_lambda = 2 * m.lambda * m.mu / (m.lambda + 2 * m.mu);
  switch (m.model) {
    case scene::MaterialModel::neo_hookean:
      return {{{m.lambda, m.mu}},
              plane_stress ? StressLaw::neo_hookean_plane_stress : StressLaw::neo_hookean};
    case scene::MaterialModel::neo_hookean_isochoric:
      return {{{m.lambda, m.mu}},
              plane_stress ? StressLaw::isochoric_plane_stress : StressLaw::isochoric};
    case scene::MaterialModel::st_venant_kirchhoff:
      return {{{plane_stress ? plane_lambda : m.lambda, m.mu}}, StressLaw::st_venant_kirchhoff};
    case scene::MaterialModel::j2_hencky:
      return {{{m.lambda, m.mu}}, StressLaw::j2_hencky};
  }
  throw std::logic_error("material model without a stress kernel");
}

/// Calls f(std::integral_constant<StressLaw, law>) for the law at hand, so that loops know it
/// at compile time.
template <class F> auto with_law(StressLaw law, const F& f) {
  using enum StressLaw;
  switch (law) {
    case neo_hookean:
      return f(std::integral_constant<StressLaw, neo_hookean>{});
    case neo_hookean_plane_stress:
      return f(std::integral_constant<StressLaw, neo_hookean_plane_stress>{});
    case isochoric:
      return f(std::integral_constant<StressLaw, isochoric>{});
    case isochoric_plane_stress:
      return f(std::integral_constant<StressLaw, isochoric_plane_stress>{});
    case st_venant_kirchhoff:
      return f(std::integral_constant<StressLaw, st_venant_kirchhoff>{});
    case j2_hencky:
      if constexpr (features::plasticity)
        return f(std::integral_constant<StressLaw, j2_hencky>{});
      break;
  }
  throw std::logic_error("stress law without a kernel");
}

/// The tensor that a column of Dim vectors holds at particle a; the rest zero.
inline Mat3 tensor_at(const Column& column, int dim, Index a) {
  const int stride = stride_of(dim);
  Mat3 t = Mat3::Zero();
  for (int j = 0; j < dim; ++j) {
    for (int i = 0; i < dim; ++i)
      t(i, j) = column[(static_cast<std::size_t>(a) * dim + j) * stride + i];
  }
  return t;
}

}  // namespace concord::particle
