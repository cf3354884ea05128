#pragma once
// The input deck of CalculiX: mesh, material, prescribed motion, what to print.

#include "fem_reference/calculix/hardening.hpp"
#include "fem_reference/calculix/options.hpp"
#include "scene/geometry.hpp"

#include <string>
#include <vector>

namespace concord::calculix {

/// A prescribed component: its value at load step k is reference * histories[history][k].
struct Prescribed {
  Index node = 0;
  int component = 0;
  double reference = 0;  ///< [m]; 0: held at zero, no history
  std::size_t history = 0;
};

/// Prescribed motion of all nodes; components that move in proportion share a history.
struct Motion {
  std::vector<Prescribed> entries;
  std::vector<std::vector<double>> histories;  ///< at t = k/steps, k = 0..steps
};
Motion prescribed_motion(const scene::Problem& problem, const scene::Mesh& mesh, int steps);

/// Nodes whose reaction forces are summed, under the name R0, R1, ...
using NodeSets = std::vector<std::vector<Index>>;

/// The deck as text. Nodes and elements count from 1. At every load step it asks for
/// displacements, sums of reaction forces of the sets and plastic strains at integration points
/// (.dat), and for stresses and plastic strains at nodes (.frd).
std::string deck_text(const scene::Problem& problem, const scene::Mesh& mesh,
                      const Options& options, const Motion& motion, const NodeSets& reactions,
                      const HardeningTable& hardening);

}  // namespace concord::calculix
