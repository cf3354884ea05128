#pragma once
// Runs in a folder that can be stopped and gone on with, and comparisons of what they leave.

#include "scene/checkpoint.hpp"
#include "scene/frame_reader.hpp"
#include "tests/property/bodies.hpp"

#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <set>
#include <sstream>

namespace concord::particle::test {

namespace fs = std::filesystem;
using Settings = std::map<std::string, std::string>;

struct Case {
  std::string scene;
  double resolution;
  std::vector<scene::Override> set{};
  Settings settings{};
  double perturb = 0;
};

/// A folder of its own, gone at the end.
class Scratch {
 public:
  Scratch()
      : m_folder(fs::path(testing::TempDir()) /
                 ("concord-resume-" + std::to_string(getpid()))) {
    fs::remove_all(m_folder);
    fs::create_directories(m_folder);
  }
  ~Scratch() { fs::remove_all(m_folder); }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  fs::path operator/(const std::string& name) const { return m_folder / name; }

 private:
  fs::path m_folder;
};

/// A run in a folder, which can be stopped at a row or frame.
struct RunInFolder {
  const Case& what;
  const Variant& variant;
  fs::path out;
  std::function<void()> at_stop = [] { throw Interrupted(); };
  double interval = 30;

  /// Stops at the call number `stops` of the progress (-1: never). False where it was stopped.
  bool operator()(int threads, bool resume, int stops, scene::Result& result) const {
    const scene::Problem problem = scene::read_problem(what.scene, what.set);
    scene::RunRequest request;
    request.h = problem.reference_length / what.resolution;
    request.perturb = what.perturb;
    request.threads = threads;
    request.settings = variant.settings;
    for (const auto& [key, value] : what.settings) request.settings[key] = value;
    request.out = out;
    request.progress = [&](double, const std::string&) {
      if (--stops == 0) at_stop();
    };
    scene::Keeping keeping;
    keeping.file = out / "checkpoint.hdf";
    keeping.resume = resume;
    keeping.interval = interval;
    const auto& method = Bench::method_of(variant);
    try {
      method.run_kept(problem, request, keeping, result);
    } catch (const Interrupted&) {
      return false;
    }
    return true;
  }
};

inline std::string contents(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

template <class T> bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

inline void expect_same(const std::map<std::string, double>& a,
                        const std::map<std::string, double>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (const auto& [name, value] : a)
    EXPECT_EQ(std::memcmp(&value, &b.at(name), sizeof value), 0) << name;
}

inline void expect_same(const scene::Result& a, const scene::Result& b) {
  EXPECT_EQ(a.steps, b.steps);
  EXPECT_EQ(a.dt, b.dt);
  EXPECT_EQ(a.t_end, b.t_end);
  expect_same(a.quantities, b.quantities);
  expect_same(a.invariants, b.invariants);
  EXPECT_TRUE(same_bits(a.samples.u, b.samples.u));
  EXPECT_TRUE(same_bits(a.samples.v, b.samples.v));
  EXPECT_TRUE(same_bits(a.samples.F, b.samples.F));
}

inline std::set<std::string> files_in(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().filename() != "checkpoint.hdf")
      names.insert(entry.path().filename().string());
  }
  return names;
}

/// Text byte for byte, frames by their datasets.
inline void expect_same_files(const fs::path& a, const fs::path& b) {
  const std::set<std::string> names = files_in(a);
  EXPECT_EQ(names, files_in(b));
  for (const std::string& name : names) {
    if (fs::path(name).extension() != ".hdf") {
      EXPECT_EQ(contents(a / name), contents(b / name)) << name;
      continue;
    }
    const scene::Frame one = scene::read_frame(a / name), two = scene::read_frame(b / name);
    EXPECT_EQ(one.time, two.time) << name;
    EXPECT_TRUE(same_bits(one.points, two.points)) << name;
    ASSERT_EQ(one.fields.size(), two.fields.size()) << name;
    for (std::size_t k = 0; k < one.fields.size(); ++k)
      EXPECT_TRUE(same_bits(one.fields[k].values, two.fields[k].values))
          << name << " " << one.fields[k].name;
  }
}

}  // namespace concord::particle::test
