#pragma once
// Lists of particles, bonds or simplices as sets.

#include <algorithm>
#include <vector>

namespace concord::particle {

/// Ascending, each once.
template <class T> void sort_unique(std::vector<T>& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

}  // namespace concord::particle
