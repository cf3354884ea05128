// Blocks, and forces of parts of a body: the bits of the whole, nothing else touched or read.

#include "sample.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace concord::sph {
namespace {

struct Case {
  int dim;
  PenaltyForm penalty;
  double alpha;
  bool mirrored;
};

class Parts : public testing::TestWithParam<Case> {
 protected:
  /// 3600 or 4096 particles, cut into several blocks.
  Body body = GetParam().dim == 3 ? lattice(3, 16, 0.25) : lattice(2, 60, 0.25);
  TlsphOptions options_here() const {
    TlsphOptions o = options(0.2, GetParam().penalty, GetParam().dim == 3 ? 1.7 : 2.4);
    o.alpha = GetParam().alpha;
    // outside of all particles: none lies on it
    if (GetParam().mirrored) o.planes = {{0, -0.5 * body.h, false}};
    return o;
  }
  TotalLagrangianSph model{
      body, rubber(GetParam().dim == 3 ? Dimension::three_d : Dimension::plane_strain),
      options_here(), one_thread};
  Column u = random_column(body, 0.004, 1), v = random_column(body, 10, 2);
};

TEST_P(Parts, HaveTheBitsOfTheWhole) {
  ASSERT_TRUE(model.has_parts());
  const std::vector<Index>& blocks = model.neighbours().blocks;
  ASSERT_GE(blocks.size(), 5U);
  Column whole(u.size());
  model.forces(u, v, whole, one_thread);
  const std::vector<std::vector<particle::ParticleRange>> choices{
      {{0, body.n}},
      {{0, 1}},
      {{blocks[1], blocks[2]}},
      {{blocks[1] - 7, blocks[1] + 5}, {blocks[3] + 1, body.n}}};
  for (const int threads : {1, 2}) {
    const Executor executor(threads);
    for (const auto& parts : choices) {
      Column f(u.size(), 3.5);
      model.forces_of(parts, u, v, f, executor);
      Column expected(u.size(), 3.5);
      for (const auto& part : parts) {
        for (Index i = part.first * body.stride; i < part.last * body.stride; ++i)
          expected[i] = whole[i];
      }
      EXPECT_EQ(f, expected);
    }
  }
}

TEST_P(Parts, ReadNothingBeyondTheirReach) {
  if (GetParam().mirrored) return;  // images beyond reach are moved, though nobody reads them
  const particle::ParticleRange part{3, 40}, reach = model.reach(part);
  EXPECT_LE(reach.first, part.first);
  EXPECT_GE(reach.last, part.last);
  EXPECT_LT(reach.last, body.n);
  Column whole(u.size()), f(u.size());
  model.forces(u, v, whole, one_thread);
  for (Index i = reach.last * body.stride; i < body.n * body.stride; ++i)
    u[i] = v[i] = std::numeric_limits<double>::quiet_NaN();
  model.forces_of(std::vector{part}, u, v, f, one_thread);
  for (Index i = part.first * body.stride; i < part.last * body.stride; ++i)
    EXPECT_EQ(f[i], whole[i]);
}

TEST_P(Parts, PairsOfABlockStandOnce) {
  const Neighbours& rows = model.neighbours();
  std::size_t block = 0, both = 0;
  for (Index a = 0; a < body.n; ++a) {
    while (a >= rows.blocks[block + 1]) ++block;
    for (std::size_t k = rows.begin[a]; k < rows.begin[a + 1]; ++k) {
      const Index b = rows.other[k];
      const bool within = b >= rows.blocks[block] && b < rows.blocks[block + 1];
      EXPECT_EQ(within, k < rows.cut[a]);
      if (within) {
        EXPECT_GT(b, a);
        ++both;
      }
      const Index source = model.points().source(b);
      EXPECT_TRUE(source >= rows.lowest[block] && source <= rows.highest[block]);
    }
  }
  EXPECT_EQ(rows.directed, rows.begin.back() + both);
}

using enum PenaltyForm;
INSTANTIATE_TEST_SUITE_P(
    Options, Parts,
    testing::Values(Case{2, none, 0, false}, Case{2, ganzenmueller, 0.5, false},
                    Case{2, potential, 0, false}, Case{2, potential, 0.5, true},
                    Case{3, ganzenmueller, 0, true}, Case{3, ganzenmueller, 0, false}));

}  // namespace
}  // namespace concord::sph
