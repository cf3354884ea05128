// Probe spectrum: what the eigenvalues of a body tell of zero-energy modes and instability.

#include "studies/probes/modes.hpp"
#include "studies/probes/states.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>

namespace concord::probes {
namespace {

/// Eigenvalues below this share of the largest one are zero: round-off of K is about 1e-13 of
/// it, the softest physical mode of a block of N cells about 1/N^2.
constexpr double zero_below = 1e-9;

ProbeInfo spectrum_info() {
  ProbeInfo info{
      "spectrum",
      "Eigenvalues of K x = lambda M x: zero modes, spurious low modes, negative and complex "
      "ones",
      "zero-energy modes of corrected gradients: Belytschko, Guo, Liu and Xiao, Int. J. Numer. "
      "Methods Eng. 48 (2000) 1359-1400",
      {number_option("low", "E/(rho L^2)", "10", 0, 1e300, ">= 0",
                     "modes below this eigenvalue are counted as low; zero modes are not"),
       number_option("reference", "1", "3", 0, 100, "0 .. 100",
                     "resolution of the fem Q2 body whose low modes are the physical ones; 0: "
                     "none")},
      {{"zero_modes", "1", "eigenvalues below 1e-9 of the largest, in size"},
       {"zero_modes_beyond_rigid", "1",
        "zero_modes less the 6 (3 in the plane) of a free body"},
       {"low_modes", "1", "eigenvalues between zero modes and `low`"},
       {"reference_low_modes", "1", "those of fem Q2"},
       {"spurious_low_modes", "1", "low_modes less reference_low_modes"},
       {"spurious_share", "1", "spurious_low_modes over all modes"},
       {"negative_modes", "1", "eigenvalues below -1e-9 of the largest"},
       {"lowest", "E/(rho L^2)", "smallest real part"},
       {"highest", "E/(rho L^2)", "largest real part"},
       {"complex_modes", "1", "eigenvalues with an imaginary part above 1e-9 of the largest"},
       {"growth_rate", "c/L",
        "largest |Im sqrt(lambda)|, c = sqrt(E/rho): what negative and complex modes grow "
        "with"},
       {"asymmetry", "1", "|K - K^T| / |K| after scaling by the masses"}}};
  for (const scene::ParameterInfo& option : deformation_options())
    info.options.push_back(option);
  return info;
}

/// E/(rho L^2) [1/s^2], by which eigenvalues are told.
double unit_of(const scene::Problem& problem) {
  const double L = problem.reference_length;
  return problem.material.E / (problem.material.rho0 * L * L);
}

long below(const Modes& modes, double limit) {
  return std::lower_bound(modes.real.begin(), modes.real.end(), limit) - modes.real.begin();
}

double zero_of(const Modes& modes) {
  return zero_below * std::max(std::abs(modes.real.front()), modes.real.back());
}

/// Eigenvalues above the zero modes and below `limit`.
double low_modes(const Modes& modes, double limit) {
  return static_cast<double>(below(modes, limit) - below(modes, zero_of(modes)));
}

class Spectrum final : public Probe {
 public:
  const ProbeInfo& info() const override { return m_info; }

  void run(const ProbeRequest& request, scene::Result& result) const override {
    const std::unique_ptr<scene::DiscreteBody> body = request.body();
    tell_size(*body, result);
    if (result.unknowns > most_unknowns) {
      throw InputError({"command line"}, "--resolution",
                       fmt::format("{} unknowns", result.unknowns),
                       fmt::format("at most {}: all eigenvalues are computed", most_unknowns));
    }
    const Modes found = modes(*body, deformed(*body, request.options));
    const double unit = unit_of(request.problem);
    write(request, found, unit);
    const double zero = zero_of(found);
    const auto zeros = static_cast<double>(below(found, zero) - below(found, -zero));
    auto& q = result.quantities;
    q["zero_modes"] = zeros;
    q["zero_modes_beyond_rigid"] = zeros - (body->dim() == 3 ? 6 : 3);
    q["negative_modes"] = static_cast<double>(below(found, -zero));
    q["lowest"] = found.real.front() / unit;
    q["highest"] = found.real.back() / unit;
    q["asymmetry"] = found.asymmetry;
    add_growth(found, zero, unit, q);
    const double limit = request.options.number("low") * unit;
    q["low_modes"] = low_modes(found, limit);
    if (request.options.number("reference") > 0) {
      q["reference_low_modes"] = low_modes(reference(request), limit);
      q["spurious_low_modes"] = q["low_modes"] - q["reference_low_modes"];
      q["spurious_share"] = q["spurious_low_modes"] / static_cast<double>(found.real.size());
    }
  }

 private:
  static constexpr long most_unknowns = 6000;

  static void add_growth(const Modes& modes, double zero, double unit,
                         std::map<std::string, double>& q) {
    double complex_modes = 0, growth = 0;
    for (std::size_t k = 0; k < modes.real.size(); ++k) {
      const double re = modes.real[k], im = modes.imaginary[k];
      if (std::abs(im) > zero) ++complex_modes;
      if (std::abs(im) <= zero && re > -zero) continue;
      growth = std::max(growth, std::sqrt(std::max(0.0, (std::hypot(re, im) - re) / 2)));
    }
    q["complex_modes"] = complex_modes;
    q["growth_rate"] = growth / std::sqrt(unit);
  }

  /// The same problem and state with fem Q2 on its lattice.
  static Modes reference(const ProbeRequest& request) {
    const scene::Method& fem = scene::MethodRegistry::instance().find("fem");
    ProbeRequest other{request.problem, fem, request.run, request.options};
    other.run.h = request.problem.reference_length / request.options.number("reference");
    other.run.perturb = 0;
    other.run.settings = {{"element", "Q2"}};
    const std::unique_ptr<scene::DiscreteBody> body = other.body();
    return modes(*body, deformed(*body, request.options));
  }

  static void write(const ProbeRequest& request, const Modes& modes, double unit) {
    if (request.run.out.empty()) return;
    std::ofstream csv(request.run.out / "spectrum.csv");
    csv << "mode,real_E_rho_L2,imaginary_E_rho_L2\n";
    for (std::size_t k = 0; k < modes.real.size(); ++k)
      csv << fmt::format("{},{:.8g},{:.8g}\n", k + 1, modes.real[k] / unit,
                         modes.imaginary[k] / unit);
  }

  ProbeInfo m_info = spectrum_info();
};

const RegisterProbe<Spectrum> registered;

}  // namespace
}  // namespace concord::probes
