#include "fem_reference/calculix/report.hpp"

#include "fem_reference/calculix/simplex.hpp"

namespace concord::calculix {
namespace {

std::span<const double> flat(const std::vector<Vec3>& values) {
  return {values.front().data(), 3 * values.size()};
}

}  // namespace

Report::Report(const scene::Problem& problem, const scene::RunRequest& request,
               const scene::Mesh& mesh, const Quantities& quantities, scene::Result& result)
    : m_problem(problem), m_mesh(mesh), m_quantities(quantities), m_result(result) {
  if (request.out.empty()) return;
  std::vector<std::string> columns{"t_s"};
  columns.insert(columns.end(), quantities.columns().begin(), quantities.columns().end());
  m_history = scene::HistoryWriter(request.out / "history.csv", columns);
  if (!request.write_frames) return;
  m_frames = scene::FrameWriter(request.out);
  // VTK's order of nodes is CalculiX's (VTK file formats, quadratic cells 22 and 24).
  const std::vector<int> order = QuadraticSimplex(mesh.dim).calculix_order();
  m_vtk_offsets.push_back(0);
  for (std::size_t c = 0; c < mesh.cell_count(); ++c) {
    for (const int k : order)
      m_vtk_cells.push_back(mesh.cells[c * order.size() + static_cast<std::size_t>(k)]);
    m_vtk_offsets.push_back(static_cast<Index>(m_vtk_cells.size()));
    m_vtk_types.push_back(mesh.dim == 2 ? 22 : 24);
  }
}

void Report::add(const Record& record) {
  const NodalFields fields = nodal_fields(m_mesh, record);
  const std::vector<double> values = m_quantities.evaluate(record, fields);
  std::vector<double> row{record.t};
  row.insert(row.end(), values.begin(), values.end());
  m_history.append(row);
  for (std::size_t k = 0; k < values.size(); ++k)
    m_result.quantities[m_quantities.keys()[k]] = values[k];
  m_result.t_end = record.t;
  m_last = record;
  const int count = m_problem.frames;
  const auto due = [&] {
    return count > 0 && record.t >= static_cast<double>(m_frames_done) / count - 5e-10;
  };
  if (!due()) return;
  frame(record, fields);
  while (due()) ++m_frames_done;
}

void Report::frame(const Record& record, const NodalFields& fields) {
  m_last_frame = record.t;
  if (!m_frames.active()) return;
  std::vector<Vec3> x = m_mesh.nodes, error;
  for (std::size_t n = 0; n < x.size(); ++n) {
    if (m_problem.exact_displacement)
      error.push_back(record.u[n] - (*m_problem.exact_displacement)(x[n], record.t));
    x[n] += record.u[n];
  }
  std::vector<scene::FrameField> frame_fields{{"displacement", 3, flat(record.u)},
                                              {"von_mises", 1, fields.von_mises}};
  if (m_problem.material.plastic()) {
    frame_fields.push_back({"kirchhoff_mises", 1, fields.kirchhoff_mises});
    frame_fields.push_back({"plastic_strain", 1, record.plastic_strain});
  }
  if (!error.empty()) frame_fields.push_back({"displacement_error", 3, flat(error)});
  m_frames.write(record.t, x, frame_fields, m_vtk_cells, m_vtk_offsets, m_vtk_types);
}

void Report::finish() {
  if (m_last.u.empty()) return;
  if (m_last_frame < m_last.t) frame(m_last, nodal_fields(m_mesh, m_last));
  const QuadraticSimplex shape(m_mesh.dim);
  const SimplexRule rule(m_mesh.dim);
  scene::Samples samples;
  for (std::size_t c = 0; c < m_mesh.cell_count(); ++c) {
    const Index* nodes = &m_mesh.cells[c * static_cast<std::size_t>(m_mesh.nodes_per_cell)];
    for (std::size_t k = 0; k < rule.points.size(); ++k) {
      const CellPoint p = evaluate(m_mesh, shape, nodes, m_last.u, rule.points[k]);
      samples.X.push_back(p.X);
      samples.u.push_back(p.u);
      samples.F.push_back(p.F);
      samples.weight.push_back(rule.weights[k] * p.jacobian * m_problem.thickness);
    }
  }
  m_result.samples = std::move(samples);
}

}  // namespace concord::calculix
