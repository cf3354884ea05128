#include "particle/core/body_cache.hpp"

#include "scene/interrupt.hpp"
#include "scene/mesher.hpp"

#include <dlfcn.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>

#include <fmt/format.h>

namespace concord::particle {
namespace fs = std::filesystem;
namespace {

/// FNV-1a (Fowler, Noll, Vo; RFC 9923) from two offset bases: 128 bits, to tell contents apart,
/// not to guard against forgery.
class Fnv {
 public:
  void add(const void* data, std::size_t size) {
    const auto* byte = static_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < size; ++i) {
      m_first = (m_first ^ byte[i]) * prime;
      m_second = (m_second ^ byte[i]) * prime;
    }
  }
  void add(const std::string& text) {
    const std::uint64_t size = text.size();
    add(&size, sizeof size);
    add(text.data(), text.size());
  }
  std::string digits() const { return fmt::format("{:016x}{:016x}", m_first, m_second); }

 private:
  static constexpr std::uint64_t prime = 0x100000001b3;
  std::uint64_t m_first = 0xcbf29ce484222325, m_second = 0x9e3779b97f4a7c15;
};

/// Bytes of a file; none if it cannot be read.
std::optional<std::string> contents(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::stringstream text;
  if (!(text << stream.rdbuf()) || !stream) return {};
  return text.str();
}

fs::path scene_library() {
  Dl_info info{};
  if (dladdr(reinterpret_cast<void*>(&scene::interrupted), &info) == 0 || !info.dli_fname)
    return {};
  return info.dli_fname;
}

/// Hash of the program, the scene library and its mesher, read once; none if they cannot be.
const std::optional<std::string>& maker() {
  static const std::optional<std::string> digits = []() -> std::optional<std::string> {
    const auto library = contents(scene_library()), mesher = contents(scene::mesher_file()),
               program = contents("/proc/self/exe");
    if (!library || !mesher || !program) return {};
    Fnv hash;
    hash.add(*library);
    hash.add(*mesher);
    hash.add(*program);
    return hash.digits();
  }();
  return digits;
}

/// Whether a .geo reads other files, runs a program or asks the environment.
bool reads_more(const std::string& geometry) {
  constexpr std::array words{"Include",   "Merge",          "SystemCall",  "System Call",
                             "FileName",  "ShapeFromFile",  "CommandLine", "GetEnv",
                             "OnelabRun", "ExternalProcess"};
  return std::any_of(words.begin(), words.end(), [&](const char* word) {
    return geometry.find(word) != std::string::npos;
  });
}

constexpr std::uint64_t file_mark = 0x31594444424e4f43;  // "CONBDDY1"

/// Sum of what is written, eight bytes at a time: a cut or a changed byte changes it.
class Checksum {
 public:
  void add(const void* data, std::size_t size) {
    const auto* byte = static_cast<const char*>(data);
    for (std::size_t i = 0; i < size; i += 8) {
      std::uint64_t word = 0;
      std::memcpy(&word, byte + i, std::min<std::size_t>(8, size - i));
      m_sum = (m_sum ^ word) * 0x9e3779b97f4a7c15;
      m_sum ^= m_sum >> 29;
    }
  }
  std::uint64_t value() const { return m_sum; }

 private:
  std::uint64_t m_sum = 1;
};

struct Writer {
  std::ofstream stream;
  Checksum sum;

  void bytes(const void* data, std::size_t size) {
    stream.write(static_cast<const char*>(data), static_cast<std::streamsize>(size));
    sum.add(data, size);
  }
  template <class T> void value(T& v) { bytes(&v, sizeof v); }
  template <class T> void list(std::vector<T>& v) {
    std::uint64_t size = v.size();
    value(size);
    bytes(v.data(), size * sizeof(T));
  }
  void check_count(std::uint64_t, std::size_t) const {}
  void text(std::string& t) {
    std::vector<char> letters(t.begin(), t.end());
    list(letters);
  }
};

/// Reads what Writer wrote; throws std::ios_base::failure at the file's end.
struct Reader {
  std::ifstream stream;
  std::uint64_t size = 0;  ///< of the file: no list is longer
  Checksum sum;

  void bytes(void* data, std::size_t count) {
    stream.read(static_cast<char*>(data), static_cast<std::streamsize>(count));
    if (!stream) throw std::ios_base::failure("cut off");
    sum.add(data, count);
  }
  template <class T> void value(T& v) { bytes(&v, sizeof v); }
  void check_count(std::uint64_t count, std::size_t bytes_each) const {
    if (count > size / bytes_each) throw std::ios_base::failure("damaged");
  }
  template <class T> void list(std::vector<T>& v) {
    std::uint64_t count = 0;
    value(count);
    check_count(count, sizeof(T));
    v.resize(count);
    bytes(v.data(), count * sizeof(T));
  }
  void text(std::string& t) {
    std::vector<char> letters;
    list(letters);
    t.assign(letters.begin(), letters.end());
  }
};

template <class File> void transfer(File& file, scene::Entity& e) {
  file.value(e.dim);
  file.value(e.tag);
  file.value(e.flat);
  file.value(e.axis);
  file.list(e.closure);
}

template <class File> void transfer(File& file, scene::Mesh& mesh) {
  file.value(mesh.dim);
  file.value(mesh.shape);
  file.value(mesh.order);
  file.value(mesh.h);
  file.list(mesh.nodes);
  std::uint64_t entities = mesh.entities.size(), groups = mesh.groups.size();
  file.value(entities);
  file.check_count(entities, sizeof(std::uint64_t));  // of each one's closure
  mesh.entities.resize(entities);
  for (scene::Entity& e : mesh.entities) transfer(file, e);
  file.list(mesh.node_entity);
  file.value(mesh.nodes_per_cell);
  file.list(mesh.cells);
  file.value(mesh.nodes_per_facet);
  file.list(mesh.facets);
  file.list(mesh.facet_entity);
  file.value(groups);
  auto group = mesh.groups.begin();
  for (std::uint64_t k = 0; k < groups; ++k) {
    std::string name = group == mesh.groups.end() ? "" : group->first;
    scene::Mesh::Group members =
        group == mesh.groups.end() ? scene::Mesh::Group{} : group++->second;
    file.text(name);
    file.value(members.dim);
    file.list(members.entities);
    mesh.groups.insert_or_assign(name, members);
  }
}

template <class File> void transfer(File& file, Body& body, double& made_s) {
  file.value(made_s);
  transfer(file, body.mesh);
  file.list(body.node);
  Triangulation& t = body.triangulation;
  file.value(t.dim);
  file.list(t.simplices);
  file.list(t.boundary);
  file.list(t.boundary_entity);
  file.list(t.on_boundary);
}

}  // namespace

std::optional<BodyCache> BodyCache::from_environment() {
  const char* folder = std::getenv("CONCORD_CACHE");
  if (folder == nullptr || *folder == 0) return {};
  return BodyCache(fs::path(folder) / "bodies");
}

std::string BodyCache::key(const scene::Problem& problem, const Arrangement& wanted) const {
  const auto geometry = contents(problem.geometry);
  if (!geometry || reads_more(*geometry) || !maker()) return "";
  Fnv hash;
  hash.add("body 1");
  hash.add(*geometry);
  for (const auto& [name, value] : problem.parameters)
    hash.add(fmt::format("{} = {:.17g}", name, value));
  hash.add(fmt::format("dimension {} layout {} h {:.17g} perturb {:.17g} seed {} cells {}",
                       problem.dim(), static_cast<int>(problem.layout), wanted.h,
                       wanted.perturb, wanted.seed, static_cast<int>(wanted.cells)));
  hash.add(scene::mesher_version());
  hash.add(*maker());
  return hash.digits();
}

bool BodyCache::fetch(const std::string& key, Body& body, double& made_s) const {
  const fs::path file = m_folder / key;
  std::error_code absent;
  Reader reader{std::ifstream(file, std::ios::binary), fs::file_size(file, absent), {}};
  if (absent || !reader.stream) return false;
  try {
    std::uint64_t mark = 0, expected = 0;
    reader.value(mark);
    if (mark != file_mark) throw std::ios_base::failure("of another kind");
    transfer(reader, body, made_s);
    const std::uint64_t found = reader.sum.value();
    reader.value(expected);
    if (found != expected) throw std::ios_base::failure("damaged");
  } catch (const std::exception&) {  // made again
    body = Body();
    fs::remove(file, absent);
    return false;
  }
  fs::last_write_time(file, fs::file_time_type::clock::now(), absent);  // used just now
  return true;
}

void BodyCache::store(const std::string& key, const Body& body, double made_s) const {
  std::error_code failed;  // a cache that cannot be written is no reason to stop
  fs::create_directories(m_folder, failed);
  static std::atomic<unsigned> drafts{0};
  const fs::path draft = m_folder / fmt::format("{}.{}.{}", key, ::getpid(), ++drafts);
  Writer writer{std::ofstream(draft, std::ios::binary), {}};
  std::uint64_t mark = file_mark;
  writer.value(mark);
  transfer(writer, const_cast<Body&>(body), made_s);  // a writer reads only
  std::uint64_t sum = writer.sum.value();
  writer.value(sum);
  writer.stream.close();
  if (writer.stream) fs::rename(draft, m_folder / key, failed);
  if (!writer.stream || failed) fs::remove(draft, failed);
  make_room();
}

void BodyCache::make_room() const {
  struct File {
    fs::path path;
    fs::file_time_type used;
    std::uintmax_t size;
  };
  std::vector<File> files;
  std::uintmax_t total = 0;
  std::error_code gone;  // by the hand of another process
  fs::directory_iterator entry(m_folder, gone);
  for (; !gone && entry != fs::directory_iterator(); entry.increment(gone)) {
    std::error_code of_time, of_size;
    const File file{entry->path(), entry->last_write_time(of_time), entry->file_size(of_size)};
    if (of_time || of_size) continue;
    files.push_back(file);
    total += file.size;
  }
  std::sort(files.begin(), files.end(),
            [](const File& p, const File& q) { return p.used < q.used; });
  for (const File& file : files) {
    if (total <= m_limit) return;
    fs::remove(file.path, gone);
    total -= file.size;
  }
}

}  // namespace concord::particle
