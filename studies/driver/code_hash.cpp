#include "studies/driver/code_hash.hpp"

namespace concord::studies {
namespace {

std::string& linked() {
  static std::string hash;
  return hash;
}

}  // namespace

LinkedCode::LinkedCode(const std::string& hash) { linked() = hash; }

const std::string& LinkedCode::hash() { return linked(); }

}  // namespace concord::studies
