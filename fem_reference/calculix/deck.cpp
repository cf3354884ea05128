#include "fem_reference/calculix/deck.hpp"

#include "fem_reference/calculix/simplex.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

namespace concord::calculix {
namespace {

using scene::BoundaryKind;
using Text = fmt::memory_buffer;

// CalculiX reads 20 characters of a number, so 13 digits.
template <class... Args>
void put(Text& out, fmt::format_string<Args...> format, Args&&... args) {
  fmt::format_to(std::back_inserter(out), format, std::forward<Args>(args)...);
}

bool gives(const scene::BoundaryCondition& bc, int component, int axis) {
  if (bc.kind == BoundaryKind::symmetric) return component == axis;
  if (bc.kind == BoundaryKind::antisymmetric) return component != axis;
  if (bc.kind == BoundaryKind::displacement && !bc.value_from_exact)
    return bc.value.component[static_cast<std::size_t>(component)].has_value();
  return true;
}

/// Finds or adds a history; those equal to 12 digits are one.
class Histories {
 public:
  explicit Histories(Motion& motion) : m_motion(motion) {}
  void add(Index node, int component, std::vector<double> values) {
    const double reference =
        *std::max_element(values.begin(), values.end(),
                          [](double a, double b) { return std::abs(a) < std::abs(b); });
    Prescribed entry{node, component, reference, 0};
    if (reference != 0) {
      for (double& v : values) v /= reference;
      const std::string key = fmt::format("{:.11e}", fmt::join(values, " "));
      const auto [found, is_new] = m_known.try_emplace(key, m_motion.histories.size());
      if (is_new) m_motion.histories.push_back(std::move(values));
      entry.history = found->second;
    }
    m_motion.entries.push_back(entry);
  }

 private:
  Motion& m_motion;
  std::map<std::string, std::size_t> m_known;
};

void put_mesh(Text& out, const scene::Mesh& mesh, const NodeSets& reactions) {
  put(out, "*NODE, NSET=NALL\n");
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
    const Vec3& X = mesh.nodes[n];
    put(out, "{},{:.12e},{:.12e},{:.12e}\n", n + 1, X[0], X[1], X[2]);
  }
  put(out, "*ELEMENT, TYPE={}, ELSET=EALL\n", mesh.dim == 2 ? "CPE6" : "C3D10");
  const std::vector<int> order = QuadraticSimplex(mesh.dim).calculix_order();
  for (std::size_t c = 0; c < mesh.cell_count(); ++c) {
    put(out, "{}", c + 1);
    for (const int k : order)
      put(out, ",{}", mesh.cells[c * order.size() + static_cast<std::size_t>(k)] + 1);
    put(out, "\n");
  }
  for (std::size_t r = 0; r < reactions.size(); ++r) {
    put(out, "*NSET, NSET=R{}\n", r);
    for (const Index n : reactions[r]) put(out, "{}\n", n + 1);
  }
}

void put_material(Text& out, const scene::Problem& problem, const HardeningTable& hardening) {
  const scene::Material& m = problem.material;
  put(out, "*MATERIAL, NAME=BODY\n*ELASTIC\n{:.12e},{:.12e}\n", m.E, m.nu);
  if (m.plastic()) {
    put(out, "*PLASTIC\n");
    for (std::size_t i = 0; i < hardening.strain.size(); ++i)
      put(out, "{:.12e},{:.12e}\n", hardening.stress[i], hardening.strain[i]);
  }
  put(out, "*SOLID SECTION, ELSET=EALL, MATERIAL=BODY\n");
  if (problem.dim() == 2) put(out, "{:.12e}\n", problem.thickness);
}

void put_times(Text& out, const Motion& motion, int steps) {
  for (std::size_t a = 0; a < motion.histories.size(); ++a) {
    put(out, "*AMPLITUDE, NAME=A{}\n", a);
    for (int k = 0; k <= steps; ++k)
      put(out, "{:.12e},{:.12e}\n", static_cast<double>(k) / steps,
          motion.histories[a][static_cast<std::size_t>(k)]);
  }
  put(out, "*TIME POINTS, NAME=LOADSTEPS\n");
  for (int k = 1; k <= steps; ++k) put(out, "{:.12e}\n", static_cast<double>(k) / steps);
}

void put_motion(Text& out, const Motion& motion) {
  put(out, "*BOUNDARY\n");
  for (const Prescribed& p : motion.entries)
    if (p.reference == 0) put(out, "{},{},{}\n", p.node + 1, p.component + 1, p.component + 1);
  for (std::size_t a = 0; a < motion.histories.size(); ++a) {
    put(out, "*BOUNDARY, AMPLITUDE=A{}\n", a);
    for (const Prescribed& p : motion.entries)
      if (p.reference != 0 && p.history == a)
        put(out, "{},{},{},{:.12e}\n", p.node + 1, p.component + 1, p.component + 1,
            p.reference);
  }
}

}  // namespace

Motion prescribed_motion(const scene::Problem& problem, const scene::Mesh& mesh, int steps) {
  Motion motion;
  Histories histories(motion);
  std::vector<char> done(mesh.nodes.size() * 3, 0);
  for (const scene::BoundaryCondition& bc : problem.boundaries) {
    const bool plane =
        bc.kind == BoundaryKind::symmetric || bc.kind == BoundaryKind::antisymmetric;
    const int axis = plane ? mesh.group_axis(bc.group, bc.where) : -1;
    for (const Index node : mesh.group_nodes(bc.group, bc.where)) {
      const auto n = static_cast<std::size_t>(node);
      std::vector<Vec3> u;
      for (int k = 0; k <= steps; ++k)
        u.push_back(problem.boundary_value(bc, mesh.nodes[n], static_cast<double>(k) / steps,
                                           Vec3::Zero()));
      for (int i = 0; i < mesh.dim; ++i) {
        if (!gives(bc, i, axis) || done[3 * n + static_cast<std::size_t>(i)] != 0) continue;
        done[3 * n + static_cast<std::size_t>(i)] = 1;  // make_mesh saw that groups agree
        std::vector<double> values;
        for (const Vec3& v : u) values.push_back(v[i]);
        histories.add(node, i, std::move(values));
      }
    }
  }
  return motion;
}

std::string deck_text(const scene::Problem& problem, const scene::Mesh& mesh,
                      const Options& options, const Motion& motion, const NodeSets& reactions,
                      const HardeningTable& hardening) {
  Text out;
  put(out, "** Scene {} for CalculiX, SI units\n", problem.name);
  put_mesh(out, mesh, reactions);
  put_material(out, problem, hardening);
  put_times(out, motion, options.steps);
  const double dt = 1.0 / options.steps;
  put(out, "*STEP, NLGEOM, INC=1000000\n*STATIC\n{:.12e},1.,{:.12e},{:.12e}\n", dt,
      std::max(1e-3 * dt, 2e-6), dt);
  put(out, "*CONTROLS, PARAMETERS=FIELD\n{0:.3e},{0:.3e},,,{0:.3e},,,\n", options.tolerance);
  put_motion(out, motion);
  const std::string times = "TIME POINTS=LOADSTEPS";
  put(out, "*NODE PRINT, NSET=NALL, {}\nU\n", times);
  for (std::size_t r = 0; r < reactions.size(); ++r)
    put(out, "*NODE PRINT, NSET=R{}, TOTALS=ONLY, {}\nRF\n", r, times);
  const bool plastic = problem.material.plastic();
  if (plastic) put(out, "*EL PRINT, ELSET=EALL, {}\nPEEQ\n", times);
  put(out, "*EL FILE{}, {}\n{}\n", mesh.dim == 2 ? ", OUTPUT=2D" : "", times,
      plastic ? "S,PEEQ" : "S");
  put(out, "*END STEP\n");
  return fmt::to_string(out);
}

}  // namespace concord::calculix
