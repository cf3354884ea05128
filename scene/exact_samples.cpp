#include "scene/exact_samples.hpp"

#include "scene/crc64.hpp"
#include "scene/errors.hpp"
#include "scene/mesher.hpp"
#include "scene/safe_file.hpp"

#include <dlfcn.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <fmt/format.h>

namespace concord::scene {
namespace fs = std::filesystem;
namespace {

constexpr std::uintmax_t most_bytes =
    500'000'000;                   // of all samples kept: some thirty bodies in space
constexpr std::size_t width = 16;  // doubles a point: X, weight, u, gradient

std::vector<char> whole(const fs::path& file) { return read_bytes(file, fs::file_size(file)); }

/// Checksum of the libraries that compute the samples.
std::uint64_t maker() {
  Dl_info info{};
  if (dladdr(reinterpret_cast<void*>(&exact_samples), &info) == 0 || info.dli_fname == nullptr)
    throw std::runtime_error("no library");
  return crc64(whole(mesher_file()), crc64(whole(info.dli_fname)));
}

/// Everything that the samples depend on.
std::string identity(const Problem& problem, double t) {
  static const std::uint64_t library = maker();
  return fmt::format("exact 1\nt {:.17g} libraries {:016x} gmsh {}\n", t, library,
                     mesher_version()) +
         problem.normalised_text;
}

ExactSamples compute(const Problem& problem, double t) {
  ExactSamples s;
  s.rule = common_quadrature(problem);
  for (const Vec3& X : s.rule.points) {
    s.u.push_back((*problem.exact_displacement)(X, t));
    s.gradient.push_back(problem.exact_gradient(X, t));
  }
  return s;
}

/// Width values a point, one point after the other.
std::vector<double> pack(const ExactSamples& s) {
  std::vector<double> values;
  values.reserve(width * s.u.size());
  for (std::size_t q = 0; q < s.u.size(); ++q) {
    const auto add = [&](const auto& v) { values.insert(values.end(), v.begin(), v.end()); };
    add(s.rule.points[q]);
    values.push_back(s.rule.weights[q]);
    add(s.u[q]);
    add(s.gradient[q].reshaped());
  }
  return values;
}

ExactSamples unpack(const std::vector<double>& values) {
  ExactSamples s;
  for (const double* v = values.data(); v < values.data() + values.size(); v += width) {
    s.rule.points.emplace_back(v);
    s.rule.weights.push_back(v[3]);
    s.u.emplace_back(v + 4);
    s.gradient.emplace_back(v + 7);
  }
  return s;
}

/// What `file` holds, if it is that of this identity and whole. Throws if it cannot be read.
std::vector<double> read(const fs::path& file, const std::string& identity) {
  const std::vector<char> bytes = whole(file);
  const std::size_t head = identity.size() + sizeof(std::uint64_t);
  std::uint64_t sum = 0;
  if (bytes.size() <= head || (bytes.size() - head) % (width * sizeof(double)) != 0 ||
      std::memcmp(bytes.data(), identity.data(), identity.size()) != 0)
    return {};
  std::vector<double> values((bytes.size() - head) / sizeof(double));
  std::memcpy(&sum, bytes.data() + identity.size(), sizeof sum);
  std::memcpy(values.data(), bytes.data() + head, bytes.size() - head);
  return crc64_of(values) == sum ? values : std::vector<double>();
}

/// Removes the oldest files of a folder until the others are within most_bytes.
void make_room(const fs::path& folder) {
  std::vector<std::pair<fs::file_time_type, fs::path>> files;
  std::error_code gone;  // another process may do the same
  for (const auto& file : fs::directory_iterator(folder))
    files.emplace_back(file.last_write_time(gone), file.path());
  std::sort(files.rbegin(), files.rend());  // newest first
  std::uintmax_t bytes = 0;
  for (const auto& [time, file] : files) {
    const std::uintmax_t size = fs::file_size(file, gone);
    if (!gone) bytes += size;
    if (bytes > most_bytes) fs::remove(file, gone);
  }
}

void keep(const fs::path& file, const std::string& identity, const ExactSamples& s) {
  const std::vector<double> values = pack(s);
  const std::uint64_t sum = crc64_of(values);
  fs::create_directories(file.parent_path());
  write_whole(file,
              {identity,
               {reinterpret_cast<const char*>(&sum), sizeof sum},
               {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double)}},
              Reach::system);
  make_room(file.parent_path());
}

}  // namespace

ExactSamples exact_samples(const Problem& problem, double t) {
  const char* folder = std::getenv("CONCORD_CACHE");
  if (folder == nullptr || *folder == 0) return compute(problem, t);
  std::string known;
  fs::path file;
  try {
    known = identity(problem, t);
    file = fs::path(folder) / "exact" / fmt::format("{:016x}", crc64(known));
    if (const std::vector<double> values = read(file, known); !values.empty())
      return unpack(values);
  } catch (const std::exception&) {  // not there, or not to be read: made anew
  }
  ExactSamples made = compute(problem, t);
  try {
    if (!file.empty()) keep(file, known, made);
  } catch (const std::exception&) {  // a cache that cannot be written costs time alone
  }
  return made;
}

}  // namespace concord::scene
