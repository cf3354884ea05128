// Whole runs with plasticity for every registered particle method, on a coarse tensile bar:
// implicit against explicit, unloading, perfect plasticity, tiny and huge steps, rotation.

#include "scene/norms.hpp"
#include "tests/property/bodies.hpp"

namespace concord::particle::test {
namespace {

using Overrides = std::vector<scene::Override>;

scene::Result pull(const Variant& variant, const Overrides& set,
                   const std::map<std::string, std::string>& more = {}) {
  Overrides all{{"load_steps", "25"}};
  all.insert(all.end(), set.begin(), set.end());
  const scene::Problem problem = scene::read_problem("tensile_bar", all);
  scene::RunRequest request;
  request.h = problem.reference_length / 14;
  request.settings = variant.settings;
  // Volumes as in the paper's comparison.
  if (variant.method == "tlsph") request.settings["volumes"] = "triangulation";
  for (const auto& [key, value] : more) request.settings[key] = value;
  scene::Result result;
  scene::MethodRegistry::instance().find(variant.method).run(problem, request, result);
  return result;
}

/// The bar has fillets; asserts that a method that declares so refuses it.
bool refused(const Variant& variant) {
  if (!refuses_curved_faces(variant)) return false;
  EXPECT_THROW(pull(variant, {}), InputError);
  return true;
}

double force(const scene::Result& r) {
  return std::hypot(r.quantities.at("reaction_x"), r.quantities.at("reaction_y"));
}

/// Motion of the ends as expressions: pulled by `d`, then turned by `angle` about the origin.
Overrides turned(const std::string& d, const std::string& angle) {
  const auto ends = [&](const std::string& Y) {
    return "[\"cos(" + angle + ")*X - sin(" + angle + ")*(" + Y + ") - X\", \"sin(" + angle +
           ")*X + cos(" + angle + ")*(" + Y + ") - Y\"]";
  };
  return {{"boundary.0.kind", "displacement"},
          {"boundary.0.value", ends("Y")},
          {"boundary.1.value", ends("Y + " + d)}};
}

TEST_P(EveryMethod, ExplicitAndImplicitPlasticRunsAgree) {
  if (refused(GetParam())) return;
  const scene::Result implicit = pull(GetParam(), {});
  const scene::Result dynamic = pull(GetParam(), {{"parameters.tau", "0.8"}},
                                     {{"solver", "explicit"}, {"duration", "1e-3"}});
  // Inertia at 1 ms is of order 1e-3 of the force (its ends differ by as much).
  EXPECT_NEAR(force(dynamic), force(implicit), 3e-3 * force(implicit));
  const double u =
      scene::relative_l2(dynamic.samples.u, implicit.samples.u, implicit.samples.weight);
  EXPECT_LT(u, 3e-3);
  EXPECT_NEAR(dynamic.quantities.at("plastic_strain_max"),
              implicit.quantities.at("plastic_strain_max"), 0.01 * 0.12);
}

TEST_P(EveryMethod, UnloadingIsElasticAndReloadingComesBack) {
  if (refused(GetParam())) return;
  // To 1 mm, back by 10 um (elastic: the bar yields at about 80 um), and to 1 mm again.
  const std::string path = "t<0.5 ? 1e-3*t/0.5 : (t<0.75 ? 1e-3 - 1e-5*(t-0.5)/0.25 : "
                           "1e-3 - 1e-5*(1-t)/0.25)";
  const auto to = [](const std::string& y) {
    return Overrides{{"boundary.1.value", "[\"0\", \"" + y + "\"]"}};
  };
  const scene::Result peak = pull(GetParam(), to("1e-3*t"));
  const scene::Result down =
      pull(GetParam(), to("t<0.5 ? 1e-3*t/0.5 : 1e-3 - 1e-5*(t-0.5)/0.5"));
  const scene::Result again = pull(GetParam(), to(path));
  const double slope = (force(peak) - force(down)) / 1e-5;
  const double elastic = force(pull(GetParam(), to("1e-5*t"))) / 1e-5;
  // The neck has thinned by a few per cent.
  EXPECT_NEAR(slope, elastic, 0.1 * elastic);
  EXPECT_NEAR(force(again), force(peak), 2e-3 * force(peak));
  EXPECT_NEAR(again.quantities.at("plastic_strain_max"),
              peak.quantities.at("plastic_strain_max"),
              2e-3 * peak.quantities.at("plastic_strain_max"));
}

TEST_P(EveryMethod, StepSizesFromTinyToHuge) {
  if (refused(GetParam())) return;
  const scene::Result fine = pull(GetParam(), {{"load_steps", "100"}});
  const scene::Result one = pull(GetParam(), {{"load_steps", "1"}});
  EXPECT_NEAR(force(one), force(fine), 3e-3 * force(fine));
  const scene::Result tiny = pull(GetParam(), {{"parameters.U", "1e-12 m"}});
  EXPECT_EQ(tiny.quantities.at("plastic_strain_max"), 0);
  const scene::Result small = pull(GetParam(), {{"parameters.U", "1e-9 m"}});
  EXPECT_NEAR(1000 * force(tiny), force(small), 1e-5 * force(small));
}

TEST_P(EveryMethod, PerfectPlasticityRuns) {
  if (refused(GetParam())) return;
  const Overrides perfect{{"material.saturation_stress", "450 MPa"},
                          {"material.hardening_modulus", "0 Pa"},
                          {"parameters.U", "0.2 mm"}};
  const scene::Result r = pull(GetParam(), perfect);
  // Plane-strain limit load of the neck, 2/sqrt(3) tau_y A; stiffer for a coarse arrangement.
  const double limit = 2 / std::sqrt(3.0) * 450e6 * 6e-6;
  EXPECT_GT(force(r), 0.9 * limit);
  EXPECT_LT(force(r), 1.35 * limit);
}

TEST_P(EveryMethod, BarTurnedUnderLoad) {
  if (refused(GetParam())) return;
  const std::string pulled = "1e-3*min(2*t, 1)";
  const scene::Result still = pull(GetParam(), turned(pulled, "0*t"));
  const scene::Result turning = pull(GetParam(), turned(pulled, "pi*max(t - 0.5, 0)"));
  // A quarter turn: the force on the bottom, along -y, now points along +x.
  EXPECT_NEAR(turning.quantities.at("reaction_x"), -still.quantities.at("reaction_y"),
              1e-6 * force(still));
  EXPECT_NEAR(turning.quantities.at("plastic_strain_max"),
              still.quantities.at("plastic_strain_max"), 1e-6);
}

}  // namespace
}  // namespace concord::particle::test
