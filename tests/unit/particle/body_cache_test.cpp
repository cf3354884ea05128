// Bodies kept on disk: what comes back is what was made, bit by bit, or it is made again.

#include "particle/core/body_cache.hpp"
#include "scene/reader.hpp"

#include <gtest/gtest.h>

#include <unistd.h>

#include <cstring>
#include <fstream>

namespace concord::particle {
namespace {

namespace fs = std::filesystem;

class Bodies : public testing::Test {
 protected:
  void SetUp() override {
    m_folder = fs::path(testing::TempDir()) / ("concord-bodies-" + std::to_string(::getpid()));
    fs::remove_all(m_folder);
  }
  void TearDown() override { fs::remove_all(m_folder); }

  static Body made(double perturb = 0.25, CellSource cells = CellSource::delaunay) {
    return make_body(block(), 0.25, perturb, 7, cells);
  }
  static const scene::Problem& block() {
    static const scene::Problem problem = scene::read_problem("spinning_block");
    return problem;
  }
  static constexpr Arrangement wanted{0.25, 0.25, 7, CellSource::delaunay};
  fs::path m_folder;
};

TEST_F(Bodies, ComeBackBitByBit) {
  const BodyCache cache(m_folder);
  for (const CellSource cells : {CellSource::delaunay, CellSource::mesh}) {
    const Body body = made(0.1, cells);
    cache.store("k", body, 1.5);
    Body back;
    double made_s = 0;
    ASSERT_TRUE(cache.fetch("k", back, made_s));
    EXPECT_EQ(made_s, 1.5);
    EXPECT_EQ(back.node, body.node);
    EXPECT_EQ(back.triangulation.simplices, body.triangulation.simplices);
    EXPECT_EQ(back.triangulation.boundary, body.triangulation.boundary);
    EXPECT_EQ(back.triangulation.boundary_entity, body.triangulation.boundary_entity);
    EXPECT_EQ(back.triangulation.on_boundary, body.triangulation.on_boundary);
    ASSERT_EQ(back.mesh.nodes.size(), body.mesh.nodes.size());
    EXPECT_EQ(std::memcmp(back.mesh.nodes.data(), body.mesh.nodes.data(),
                          body.mesh.nodes.size() * sizeof(Vec3)),
              0);
    EXPECT_EQ(back.mesh.cells, body.mesh.cells);
    EXPECT_EQ(back.mesh.facets, body.mesh.facets);
    EXPECT_EQ(back.mesh.facet_entity, body.mesh.facet_entity);
    EXPECT_EQ(back.mesh.node_entity, body.mesh.node_entity);
    ASSERT_EQ(back.mesh.groups.size(), body.mesh.groups.size());
    for (const auto& [name, group] : body.mesh.groups) {
      EXPECT_EQ(back.mesh.groups.at(name).dim, group.dim);
      EXPECT_EQ(back.mesh.groups.at(name).entities, group.entities);
    }
    ASSERT_EQ(back.mesh.entities.size(), body.mesh.entities.size());
    for (std::size_t e = 0; e < body.mesh.entities.size(); ++e) {
      EXPECT_EQ(back.mesh.entities[e].axis, body.mesh.entities[e].axis);
      EXPECT_EQ(back.mesh.entities[e].closure, body.mesh.entities[e].closure);
    }
  }
}

TEST_F(Bodies, ThatAreCutOffOrDamagedAreMadeAgain) {
  const BodyCache cache(m_folder);
  const Body body = made();
  Body back;
  double made_s = 0;
  EXPECT_FALSE(cache.fetch("k", back, made_s));
  cache.store("k", body, 1);
  const auto size = fs::file_size(m_folder / "k");
  for (const auto cut : {size - 1, size / 2, std::uintmax_t{20}, std::uintmax_t{0}}) {
    cache.store("k", body, 1);
    fs::resize_file(m_folder / "k", cut);
    EXPECT_FALSE(cache.fetch("k", back, made_s)) << cut;
    EXPECT_FALSE(fs::exists(m_folder / "k"));
    EXPECT_TRUE(back.triangulation.simplices.empty());
  }
  for (const auto at : {size - 9, size / 2, std::uintmax_t{30}}) {
    cache.store("k", body, 1);
    std::fstream file(m_folder / "k", std::ios::in | std::ios::out | std::ios::binary);
    file.seekg(static_cast<std::streamoff>(at));
    const char changed = static_cast<char>(file.get() ^ 0x10);
    file.seekp(static_cast<std::streamoff>(at));
    file.put(changed);
    file.close();
    EXPECT_FALSE(cache.fetch("k", back, made_s)) << at;
  }
}

TEST_F(Bodies, AreNamedByEverythingThatDecidesThem) {
  const BodyCache cache(m_folder);
  const std::string base = cache.key(block(), wanted);
  EXPECT_EQ(cache.key(block(), wanted), base);
  EXPECT_NE(cache.key(block(), {0.2, 0.25, 7, CellSource::delaunay}), base);
  EXPECT_NE(cache.key(block(), {0.25, 0.2, 7, CellSource::delaunay}), base);
  EXPECT_NE(cache.key(block(), {0.25, 0.25, 8, CellSource::delaunay}), base);
  EXPECT_NE(cache.key(block(), {0.25, 0.25, 7, CellSource::mesh}), base);
  EXPECT_NE(cache.key(scene::read_problem("swinging_cube"), wanted), base);
  scene::Problem other = block();
  other.parameters["B"] = 3;
  EXPECT_NE(cache.key(other, wanted), base);
  other = block();
  other.layout = block().layout == scene::Layout::lattice ? scene::Layout::unstructured
                                                          : scene::Layout::lattice;
  EXPECT_NE(cache.key(other, wanted), base);
  other = block();
  other.dimension = Dimension::plane_strain;
  EXPECT_NE(cache.key(other, wanted), base);
  fs::create_directories(m_folder);
  other = block();
  other.geometry = m_folder / "body.geo";
  std::ofstream(other.geometry) << "Point(1) = {0, 0, 0};";
  const std::string own = cache.key(other, wanted);
  std::ofstream(other.geometry) << "Point(1) = {0, 0, 1};";
  EXPECT_NE(cache.key(other, wanted), own);
  for (const char* more :
       {"Include \"other.geo\";", "Merge \"other.step\";",
        "a() = ShapeFromFile(\"other.step\");", "a = GetEnv(\"A\");", "SystemCall \"make\";"}) {
    std::ofstream(other.geometry) << more;
    EXPECT_EQ(cache.key(other, wanted), "") << more;
  }
  other.geometry = m_folder / "absent.geo";
  EXPECT_EQ(cache.key(other, wanted), "");
}

TEST_F(Bodies, ThoseNotUsedForLongestGoFirst) {
  const Body body = made();
  BodyCache(m_folder).store("a", body, 1);
  const auto size = fs::file_size(m_folder / "a");
  const BodyCache cache(m_folder, 2 * size);
  cache.store("b", body, 1);
  const auto now = fs::file_time_type::clock::now();
  fs::last_write_time(m_folder / "a", now - std::chrono::hours(2));
  fs::last_write_time(m_folder / "b", now - std::chrono::hours(1));
  Body back;
  double made_s = 0;
  ASSERT_TRUE(cache.fetch("a", back, made_s));  // now the one used last
  cache.store("c", body, 1);
  EXPECT_TRUE(fs::exists(m_folder / "a"));
  EXPECT_FALSE(fs::exists(m_folder / "b"));
  EXPECT_TRUE(fs::exists(m_folder / "c"));
}

TEST_F(Bodies, FromTheCacheAreTheSameAndChecked) {
  // 90,000 particles take longer to make than the cache finds worthwhile.
  const auto make = [] { return make_body(block(), block().reference_length / 44, 0.25, 3); };
  const Body without = make();
  ASSERT_EQ(setenv("CONCORD_CACHE", m_folder.c_str(), 1), 0);
  const Body first = make(), second = make();
  unsetenv("CONCORD_CACHE");
  EXPECT_EQ(without.saved_s, 0);
  EXPECT_EQ(first.saved_s, 0);
  const bool kept = fs::exists(m_folder / "bodies");  // not on machines that are faster still
  EXPECT_EQ(second.saved_s > 0, kept);
  for (const Body* body : {&first, &second}) {
    EXPECT_EQ(body->triangulation.simplices, without.triangulation.simplices);
    EXPECT_EQ(body->X, without.X);
    EXPECT_EQ(body->V, without.V);
    EXPECT_EQ(body->m, without.m);
    EXPECT_EQ(body->particle, without.particle);
    EXPECT_EQ(body->h_min, without.h_min);
  }
}

}  // namespace
}  // namespace concord::particle
