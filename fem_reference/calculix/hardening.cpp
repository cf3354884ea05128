#include "fem_reference/calculix/hardening.hpp"

#include <algorithm>
#include <cmath>

namespace concord::calculix {

double flow_stress(const scene::Hardening& h, double eps_p) {
  return h.yield_stress + h.modulus * eps_p -
         (h.saturation_stress - h.yield_stress) * std::expm1(-h.exponent * eps_p);
}

HardeningTable hardening_table(const scene::Hardening& h, int points) {
  HardeningTable table;
  const int intervals = points - 2;  // one more is the straight end
  // Equal shares of the integral of exp(-a e/2), which |tau_y''|^(1/2) is proportional to.
  const double a = h.exponent / 2, whole = std::expm1(-a * sampled_strain);
  for (int i = 0; i <= intervals; ++i) {
    const double share = static_cast<double>(i) / intervals;
    const bool curved = a * sampled_strain > 1e-6;
    table.strain.push_back(curved ? -std::log1p(share * whole) / a : share * sampled_strain);
  }
  table.strain.back() = sampled_strain;
  for (const double e : table.strain) table.stress.push_back(flow_stress(h, e));
  constexpr int checks = 50;  // between two points
  for (std::size_t i = 0; i + 1 < table.strain.size(); ++i) {
    for (int k = 1; k < checks; ++k) {
      const double s = static_cast<double>(k) / checks;
      const double exact = flow_stress(h, (1 - s) * table.strain[i] + s * table.strain[i + 1]);
      const double chord = (1 - s) * table.stress[i] + s * table.stress[i + 1];
      table.error = std::max(table.error, std::abs(chord - exact) / exact);
    }
  }
  const double slope = h.modulus + (h.saturation_stress - h.yield_stress) * h.exponent *
                                       std::exp(-h.exponent * sampled_strain);
  table.strain.push_back(last_strain);
  table.stress.push_back(table.stress.back() + slope * (last_strain - sampled_strain));
  return table;
}

}  // namespace concord::calculix
