// Maps on the rows, the corners and the points of a surface.
#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "ahm/error.hpp"
#include "ahm/fields/distance.hpp"
#include "ahm/maps/place_in_space.hpp"
#include "ahm/surface/surface.hpp"
#include "ahm/util/parallel.hpp"
#include "ahm/util/vec.hpp"
#include "visit_point.hpp"

namespace ahm {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Of the vertices of a row the one with coordinates nearest to the source; nothing where there is none.
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

RowLogMap Surface::on_rows(const LogMap& map, unsigned threads) const {
  check_map(map);
  // Distances that are not exact may be below the straight line, which no way on the surface is.
  const auto source = map.method() != Method::exact ? start_of_lines(graph(), map.source()) : std::nullopt;
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
    // A row that was joined with the source is there, too.
    const bool is_away = source && map.distance(v) > 0;
    const double line = is_away ? distance(graph().frame(v.index)->origin, *source) : 0;
    const double away = no_shorter_than(line, map.distance(v));
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

std::vector<Vec2> Surface::on_corners(const LogMap& map) const {
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
    throw InvalidArgument("the map has " + std::to_string(map.size()) + " vertices in dimension " +
                          std::to_string(map.dimension()) + ", this surface's graph has " +
                          std::to_string(graph().size()) + " in dimension 2: it belongs to another graph");
}

std::vector<double> on_rows(const RowLogMap& rows, std::span<const double> values) {
  std::vector<double> result;
  result.reserve(rows.vertex.size());
  for (const std::optional<Vertex>& vertex : rows.vertex) {
    if (vertex && static_cast<std::size_t>(vertex->index) >= values.size())
      throw InvalidArgument("on_rows: there are " + std::to_string(values.size()) +
                            " values, but the map has a vertex " + std::to_string(vertex->index));
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
