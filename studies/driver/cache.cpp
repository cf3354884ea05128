#include "studies/driver/cache.hpp"

#include "scene/interrupt.hpp"
#include "scene/mesher.hpp"
#include "scene/output.hpp"
#include "studies/driver/code_hash.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <openssl/evp.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <map>

namespace concord::studies {
namespace fs = std::filesystem;

ContentHash::ContentHash() : m_context(EVP_MD_CTX_new()) {
  EVP_DigestInit_ex(static_cast<EVP_MD_CTX*>(m_context), EVP_sha256(), nullptr);
}

ContentHash::~ContentHash() { EVP_MD_CTX_free(static_cast<EVP_MD_CTX*>(m_context)); }

ContentHash& ContentHash::add(const std::string& piece) {
  auto* context = static_cast<EVP_MD_CTX*>(m_context);
  const std::string size = std::to_string(piece.size()) + ":";
  EVP_DigestUpdate(context, size.data(), size.size());
  EVP_DigestUpdate(context, piece.data(), piece.size());
  return *this;
}

ContentHash& ContentHash::add_file(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream)
    throw InputError({file.string()}, "file", "unreadable", "a file that can be read");
  auto* context = static_cast<EVP_MD_CTX*>(m_context);
  const std::string size = std::to_string(fs::file_size(file)) + ":";
  EVP_DigestUpdate(context, size.data(), size.size());
  std::vector<char> block(1 << 20);
  while (stream.read(block.data(), static_cast<std::streamsize>(block.size())),
         stream.gcount() > 0)
    EVP_DigestUpdate(context, block.data(), static_cast<std::size_t>(stream.gcount()));
  return *this;
}

std::string ContentHash::digits() {
  std::array<unsigned char, EVP_MAX_MD_SIZE> bytes{};
  unsigned int size = 0;
  EVP_DigestFinal_ex(static_cast<EVP_MD_CTX*>(m_context), bytes.data(), &size);
  std::string text;
  for (unsigned int i = 0; i < size; ++i) text += fmt::format("{:02x}", bytes[i]);
  return text;
}

namespace {

fs::path scene_library() {
  Dl_info info{};
  if (dladdr(reinterpret_cast<void*>(&scene::interrupted), &info) == 0 || !info.dli_fname)
    return fs::read_symlink("/proc/self/exe");
  return fs::canonical(info.dli_fname);
}

/// Hash of the code that computes a method, or probes it. The finite elements are a module of
/// their own; probes, the other methods and the sources that make and time runs are linked into
/// the program, which knows a hash of them.
std::string hash_code(const std::string& method, bool probe) {
  const fs::path library = scene_library();
  const fs::path module = library.parent_path() / "libconcord_fem.so";
  // Probes of any method may run finite elements to compare with.
  const bool fem = (method == "fem" || probe) && fs::exists(module);
  ContentHash hash;
  hash.add_file(library).add_file(scene::mesher_file());
  if (fem) hash.add_file(module);
  if (LinkedCode::hash().empty())
    hash.add_file("/proc/self/exe");
  else
    hash.add(LinkedCode::hash());
  return hash.digits();
}

}  // namespace

std::string build_hash(const std::string& method, bool probe) {
  // Binaries do not change while we run.
  static std::map<std::pair<std::string, bool>, std::string> known;
  auto& hash = known[{method, probe}];
  if (hash.empty()) hash = hash_code(method, probe);
  return hash;
}

bool build_unchanged(const std::string& method, bool probe) {
  return hash_code(method, probe) == build_hash(method, probe);
}

std::string cache_key(const scene::Problem& problem, const RunKey& run) {
  ContentHash hash;
  hash.add("run 1").add(problem.name).add(problem.normalised_text).add_file(problem.geometry);
  hash.add(run.entry->method);
  for (const auto& [key, value] : run.entry->set) hash.add(key).add(value);
  hash.add(fmt::format("perturb {} resolution {} seed {} frames {} timed {}",
                       run.entry->perturb, run.resolution, run.seed, run.frames, run.timed));
  const bool probe = !run.entry->probe.empty();
  if (probe) hash.add("probe").add(run.entry->probe);
  for (const auto& [key, value] : run.entry->options) hash.add(key).add(value);
  if (run.entry->repeats > 0) hash.add(fmt::format("repeats {}", run.entry->repeats));
  hash.add(build_hash(run.entry->method, probe));
  return hash.digits();
}

namespace {

nlohmann::json listing(const fs::path& folder) {
  nlohmann::json files = nlohmann::json::object();
  for (const auto& file : fs::recursive_directory_iterator(folder))
    if (file.is_regular_file() && file.path().filename() != "entry.json")
      files[fs::relative(file.path(), folder).string()] = file.file_size();
  return files;
}

bool sound(const fs::path& entry) {
  try {
    std::ifstream stream(entry / "entry.json");
    if (!stream || nlohmann::json::parse(stream) != listing(entry)) return false;
    std::ifstream summary(entry / "summary.json");
    return nlohmann::json::parse(summary).is_object();
  } catch (const std::exception&) {
    return false;  // unreadable: computed again
  }
}

}  // namespace

bool Cache::fetch(const std::string& key, const fs::path& target) const {
  const fs::path entry = m_folder / key;
  if (!fs::exists(entry)) return false;
  if (!sound(entry)) {
    fs::remove_all(entry);
    return false;
  }
  fs::remove_all(target);
  fs::create_directories(target);
  fs::copy(entry, target, fs::copy_options::recursive);
  fs::remove(target / "entry.json");
  return true;
}

void Cache::store(const std::string& key, const fs::path& source) const {
  const fs::path entry = m_folder / key;
  const fs::path draft = m_folder / fmt::format("{}.{}", key, ::getpid());
  fs::remove_all(draft);
  fs::create_directories(draft);
  fs::copy(source, draft, fs::copy_options::recursive);
  scene::write_file(draft / "entry.json", listing(draft).dump(1));
  fs::remove_all(entry);
  std::error_code taken;  // another process stored the same run: the same content
  fs::rename(draft, entry, taken);
  if (taken) fs::remove_all(draft);
}

fs::path build_home() {
  const char* home = std::getenv("CONCORD_HOME");
  return (home && *home ? fs::path(home) : fs::current_path()) / "build";
}

fs::path cache_folder() {
  const char* folder = std::getenv("CONCORD_CACHE");
  return folder && *folder ? fs::path(folder) : build_home() / "cache";
}

}  // namespace concord::studies
