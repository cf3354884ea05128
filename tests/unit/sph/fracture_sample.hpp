#pragma once
// A plate whose pairs can break, at a coarse spacing.

#include "sample.hpp"

#include "scene/reader.hpp"
#include "sph_reference/total_lagrangian/fracture.hpp"

namespace concord::sph {

inline scene::Problem plate(const std::vector<scene::Override>& more = {}) {
  std::vector<scene::Override> set{{"parameters.width", "20 mm"},
                                   {"parameters.crack", "10 mm"},
                                   {"parameters.strip", "4 mm"}};
  set.insert(set.end(), more.begin(), more.end());
  return scene::read_problem("pmma_plate", set);
}
inline Body body_of(const scene::Problem& problem) {
  return particle::make_body(problem, 0.5e-3, 0, 1);
}
inline scene::Problem whole_plate() {
  scene::Problem problem = plate();
  problem.fracture->cracks.clear();
  return problem;
}

inline FractureOptions breakable(PenaltyForm penalty = PenaltyForm::potential,
                                 SpringLayout springs = SpringLayout::edges,
                                 double beta = 0.5) {
  FractureOptions o;
  o.sph = options(0.07, penalty, 2.4);
  o.sph.local = true;
  o.springs = springs;
  o.beta = beta;
  return o;
}

/// Moves one particle so far to all sides that each of its springs breaks.
inline void damage(FracturingSph& model, const Body& body, Index lone) {
  for (int side = 0; side < 4; ++side) {
    Column u(body.X.size(), 0.0), v = u, f = u;
    u[2 * lone + side % 2] = (side < 2 ? 0.1 : -0.1) * body.h;
    model.advance(1e-6 * side, 1e-8, u, v, f, one_thread);
  }
}
inline constexpr Index lone = 300;

inline std::vector<Index> holding(const FracturingSph& model, Index a) {
  std::vector<Index> pairs;
  for (const Index p : model.springs().pairs_at(a)) {
    if (model.springs().holds(p)) pairs.push_back(p);
  }
  return pairs;
}

}  // namespace concord::sph
