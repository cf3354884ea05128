#pragma once
// Settings of method `calculix`, and what it can do.

#include "scene/method.hpp"

namespace concord::calculix {

struct Options {
  int steps = 1;  ///< load steps
  int hardening_points = 200;
  double tolerance = 1e-8;  ///< of CalculiX's residual and correction, relative
  bool keep_files = false;
};

const scene::MethodInfo& method_info();

/// Throws InputError for wrong settings and for whatever of the problem this method cannot do,
/// saying what it can.
Options read_options(const scene::Problem& problem, const scene::RunRequest& request);

}  // namespace concord::calculix
