#pragma once
// What can be compiled out, for tests/instructions alone: there, a step with a feature switched
// off is counted against one built without it. The program itself is built with all of them.
// For conditions in functions of one source file: `if (features::contact && m_contact)`.

namespace concord::particle::features {

#ifdef CONCORD_WITHOUT_CONTACT
constexpr bool contact = false;
#else
constexpr bool contact = true;     ///< contact stabilisation of the Delaunay method
#endif

#ifdef CONCORD_WITHOUT_VISCOSITY
constexpr bool viscosity = false;
#else
constexpr bool viscosity = true;   ///< artificial viscosity, of every method
#endif

#ifdef CONCORD_WITHOUT_PLASTICITY
constexpr bool plasticity = false;
#else
constexpr bool plasticity = true;  ///< materials with history
#endif

#ifdef CONCORD_WITHOUT_RETURN_MAP
constexpr bool return_map = false;
#else
constexpr bool return_map = true;  ///< plastic flow of materials with history
#endif

#ifdef CONCORD_WITHOUT_DAMPING
constexpr bool damping = false;
#else
constexpr bool damping = true;     ///< mass-proportional damping
#endif

#ifdef CONCORD_WITHOUT_OUTPUT
constexpr bool output = false;
#else
constexpr bool output = true;      ///< history rows and frames during a run
#endif

#ifdef CONCORD_WITHOUT_REST
constexpr bool rest = false;
#else
constexpr bool rest = true;        ///< regions at rest left out of the step
#endif

#ifdef CONCORD_WITHOUT_FRACTURE
constexpr bool fracture = false;
#else
constexpr bool fracture = true;    ///< bonds that can break
#endif

#ifdef CONCORD_WITHOUT_PENALTY
constexpr bool penalty = false;
#else
constexpr bool penalty = true;     ///< penalty stabilisation of SPH
#endif

}  // namespace concord::particle::features
