#include "particle/voronoi/tessellation.hpp"

#include "particle/voronoi/container.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace concord::particle::voronoi {
namespace {

/// What a cell shares with one particle or wall so far, relative to its particle, scaled.
struct Share {
  Index b, wall;
  Moments sum;
  std::vector<Polygon> shapes;
};

/// Faces of some particles' cells.
struct Batch {
  std::vector<Face> interior, walls;
  FacePolygons interior_polygons, wall_polygons;  // `face` counts within the batch
  Index lost = -1;                                ///< first particle without a cell
};

class CellMaker {
 public:
  CellMaker(const Region& region, int dim, double thickness, std::span<const Vec3> X,
            bool polygons, Container& near, Container* whole)
      : m_region(region), m_dim(dim), m_X(X), m_polygons(polygons), m_near(near),
        m_thickness(thickness), m_smallest(smallest_area(region, dim, thickness)) {
    if (whole) m_whole.emplace(*whole);
  }

  bool add(Index a, Batch& batch) {
    m_a = a;
    m_P = m_region.scale.factor * m_X[a];
    m_shares.clear();
    if (!m_near.cell(a, m_cell)) return false;
    if (!collect()) {  // the cell leaves the box around it: once more without
      m_shares.clear();
      if (!m_whole->cell(a, m_cell)) return false;
      collect();
    }
    if (!m_inside) return false;
    hand_over(batch);
    return true;
  }

 private:
  /// All shares of the cell in the body. False if the local box has cut it there.
  bool collect() {
    double radius = 0;
    for (int i = 0; i < m_cell.p; ++i)
      radius = std::max(radius, Eigen::Map<const Vec3>(m_cell.pts + 3 * i).norm());
    radius *= 0.5;  // voro++ keeps corners at twice their distance
    m_box_seen = m_inside = false;
    for (const std::vector<PlaneSide>& part : m_region.parts) {
      if (!cuts_of(part, radius)) continue;
      if (m_cuts.empty()) {
        m_touched.clear();
        add_faces(m_cell);
        break;  // all of it is in this part
      }
      voro::voronoicell_neighbor& piece = m_region.convex() ? m_cell : m_piece;
      if (!m_region.convex()) m_piece = m_cell;
      m_touched.clear();
      const bool left = std::all_of(m_cuts.begin(), m_cuts.end(),
                                    [&](const PlaneSide& p) { return trim(piece, p); });
      if (left) add_faces(piece);
    }
    return !m_box_seen;
  }

  /// The planes of a part that may cut the cell. False if the cell lies outside.
  bool cuts_of(const std::vector<PlaneSide>& part, double radius) {
    m_cuts.clear();
    for (const PlaneSide& p : part) {
      const Plane& plane = m_region.planes[p.plane];
      const double beyond = plane.side(p.side).beyond(m_P);
      if (beyond > radius) return false;
      const bool done = plane.supporting && beyond >= -reach * m_region.scale.spacing;
      if (beyond > -radius && !done) m_cuts.push_back(p);
    }
    return true;
  }

  /// Cuts by a plane, unless it only touches: voro++ would give a face that lies in it (between
  /// particles of a lattice) to the plane. False: nothing is left.
  bool trim(voro::voronoicell_neighbor& piece, const PlaneSide& p) {
    const HalfSpace half = m_region.planes[p.plane].side(p.side);
    const double offset = -half.beyond(m_P), touch = voro::tolerance / m_region.scale.spacing;
    bool inside = false, outside = false, touches = false;
    for (int i = 0; i < piece.p; ++i) {
      const double d = 0.5 * half.N.dot(Eigen::Map<const Vec3>(piece.pts + 3 * i)) - offset;
      inside = inside || d < -touch;
      outside = outside || d > touch;
      touches = touches || std::abs(d) <= touch;
    }
    if (!inside) return false;
    if (outside) return cut(piece, half, m_P, m_region.scale.spacing, face_id(p));
    if (touches && !m_region.planes[p.plane].walls[p.side].empty()) m_touched.push_back(p);
    return true;
  }

  void add_faces(voro::voronoicell_neighbor& cell) {
    m_inside = true;
    cell.neighbors(m_ids);
    cell.face_vertices(m_corners);
    std::size_t at = 0;
    for (const int id : m_ids) {
      const int count = m_corners[at];
      if (id == local_box) m_box_seen = true;
      if (id > m_a || id < local_box || !m_touched.empty()) {
        m_face.clear();
        for (int k = 1; k <= count; ++k)
          m_face.push_back(0.5 * Eigen::Map<const Vec3>(cell.pts + 3 * m_corners[at + k]));
        add_face(id);
      }
      at += static_cast<std::size_t>(count) + 1;
    }
  }

  void add_face(int id) {
    if (id < local_box) {
      const PlaneSide p = plane_side(id);
      const Index whole = m_region.planes[p.plane].whole();
      if (whole >= 0)
        add_share(-1, whole, m_face, m_region.planes[p.plane].half.N);
      else
        divide(p, -1);
      return;
    }
    if (id < 0) return;
    for (const PlaneSide& p : m_touched) {
      const HalfSpace half = m_region.planes[p.plane].half;
      const double offset = -half.beyond(m_P), touch = voro::tolerance / m_region.scale.spacing;
      if (std::all_of(m_face.begin(), m_face.end(), [&](const Vec3& X) {
            return std::abs(half.N.dot(X) - offset) <= touch;
          })) {
        divide(p, id);
        return;
      }
    }
    if (id > m_a) add_share(id, -1, m_face, normal_to(id));
  }

  Vec3 normal_to(Index b) const {
    return (m_region.scale.factor * (m_X[b] - m_X[m_a])).normalized();
  }

  /// Divides what lies on a plane among its walls. What lies on none is a face to particle b
  /// where the plane happens to bisect a and b, else a cut between parts of the body.
  void divide(const PlaneSide& p, Index b) {
    const Plane& plane = m_region.planes[p.plane];
    std::vector<Polygon> left = {m_face}, outside;
    Polygon beyond, inside;
    for (const Index w : plane.walls[p.side])
      for (const ConvexPiece& piece : m_region.pieces[w]) {
        outside.clear();
        for (Polygon& rest : left) {
          for (const HalfSpace& edge : piece.edges) {
            const HalfSpace half{edge.N, -edge.beyond(m_P)};
            clip(rest, half.opposite(), beyond);
            if (!beyond.empty()) outside.push_back(beyond);
            clip(rest, half, inside);
            std::swap(rest, inside);
            if (rest.empty()) break;
          }
          if (!rest.empty()) add_share(-1, w, rest, plane.half.N);
        }
        std::swap(left, outside);
      }
    for (const Polygon& rest : left)
      if (b > m_a) add_share(b, -1, rest, normal_to(b));
  }

  void add_share(Index b, Index wall, const Polygon& polygon, const Vec3& N) {
    auto share = std::find_if(m_shares.begin(), m_shares.end(),
                              [&](const Share& s) { return s.b == b && s.wall == wall; });
    if (share == m_shares.end()) {
      m_shares.push_back({b, wall, {}, {}});
      share = m_shares.end() - 1;
    }
    const Moments m = moments(polygon, N);
    share->sum.A += m.A;
    share->sum.AC += m.AC;
    if (m_polygons) share->shapes.push_back(polygon);
  }

  /// Into metres, sorted by neighbour and wall, without faces that are no more than edges.
  void hand_over(Batch& batch) {
    std::sort(m_shares.begin(), m_shares.end(), [](const Share& s, const Share& t) {
      return std::pair(s.b, s.wall) < std::pair(t.b, t.wall);
    });
    const Scale& scale = m_region.scale;
    const double area = m_dim == 3 ? 1 / (scale.factor * scale.factor)
                                   : m_thickness / (2 * scale.half_width * scale.factor);
    for (const Share& share : m_shares) {
      Face face{m_a, share.b, share.wall, area * share.sum.A, Vec3::Zero()};
      if (face.A <= m_smallest) continue;
      face.C = m_X[m_a] + share.sum.AC / (share.sum.A * scale.factor);
      if (m_dim == 2) face.C[2] = 0;
      std::vector<Face>& faces = share.b >= 0 ? batch.interior : batch.walls;
      FacePolygons& polygons = share.b >= 0 ? batch.interior_polygons : batch.wall_polygons;
      for (const Polygon& shape : share.shapes)
        keep_polygon(polygons, shape, static_cast<Index>(faces.size()));
      faces.push_back(face);
    }
  }

  void keep_polygon(FacePolygons& polygons, const Polygon& shape, Index face) {
    polygons.begin.push_back(polygons.points.size());
    polygons.face.push_back(face);
    for (const Vec3& corner : shape) {
      if (m_dim == 2 && corner[2] > 0) continue;  // of a slab's face the lower edge
      polygons.points.push_back(m_X[m_a] + corner / m_region.scale.factor);
      if (m_dim == 2) polygons.points.back()[2] = 0;
    }
  }

  const Region& m_region;
  int m_dim;
  std::span<const Vec3> m_X;
  bool m_polygons;
  Container::Search m_near;
  std::optional<Container::Search> m_whole;
  double m_thickness, m_smallest;

  Index m_a = 0;
  Vec3 m_P;
  bool m_box_seen = false, m_inside = false;  // some of the cell is on the box, in the body
  voro::voronoicell_neighbor m_cell, m_piece;
  std::vector<PlaneSide> m_cuts, m_touched;  // planes that cut the piece; that it only touches
  std::vector<int> m_ids, m_corners;
  Polygon m_face;
  std::vector<Share> m_shares;
};

void append(FacePolygons& all, const FacePolygons& more, std::size_t first_face) {
  for (const std::size_t begin : more.begin) all.begin.push_back(all.points.size() + begin);
  for (const Index face : more.face) all.face.push_back(static_cast<Index>(first_face) + face);
  all.points.insert(all.points.end(), more.points.begin(), more.points.end());
}

/// Batches one after the other, each freed when it is copied.
void join(std::vector<Batch>& batches, bool walls, Cells& cells) {
  for (Batch& batch : batches) {
    std::vector<Face>& faces = walls ? batch.walls : batch.interior;
    FacePolygons& polygons = walls ? batch.wall_polygons : batch.interior_polygons;
    append(cells.polygons, polygons, cells.faces.size());
    cells.faces.insert(cells.faces.end(), faces.begin(), faces.end());
    std::vector<Face>().swap(faces);
    polygons = {};
  }
}

}  // namespace

double smallest_area(const Region& region, int dim, double thickness) {
  const Scale& scale = region.scale;
  const double gap = 64 * std::numeric_limits<double>::epsilon() * region.extent();
  return gap / scale.factor * (dim == 3 ? scale.spacing / scale.factor : thickness);
}

Cells tessellate(const Region& region, int dim, double thickness, std::span<const Vec3> X,
                 const Executor& executor, const CellOptions& options) {
  Container near(region, dim, X, !region.convex());
  std::optional<Container> whole;
  if (!region.convex()) whole.emplace(region, dim, X, false);
  // Enough pieces for any number of threads, few enough that voro++'s search memory, which
  // grows with the body, stays linear.
  const std::size_t count = std::clamp<std::size_t>(X.size() / 512, 1, 64);
  std::vector<Batch> batches(count);
  executor.for_each(count, [&](std::size_t k) {
    CellMaker maker(region, dim, thickness, X, options.polygons, near,
                    whole ? &*whole : nullptr);
    for (std::size_t a = k * X.size() / count; a < (k + 1) * X.size() / count; ++a)
      if (!maker.add(static_cast<Index>(a), batches[k]) && batches[k].lost < 0)
        batches[k].lost = static_cast<Index>(a);
  });
  Cells cells;
  cells.dim = dim;
  cells.thickness = thickness;
  cells.walls = region.walls;
  std::size_t faces = 0;
  for (const Batch& batch : batches) {
    if (batch.lost >= 0) no_cell(X, batch.lost, options.where);
    faces += batch.interior.size() + batch.walls.size();
  }
  cells.faces.reserve(faces);
  join(batches, false, cells);
  cells.interior = cells.faces.size();
  join(batches, true, cells);
  cells.polygons.begin.push_back(cells.polygons.points.size());
  return cells;
}

}  // namespace concord::particle::voronoi
