#include "studies/driver/compare.hpp"

#include "fem_reference/field.hpp"
#include "fem_reference/shape.hpp"
#include "scene/frame_reader.hpp"
#include "scene/norms.hpp"
#include "scene/output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>

namespace concord::studies {
namespace fs = std::filesystem;
namespace {

std::size_t reference_case(const Study& study, const Comparison& comparison) {
  std::size_t c = 0;
  while (c < study.cases.size() && !study.cases[c].matches(comparison.reference)) ++c;
  return c;  // the number of cases where this mode runs none
}

bool is_reference(const Study& study, const Comparison& comparison, std::size_t case_index,
                  double resolution, std::uint64_t seed) {
  if (case_index != reference_case(study, comparison)) return false;
  const Case& entry = study.cases[case_index];
  return resolution == comparison.reference_resolution.value_or(entry.resolutions.back()) &&
         seed == entry.seeds.front();
}

/// Shape functions of a VTK type; tells the mesh its dimension, shape and order.
fem::LagrangeShape shape_of(unsigned char vtk_type, scene::Mesh& mesh) {
  for (const int dim : {2, 3})
    for (const auto shape : {scene::CellShape::simplex, scene::CellShape::hypercube})
      for (const int order : {1, 2}) {
        fem::LagrangeShape candidate(dim, shape, order);
        if (candidate.vtk_type() != vtk_type) continue;
        mesh.dim = dim;
        mesh.shape = shape;
        mesh.order = order;
        return candidate;
      }
  throw std::runtime_error(fmt::format(
      "the reference has cells of VTK type {}, of which no field can be made", vtk_type));
}

/// The mesh behind a frame, at its reference positions and with nodes in gmsh's order.
scene::Mesh mesh_of(const scene::Frame& frame) {
  if (frame.types.empty()) throw std::runtime_error("the reference has no cells");
  scene::Mesh mesh;
  const fem::LagrangeShape shape = shape_of(frame.types.front(), mesh);
  const std::vector<int> order = shape.vtk_order();
  mesh.nodes_per_cell = shape.node_count();
  mesh.nodes = frame.reference_positions();
  mesh.cells.resize(frame.cells.size());
  const std::size_t n = order.size();
  for (std::size_t c = 0; c < frame.types.size(); ++c) {
    if (frame.types[c] != frame.types.front() ||
        static_cast<std::size_t>(frame.offsets[c + 1] - frame.offsets[c]) != n)
      throw std::runtime_error("the reference has cells of several kinds");
    for (std::size_t k = 0; k < n; ++k)
      mesh.cells[c * n + static_cast<std::size_t>(order[k])] = frame.cells[c * n + k];
  }
  return mesh;
}

/// Values of a reference at reference positions.
class ReferenceFields {
 public:
  explicit ReferenceFields(scene::Frame frame) : m_frame(std::move(frame)) {
    if (m_frame.types.empty() || m_frame.types.front() == vtk_vertex) {
      m_particles = m_frame.reference_positions();
      return;
    }
    m_mesh = mesh_of(m_frame);
    m_places.emplace(m_mesh, std::vector<Vec3>(m_mesh.nodes.size(), Vec3::Zero()));
  }

  /// Values of the named fields at X, field after field.
  std::vector<std::vector<double>> at(const std::vector<Vec3>& X,
                                      const std::vector<std::string>& names) const {
    std::vector<const std::vector<double>*> nodal;
    for (const std::string& name : names) nodal.push_back(&m_frame.scalar(name));
    std::vector<std::vector<double>> values(names.size(), std::vector<double>(X.size()));
    if (m_places) {
      for (std::size_t a = 0; a < X.size(); ++a) interpolate(X[a], a, nodal, values);
      return values;
    }
    check_particles(X);
    for (std::size_t f = 0; f < names.size(); ++f) values[f] = *nodal[f];
    return values;
  }

 private:
  static constexpr unsigned char vtk_vertex = 1;

  void interpolate(const Vec3& X, std::size_t a,
                   const std::vector<const std::vector<double>*>& nodal,
                   std::vector<std::vector<double>>& values) const {
    const auto place = m_places->locate(X);
    const std::vector<double> N = m_places->weights(place);
    const Index* nodes = &m_mesh.cells[static_cast<std::size_t>(place.cell) *
                                       static_cast<std::size_t>(m_mesh.nodes_per_cell)];
    for (std::size_t f = 0; f < nodal.size(); ++f)
      for (std::size_t k = 0; k < N.size(); ++k)
        values[f][a] += N[k] * (*nodal[f])[static_cast<std::size_t>(nodes[k])];
  }

  /// Particles of one arrangement: X = x - u agrees to round-off.
  void check_particles(const std::vector<Vec3>& X) const {
    double largest = 0, apart = 0;
    bool same = X.size() == m_particles.size();
    for (std::size_t a = 0; same && a < X.size(); ++a) {
      largest = std::max(largest, X[a].norm());
      apart = std::max(apart, (X[a] - m_particles[a]).norm());
    }
    same = same && apart <= 1e-9 * largest;
    if (!same)
      throw std::runtime_error("the reference has particles, and this run has other ones");
  }

  scene::Frame m_frame;
  scene::Mesh m_mesh;
  std::vector<Vec3> m_particles;
  std::optional<fem::MeshField> m_places;
};

scene::Frame last_frame(const fs::path& run) {
  return scene::read_frame(scene::read_frame_series(run).back().file);
}

/// Which points count: those farther than the given number of spacings from both planes.
std::vector<bool> counted(const std::vector<Vec3>& X, const std::optional<LeaveOut>& leave_out,
                          double h) {
  std::vector<bool> counts(X.size(), true);
  if (!leave_out) return counts;
  const double reach = leave_out->spacings * h;
  for (std::size_t a = 0; a < X.size(); ++a) {
    const double x = X[a][leave_out->axis];
    counts[a] = x - leave_out->low >= reach && leave_out->high - x >= reach;
  }
  return counts;
}

std::vector<double> chosen(const std::vector<double>& values, const std::vector<bool>& counts) {
  std::vector<double> left;
  for (std::size_t a = 0; a < values.size(); ++a)
    if (counts[a]) left.push_back(values[a]);
  return left;
}

/// The run's frame with its own values, the reference's and what lies between them.
void write_difference(const fs::path& file, const scene::Frame& frame,
                      const std::vector<std::string>& names,
                      const std::vector<std::vector<double>>& reference) {
  std::vector<scene::FrameField> fields{
      {"displacement", 3, frame.find("displacement")->values}};
  std::vector<std::vector<double>> differences;
  for (std::size_t f = 0; f < names.size(); ++f) {
    differences.push_back(frame.scalar(names[f]));
    for (std::size_t a = 0; a < reference[f].size(); ++a) differences[f][a] -= reference[f][a];
  }
  for (std::size_t f = 0; f < names.size(); ++f) {
    fields.push_back({names[f], 1, frame.scalar(names[f])});
    fields.push_back({names[f] + "_reference", 1, reference[f]});
    fields.push_back({names[f] + "_difference", 1, differences[f]});
  }
  scene::write_frame(file, frame.time, frame.points, fields, frame.cells, frame.offsets,
                     frame.types);
}

void compare_run(const Comparison& comparison, const ReferenceFields& reference, Row& row,
                 const fs::path& folder) {
  const scene::Frame frame = last_frame(folder);
  const std::vector<Vec3> X = frame.reference_positions();
  const auto values = reference.at(X, comparison.fields);
  write_difference(folder / (comparison.name + ".hdf"), frame, comparison.fields, values);
  const auto counts = counted(X, comparison.leave_out, value_of(row, "h").value_or(0));
  const auto points = std::count(counts.begin(), counts.end(), true);
  auto& told = row.summary["comparisons"][comparison.name];
  told["points"] = points;
  told["left_out"] = static_cast<long>(X.size()) - points;
  if (points == 0) throw std::runtime_error("leave_out leaves no point");
  for (std::size_t f = 0; f < comparison.fields.size(); ++f)
    row.summary["errors"][comparison.fields[f] + "_" + comparison.name] = scene::field_error(
        chosen(values[f], counts), chosen(frame.scalar(comparison.fields[f]), counts));
}

/// The reference's fields, or why there are none.
struct LoadedReference {
  std::string title, reason;
  std::unique_ptr<ReferenceFields> fields;
};

LoadedReference load(const Study& study, const Comparison& comparison,
                     const std::vector<Row>& rows, const fs::path& out) {
  LoadedReference loaded;
  const std::size_t c = reference_case(study, comparison);
  loaded.title = c < study.cases.size() ? study.cases[c].title() : "";
  loaded.reason = "the reference was not run";
  for (const Row& row : rows) {
    if (!is_reference(study, comparison, row.case_index, row.resolution, row.seed)) continue;
    loaded.title += fmt::format(", {:g}", row.resolution);
    loaded.reason = row.error.empty() ? "" : "the reference failed: " + row.error;
    if (!row.error.empty()) break;
    try {
      loaded.fields = std::make_unique<ReferenceFields>(last_frame(out / row.run));
    } catch (const std::runtime_error& error) {
      loaded.reason = error.what();
    }
    break;
  }
  return loaded;
}

}  // namespace

std::vector<const Comparison*> comparisons_of(const Study& study, std::size_t case_index,
                                              double resolution, std::uint64_t seed) {
  if (!study.cases[case_index].probe.empty()) return {};  // no frames
  std::map<std::string, const Comparison*> found;         // nullptr: a reference of this name
  for (const Comparison& comparison : study.comparisons)
    if (is_reference(study, comparison, case_index, resolution, seed))
      found[comparison.name] = nullptr;
  for (const Comparison& comparison : study.comparisons)
    if (study.cases[case_index].matches(comparison.selector))
      found.emplace(comparison.name, &comparison);
  std::vector<const Comparison*> result;
  for (const auto& [name, comparison] : found)
    if (comparison != nullptr) result.push_back(comparison);
  return result;
}

bool needs_last_frame(const Study& study, std::size_t case_index, double resolution,
                      std::uint64_t seed) {
  if (!comparisons_of(study, case_index, resolution, seed).empty()) return true;
  return std::any_of(study.comparisons.begin(), study.comparisons.end(),
                     [&](const Comparison& comparison) {
                       return is_reference(study, comparison, case_index, resolution, seed);
                     });
}

void compare_runs(const Study& study, std::vector<Row>& rows, const fs::path& out) {
  std::map<const Comparison*, LoadedReference> references;
  for (const Comparison& comparison : study.comparisons)
    references.emplace(&comparison, load(study, comparison, rows, out));
  for (Row& row : rows) {
    if (!row.error.empty()) continue;
    for (const Comparison* comparison :
         comparisons_of(study, row.case_index, row.resolution, row.seed)) {
      const LoadedReference& reference = references.at(comparison);
      auto& told = row.summary["comparisons"][comparison->name];
      told["reference"] = reference.title;
      try {
        if (!reference.fields) throw std::runtime_error(reference.reason);
        compare_run(*comparison, *reference.fields, row, out / row.run);
      } catch (const std::exception& error) {
        told["reason"] = error.what();
      }
    }
  }
}

}  // namespace concord::studies
