#include "particle/core/crack.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <queue>

namespace concord::particle {
namespace {

constexpr double far_away = std::numeric_limits<double>::infinity();

/// Shortest distances from a growing set of nodes, over dead triangles that share a vertex.
class PathFinder {
 public:
  PathFinder(const CrackBody& body, std::vector<Index> triangles)
      : m_body(body), m_triangles(std::move(triangles)), m_at(body.X.size()) {
    for (Index k = 0; k < count(); ++k) {
      for (const Index vertex : body.triangles[m_triangles[k]]) m_at[vertex].push_back(k);
    }
    m_distance.assign(m_triangles.size(), far_away);
    m_before.assign(m_triangles.size(), -1);
  }
  Index count() const { return static_cast<Index>(m_triangles.size()); }
  Vec3 place(Index node) const { return m_body.centroid(m_triangles[node]); }
  double distance(Index node) const { return m_distance[node]; }

  /// These nodes are sources from now on.
  void add_sources(const std::vector<Index>& nodes) {
    for (const Index node : nodes) reach(node, 0, -1);
    while (!m_queue.empty()) {
      const auto [distance, node] = m_queue.top();
      m_queue.pop();
      if (distance > m_distance[node]) continue;
      for (const Index vertex : m_body.triangles[m_triangles[node]]) {
        for (const Index next : m_at[vertex])
          reach(next, distance + (place(next) - place(node)).norm(), node);
      }
    }
  }

  /// The farthest node that can be reached; the lowest of equal ones.
  Index farthest() const {
    Index best = -1;
    for (Index node = 0; node < count(); ++node) {
      if (m_distance[node] == far_away) continue;
      if (best < 0 || m_distance[node] > m_distance[best]) best = node;
    }
    return best;
  }

  /// From the source that a node is reached from, to it.
  std::vector<Index> path_to(Index node) const {
    std::vector<Index> path;
    for (; node >= 0; node = m_before[node]) path.push_back(node);
    std::reverse(path.begin(), path.end());
    return path;
  }

 private:
  void reach(Index node, double distance, Index from) {
    if (distance >= m_distance[node]) return;
    m_distance[node] = distance;
    m_before[node] = from;
    m_queue.emplace(distance, node);
  }

  using Entry = std::pair<double, Index>;
  const CrackBody& m_body;
  std::vector<Index> m_triangles;
  std::vector<std::vector<Index>> m_at;  ///< nodes at a particle
  std::vector<double> m_distance;
  std::vector<Index> m_before;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> m_queue;
};

/// The chord from the beginning of a path to where it has gone `longest`, or to its end; zero
/// if that is before half of it.
Vec3 chord(const PathFinder& finder, std::span<const Index> path, double longest) {
  double gone = 0;
  std::size_t k = 1;
  for (; k < path.size() && gone < longest; ++k)
    gone += (finder.place(path[k]) - finder.place(path[k - 1])).norm();
  if (gone < 0.5 * longest) return Vec3::Zero();
  return finder.place(path[k - 1]) - finder.place(path[0]);
}

/// What goes on from a node of the paths that are there.
std::span<const Index> rest_from(const std::vector<std::vector<Index>>& paths, Index node) {
  for (const std::vector<Index>& path : paths) {
    // A side branch begins at a node of an older path, which comes first.
    const auto at = std::find(path.begin(), path.end(), node);
    if (at != path.end()) return {at, path.end()};
  }
  return {};
}

}  // namespace

Vec3 CrackBody::centroid(Index triangle) const {
  const Corners& corners = triangles[triangle];
  Vec3 sum = Vec3::Zero();
  for (const Index a : corners) sum += X[a];
  if (corners.size() == 4) sum[2] = 0;
  return sum / static_cast<double>(corners.size());
}

double CrackBody::area(Index triangle) const {
  const Corners& corners = triangles[triangle];
  const Vec3 p = X[corners[1]] - X[corners[0]], q = X[corners[2]] - X[corners[0]];
  if (corners.size() == 3) return 0.5 * p.cross(q).norm();
  return std::abs(p.cross(q).dot(X[corners[3]] - X[corners[0]])) / (6 * thickness);
}

Groups::Groups(std::size_t points) : m_parent(points) {
  std::iota(m_parent.begin(), m_parent.end(), 0);
}

Index Groups::find(Index point) {
  while (m_parent[point] != point) point = m_parent[point] = m_parent[m_parent[point]];
  return point;
}

void Groups::join(Index a, Index b) { m_parent[find(b)] = find(a); }

CrackTip::CrackTip(const CrackBody& body, const CrackStart& start)
    : m_body(body), m_start(start), m_groups(body.X.size()),
      m_foremost(body.X.size(), -far_away) {}

void CrackTip::add(const DeadSimplex& dead) {
  const auto& vertices = m_body.triangles[dead.simplex];
  double foremost = (m_body.centroid(dead.simplex) - m_start.tip).dot(m_start.direction);
  for (const Index vertex : vertices)
    foremost = std::max(foremost, m_foremost[m_groups.find(vertex)]);
  if (dead.t != before_start && m_root < 0) start_at_particle();
  if (dead.t == before_start) {
    if (m_root < 0) m_root = vertices[0];
    foremost = std::max(foremost, m_foremost[m_groups.find(m_root)]);
    m_groups.join(m_root, vertices[0]);
  }
  for (const Index vertex : vertices) m_groups.join(vertices[0], vertex);
  const Index group = m_groups.find(vertices[0]);
  m_foremost[group] = foremost;
  if (dead.t != before_start && connected(dead.simplex))
    m_advance = std::max(m_advance, foremost);
}

/// A pre-crack that took no triangle is a slit of the mesh: the triangles around the particle
/// at its tip stand for those that would be dead.
void CrackTip::start_at_particle() {
  const auto distance = [&](Index a) { return (m_body.X[a] - m_start.tip).squaredNorm(); };
  m_root = 0;
  for (Index a = 1; a < static_cast<Index>(m_body.X.size()); ++a) {
    if (distance(a) < distance(m_root)) m_root = a;
  }
  for (const auto& vertices : m_body.triangles) {
    if (std::find(vertices.begin(), vertices.end(), m_root) == vertices.end()) continue;
    for (const Index vertex : vertices) m_groups.join(m_root, vertex);
  }
}

bool CrackTip::connected(Index triangle) {
  return m_root >= 0 && m_groups.find(m_body.triangles[triangle][0]) == m_groups.find(m_root);
}

double CrackPaths::branches_length() const {
  return std::accumulate(branch_lengths.begin(), branch_lengths.end(), 0.0);
}

double CrackPaths::mean_angle() const {
  return std::accumulate(branch_angles.begin(), branch_angles.end(), 0.0) /
         static_cast<double>(branch_angles.size());
}

CrackPaths crack_paths(const CrackBody& body, const CrackStart& start,
                       std::span<const DeadSimplex> dead, double shortest) {
  CrackTip tip(body, start);
  for (const DeadSimplex& d : dead) tip.add(d);
  const auto distance = [&](Index t) { return (body.centroid(t) - start.tip).norm(); };
  std::vector<Index> triangles;
  Index root = -1;
  for (const DeadSimplex& d : dead) {
    if (!tip.connected(d.simplex)) continue;
    if (root < 0 || distance(d.simplex) < distance(root)) root = d.simplex;
    if (d.t != before_start) triangles.push_back(d.simplex);
  }
  CrackPaths result;
  if (triangles.empty()) return result;
  const auto known = std::find(triangles.begin(), triangles.end(), root);
  const auto first = static_cast<Index>(known - triangles.begin());
  if (known == triangles.end()) triangles.push_back(root);
  PathFinder finder(body, std::move(triangles));
  finder.add_sources({first});
  Index end = finder.farthest();
  result.main_length = finder.distance(end);
  std::vector<std::vector<Index>> paths{finder.path_to(end)};
  for (;;) {
    finder.add_sources(paths.back());
    end = finder.farthest();
    const double length = finder.distance(end);
    if (!(length >= shortest)) return result;
    const std::vector<Index> branch = finder.path_to(end);
    result.branch_lengths.push_back(length);
    const Vec3 own = chord(finder, branch, 4 * shortest),
               other = chord(finder, rest_from(paths, branch.front()), 4 * shortest);
    if (own.norm() > 0 && other.norm() > 0)
      result.branch_angles.push_back(
          std::acos(std::clamp(own.dot(other) / (own.norm() * other.norm()), -1.0, 1.0)));
    paths.push_back(branch);
  }
}

Fragments fragments(const CrackBody& body, std::span<const DeadSimplex> dead) {
  std::vector<char> gone(body.triangles.size(), 0), held(body.X.size(), 0);
  for (const DeadSimplex& d : dead) gone[d.simplex] = 1;
  Groups groups(body.X.size());
  for (std::size_t t = 0; t < body.triangles.size(); ++t) {
    if (gone[t] != 0) continue;
    for (const Index a : body.triangles[t]) {
      held[a] = 1;
      groups.join(body.triangles[t][0], a);
    }
  }
  Fragments result;
  for (Index a = 0; a < static_cast<Index>(body.X.size()); ++a) {
    if (held[a] == 0)
      ++result.isolated;
    else if (groups.find(a) == a)
      ++result.pieces;
  }
  return result;
}

double dead_area(const CrackBody& body, std::span<const DeadSimplex> dead) {
  double area = 0;
  for (const DeadSimplex& d : dead) {
    if (d.t != before_start) area += body.area(d.simplex);
  }
  return area;
}

}  // namespace concord::particle
