#pragma once
// The state of the body after every load step, from the files that CalculiX wrote.

#include "scene/geometry.hpp"

#include <array>
#include <filesystem>
#include <vector>

namespace concord::calculix {

/// State at one load step. Nodal values in the mesh's order of nodes.
struct Record {
  double t = 0;
  std::vector<Vec3> u;                 ///< [m]
  std::vector<Vec3> reactions;         ///< of the sets R0, R1, ... [N]
  std::vector<Mat3> stress;            ///< Cauchy, extrapolated and averaged by CalculiX [Pa]
  std::vector<double> plastic_strain;  ///< likewise; empty for elastic materials
  double gauss_plastic_strain_max = 0;
};

struct RecordRequest {
  int steps = 1;
  std::size_t reactions = 0;  ///< number of sets
  bool plastic = false;
  double t_reached = 1;  ///< later tables are of increments that did not converge
};

/// Undeformed state.
Record zero_record(const scene::Mesh& mesh, const RecordRequest& request);

/// Load steps 1, 2, ... as far as the files job.dat and job.frd in `folder` hold all of a
/// step. Throws SolveError for files that are not CalculiX's.
std::vector<Record> read_records(const std::filesystem::path& folder, const scene::Mesh& mesh,
                                 const RecordRequest& request);

}  // namespace concord::calculix
