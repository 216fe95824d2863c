#include "triangle_mesh_surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "ahm/error.hpp"
#include "ahm/surface/detail/unfolded_corners.hpp"
#include "ahm/surface/directions.hpp"
#include "ahm/surface/exact/flat_triangles.hpp"
#include "ahm/surface/surface_triangles.hpp"
#include "ahm/util/memory.hpp"
#include "ahm/util/stopwatch.hpp"
#include "ahm/util/text.hpp"

namespace ahm::trimesh {
namespace {

/// The layout with side 0 along the x axis, from the x components of the other sides and the height y.
FaceLayout turned_to_x(double length, double x1, double x2, double y) {
  return {Vec2{length, 0}, Vec2{x1, y}, Vec2{x2, -y}};
}

}  // namespace

FaceLayout layout_of_positions(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 s0 = b - a, s1 = c - b, s2 = a - c;
  const double length = norm(s0);
  if (!(length > 0)) return {Vec2{0, 0}, Vec2{norm(s1), 0}, Vec2{-norm(s2), 0}};
  // The cross product of the two shorter sides is the most accurate one.
  const double l1 = norm(s1), l2 = norm(s2);
  const double longest = std::max({length, l1, l2});
  const double area = norm(longest == length ? cross(s1, s2) : longest == l1 ? cross(s2, s0) : cross(s0, s1));
  return turned_to_x(length, dot(s1, s0) / length, dot(s2, s0) / length, area / length);
}

FaceLayout layout_of_lengths(double l0, double l1, double l2) {
  if (!(l0 > 0)) return {Vec2{0, 0}, Vec2{l1, 0}, Vec2{-l2, 0}};
  // Kahan's stable form of 16 area^2, sides sorted.
  double x = l0, y = l1, z = l2;
  if (x < y) std::swap(x, y);
  if (y < z) std::swap(y, z);
  if (x < y) std::swap(x, y);
  const double area = 0.5 * std::sqrt(std::max(0.0, (x + (y + z)) * (z - (x - y)) * (z + (x - y)) * (x + (y - z))));
  // The apex c lies at distance l2 from a and l1 from b.
  const double c = 0.5 * (l0 + (l2 - l1) * ((l2 + l1) / l0));
  return turned_to_x(l0, c - l0, -c, area / l0);
}

double relative_height(const Vec2* sides) {
  const double l0 = dot(sides[0], sides[0]), l1 = dot(sides[1], sides[1]), l2 = dot(sides[2], sides[2]);
  const double longest = std::max({l0, l1, l2});
  const double area = longest == l0   ? cross(sides[1], sides[2])
                      : longest == l1 ? cross(sides[2], sides[0])
                                      : cross(sides[0], sides[1]);
  return longest > 0 ? area / longest : 0.0;
}

TriangleMeshSurface::Impl::StoredPoint TriangleMeshSurface::Impl::stored(const FacePoint& point) const {
  StoredPoint result{mesh.kept_corner(point.face, 0) / 3, {0, 0, 0}};
  for (int s = 0; s < 3; ++s) result.weight[mesh.kept_corner(point.face, s) % 3] += point.barycentric[s];
  return result;
}

FlipHistory::Point TriangleMeshSurface::Impl::locate(const FacePoint& point) const {
  auto [face, weight] = stored(point);
  double total = 0;
  for (double& w : weight) total += w = std::max(0.0, w);
  for (double& w : weight) w /= total;
  return triangulation.history().locate(face, weight);
}

Vec2 TriangleMeshSurface::Impl::input_side(Index face, int from, int to) const {
  const Half a = mesh.kept_corner(face, from), b = mesh.kept_corner(face, to);
  if (a == b) return {0, 0};
  const auto layout = mesh.layout(a / 3);
  return b == next(a) ? layout[a % 3] : -layout[b % 3];
}

Source TriangleMeshSurface::Impl::source(const FacePoint& point, Vec2 u) const {
  const FlipHistory::Point p = locate(point);
  const HalfEdges edges = triangulation.half_edges();
  const Vec2* side = triangulation.sides(p.face);
  const Vec2 corner[3] = {{0, 0}, side[0], -side[2]};
  const Vec2 at = p.weight[1] * corner[1] + p.weight[2] * corner[2];
  const Vec2 u_here = p.map(u);
  const double size = std::max({norm(side[0]), norm(side[1]), norm(side[2])});
  Source source(2);
  for (int s = 0; s < 3; ++s) {
    if (!(p.weight[s] > 0)) continue;
    const Half h = 3 * p.face + s;
    const Vec2 offset = corner[s] - at;
    const Vec2 z = product(conj(u_here), offset);
    const double position[] = {mesh.length_unit() * z[0], mesh.length_unit() * (p.map.mirrored ? -z[1] : z[1])};

    // Transport along the straight line to the corner, which has a known angle in the frame there.
    const double full = triangulation.angle(h);
    const bool at_corner = !(norm(offset) > 1e-14 * size);
    const double within = at_corner ? 0.5 * full : std::clamp(angle_between(side[s], -offset), 0.0, full);
    const Vec2 back = at_corner ? product(unit(within), normalized(side[s])) : normalized(-offset);
    const Index k = edges.tail[h];
    const bool forward = frames.forward(edges, h, true);
    const double angle =
        frames.angle[edges.directed(h, true)] + (forward ? within : -within) * frames.corner_scale(h, k);
    Vec2 axis = product(u_here, conj(back));
    if (!forward) axis = conj(axis);
    axis = normalized(product(axis, unit(angle)));
    // v is u rotated to the left in the layout of the source. Each change of orientation in between makes this a rotation to
    // the right.
    const bool reflects = p.map.mirrored == forward;
    const double axes[] = {axis[0], reflects ? axis[1] : -axis[1], axis[1], reflects ? -axis[0] : axis[0]};
    source.add(Vertex(k), p.weight[s], position, axes);
  }
  return source;
}

std::optional<Frame> TriangleMeshSurface::Impl::frame(const FacePoint& point) const {
  if (!mesh.has_positions()) return std::nullopt;
  const auto [face, weight] = stored(point);
  Vec3 corner[3], origin{0, 0, 0};
  for (int s = 0; s < 3; ++s) {
    const Index v = mesh.tails()[3 * face + s];
    corner[s] = mesh.position(Vertex(v));
    origin = origin + weight[s] * mesh.original_position(Vertex(v));
  }
  const int a = mesh.kept_corner(point.face, 0) % 3, b = mesh.kept_corner(point.face, 1) % 3;
  const Vec3 side = a != b ? corner[b] - corner[a] : corner[1] - corner[0];
  const Vec3 normal = cross(corner[1] - corner[0], corner[2] - corner[0]);
  if (!(norm(side) > 0) || !(norm(normal) > 0)) return std::nullopt;
  const Vec3 x = 1 / norm(side) * side, n = 1 / norm(normal) * normal;
  return Frame{origin, x, cross(n, x), n};
}

SurfaceSource TriangleMeshSurface::source_in_face(const FacePoint& point, const std::optional<Vec3>& u_axis) const {
  std::optional<Frame> frame = impl_->frame(point);
  const Vec2 side = impl_->input_side(point.face, 0, 1);
  Vec2 u = norm(side) > 0 ? normalized(side) : Vec2{1, 0};
  if (u_axis) {
    const std::string where = "in face " + std::to_string(point.face);
    if (!frame)
      throw InvalidArgument(where.substr(3) +
                            " has no plane in space (no positions, or no area), so a direction in space "
                            "has no meaning");
    const auto [x, y] = projected(frame->x, frame->y, *u_axis, where);
    u = normalized(product(normalized(Vec2{x, y}), u));
    frame = turned(*frame, *u_axis);
  }
  return {impl_->source(point, u), impl_->mesh.has_positions() ? position(point) : Vec3{}, frame, std::nullopt};
}

/// Searches the faces around all vertices of `from`. Only in a split mesh does a row have several vertices.
std::optional<TriangleMeshSurface::Impl::Edge> TriangleMeshSurface::Impl::edge(Row from, Row to) const {
  const HalfEdges edges = mesh.topology().half_edges();
  const auto ends = rows.vertices(to);
  for (Vertex v : rows.vertices(from)) {
    const Corner start = edges.rightmost({mesh.corners()[v.index], true});
    for (Corner c = start; c.half >= 0;) {
      const Index face = c.half / 3;
      const int at = c.half % 3;
      for (int other : {(at + 1) % 3, (at + 2) % 3})
        if (std::find(ends.begin(), ends.end(), Vertex(edges.tail[3 * face + other])) != ends.end())
          return Edge{face, mesh.stored_corner(face, at), mesh.stored_corner(face, other)};
      c = edges.turn_left(c);
      if (c == start) break;
    }
  }
  return std::nullopt;
}

SurfaceSource TriangleMeshSurface::source_on_edge(const EdgePoint& edge, const std::optional<Vec3>& u_axis) const {
  const FacePoint point = face_point(edge);
  SurfaceSource result = source_in_face(point, u_axis);
  const std::optional<Impl::Edge> place = impl_->edge(edge.from, edge.to);
  if (u_axis || !place) return result;
  result.source = impl_->source(point, normalized(impl_->input_side(place->face, place->from, place->to)));
  if (result.frame) result.frame = turned(*result.frame, positions()[edge.to.index] - positions()[edge.from.index]);
  return result;
}

FacePoint TriangleMeshSurface::face_point(const EdgePoint& edge) const {
  const std::optional<Impl::Edge> place = impl_->edge(edge.from, edge.to);
  if (!place) return Surface::face_point(edge);  // contracted, or not an edge
  FacePoint point{place->face, {0, 0, 0}};
  point.barycentric[place->from] = 1 - edge.t;
  point.barycentric[place->to] = edge.t;
  return point;
}

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

Vec2 coordinates(const LogMap& map, Index vertex) {
  const auto phi = map.coordinates(Vertex(vertex));
  return {phi[0], phi[1]};
}

/// A face laid out in the plane, with the map at its corners.
struct MappedFace {
  Vec2 side[3];  ///< vectors of the sides, world units
  Vec2 phi[3]{};

  MappedFace(const TriangleMesh& mesh, const Vec2* sides) {
    for (int s = 0; s < 3; ++s) side[s] = mesh.length_unit() * sides[s];
  }

  /// Whether the map keeps side s within a factor of 1.5.
  bool keeps(int s) const {
    const double mapped = norm(phi[(s + 1) % 3] - phi[s]), length = norm(side[s]);
    return mapped <= 1.5 * length && length <= 1.5 * mapped;
  }
  /// Whether the map is nearly isometric here. Where it blends the two sides of a cut, it turns faces over.
  bool is_sound(bool orientable) const {
    return keeps(0) && keeps(1) && keeps(2) && (!orientable || cross(phi[1] - phi[0], phi[2] - phi[0]) > 0);
  }
  /// Places the third corner so that the face keeps its shape, to the left or right of side s.
  void follow(int s, bool left) {
    const Vec2 a = phi[s], b = phi[(s + 1) % 3], along = normalized(b - a);
    // The apex relative to the middle of the side.
    const Vec2 apex = product(conj(normalized(side[s])), -0.5 * side[s] - side[(s + 2) % 3]);
    phi[(s + 2) % 3] = 0.5 * (a + b) + product(along, left ? apex : conj(apex));
  }
};

}  // namespace

std::vector<Vec2> TriangleMeshSurface::to_corners(const LogMap& map) const {
  check_map(map);
  const TriangleMesh& mesh = impl_->mesh;
  std::vector<Vec2> places(mesh.tails().size(), {nan, nan});
  for (Index f = 0; f < mesh.face_count(); ++f) {
    if (mesh.is_dropped(f)) continue;
    const std::array<Vec2, 3> side = mesh.layout(f);
    places[3 * f] = {0, 0}, places[3 * f + 1] = side[0], places[3 * f + 2] = -side[2];
  }
  const std::vector<Vec2> stored = detail::unfolded_corners(
      mesh.topology().half_edges(), {mesh.tails(), places, mesh.length_unit(), mesh.report().orientable}, map);
  std::vector<Vec2> result(stored.size(), {nan, nan});
  for (Index f = 0; f < mesh.face_count(); ++f) {
    if (mesh.is_dropped(f) && mesh.topology().stand_in(f)[0] < 0) continue;
    for (int s = 0; s < 3; ++s) result[3 * f + s] = stored[mesh.kept_corner(f, s)];
  }
  return result;
}

Sample TriangleMeshSurface::sample_in_face(const LogMap& map, const FacePoint& point) const {
  const FlipHistory::Point p = impl_->locate(point);
  const auto tail = impl_->triangulation.half_edges().tail;
  MappedFace face(impl_->mesh, impl_->triangulation.sides(p.face));
  for (int s = 0; s < 3; ++s) {
    const Index v = tail[3 * p.face + s];
    if (map.status(Vertex(v)) != Status::ok) return {nan, nan, map.status(Vertex(v))};
    face.phi[s] = coordinates(map, v);
  }
  const bool orientable = impl_->mesh.report().orientable;
  if (!face.is_sound(orientable)) {
    int side = 0;
    while (side < 3 && !face.keeps(side)) ++side;
    if (side == 3 || !orientable) return {nan, nan, Status::unreached};
    face.follow(side, true);
  }
  const Vec2 phi = p.weight[0] * face.phi[0] + p.weight[1] * face.phi[1] + p.weight[2] * face.phi[2];
  return {phi[0], phi[1], Status::ok};
}

TriangleMeshSurface::IntrinsicPoint TriangleMeshSurface::locate(const FacePoint& point) const {
  check(point);
  const FlipHistory::Point p = impl_->locate(point);
  const auto tail = impl_->triangulation.half_edges().tail;
  return {{tail[3 * p.face], tail[3 * p.face + 1], tail[3 * p.face + 2]}, p.weight, p.depth};
}

namespace {

void measure_edges(const IntrinsicTriangulation& triangulation, double length_unit, MeshDetails& report) {
  double shortest = HUGE_VAL, longest = 0;
  std::vector<double> longest_at(triangulation.half_edges().tail.size(), 0.0);  // per vertex; some are unused
  for (Half h = 0; h < triangulation.half_edges().size(); ++h) {
    if (triangulation.is_dropped(h / 3)) continue;
    const double length = triangulation.length(h);
    shortest = std::min(shortest, length);
    longest = std::max(longest, length);
    for (Index v : {triangulation.half_edges().tail[h], triangulation.half_edges().head(h)})
      longest_at[v] = std::max(longest_at[v], length);
  }
  double finest = longest;
  for (double length : longest_at)
    if (length > 0) finest = std::min(finest, length);
  report.finest = finest * length_unit;
  report.shortest_edge = shortest * length_unit;
  report.longest_edge = longest * length_unit;
}

/// The triangulation from which the graph is built. Lengths are changed only if flips do not end, or leave a side without
/// direction. Once edges without length are contracted, only flips of faces without area can make such a side.
IntrinsicTriangulation triangulate(const TriangleMesh& mesh, const MeshOptions& options, MeshDetails& report) {
  IntrinsicTriangulation triangulation(mesh, false, options.threads);
  measure_edges(triangulation, mesh.length_unit(), report);
  report.collinear = triangulation.thin_faces();
  report.degenerate_faces = report.dropped_faces + static_cast<Index>(report.collinear.size());
  if (!(report.longest_edge > 0)) throw InvalidGeometry("all vertices of the mesh are at the same place");
  auto flip = [&](IntrinsicTriangulation& t) {
    return !options.intrinsic_delaunay || t.flip_to_delaunay(options.threads, options.progress);
  };
  if (flip(triangulation) && triangulation.has_angles()) return triangulation;
  triangulation = IntrinsicTriangulation(mesh, true, options.threads);
  if (!flip(triangulation)) report.flips_stopped = true;
  if (!triangulation.has_angles())
    throw InvalidGeometry(
        "faces stay degenerate after mollification: edge lengths span too many orders of "
        "magnitude (" +
        detail::number(report.shortest_edge) + " to " + detail::number(report.longest_edge) + ")");
  return triangulation;
}

RowMap rows_of(const TriangleMesh& mesh) {
  return RowMap(mesh.report().vertices, mesh.vertex_count(), mesh.topology().rows());
}

exact::PolyhedralSurface polyhedron(const TriangleMesh& mesh, unsigned threads) {
  return {mesh.topology().half_edges(), [&](Index face) { return mesh.layout(face); }, mesh.corners(), threads};
}

/// The polyhedral surface without dropped faces.
exact::PolyhedralSurface polyhedron_of_kept(const TriangleMesh& mesh, unsigned threads) {
  const HalfEdges edges = mesh.topology().half_edges();
  std::vector<Half> place(edges.tail.size(), -1), corners;  // numbers of the half-edges that are kept
  std::vector<Index> kept;
  for (Index f = 0; f < edges.size() / 3; ++f) {
    if (mesh.is_dropped(f)) continue;
    for (int s = 0; s < 3; ++s) place[3 * f + s] = static_cast<Half>(3 * kept.size()) + s;
    kept.push_back(f);
  }
  std::vector<Index> tail;
  std::vector<Half> twin;
  std::vector<std::uint8_t> mirrored;
  for (Half h = 0; h < edges.size(); ++h) {
    if (place[h] < 0) continue;
    tail.push_back(edges.tail[h]);
    twin.push_back(edges.twin[h] < 0 ? edges.twin[h] : place[edges.twin[h]]);
    if (!edges.mirrored.empty()) mirrored.push_back(edges.mirrored[h]);
  }
  for (Half h : mesh.corners()) corners.push_back(place[h]);
  return {HalfEdges{tail, twin, mirrored}, [&](Index face) { return mesh.layout(kept[face]); }, corners, threads};
}

}  // namespace

TriangleMeshSurface::TriangleMeshSurface(std::unique_ptr<const Impl> impl) : impl_(std::move(impl)) {}
TriangleMeshSurface::~TriangleMeshSurface() = default;
TriangleMeshSurface::TriangleMeshSurface(TriangleMeshSurface&&) noexcept = default;
TriangleMeshSurface& TriangleMeshSurface::operator=(TriangleMeshSurface&&) noexcept = default;

const CsrGraph& TriangleMeshSurface::graph() const& { return impl_->graph; }
const RowMap& TriangleMeshSurface::rows() const { return impl_->rows; }
std::span<const Vec3> TriangleMeshSurface::positions() const { return impl_->mesh.input_positions(); }
FaceList TriangleMeshSurface::faces() const { return {impl_->mesh.topology().face_begin(), impl_->face_rows}; }
std::span<const Index> TriangleMeshSurface::corner_vertices() const { return impl_->mesh.tails(); }
const MeshDetails& TriangleMeshSurface::details() const noexcept { return impl_->details; }
const TriangleMesh& TriangleMeshSurface::mesh() const noexcept { return impl_->mesh; }

FlatTriangles TriangleMeshSurface::flat_triangles() const {
  const TriangleMesh& mesh = impl_->mesh;
  std::vector<Vec3> positions;
  if (mesh.has_positions()) {
    positions.reserve(static_cast<std::size_t>(mesh.vertex_count()));
    for (Index v = 0; v < mesh.vertex_count(); ++v) positions.push_back(mesh.original_position(Vertex(v)));
  }
  const auto make = details().dropped_faces == 0 ? polyhedron : polyhedron_of_kept;
  return {make(mesh, impl_->threads), std::move(positions), mesh.length_unit()};
}

exact::MeshPoint TriangleMeshSurface::flat_point_in_face(const FacePoint& point) const {
  const TriangleMesh& mesh = impl_->mesh;
  const auto [face, weight] = impl_->stored(point);
  Index kept = 0;
  for (Index f = 0; f < face; ++f) kept += !mesh.is_dropped(f);
  return {kept, weight};
}

Surface::Reason TriangleMeshSurface::missing_vertex_reason(Row row) const {
  const std::vector<Index>& used = impl_->face_rows;
  if (std::find(used.begin(), used.end(), row.index) == used.end()) return Surface::missing_vertex_reason(row);
  return {"row_without_area", "lies only in faces without area", "choose another one"};
}

Report TriangleMeshSurface::report() const {
  const MeshDetails& d = details();
  Report report{{"vertices", d.vertices},
                {"faces", d.topology.faces},
                {"edges", d.edges},
                {"flips", d.flips},
                {"merged_vertices", d.merged_vertices},
                {"dropped_faces", d.dropped_faces},
                {"mollification", d.mollification},
                {"degenerate_faces", d.degenerate_faces}};
  const Report topology = figures(d.topology);
  report.insert(report.end(), topology.begin(), topology.end());
  report.push_back({"seconds.checks", d.seconds_checks});
  report.push_back({"seconds.delaunay", d.seconds_delaunay});
  report.push_back({"seconds.graph", d.seconds_graph});
  return report;
}

std::vector<Warning> TriangleMeshSurface::warnings() const {
  const MeshDetails& d = details();
  std::vector<Warning> result;
  if (d.flips_stopped) result.push_back({"flips_stopped", {}, {}});
  const std::vector<Warning> topology = ahm::warnings(d.topology);
  result.insert(result.end(), topology.begin(), topology.end());
  if (d.merged_vertices > 0)
    result.push_back({"merged", {static_cast<double>(d.merged_vertices), static_cast<double>(d.dropped_faces)}, {}});
  if (!d.collinear.empty())
    result.push_back(
        {"collinear_faces", {static_cast<double>(d.collinear.size()), static_cast<double>(d.collinear.front())}, {}});
  if (d.mollification > 0)
    result.push_back({"mollified", {static_cast<double>(d.degenerate_faces), d.mollification}, {}});
  if (d.longest_edge > 1e6 * d.finest) result.push_back({"edge_lengths", {d.finest, d.longest_edge}, {}});
  return result;
}

TriangleMeshSurface TriangleMeshSurface::build(TriangleMesh mesh, const MeshOptions& options, double seconds_checks) {
  MeshDetails details;
  details.seconds_checks = seconds_checks;
  details.topology = mesh.report();
  details.vertices = mesh.vertex_count();
  details.merged_vertices = static_cast<Index>(mesh.topology().merged().size());
  for (std::uint8_t dropped : mesh.topology().dropped()) details.dropped_faces += dropped;
  detail::Stopwatch stopwatch;
  options.progress.step("flips", 0.0);
  IntrinsicTriangulation triangulation = triangulate(mesh, options, details);
  details.flips = static_cast<Offset>(triangulation.history().size());
  details.history_bytes = static_cast<Offset>(triangulation.history().bytes());
  details.mollification = triangulation.mollification() * mesh.length_unit();
  options.progress.step("flips", 1.0);
  details.seconds_delaunay = stopwatch.lap();

  VertexFrames frames = find_frames(mesh, triangulation, options.threads);
  CsrGraphData data = mesh_edges(mesh, triangulation, frames, options.clamp_weights, options.threads, details);
  data.is_delaunay = options.intrinsic_delaunay;
  data.frames = frames_in_space(mesh, options.threads);
  options.progress.step("graph", 1.0);
  details.seconds_graph = stopwatch.lap();
  RowMap rows = rows_of(mesh);
  std::vector<Index> face_rows = mesh.topology().given_corners();
  return TriangleMeshSurface(std::make_unique<const Impl>(
      Impl{std::move(mesh), std::move(triangulation), std::move(frames), CsrGraph(std::move(data)), details,
           std::move(rows), std::move(face_rows), options.threads}));
}

TriangleMeshSurface TriangleMeshSurface::build(TriangleMesh mesh, const MeshOptions& options) {
  return detail::with_memory_check("building the graph of a triangle mesh",
                                   [&] { return build(std::move(mesh), options, 0.0); });
}

TriangleMeshSurface TriangleMeshSurface::build(std::span<const Vec3> positions, std::span<const Triangle> faces,
                                               const MeshOptions& options) {
  const std::string what = "building the graph of a mesh of " + detail::counted(faces.size(), "face");
  return detail::with_memory_check(what, [&] {
    detail::Stopwatch stopwatch;
    options.progress.step("checks", 0.0);
    TriangleMesh mesh =
        TriangleMesh::from_positions(positions, faces, options.non_manifold, options.counts_as_reversed);
    return build(std::move(mesh), options, stopwatch.lap());
  });
}

}  // namespace ahm::trimesh
