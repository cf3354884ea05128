#pragma once
// What a solver shows of itself to those who write it down.

#include "particle/core/body.hpp"

#include <span>

namespace concord::particle {

/// A state at one instant. Columns of `stride` doubles a particle.
struct State {
  double t = 0;
  std::span<const double> u, v;  ///< displacement, velocity at the same instant
  std::span<const double>
      unbalanced;  ///< internal + external force, prescribed components included
  std::span<const double> acceleration;  ///< empty in static runs
  double external_work = 0;     ///< done since the start by loads and prescribed motion [J]
  double dissipation = 0;       ///< taken since the start by viscosity and mass damping [J]
  double released = 0;          ///< taken since the start by the deletion of bonds [J]
  Vec3 impulse = Vec3::Zero();  ///< of the loads that never change, since the start [kg m/s]
};

/// Vector of a particle in a column; zero for an empty one.
inline Vec3 column_vector(std::span<const double> column, const Body& body, Index a) {
  Vec3 r = Vec3::Zero();
  if (column.empty()) return r;
  for (int i = 0; i < body.dim; ++i)
    r[i] = column[static_cast<std::size_t>(a) * body.stride + i];
  return r;
}

}  // namespace concord::particle
