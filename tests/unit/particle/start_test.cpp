// Runs that start from equilibrium: the stretched strip with its notch, which breaks nothing.

#include "particle/core/particle_method.hpp"
#include "scene/reader.hpp"

#include <gtest/gtest.h>

#include <map>
#include <string>

namespace concord::particle {
namespace {

scene::Result stretched(const std::string& method, const std::string& start,
                        const std::string& toughness) {
  const scene::Problem problem =
      scene::read_problem("pmma_strip", {{"end_time", "5 us"},
                                         {"parameters.dU", "0.05 mm"},
                                         {"fracture.energy_release_rate", toughness}});
  scene::RunRequest request;
  request.h = 1e-3;
  request.settings = {{"start", start}, {"beta", "0.5"}};
  scene::Result result;
  scene::MethodRegistry::instance().find(method).run(problem, request, result);
  return result;
}

constexpr const char *unbreakable = "1e9 J/m^2", *weak = "30 J/m^2";

}  // namespace

// The strip's edges do not hold it along themselves: that motion is left where it is.
TEST(EquilibriumStart, NothingMoves) {
  for (const char* method : {"cbm", "delaunay"}) {
    const scene::Result given = stretched(method, "given", unbreakable),
                        settled = stretched(method, "equilibrium", unbreakable);
    EXPECT_GT(given.quantities.at("dissipated_share"), 1e-3) << method;
    EXPECT_LT(settled.quantities.at("dissipated_share"), 1e-15) << method;
    double moved = 0, size = 0, along = 0;
    for (std::size_t a = 0; a < settled.samples.u.size(); ++a) {
      moved = std::max(moved, settled.samples.v[a].norm());
      size = std::max(size, given.samples.v[a].norm());
      along += settled.samples.u[a][0] - given.samples.u[a][0];
    }
    EXPECT_LT(moved, 1e-6 * size) << method;
    EXPECT_LT(std::abs(along) / static_cast<double>(settled.samples.u.size()), 1e-5) << method;
  }
}

// Bonds beyond their strain break in the first step, not while equilibrium is looked for.
TEST(EquilibriumStart, BreaksOnceItRuns) {
  EXPECT_GT(stretched("cbm", "equilibrium", weak).quantities.at("broken_bonds"), 0);
}

TEST(EquilibriumStart, IsNoSettingOfStaticScenes) {
  const scene::Problem problem = scene::read_problem("patch_test_a", {});
  scene::RunRequest request;
  request.h = problem.reference_length / 2;
  request.settings = {{"start", "equilibrium"}};
  scene::Result result;
  EXPECT_THROW(scene::MethodRegistry::instance().find("delaunay").run(problem, request, result),
               InputError);
}

}  // namespace concord::particle
