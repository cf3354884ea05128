// A pre-crack that is a slit of the mesh: pmma_plate with parameters.slit = 1.

#include "particle/core/body.hpp"
#include "scene/reader.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <vector>

namespace concord::particle {
namespace {

constexpr double slit_width = 20e-3, slit_crack = 10e-3, slit_middle = 10e-3;  // [m]

/// The plate of Table 3, l_ref = 1/N mm.
Body slit_body(int N, bool slit = true) {
  const scene::Problem problem =
      scene::read_problem("pmma_plate", {{"parameters.width", "20 mm"},
                                         {"parameters.crack", "10 mm"},
                                         {"parameters.strip", "4 mm"},
                                         {"parameters.slit", slit ? "1" : "0"}});
  return make_body(problem, 1e-3 / N, 0, 1, CellSource::mesh);
}

bool on_slit(const Vec3& X) {
  return std::abs(X[1] - slit_middle) < 1e-9 * slit_width &&
         X[0] < slit_crack + 1e-9 * slit_width;
}

/// Particles on the slit's line, by place: x in units of 1e-9 of the width.
std::map<long, std::vector<Index>> places_of(const Body& body) {
  std::map<long, std::vector<Index>> places;
  for (Index a = 0; a < body.n; ++a) {
    const Vec3 X = body.position(a);
    if (on_slit(X)) places[std::lround(X[0] / (1e-9 * slit_width))].push_back(a);
  }
  return places;
}

}  // namespace

TEST(Slit, DoublesItsParticlesButTheTip) {
  const Body body = slit_body(4);
  const auto places = places_of(body);
  ASSERT_EQ(places.size(), 41U);  // 10 mm at 1/4 mm
  for (const auto& [place, particles] : places) {
    const bool tip = place == places.rbegin()->first;
    EXPECT_EQ(particles.size(), tip ? 1U : 2U) << "at x = " << place << "e-9 of the width";
    for (const Index a : particles) EXPECT_NE(body.triangulation.on_boundary[a], 0);
  }
  EXPECT_NEAR(body.position(places.rbegin()->second[0])[0], slit_crack, 1e-12);
}

// Of two particles at one place one has the triangles above, the other those below, so that no
// triangle, and no bond, goes from face to face.
TEST(Slit, NoBondGoesAcross) {
  const Body body = slit_body(4);
  std::map<Index, int> face;  // +1: triangles above have been seen at it
  const auto places = places_of(body);
  for (const auto& [place, particles] : places) {
    if (particles.size() == 2) face[particles[0]] = face[particles[1]] = 0;
  }
  for (std::size_t t = 0; t < body.triangulation.size(); ++t) {
    const Index* v = &body.triangulation.simplices[3 * t];
    double low = 1e9, high = -1e9;
    bool left = true;  // of the tip
    for (int k = 0; k < 3; ++k) {
      const Vec3 X = body.position(v[k]);
      low = std::min(low, X[1] - slit_middle);
      high = std::max(high, X[1] - slit_middle);
      left = left && X[0] < slit_crack - 1e-9;
    }
    if (left) EXPECT_FALSE(low < -1e-9 && high > 1e-9) << "triangle " << t << " goes across";
    const int side = high > 1e-9 ? 1 : -1;
    for (int k = 0; k < 3; ++k) {
      const auto found = face.find(v[k]);
      if (found == face.end()) continue;
      EXPECT_TRUE(found->second == 0 || found->second == side) << "both sides at " << v[k];
      found->second = side;
    }
  }
  for (const auto& [place, particles] : places) {
    if (particles.size() == 2)
      EXPECT_EQ(face[particles[0]] * face[particles[1]], -1) << "a face without triangles";
  }
}

// Without a slit the line has no particle twice: what the two tests above look at is there.
TEST(Slit, NoneWithoutIt) {
  for (const auto& [place, particles] : places_of(slit_body(4, false)))
    EXPECT_EQ(particles.size(), 1U);
}

// Table 3 gives the particles of a mesh; places are compared with it, since a slit doubles
// particles without making the mesh finer. 1/7 mm: the one that is furthest off.
TEST(Slit, PlacesAreAsManyAsThePapersParticles) {
  for (const auto& [N, paper] : {std::pair{4, 3487}, {7, 8293}}) {
    const Body body = slit_body(N);
    Index doubled = 0;
    for (const auto& [place, particles] : places_of(body))
      doubled += static_cast<Index>(particles.size()) - 1;
    EXPECT_EQ(doubled, 10 * N) << N;
    EXPECT_NEAR(body.n - doubled, paper, 0.015 * paper) << N;
  }
}

}  // namespace concord::particle
