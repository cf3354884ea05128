// Names the registered methods and computes one static patch test, as a user of the package
// would.

#include "scene/method.hpp"
#include "scene/reader.hpp"

#include <iostream>

int main() {
  const auto problem = concord::scene::read_problem("patch_test_a");
  std::string names;
  for (const auto* method : concord::scene::MethodRegistry::instance().all())
    names += (names.empty() ? "" : " ") + method->info().name;
  std::cout << names << '\n';
  concord::scene::RunRequest request;
  request.h = problem.reference_length / 3;
  concord::scene::Result result;
  concord::scene::MethodRegistry::instance().find("delaunay").run(problem, request, result);
  return result.particles == 64 ? 0 : 1;
}
