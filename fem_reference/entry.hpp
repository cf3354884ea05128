#pragma once
// The symbols of libconcord_fem.so that the rest of the house calls.

#include "scene/discrete_body.hpp"

/// Runs `problem` with deal.II's finite elements. Throws what scene::Method::run throws; the
/// exceptions' types live in libconcord_scene.so, so they pass the library's boundary intact.
extern "C" void concord_fem_run(const concord::scene::Problem& problem,
                                const concord::scene::RunRequest& request,
                                concord::scene::Result& result);

/// The body of an explicit run; the caller owns it. Throws what scene::Discretises::discretise
/// throws.
extern "C" concord::scene::DiscreteBody*
concord_fem_discretise(const concord::scene::Problem& problem,
                       const concord::scene::RunRequest& request);
