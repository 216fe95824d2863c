#include "face_mesh.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>

#include "ahm/error.hpp"
#include "ahm/surface/exact/flat_triangles.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/vec.hpp"

namespace ahm {
namespace {

using detail::Half;

/// A side of a face, by its two points in ascending order.
struct Side {
  std::uint64_t ends;
  Half half;
  bool operator<(const Side& other) const { return ends != other.ends ? ends < other.ends : half < other.half; }
};

void set_twins(FaceMesh& mesh) {
  const auto count = 3 * mesh.faces.size();
  std::vector<Side> sides;
  sides.reserve(count);
  for (std::size_t h = 0; h < count; ++h) {
    const auto half = static_cast<Half>(h);
    const auto [a, b] = std::minmax({mesh.tail(half), mesh.head(half)});
    sides.push_back({static_cast<std::uint64_t>(a) << 32 | static_cast<std::uint64_t>(b), half});
  }
  std::sort(sides.begin(), sides.end());
  mesh.twin.assign(count, -1);
  mesh.mirrored.assign(count, 0);
  for (std::size_t k = 0, end = 0; k < count; k = end) {
    while (end < count && sides[end].ends == sides[k].ends) ++end;
    if (end - k != 2) continue;
    const Half a = sides[k].half, b = sides[k + 1].half;
    mesh.twin[static_cast<std::size_t>(a)] = b, mesh.twin[static_cast<std::size_t>(b)] = a;
    if (mesh.tail(a) == mesh.tail(b))
      mesh.mirrored[static_cast<std::size_t>(a)] = mesh.mirrored[static_cast<std::size_t>(b)] = 1;
  }
}

/// Corners that belong together, as a forest.
class Groups {
 public:
  explicit Groups(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), std::size_t{0}); }
  std::size_t root(std::size_t k) {
    while (parent_[k] != k) k = parent_[k] = parent_[parent_[k]];
    return k;
  }
  void join(std::size_t a, std::size_t b) {
    a = root(a), b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::size_t> parent_;
};

/// Gives every fan of faces a point of its own, and drops points without faces.
void split_fans(FaceMesh& mesh) {
  const auto count = 3 * mesh.faces.size();
  Groups groups(count);
  for (std::size_t h = 0; h < count; ++h) {
    const auto half = static_cast<Half>(h);
    const Half twin = mesh.twin[h];
    if (twin < half) continue;
    const Half same = mesh.mirrored[h] != 0 ? twin : detail::next(twin),
               other = mesh.mirrored[h] != 0 ? detail::next(twin) : twin;
    groups.join(h, static_cast<std::size_t>(same));
    groups.join(static_cast<std::size_t>(detail::next(half)), static_cast<std::size_t>(other));
  }
  std::vector<Vec3> points;
  std::vector<Index> vertices, number(count, -1);
  for (std::size_t h = 0; h < count; ++h) {
    Index& corner = mesh.faces[h / 3][h % 3];
    const std::size_t root = groups.root(h);
    if (root == h) {
      number[h] = static_cast<Index>(points.size());
      points.push_back(mesh.points[static_cast<std::size_t>(corner)]);
      vertices.push_back(mesh.vertices[static_cast<std::size_t>(corner)]);
    }
    corner = number[root];
  }
  mesh.points = std::move(points);
  mesh.vertices = std::move(vertices);
}

/// The corners of all faces as fans of triangles of vertices, without triangles whose corners coincide.
FaceMesh fans(const Surface& surface) {
  const FaceList faces = surface.faces();
  const std::span<const Index> corners = surface.corner_vertices();
  std::vector<Triangle> triangles;
  for (std::size_t f = 0; f < faces.size(); ++f)
    for (auto c = static_cast<std::size_t>(faces.begin[f]) + 1; c + 1 < static_cast<std::size_t>(faces.begin[f + 1]);
         ++c) {
      const Triangle t{corners[static_cast<std::size_t>(faces.begin[f])], corners[c], corners[c + 1]};
      if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) triangles.push_back(t);
    }
  const auto n = static_cast<std::size_t>(surface.graph().size());
  std::vector<Vec3> points(n);
  for (std::size_t v = 0; v < n; ++v)
    if (const auto row = surface.rows().row(Vertex(static_cast<Index>(v))))
      points[v] = surface.positions()[static_cast<std::size_t>(row->index)];
  std::vector<Index> vertices(n);
  std::iota(vertices.begin(), vertices.end(), 0);
  return glued(std::move(points), std::move(triangles), std::move(vertices));
}

FaceMesh from_flat(const FlatTriangles& flat) {
  std::vector<Triangle> triangles;
  for (Index f = 0; f < flat.surface.face_count(); ++f) {
    const exact::HalfRecord side = flat.surface.record(3 * f);
    triangles.push_back({side.tail, side.head, side.apex});
  }
  std::vector<Index> vertices(flat.positions.size());
  std::iota(vertices.begin(), vertices.end(), 0);
  return glued(flat.positions, std::move(triangles), std::move(vertices));
}

}  // namespace

Vec3 FaceMesh::position(const exact::MeshPoint& point) const {
  const Triangle& f = faces[static_cast<std::size_t>(point.face)];
  Vec3 sum{};
  for (std::size_t c = 0; c < 3; ++c) sum = sum + point.barycentric[c] * points[static_cast<std::size_t>(f[c])];
  return sum;
}

Vec3 FaceMesh::area_normal(Index face) const {
  const Triangle& f = faces[static_cast<std::size_t>(face)];
  const Vec3 &a = points[static_cast<std::size_t>(f[0])], &b = points[static_cast<std::size_t>(f[1])],
             &c = points[static_cast<std::size_t>(f[2])];
  return cross(b - a, c - a);
}

double FaceMesh::area(Index face) const { return norm(area_normal(face)) / 2; }

FaceMesh glued(std::vector<Vec3> points, std::vector<Triangle> faces, std::vector<Index> vertices) {
  FaceMesh mesh{std::move(points), std::move(faces), std::move(vertices), {}, {}};
  set_twins(mesh);
  split_fans(mesh);
  return mesh;
}

FaceMesh face_mesh(const Surface& surface) {
  if (surface.positions().empty())
    throw InvalidArgument("no_positions", "curves in space need a surface with positions", "add positions");
  const FaceList faces = surface.faces();
  if (faces.size() == 0) return from_flat(surface.flat_approximation());
  if (surface.corner_vertices().size() == 3 * faces.size()) return fans(surface);
  try {
    return from_flat(surface.flat_triangles());
  } catch (const InvalidArgument&) {  // twisted polygons
    return fans(surface);
  }
}

exact::MeshPoint on_side(Half side, double share) {
  const auto s = static_cast<std::size_t>(side % 3);
  exact::MeshPoint point{side / 3, {0, 0, 0}};
  point.barycentric[s] = 1 - share;
  point.barycentric[(s + 1) % 3] = share;
  return point;
}

exact::MeshPoint in_face(const FaceMesh& mesh, const exact::MeshPoint& point, Index face) {
  if (point.face == face) return point;
  exact::MeshPoint result{face, {0, 0, 0}};
  const Triangle &from = mesh.faces[static_cast<std::size_t>(point.face)],
                 &to = mesh.faces[static_cast<std::size_t>(face)];
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t k = 0; k < 3; ++k)
      if (from[c] == to[k] && point.barycentric[c] != 0) result.barycentric[k] = point.barycentric[c];
  return result;
}

namespace {

/// Follows the curves of one level from face to face.
class LevelTracer {
 public:
  LevelTracer(const FaceMesh& mesh, std::span<const double> values, double level)
      : mesh_(mesh), values_(values), level_(level), visited_(mesh.size()) {}

  std::vector<MeshCurve> curves() {
    std::vector<MeshCurve> result;
    for (std::size_t f = 0; f < mesh_.size(); ++f) {
      const auto face = static_cast<Index>(f);
      if (visited_[f] != 0 || !is_crossed_face(face)) continue;
      MeshCurve curve;
      curve.closed = walk(face, curve);
      if (is_curve(curve)) result.push_back(std::move(curve));
    }
    return result;
  }

 private:
  bool is_above(Index point) const { return values_[static_cast<std::size_t>(point)] >= level_; }
  bool is_crossed(Half h) const { return is_above(mesh_.tail(h)) != is_above(mesh_.head(h)); }
  bool is_crossed_face(Index face) const {
    int above = 0;
    for (const Index p : mesh_.faces[static_cast<std::size_t>(face)]) {
      if (std::isnan(values_[static_cast<std::size_t>(p)])) return false;
      above += is_above(p);
    }
    return above == 1 || above == 2;
  }

  /// The side of a face where its segment ends (`end`) or starts.
  Half crossed_side(Index face, bool end) const {
    for (Half h = 3 * face; h < 3 * face + 3; ++h)
      if (is_crossed(h) && is_above(mesh_.head(h)) == end) return h;
    return -1;
  }

  /// The point of a side with the level, the same from both faces.
  exact::MeshPoint crossing(Half h) const {
    const Index a = mesh_.tail(h), b = mesh_.head(h);
    const double fa = values_[static_cast<std::size_t>(a)], fb = values_[static_cast<std::size_t>(b)];
    return on_side(h, a < b ? (level_ - fa) / (fb - fa) : 1 - (level_ - fb) / (fa - fb));
  }

  /// Follows the curve from a face in both directions. @return whether it is closed
  bool walk(Index first, MeshCurve& curve) {
    visited_[static_cast<std::size_t>(first)] = 1;
    curve.points = {crossing(crossed_side(first, false)), crossing(crossed_side(first, true))};
    curve.faces = {first};
    if (follow(crossed_side(first, true), curve)) {
      curve.points.pop_back();
      return true;
    }
    MeshCurve back;
    follow(crossed_side(first, false), back);
    std::reverse(back.points.begin(), back.points.end());
    std::reverse(back.faces.begin(), back.faces.end());
    curve.points.insert(curve.points.begin(), back.points.begin(), back.points.end());
    curve.faces.insert(curve.faces.begin(), back.faces.begin(), back.faces.end());
    return false;
  }

  /// Appends the faces beyond a side. @return whether the curve returned to a visited face, its first one
  bool follow(Half side, MeshCurve& curve) {
    for (;;) {
      const Half entered = mesh_.twin[static_cast<std::size_t>(side)];
      if (entered < 0 || !is_crossed_face(entered / 3)) return false;
      const Index face = entered / 3;
      if (visited_[static_cast<std::size_t>(face)] != 0) return true;
      visited_[static_cast<std::size_t>(face)] = 1;
      side = crossed_side(face, false) == entered ? crossed_side(face, true) : crossed_side(face, false);
      curve.points.push_back(crossing(side));
      curve.faces.push_back(face);
    }
  }

  bool is_curve(const MeshCurve& curve) const {
    for (const exact::MeshPoint& point : curve.points)
      if (mesh_.position(point) != mesh_.position(curve.points.front())) return true;
    return false;
  }

  const FaceMesh& mesh_;
  std::span<const double> values_;
  double level_;
  std::vector<std::uint8_t> visited_;
};

}  // namespace

std::vector<MeshCurve> level_curves(const FaceMesh& mesh, std::span<const double> values, double level) {
  return LevelTracer(mesh, values, level).curves();
}

}  // namespace ahm
