#include "particle/core/crack_quantities.hpp"

#include "particle/core/checkpoint.hpp"
#include "scene/output.hpp"

#include <algorithm>
#include <cmath>

namespace concord::particle {
namespace {

/// Side branches count from this length on: three spacings of the branching study's plate, .5
/// mm at 1/6 mm.
constexpr double shortest_branch = 3;
/// The mean speed and the toughness are taken between these shares of the ligament: without the
/// start, whose instant is not well defined, and without the end, whose stress waves come back.
constexpr double from_share = 0.1, to_share = 0.9;

/// Of the way from a to b.
CrackCost between(const CrackCost& a, const CrackCost& b, double share) {
  return {a.damping + share * (b.damping - a.damping),
          a.deletion + share * (b.deletion - a.deletion)};
}

}  // namespace

void CrackToll::add(double share, const CrackCost& cost) {
  const std::array<double, 2> marks{from_share, to_share};
  for (std::size_t k = 0; k < marks.size(); ++k) {
    if (m_passed[k] || share < marks[k]) continue;
    m_passed[k] = true;
    m_at[k] = between(m_cost, cost, (marks[k] - m_share) / (share - m_share));
  }
  m_share = share;
  m_cost = cost;
}

std::optional<CrackCost> CrackToll::paid() const {
  if (!m_passed[0] || !m_passed[1]) return std::nullopt;
  return CrackCost{m_at[1].damping - m_at[0].damping, m_at[1].deletion - m_at[0].deletion};
}

void CrackToll::keep(scene::Checkpoint& state) {
  state.item("crack_toll.share", m_share);
  const auto item = [&](const std::string& name, CrackCost& cost) {
    state.item(name + ".damping", cost.damping);
    state.item(name + ".deletion", cost.deletion);
  };
  item("crack_toll.last", m_cost), item("crack_toll.from", m_at[0]);
  item("crack_toll.to", m_at[1]);
  state.item("crack_toll.passed_from", m_passed[0]);
  state.item("crack_toll.passed_to", m_passed[1]);
}

double rayleigh_speed(const scene::Material& material, Dimension dimension) {
  const double c_s = material.shear_wave_speed(), nu = material.nu;
  const double c_p = dimension == Dimension::plane_stress
                         ? std::sqrt(material.E / (material.rho0 * (1 - nu * nu)))
                         : material.longitudinal_wave_speed();
  const double ratio = (c_s / c_p) * (c_s / c_p);
  double low = 0.1, high = 1;  // s; the function is positive below the root, negative above
  for (int i = 0; i < 200 && low < high; ++i) {
    const double s = 0.5 * (low + high);
    const double value = 4 * std::sqrt(1 - s) * std::sqrt(1 - s * ratio) - (2 - s) * (2 - s);
    if (s == low || s == high) break;
    (value > 0 ? low : high) = s;
  }
  return c_s * std::sqrt(low);
}

CrackQuantities::CrackQuantities(const scene::Problem& problem, const Body& body,
                                 const Constraints& constraints, const Fracturing& fracturing)
    : m_problem(problem), m_fracturing(fracturing),
      m_l(problem.fracture->length > 0 ? problem.fracture->length : body.h),
      m_at_end(body.n, 0), m_held(body.n, 0) {
  for (Index a = 0; a < body.n; ++a) m_body.X.push_back(body.position(a));
  const std::vector<Index>& vertices = body.triangulation.simplices;
  const auto corners = static_cast<std::size_t>(body.dim) + 1;
  for (std::size_t t = 0; t < body.triangulation.size(); ++t) {
    const Index* v = &vertices[corners * t];
    m_body.triangles.push_back(body.dim == 3 ? Corners(v[0], v[1], v[2], v[3])
                                             : Corners(v[0], v[1], v[2]));
  }
  if (body.dim == 3) {
    const auto [low, high] =
        std::minmax_element(m_body.X.begin(), m_body.X.end(),
                            [](const Vec3& p, const Vec3& q) { return p[2] < q[2]; });
    m_body.thickness = (*high)[2] - (*low)[2];
  }
  for (const PrescribedDof& dof : constraints.dofs()) m_held[dof.particle] = 1;
  const scene::Fracture& fracture = *problem.fracture;
  if (!fracture.arrival.empty()) {
    for (const Index node : body.mesh.group_nodes(fracture.arrival, fracture.where))
      m_at_end[body.particle[node]] = 1;
  }
  if (fracture.cracks.empty()) return;
  const scene::PreCrack& crack = fracture.cracks.front();
  m_start = CrackStart{crack.to, (crack.to - crack.from).normalized()};
  for (const Vec3& X : m_body.X)
    m_ligament = std::max(m_ligament, (X - m_start->tip).dot(m_start->direction));
  if (!(m_ligament > 0)) {
    throw InputError(
        fracture.where, "fracture.crack", "a pre-crack with nothing of the body ahead",
        "a tip (to) that the body goes on from, in the direction from the mouth (from)");
  }
  m_tip.emplace(m_body, *m_start);
}

/// Takes in what has died since.
void CrackQuantities::follow() {
  const FractureRecord& record = m_fracturing.record();
  for (; m_followed < record.dead.size(); ++m_followed) {
    const DeadSimplex& dead = record.dead[m_followed];
    if (dead.t != before_start) m_area += m_body.area(dead.simplex);
    if (!m_tip) continue;
    const double before = m_tip->advance();
    m_tip->add(dead);
    if (m_tip->advance() > before) m_advances.emplace_back(dead.t, m_tip->advance());
  }
  find_arrival();
}

/// First broken bond at a particle of the arrival group, away from prescribed particles.
void CrackQuantities::find_arrival() {
  const FractureRecord& record = m_fracturing.record();
  for (; m_looked < record.broken.size() && !m_arrival; ++m_looked) {
    const BrokenBond& bond = record.broken[m_looked];
    const bool at_end = m_at_end[bond.a] != 0 || m_at_end[bond.b] != 0,
               held = m_held[bond.a] != 0 || m_held[bond.b] != 0;
    if (at_end && !held) m_arrival = bond.t;
  }
}

/// Between the tip's first passing of both shares of the ligament; not a number before that.
double CrackQuantities::mean_speed() const {
  const auto passed = [&](double share) {
    return std::find_if(m_advances.begin(), m_advances.end(),
                        [&](const auto& at) { return at.second >= share * m_ligament; });
  };
  const auto from = passed(from_share), to = passed(to_share);
  if (to == m_advances.end() || !(to->first > from->first)) return std::nan("");
  return (to->second - from->second) / (to->first - from->first);
}

std::vector<std::string> CrackQuantities::columns() {
  return {"broken_bonds", "dead_area_m2", "crack_advance_m"};
}

void CrackQuantities::append(std::vector<double>& values) {
  follow();
  values.insert(values.end(), {static_cast<double>(m_fracturing.record().broken.size()), m_area,
                               m_tip ? m_tip->advance() : 0.0});
}

std::map<std::string, double> CrackQuantities::quantities() {
  follow();
  const FractureRecord& record = m_fracturing.record();
  const Fragments parts = fragments(m_body, record.dead);
  std::map<std::string, double> q{{"broken_bonds", static_cast<double>(record.broken.size())},
                                  {"dead_area", m_area},
                                  {"fragments", static_cast<double>(parts.pieces)},
                                  {"isolated_particles", static_cast<double>(parts.isolated)},
                                  {"flat_simplices", static_cast<double>(record.flat)}};
  if (m_arrival) q["crack_arrival"] = *m_arrival;
  if (!m_start) return q;
  const CrackPaths paths = crack_paths(m_body, *m_start, record.dead, shortest_branch * m_l);
  q["crack_advance"] = m_tip->advance();
  q["crack_length"] = paths.main_length + paths.branches_length();
  q["crack_branches"] = static_cast<double>(paths.branch_lengths.size());
  q["crack_branches_length"] = paths.branches_length();
  if (!paths.branch_angles.empty())
    q["crack_branching_angle_deg"] = paths.mean_angle() * 180 / M_PI;
  q["degree_of_branching"] = m_area / (m_l * m_ligament);
  const double c_R = rayleigh_speed(m_problem.material, m_problem.dimension);
  q["rayleigh_speed"] = c_R;
  if (!m_advances.empty()) q["crack_start"] = m_advances.front().first;
  if (const double v = mean_speed(); std::isfinite(v)) {
    q["crack_speed"] = v;
    q["crack_speed_over_rayleigh"] = v / c_R;
  }
  return q;
}

double CrackQuantities::advance_share() {
  follow();
  return m_tip ? m_tip->advance() / m_ligament : 0.0;
}

std::map<std::string, double> CrackQuantities::toughness(const CrackCost& cost) const {
  const double thickness =
      m_problem.dimension == Dimension::three_d ? m_body.thickness : m_problem.thickness;
  const double area = (to_share - from_share) * m_ligament * thickness;
  const double effective = (cost.damping + cost.deletion) / area;
  return {{"effective_toughness", effective},
          {"effective_toughness_deletion", cost.deletion / area},
          {"effective_over_nominal_toughness",
           effective / m_problem.fracture->energy_release_rate}};
}

void CrackQuantities::write(const std::filesystem::path& file) const {
  scene::HistoryWriter writer(file, {"t_s", "x1_m", "y1_m", "x2_m", "y2_m", "x3_m", "y3_m"});
  std::vector<double> row;
  for (const DeadSimplex& dead : m_fracturing.record().dead) {
    const Corners& corners = m_body.triangles[dead.simplex];
    const bool solid = corners.size() == 4;  // told by its faces, which cover what it covers
    for (std::size_t left_out = solid ? 0 : 3; left_out < 4; ++left_out) {
      row.assign(1, dead.t == before_start ? 0.0 : dead.t);
      for (std::size_t k = 0; k < corners.size(); ++k) {
        const Vec3& X = m_body.X[corners[k]];
        if (k != left_out) row.insert(row.end(), {X[0], X[1]});
      }
      writer.append(row);
    }
  }
}

}  // namespace concord::particle
