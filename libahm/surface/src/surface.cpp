// Maps by rows, corners and points of a surface.
#include "ahm/surface/surface.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>
#include <string>
#include <utility>

#include "ahm/error.hpp"
#include "ahm/fields/distance.hpp"
#include "ahm/maps/straight_line.hpp"
#include "ahm/surface/detail/face_tree.hpp"
#include "ahm/surface/directions.hpp"
#include "ahm/surface/exact/flat_triangles.hpp"
#include "ahm/surface/polar_map_solver.hpp"
#include "ahm/surface/surface_point.hpp"
#include "ahm/util/parallel.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/text.hpp"
#include "ahm/util/vec.hpp"
#include "row_tree.hpp"

namespace ahm {

template <class... Visits>
struct Overloaded : Visits... {
  using Visits::operator()...;
};
template <class... Visits>
Overloaded(Visits...) -> Overloaded<Visits...>;

inline void check_finite(const Vec3& position) {
  if (!is_finite(position)) throw InvalidArgument("a position is not finite");
}

inline void check_finite(const TangentPoint& point) { check_finite(point.position); }

struct Surface::Lazy {
  std::once_flag once;
  std::optional<detail::FaceTree> tree;
  std::atomic<int> row_queries = 0;  ///< number of searches for the nearest row so far
  std::once_flag rows_once;
  std::optional<RowTree> rows;
};

Surface::Surface() : lazy_(std::make_unique<Lazy>()) {}
Surface::~Surface() = default;
Surface::Surface(Surface&&) noexcept = default;
Surface& Surface::operator=(Surface&&) noexcept = default;

std::vector<Vec3> Surface::normals(unsigned threads) const {
  Vec3 none;
  none.fill(std::numeric_limits<double>::quiet_NaN());
  std::vector<Vec3> result(rows().row_count(), none);
  detail::for_each_index(result.size(), threads, [&](std::size_t r) {
    if (const auto vertex = rows().vertex(Row(static_cast<Index>(r))))
      if (const auto frame = graph().frame(vertex->index)) result[r] = frame->normal;
  });
  return result;
}

Vertex Surface::vertex(Row row) const {
  if (const auto vertex = rows().vertex(row)) return *vertex;
  const auto [fault, text, remedy] = missing_vertex_reason(row);
  throw InvalidArgument(fault, "row " + std::to_string(row.index) + " " + std::string(text), std::string(remedy));
}

Row Surface::nearest_row(const Vec3& position) const {
  check_finite(position);
  const std::span<const Vec3> points = positions();
  if (points.empty()) throw InvalidArgument("the surface has no positions, so the nearest row is undefined");
  constexpr int few = 2;  // scans are faster than building a tree
  if (lazy_->row_queries >= few) {
    std::call_once(lazy_->rows_once, [&] { lazy_->rows.emplace(rows(), points, graph().size()); });
    return lazy_->rows->nearest(position);
  }
  ++lazy_->row_queries;
  Row best;
  double least = std::numeric_limits<double>::infinity();
  for (Index v = 0; v < graph().size(); ++v) {
    const std::optional<Row> row = rows().row(Vertex(v));
    if (!row) continue;
    const double away = distance(points[row->index], position);
    if (!(away < least)) continue;
    least = away;
    best = *row;
  }
  return best;
}

ClosestPoint Surface::closest_point(const Vec3& position) const {
  check_finite(position);
  if (faces().size() > 0 && !positions().empty()) {
    std::call_once(lazy_->once, [&] { lazy_->tree.emplace(positions(), faces()); });
    detail::FaceTree::Hit hit = lazy_->tree->nearest(position);
    return {std::move(hit.point), hit.position, hit.distance};
  }
  const Row row = nearest_row(position);
  const std::optional<Frame> frame = graph().frame(vertex(row).index);
  if (!frame)
    throw InvalidArgument("the graph has no frames in space, so the nearest point of its tangent planes is undefined");
  const Vec3 &point = positions()[row.index], away = position - point;
  const Vec3 along = away - dot(away, frame->normal) * frame->normal;
  double reach = 0;  // radius of the plane: distance of the farthest neighbor
  const Star star = graph().star(vertex(row).index);
  for (std::size_t e = 0; e < star.degree(); ++e) reach = std::max(reach, length(star.log(e)) * graph().length_unit());
  const double far = length(along);
  const Vec3 nearest = point + (far > reach ? reach / far : 1) * along;
  return {TangentPoint{row, nearest}, nearest, distance(position, nearest)};
}

Vec3 Surface::position(const SurfacePoint& point) const {
  const std::span<const Vec3> points = positions();
  if (points.empty()) throw InvalidArgument("the surface has no positions");
  const auto visit =
      Overloaded{[&](Row row) {
                   rows().vertices(row);  // checks the row
                   return points[row.index];
                 },
                 [&](const EdgePoint& edge) {
                   check(edge);
                   return (1 - edge.t) * points[edge.from.index] + edge.t * points[edge.to.index];
                 },
                 [&](const FacePoint& inside) {
                   check(inside);
                   Vec3 sum{};
                   const auto corners = faces()[inside.face];
                   for (std::size_t c = 0; c < corners.size(); ++c)
                     sum = sum + inside.barycentric[c] * points[corners[c]];
                   return sum;
                 },
                 [&](const TangentPoint& near) {
                   check_finite(near);
                   const std::optional<Frame> frame = graph().frame(vertex(near.row).index);
                   if (!frame) throw InvalidArgument("the graph has no frames in space");
                   return near.position - dot(near.position - points[near.row.index], frame->normal) * frame->normal;
                 }};
  return std::visit(visit, point);
}

double Surface::normal_error_degrees() const { return normal_error; }

namespace {

std::string where(const SurfacePoint& point) {
  return std::visit(
      Overloaded{[](Row row) { return "at row " + std::to_string(row.index); },
                 [](const EdgePoint& edge) { return "on the edge from row " + std::to_string(edge.from.index); },
                 [](const FacePoint& inside) { return "in face " + std::to_string(inside.face); },
                 [](const TangentPoint& near) { return "near row " + std::to_string(near.row.index); }},
      point);
}

}  // namespace

SurfaceSource Surface::source(const SurfacePoint& point, const std::optional<Vec3>& u_axis) const {
  if (!u_axis) return placed(point, u_axis);
  if (const std::optional<Frame> frame = placed(point, {}).frame)
    check_off_normal(*u_axis, frame->normal, normal_error_degrees(), where(point));
  return placed(point, u_axis);
}

Vec3 Surface::direction(const SurfacePoint& point, double angle) const {
  const std::optional<Frame> frame = source(point).frame;
  if (!frame) throw InvalidArgument("there is no u axis " + where(point) + "; use a vector instead of an angle");
  return std::cos(angle) * frame->x + std::sin(angle) * frame->y;
}

SurfaceSource Surface::placed(const SurfacePoint& point, const std::optional<Vec3>& u_axis) const {
  const auto visit = Overloaded{[&](Row row) { return source_at_row(row, u_axis); },
                                [&](const EdgePoint& edge) {
                                  check(edge);
                                  return source_on_edge(edge, u_axis);
                                },
                                [&](const FacePoint& inside) {
                                  check(inside);
                                  return source_in_face(inside, u_axis);
                                },
                                [&](const TangentPoint& near) { return source_near_row(near, u_axis); }};
  return std::visit(visit, point);
}

SurfaceSource Surface::source_at_row(Row row, const std::optional<Vec3>& u_axis) const {
  const Vertex v = vertex(row);
  SurfaceSource result{Source::at_vertex(v), {}, graph().frame(v.index), row};
  if (!positions().empty()) result.position = positions()[row.index];
  if (!u_axis) return result;
  result.source = Source::at_vertex(v, projected(graph(), v, *u_axis));
  result.frame = turned(*result.frame, *u_axis);
  return result;
}

SurfaceSource Surface::source_near_row(const TangentPoint& point, const std::optional<Vec3>& u_axis) const {
  SurfaceSource result = source_at_row(point.row, u_axis);
  const Vec3 place = position(point);
  const Vec3 back = result.position - point.position;
  const double offset[] = {dot(back, result.frame->x), dot(back, result.frame->y)}, identity[] = {1, 0, 0, 1};
  Source source(2);
  source.add(result.source.vertices()[0], 1.0, offset,
             result.source.axes().empty() ? std::span<const double>(identity) : result.source.axes());
  return {std::move(source), place, result.frame, std::nullopt};
}

SurfaceSource Surface::source_in_face(const FacePoint&, const std::optional<Vec3>&) const {
  throw InvalidArgument("this surface does not support sources in faces");
}

SurfaceSource Surface::source_on_edge(const EdgePoint& point, const std::optional<Vec3>& u_axis) const {
  const FacePoint inside = face_point(point);
  if (u_axis) return source_in_face(inside, u_axis);
  if (positions().empty()) throw InvalidArgument("the surface has no positions; give a u axis");
  return source_in_face(inside, positions()[point.to.index] - positions()[point.from.index]);
}

FacePoint Surface::face_point(const EdgePoint& point) const {
  const FaceList all = faces();
  for (std::size_t f = 0; f < all.size(); ++f) {
    const auto face = all[f];
    for (std::size_t c = 0; c < face.size(); ++c) {
      const std::size_t d = (c + 1) % face.size();
      const bool forward = face[c] == point.from.index && face[d] == point.to.index;
      if (!forward && !(face[c] == point.to.index && face[d] == point.from.index)) continue;
      FacePoint result{static_cast<Index>(f), std::vector<double>(face.size(), 0.0)};
      result.barycentric[c] = forward ? 1 - point.t : point.t;
      result.barycentric[d] = forward ? point.t : 1 - point.t;
      return result;
    }
  }
  throw InvalidArgument("rows " + std::to_string(point.from.index) + " and " + std::to_string(point.to.index) +
                        " are not joined by an edge");
}

FlatTriangles Surface::flat_approximation() const { return flat_triangles(); }

Method Surface::suggested_method() const { return choose_method(graph()); }

FlatTriangles Surface::flat_triangles() const {
  throw InvalidArgument("no_flat_triangles", "exact geodesics need faces, which this surface does not have",
                        "use the polar or the heat method");
}

exact::MeshPoint Surface::flat_point_in_face(const FacePoint&) const {
  throw InvalidArgument("no_flat_triangles", "this surface has no flat triangles", "use the heat method");
}

exact::MeshPoint Surface::flat_point(const FacePoint& point) const {
  check(point);
  return flat_point_in_face(point);
}

exact::MeshPoint Surface::flat_point(const EdgePoint& point) const {
  check(point);
  return flat_point_in_face(face_point(point));
}

Vertex Surface::corner_vertex(Index face, std::size_t corner) const {
  const FaceList all = faces();
  const auto given = all[face];
  const auto stored = corner_vertices().subspan(all.begin[face], given.size());
  const auto second = rows().vertices(Row(given[1]));
  const bool reversed = std::find(second.begin(), second.end(), Vertex(stored[1])) == second.end();
  return Vertex(stored[reversed ? (given.size() - corner) % given.size() : corner]);
}

void Surface::check(const FacePoint& point) const {
  const FaceList all = faces();
  if (point.face < 0 || static_cast<std::size_t>(point.face) >= all.size())
    throw InvalidArgument("face " + std::to_string(point.face) + " is outside [0, " + std::to_string(all.size()) + ")");
  const std::size_t m = all[point.face].size();
  const std::string where = "face " + std::to_string(point.face);
  if (point.barycentric.size() != m)
    throw InvalidArgument(where + " needs " + std::to_string(m) + " barycentric coordinates, found " +
                          std::to_string(point.barycentric.size()) + " instead");
  double sum = 0;
  for (double w : point.barycentric) {
    if (!(w >= -1e-9) || !std::isfinite(w))
      throw InvalidArgument("a barycentric coordinate in " + where + " is " + detail::number(w) +
                            "; they must be finite and >= 0");
    sum += w;
  }
  if (!(std::abs(sum - 1) <= 1e-9))
    throw InvalidArgument("the barycentric coordinates in " + where + " have sum " + detail::number(sum) + ", not 1");
}

void Surface::check(const EdgePoint& point) const {
  vertex(point.from), vertex(point.to);
  if (!(point.t >= 0 && point.t <= 1))
    throw InvalidArgument("t is " + detail::number(point.t) + " on an edge; it must be in [0, 1]");
}

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// The vertex of a row whose coordinates are nearest to the source; none where no vertex has coordinates.
struct Best {
  std::optional<Vertex> vertex;
  Status status = Status::removed;

  Best(const LogMap& map, const RowMap& rows, Row row)
      : vertex(rows.least(row, [&](Vertex v) { return map.distance(v); })) {
    if (vertex)
      status = Status::ok;
    else if (const auto all = rows.vertices(row); !all.empty())
      status = map.status(all.back());
  }
};

}  // namespace

RowLogMap Surface::to_rows(const LogMap& map, unsigned threads) const {
  check_map(map);
  // Distances that are not exact may be shorter than the straight line, which is a lower bound.
  const auto source = map.method() != Method::exact ? straight_line_origin(graph(), map.source()) : std::nullopt;
  const auto n = static_cast<std::size_t>(rows().row_count());
  const std::vector<double> none(n, nan);
  RowLogMap result{none, none, none, none, none, {}, {}, std::vector<Status>(n, Status::removed), {}};
  if (map.method() != Method::exact && !map.source().is_curve()) result.bounded = none;
  result.vertex.resize(n);
  const std::span<const double> error = map.error_estimate();
  if (!error.empty()) result.error_estimate = none;
  detail::for_each_index(n, threads, [&](std::size_t r) {
    const Best best(map, rows(), Row(static_cast<Index>(r)));
    result.status[r] = best.status;
    if (!best.vertex) return;
    const Vertex v = *best.vertex;
    // A row that was merged with the source has distance 0.
    const bool is_away = source && map.distance(v) > 0;
    const double line = is_away ? distance(graph().frame(v.index)->origin, *source) : 0;
    const double away = bounded_distance(line, map.distance(v));
    if (away > map.radius()) {
      result.status[r] = Status::beyond_radius;
      return;
    }
    const auto phi = map.coordinates(v);
    result.u[r] = phi[0];
    result.v[r] = phi[1];
    result.distance[r] = away;
    if (!result.bounded.empty()) result.bounded[r] = away > map.distance(v) ? 1 : 0;
    if (!map.spread().empty()) result.spread[r] = map.spread()[v.index];
    result.angle[r] = std::atan2(phi[1], phi[0]);
    if (!error.empty()) result.error_estimate[r] = error[v.index];
    result.vertex[r] = best.vertex;
  });
  return result;
}

std::vector<Vec2> Surface::to_corners(const LogMap& map) const {
  check_map(map);
  const FaceList all = faces();
  std::vector<Vec2> result(all.vertices.size(), Vec2{nan, nan});
  for (std::size_t f = 0; f < all.size(); ++f)
    for (std::size_t c = 0; c < all[f].size(); ++c) {
      const Vertex v = corner_vertex(static_cast<Index>(f), c);
      if (map.status(v) != Status::ok) continue;
      const auto phi = map.coordinates(v);
      result[static_cast<std::size_t>(all.begin[f]) + c] = {phi[0], phi[1]};
    }
  return result;
}

Sample Surface::at(const LogMap& map, const SurfacePoint& point) const {
  check_map(map);
  const auto at_row = [&](Row row) -> std::pair<Sample, Index> {
    const Best best(map, rows(), row);
    if (!best.vertex) return {{nan, nan, best.status}, -1};
    const auto phi = map.coordinates(*best.vertex);
    return {{phi[0], phi[1], Status::ok}, best.vertex->index};
  };
  const auto visit = Overloaded{[&](Row row) { return at_row(row).first; },
                                [&](const EdgePoint& edge) {
                                  check(edge);
                                  return sample_in_face(map, face_point(edge));
                                },
                                [&](const FacePoint& inside) {
                                  check(inside);
                                  return sample_in_face(map, inside);
                                },
                                [&](const TangentPoint& near) {
                                  check_finite(near);
                                  if (map.frames().empty())
                                    throw InvalidArgument("map_without_frames", "the map has no frames",
                                                          "solve with MapOptions::frames");
                                  auto [sample, v] = at_row(near.row);
                                  const auto frame = v < 0 ? std::nullopt : graph().frame(v);
                                  if (!frame) return sample;
                                  const Vec3 way = near.position - frame->origin;
                                  const double x = dot(way, frame->x), y = dot(way, frame->y);
                                  const auto U = map.frames().subspan(4 * static_cast<std::size_t>(v), 4);
                                  sample.u += U[0] * x + U[2] * y;
                                  sample.v += U[1] * x + U[3] * y;
                                  return sample;
                                }};
  return std::visit(visit, point);
}

Sample Surface::sample_in_face(const LogMap& map, const FacePoint& point) const {
  Sample sum{0, 0, Status::ok};
  for (std::size_t c = 0; c < point.barycentric.size(); ++c) {
    const Vertex v = corner_vertex(point.face, c);
    if (map.status(v) != Status::ok) return {nan, nan, map.status(v)};
    const auto phi = map.coordinates(v);
    sum.u += point.barycentric[c] * phi[0];
    sum.v += point.barycentric[c] * phi[1];
  }
  return sum;
}

void Surface::check_map(const LogMap& map) const {
  if (map.size() != graph().size() || map.dimension() != 2)
    throw InvalidArgument("the map has " + detail::counted(map.size(), "vertex") + " in dimension " +
                          std::to_string(map.dimension()) + ", this surface's graph has " +
                          std::to_string(graph().size()) + " in dimension 2: the map belongs to another graph");
}

std::vector<double> to_rows(const RowLogMap& rows, std::span<const double> values) {
  std::vector<double> result;
  result.reserve(rows.vertex.size());
  for (const std::optional<Vertex>& vertex : rows.vertex) {
    if (vertex && static_cast<std::size_t>(vertex->index) >= values.size())
      throw InvalidArgument("to_rows: there are " + detail::counted(values.size(), "value") +
                            ", but the map uses vertex " + std::to_string(vertex->index));
    result.push_back(vertex ? values[vertex->index] : nan);
  }
  return result;
}

std::vector<Vec3> distance_gradients(const Surface& surface, const LogMap& map, const RowLogMap& rows) {
  const VertexField gradient = distance_gradient(surface.graph(), map);
  std::vector<Vec3> result(rows.vertex.size(), Vec3{nan, nan, nan});
  for (std::size_t r = 0; r < result.size(); ++r) {
    if (!rows.vertex[r]) continue;
    const Index vertex = rows.vertex[r]->index;
    const double* g = gradient.values.data() + 2 * static_cast<std::size_t>(vertex);
    if (const std::optional<Frame> frame = surface.graph().frame(vertex)) result[r] = g[0] * frame->x + g[1] * frame->y;
  }
  return result;
}

}  // namespace ahm
