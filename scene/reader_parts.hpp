#pragma once
// Steps of read_problem, in its order.

#include "scene/section.hpp"

namespace concord::scene {

/// What expressions of a scene know by name: parameters, material constants, L.
using Symbols = std::map<std::string, double>;

void read_head(const Section& scene, Problem& problem);
void read_material(const Section& scene, Problem& problem);
/// Fills problem.parameters and returns all that expressions know.
Symbols read_parameters(const Section& scene, Problem& problem);
void read_exact(const Section& scene, const Symbols& symbols, Problem& problem);
void read_boundaries(const Section& scene, const Symbols& symbols, Problem& problem);
void read_loads(const Section& scene, const Symbols& symbols, Problem& problem);
void read_initial(const Section& scene, const Symbols& symbols, Problem& problem);
/// After the material: fracture is for elastic ones.
void read_fracture(const Section& scene, const Symbols& symbols, Problem& problem);
void read_quantities(const Section& scene, Problem& problem);
void read_output(const Section& scene, Problem& problem);

/// Statements that do not go together: conditions of one group that contradict each other, a
/// static scene that nothing holds.
void check_statements(const Section& scene, const Problem& problem);

/// One expression a direction. In plane problems the third may be left out, or be zero or free.
/// `free` and `exact` say whether these words may stand for a component.
VectorExpression read_vector(const ConfigNode& node, const Symbols& symbols,
                             const Problem& problem, bool free, bool exact);

/// One quantity a direction; in plane problems the third may be left out, or be 0.
Vec3 read_vector_quantity(const ConfigNode& node, const UnitDimension& unit, int dim);

}  // namespace concord::scene
