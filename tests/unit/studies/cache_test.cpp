// The content hash against published digests, and entries that are whole, broken or absent.

#include "studies/driver/cache.hpp"

#include <gtest/gtest.h>

#include <fstream>

using namespace concord::studies;
namespace fs = std::filesystem;

namespace {

class CacheFolder : public testing::Test {
 protected:
  void SetUp() override {
    m_top = fs::path(testing::TempDir()) / ("concord-cache-" + std::to_string(::getpid()));
    fs::remove_all(m_top);
    fs::create_directories(m_top / "run" / "sub");
    std::ofstream(m_top / "run" / "summary.json") << "{\"h\": 1}";
    std::ofstream(m_top / "run" / "sub" / "frame") << "0123456789";
  }
  void TearDown() override { fs::remove_all(m_top); }
  fs::path m_top;
};

}  // namespace

// SHA-256 of "3:abc", whose pieces carry their length (value by coreutils' sha256sum).
TEST(ContentHash, IsSha256OfLengthAndText) {
  EXPECT_EQ(ContentHash().add("abc").digits(),
            "aab5f9ae99b2e38fb462025c8f72f570c9c811705d2a4277dc855d7fa293fe97");
  EXPECT_EQ(ContentHash().digits(),
            "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_NE(ContentHash().add("ab").add("c").digits(),
            ContentHash().add("a").add("bc").digits());
}

TEST(ContentHash, AFileIsItsBytes) {
  const fs::path file =
      fs::path(testing::TempDir()) / ("concord-hash-" + std::to_string(::getpid()));
  std::ofstream(file) << "abc";
  EXPECT_EQ(ContentHash().add_file(file).digits(), ContentHash().add("abc").digits());
  fs::remove(file);
  EXPECT_THROW(ContentHash().add_file(file), concord::InputError);
}

TEST_F(CacheFolder, GivesBackWhatWasStored) {
  const Cache cache(m_top / "cache");
  EXPECT_FALSE(cache.fetch("k", m_top / "back"));
  cache.store("k", m_top / "run");
  ASSERT_TRUE(cache.fetch("k", m_top / "back"));
  EXPECT_TRUE(fs::exists(m_top / "back" / "summary.json"));
  EXPECT_EQ(fs::file_size(m_top / "back" / "sub" / "frame"), 10u);
  EXPECT_FALSE(fs::exists(m_top / "back" / "entry.json"));
  EXPECT_FALSE(cache.fetch("other", m_top / "back"));
}

TEST_F(CacheFolder, ABrokenEntryIsComputedAgain) {
  const Cache cache(m_top / "cache");
  cache.store("k", m_top / "run");
  std::ofstream(m_top / "cache" / "k" / "sub" / "frame") << "cut";
  EXPECT_FALSE(cache.fetch("k", m_top / "back"));
  cache.store("k", m_top / "run");
  fs::remove(m_top / "cache" / "k" / "entry.json");
  EXPECT_FALSE(cache.fetch("k", m_top / "back"));
  cache.store("k", m_top / "run");
  std::ofstream(m_top / "cache" / "k" / "summary.json") << "{\"h\": 1";
  EXPECT_FALSE(cache.fetch("k", m_top / "back"));
  cache.store("k", m_top / "run");
  EXPECT_TRUE(cache.fetch("k", m_top / "back"));
}

// Probes of particle methods run finite elements to compare with, and runs of finite elements
// are made and timed by the program: all of these stand on the same code. Each hash had to
// differ from the others when it left one of the parts out.
TEST(BuildHash, OfProbesAndOfFiniteElementsHoldsAllTheCode) {
  EXPECT_EQ(build_hash("delaunay", true), build_hash("fem", true));
  EXPECT_EQ(build_hash("fem"), build_hash("fem", true));
  EXPECT_EQ(build_hash("delaunay"), build_hash("tlsph"));
}

TEST(CacheKey, ChangesWithEverythingThatDecidesTheRun) {
  const fs::path geometry =
      fs::path(testing::TempDir()) / ("concord-geo-" + std::to_string(::getpid()));
  std::ofstream(geometry) << "Point(1) = {0, 0, 0};";
  concord::scene::Problem problem;
  problem.name = "p";
  problem.normalised_text = "a";
  problem.geometry = geometry;
  Case entry;
  entry.method = "delaunay";
  const auto key = [&](double n, std::uint64_t seed, bool frames = false, bool timed = false) {
    return cache_key(problem, {&entry, n, seed, frames, timed});
  };
  const std::string base = key(4, 1);
  EXPECT_EQ(key(4, 1), base);
  EXPECT_NE(key(8, 1), base);
  EXPECT_NE(key(4, 2), base);
  EXPECT_NE(key(4, 1, true), base);
  EXPECT_NE(key(4, 1, false, true), base);
  entry.perturb = 0.25;
  EXPECT_NE(key(4, 1), base);
  entry.perturb = 0;
  entry.set["xi_n"] = "0";
  EXPECT_NE(key(4, 1), base);
  entry.set.clear();
  entry.repeats = 5;
  EXPECT_NE(key(4, 1), base);
  entry.repeats = 0;
  entry.probe = "spectrum";
  const std::string probe = key(4, 1);
  EXPECT_NE(probe, base);
  entry.options["xi"] = "1";
  EXPECT_NE(key(4, 1), probe);
  entry.options.clear();
  entry.probe.clear();
  problem.normalised_text = "b";
  EXPECT_NE(key(4, 1), base);
  problem.normalised_text = "a";
  EXPECT_EQ(key(4, 1), base);
  std::ofstream(geometry) << "Point(1) = {0, 0, 1};";
  EXPECT_NE(key(4, 1), base);
  fs::remove(geometry);
}
