// The loops of rows.inc, compiled for each instruction set. target_clones will not do: g++ 12
// lowers vector expressions to the baseline before it clones, which makes stores and shuffles
// of every broadcast.

#include "sph_reference/total_lagrangian/loops.hpp"

#include "particle/core/elastic.hpp"

#include <algorithm>
#include <type_traits>

namespace concord::sph {

using particle::Lanes;
using particle::stress_width;
using particle::v2d;
using particle::v4d;
using particle::Vec;

#define SPH_TARGET
namespace baseline {
#include "sph_reference/total_lagrangian/rows.inc"
}
#undef SPH_TARGET

#if !defined(CONCORD_NO_CLONES) && defined(__x86_64__) && defined(__GNUC__) &&                 \
    !defined(__clang__)
#define SPH_WIDE 1
#define SPH_TARGET __attribute__((target("arch=x86-64-v3")))
namespace avx2 {
#include "sph_reference/total_lagrangian/rows.inc"
}
#undef SPH_TARGET
#define SPH_TARGET __attribute__((target("arch=x86-64-v4,prefer-vector-width=256")))
namespace avx512 {
#include "sph_reference/total_lagrangian/rows.inc"
}
#undef SPH_TARGET
#endif

Isa best_isa() {
#ifdef SPH_WIDE
  if (__builtin_cpu_supports("x86-64-v4")) return Isa::avx512;
  if (__builtin_cpu_supports("x86-64-v3")) return Isa::avx2;
#endif
  return Isa::baseline;
}

Loops choose_loops(int dim, StressLaw law, PenaltyForm penalty, bool viscous, Isa isa) {
#ifdef SPH_WIDE
  if (isa == Isa::avx512) return avx512::choose(dim, law, penalty, viscous);
  if (isa == Isa::avx2) return avx2::choose(dim, law, penalty, viscous);
#endif
  static_cast<void>(isa);
  return baseline::choose(dim, law, penalty, viscous);
}

ForceLoop choose_damping(int dim, Isa isa) {
#ifdef SPH_WIDE
  if (isa == Isa::avx512) return avx512::choose_damping(dim);
  if (isa == Isa::avx2) return avx2::choose_damping(dim);
#endif
  static_cast<void>(isa);
  return baseline::choose_damping(dim);
}

}  // namespace concord::sph
