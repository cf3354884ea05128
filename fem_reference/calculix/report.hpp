#pragma once
// From the states after load steps to history.csv, frames and the Result.

#include "fem_reference/calculix/quantities.hpp"
#include "scene/output.hpp"

namespace concord::calculix {

class Report {
 public:
  Report(const scene::Problem& problem, const scene::RunRequest& request,
         const scene::Mesh& mesh, const Quantities& quantities, scene::Result& result);
  /// A state, in the order of time: a row, a frame where one is due, the Result's quantities.
  /// Throws SolveError for a folded state.
  void add(const Record& record);
  /// Frame of the last state if it has none, and samples at quadrature points of degree 7 -
  /// dim.
  void finish();

 private:
  void frame(const Record& record, const NodalFields& fields);

  const scene::Problem& m_problem;
  const scene::Mesh& m_mesh;
  const Quantities& m_quantities;
  scene::Result& m_result;
  scene::HistoryWriter m_history;
  scene::FrameWriter m_frames;
  Record m_last;
  int m_frames_done = 0;
  double m_last_frame = -1;
  std::vector<Index> m_vtk_cells, m_vtk_offsets;
  std::vector<unsigned char> m_vtk_types;
};

}  // namespace concord::calculix
