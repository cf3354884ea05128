// Polygons with corners that point inwards, holes or several loops, as unions of convex ones.

#include "particle/voronoi/region.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace concord::particle::voronoi {
namespace {

using Segment = std::array<Vec3, 2>;

/// All points of the plane on a segment's left.
HalfSpace left_of(const Segment& s, const Vec3& N) {
  const Vec3 m = (s[1] - s[0]).cross(N).normalized();
  return {m, m.dot(0.5 * (s[0] + s[1]))};
}

/// Segments on one directed line, joined where they touch: long ones give exact directions.
std::vector<Segment> joined(const std::vector<Segment>& segments, const Vec3& N, double tiny) {
  struct Line {
    HalfSpace left;
    Vec3 along;
    std::vector<Segment> members;
  };
  std::vector<Line> lines;
  for (const Segment& s : segments) {
    if ((s[1] - s[0]).norm() < tiny) continue;
    const auto same = [&](const Line& l) {
      return (s[1] - s[0]).dot(l.along) > 0 && std::abs(l.left.beyond(s[0])) < tiny &&
             std::abs(l.left.beyond(s[1])) < tiny;
    };
    auto line = std::find_if(lines.begin(), lines.end(), same);
    if (line == lines.end()) {
      lines.push_back({left_of(s, N), (s[1] - s[0]).normalized(), {}});
      line = lines.end() - 1;
    }
    line->members.push_back(s);
  }
  std::vector<Segment> result;
  for (Line& line : lines) {
    std::sort(line.members.begin(), line.members.end(),
              [&](const Segment& s, const Segment& t) {
                return line.along.dot(s[0]) < line.along.dot(t[0]);
              });
    Segment run = line.members.front();
    for (const Segment& s : line.members) {
      if (line.along.dot(s[0] - run[1]) > tiny) {
        result.push_back(run);
        run = s;
      } else if (line.along.dot(s[1] - run[1]) > 0) {
        run[1] = s[1];
      }
    }
    result.push_back(run);
  }
  return result;
}

bool inside(const std::vector<Segment>& boundary, const Vec3& N, const Vec3& X) {
  double angle = 0;
  for (const Segment& s : boundary) {
    const Vec3 p = s[0] - X, q = s[1] - X;
    angle += std::atan2(p.cross(q).dot(N), p.dot(q));
  }
  return angle > std::numbers::pi;
}

/// What is left of a segment inside a piece, and the line of the whole of it.
struct Crossing {
  Segment s;
  HalfSpace left;
};

struct Halving {
  const std::vector<Segment>& boundary;
  const Vec3& N;
  double tiny, size;
  std::vector<ConvexPiece> found;

  void run(const ConvexPiece& piece, const std::vector<Crossing>& crossing) {
    if (piece.polygon.empty()) return;
    if (crossing.empty()) {
      keep_if_inside(piece);
      return;
    }
    const HalfSpace left = crossing.front().left;
    for (const HalfSpace& side : {left, left.opposite()}) {
      ConvexPiece half;
      clip(piece.polygon, side, half.polygon);
      half.edges = piece.edges;
      half.edges.push_back(side);
      std::vector<Crossing> rest;
      for (const Crossing& c : crossing) {
        const double d0 = side.beyond(c.s[0]), d1 = side.beyond(c.s[1]);
        if (std::min(d0, d1) > -tiny) continue;  // beyond it, or on it
        Crossing cut = c;
        if (d0 > 0) cut.s[0] = c.s[0] + d0 / (d0 - d1) * (c.s[1] - c.s[0]);
        if (d1 > 0) cut.s[1] = c.s[0] + d0 / (d0 - d1) * (c.s[1] - c.s[0]);
        if ((cut.s[1] - cut.s[0]).norm() > tiny) rest.push_back(cut);
      }
      run(half, rest);
    }
  }

  /// Keeps what it needs of the half-spaces: those with an edge of the polygon.
  void keep_if_inside(const ConvexPiece& piece) {
    const Moments m = moments(piece.polygon, N);
    if (m.A < tiny * size || !inside(boundary, N, m.AC / m.A)) return;
    ConvexPiece kept{piece.polygon, {}};
    for (const HalfSpace& edge : piece.edges) {
      const auto touching =
          std::count_if(piece.polygon.begin(), piece.polygon.end(),
                        [&](const Vec3& X) { return std::abs(edge.beyond(X)) < tiny; });
      if (touching >= 2) kept.edges.push_back(edge);
    }
    found.push_back(std::move(kept));
  }
};

}  // namespace

std::vector<ConvexPiece> convex_pieces(const std::vector<Segment>& segments, const Vec3& N,
                                       double tiny) {
  const std::vector<Segment> boundary = joined(segments, N, tiny);
  if (boundary.empty()) return {};
  const Vec3 centre = boundary.front()[0];
  double radius = 0;
  for (const Segment& s : boundary)
    for (const Vec3& X : s) radius = std::max(radius, (X - centre).norm());
  const Vec3 u = 2 * radius * N.unitOrthogonal(), v = N.cross(u);
  std::vector<Crossing> crossing;
  for (const Segment& s : boundary) crossing.push_back({s, left_of(s, N)});
  Halving halving{boundary, N, tiny, radius, {}};
  halving.run({{centre - u - v, centre + u - v, centre + u + v, centre - u + v}, {}}, crossing);
  return std::move(halving.found);
}

}  // namespace concord::particle::voronoi
