#pragma once
// What a crack measures, from the triangles that are gone. README.md (cracks) tells the
// algorithm; it needs positions and triangles only, so that made-up patterns test it.

#include "particle/core/fracturing.hpp"
#include "scene/types.hpp"

#include <array>
#include <span>
#include <vector>

namespace concord::particle {

/// Corners of a triangle or, in 3D, a tetrahedron.
class Corners {
 public:
  Corners(Index a, Index b, Index c) : m_at{a, b, c, -1}, m_count(3) {}
  Corners(Index a, Index b, Index c, Index d) : m_at{a, b, c, d}, m_count(4) {}
  const Index* begin() const { return m_at.data(); }
  const Index* end() const { return begin() + m_count; }
  Index operator[](std::size_t k) const { return m_at[k]; }
  std::size_t size() const { return static_cast<std::size_t>(m_count); }

 private:
  std::array<Index, 4> m_at;
  int m_count;
};

/// Particles and the triangles between them; or tetrahedra of a slab, seen along its thickness.
struct CrackBody {
  std::vector<Vec3> X;  ///< [m]
  std::vector<Corners> triangles;
  double thickness = 1;  ///< of a slab, along Z [m]

  Vec3 centroid(Index triangle) const;  ///< in 3D its projection along Z
  double area(Index triangle) const;    ///< in 3D the volume over the thickness [m^2]
};

/// Where a crack begins.
struct CrackStart {
  Vec3 tip = Vec3::Zero(), direction = Vec3::UnitX();  ///< of the pre-crack; a unit vector
};

/// Groups of points, joined one pair at a time.
class Groups {
 public:
  explicit Groups(std::size_t points);
  Index find(Index point);
  void join(Index a, Index b);

 private:
  std::vector<Index> m_parent;
};

/// The foremost dead triangle that is connected to the pre-crack through shared vertices.
class CrackTip {
 public:
  CrackTip(const CrackBody& body, const CrackStart& start);
  /// In the order of death; pre-crack first.
  void add(const DeadSimplex& dead);
  /// How far the tip is ahead of the pre-crack's, along its direction [m]; 0 at the start.
  double advance() const { return m_advance; }
  /// Whether a dead triangle is connected to the pre-crack.
  bool connected(Index triangle);

 private:
  void start_at_particle();

  const CrackBody& m_body;
  CrackStart m_start;
  Groups m_groups;
  std::vector<double> m_foremost;  ///< of a group, at its representative
  Index m_root = -1;               ///< a vertex of the pre-crack, or at its tip
  double m_advance = 0;
};

/// Path of the crack and its side branches.
struct CrackPaths {
  double main_length = 0;              ///< of the longest path from the pre-crack's tip [m]
  std::vector<double> branch_lengths;  ///< side branches of at least the length asked for [m]
  std::vector<double> branch_angles;  ///< between a branch and what it leaves [rad]; where both
                                      ///< go on
  double branches_length() const;
  double mean_angle() const;  ///< not a number without branches
};

/// Peels longest paths: the longest of the shortest paths from the dead triangle nearest the
/// pre-crack's tip, through centroids of dead triangles that share a vertex; then, as long as
/// it is at least `shortest`, the longest of the shortest paths from all that has been peeled.
/// Angles are between the chords from the fork to what lies four times `shortest` along either
/// path, or to its end, where both have at least half of that.
CrackPaths crack_paths(const CrackBody& body, const CrackStart& start,
                       std::span<const DeadSimplex> dead, double shortest);

/// Pieces of the body, joined by live triangles, and particles without any.
struct Fragments {
  Index pieces = 0, isolated = 0;
};
Fragments fragments(const CrackBody& body, std::span<const DeadSimplex> dead);

/// Sum of the areas of the triangles that died after the start [m^2].
double dead_area(const CrackBody& body, std::span<const DeadSimplex> dead);

}  // namespace concord::particle
