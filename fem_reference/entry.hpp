#pragma once
// The one symbol of libconcord_fem.so that the rest of the house calls.

#include "scene/method.hpp"

/// Runs `problem` with deal.II's finite elements. Throws what scene::Method::run throws; the
/// exceptions' types live in libconcord_scene.so, so they pass the library's boundary intact.
extern "C" void concord_fem_run(const concord::scene::Problem& problem,
                                const concord::scene::RunRequest& request,
                                concord::scene::Result& result);
