#include "ahm/applications/stroke.hpp"

#include <cmath>
#include <numeric>
#include <string>

#include "ahm/error.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/text.hpp"
#include "ahm/util/vec.hpp"
#include "coverage.hpp"

namespace ahm {
namespace {

/// An edge of the path, as stored at vertex `from`.
struct PathEdge {
  Vec2 log;       ///< logarithm of the edge in the frame of `from`, world units
  bool mirrored;  ///< the frames of its two vertices have opposite orientations
};

PathEdge path_edge(const TangentGraph& graph, Vertex from, Vertex to) {
  const Star star = graph.star(from.index);
  const double unit = graph.length_unit();
  for (std::size_t e = 0; e < star.degree(); ++e) {
    if (star.neighbors[e] != to.index) continue;
    return {{star.log(e)[0] * unit, star.log(e)[1] * unit}, star.transport(e).reflects()};
  }
  throw InvalidArgument("vertices " + std::to_string(from.index) + " and " + std::to_string(to.index) +
                        " are consecutive in 'path' but not neighbors in the graph; add the vertices between them");
}

/// Unit direction that bisects the angle between arriving and leaving. At an end of the curve one of them is zero.
Vec2 bisector(const Vec2& arriving, const Vec2& leaving, std::size_t k) {
  Vec2 sum{};
  for (const Vec2& v : {arriving, leaving})
    if (const double norm = length(v); norm > 0)
      for (int a = 0; a < 2; ++a) sum[a] += v[a] / norm;
  const double norm = length(sum);
  if (!(norm > 1e-6))
    throw InvalidArgument("the curve, or its image in the plane, turns back or does not advance at point " +
                          std::to_string(k) + "; split it there");
  return {sum[0] / norm, sum[1] / norm};
}

/// The curve at each vertex of its path.
struct Curve {
  std::vector<Vec2> tangents;  ///< in the frame of the vertex, unit length
  std::vector<double> sides;   ///< +1: the left side of the curve is left in the vertex's frame; -1: it is right
  std::vector<double> s;       ///< arclengths
  std::vector<double> weights;
  double length = 0;
};

void check_path(const TangentGraph& graph, std::span<const Vertex> path, bool closed) {
  if (graph.dimension() != 2)
    throw InvalidArgument("the graph has dimension " + std::to_string(graph.dimension()) + ", not 2");
  if (path.size() < (closed ? 3U : 2U))
    throw InvalidArgument("'path' has " + detail::counted(path.size(), "vertex") + "; give at least " +
                          (closed ? "3" : "2"));
  for (const auto [vertex] : path)
    if (vertex < 0 || vertex >= graph.size())
      throw InvalidArgument("vertex " + std::to_string(vertex) + " of 'path' is outside [0, " +
                            std::to_string(graph.size()) + ")");
}

Curve follow(const TangentGraph& graph, std::span<const Vertex> path, bool closed) {
  check_path(graph, path, closed);
  const std::size_t n = path.size();
  Curve curve{{}, {}, {}, std::vector<double>(n, 0.0), 0};
  Vec2 arriving{};
  if (closed) {
    const Vec2 back = path_edge(graph, path[0], path[n - 1]).log;
    arriving = {-back[0], -back[1]};
  }
  double side = 1;
  for (std::size_t k = 0; k < n; ++k) {
    curve.s.push_back(curve.length);
    curve.sides.push_back(side);
    if (k + 1 == n && !closed) {
      curve.tangents.push_back(bisector(arriving, {}, k));
      break;
    }
    const std::size_t next = (k + 1) % n;
    const PathEdge there = path_edge(graph, path[k], path[next]), back = path_edge(graph, path[next], path[k]);
    curve.tangents.push_back(bisector(arriving, there.log, k));
    const double half = (length(there.log) + length(back.log)) / 4;
    curve.weights[k] += half;
    curve.weights[next] += half;
    curve.length += 2 * half;
    arriving = {-back.log[0], -back.log[1]};
    if (there.mirrored) side = -side;
  }
  if (closed && side < 0)
    throw InvalidArgument(
        "the closed 'path' runs along a one-sided band, so its left side is undefined; use an open path");
  return curve;
}

/// The u axis is the tangent, turned back by the angle of the curve in the plane of coordinates.
void add_sample(Source& source, Vertex vertex, double weight, const Vec2& z, const Vec2& tangent, double side,
                const Vec2& direction) {
  const auto point = static_cast<Index>(source.vertices().size());
  const Vec2 left{-side * tangent[1], side * tangent[0]};
  const double c = direction[0], s = direction[1];
  const double axes[] = {c * tangent[0] - s * left[0], s * tangent[0] + c * left[0], c * tangent[1] - s * left[1],
                         s * tangent[1] + c * left[1]};
  source.add(vertex, weight, z, axes, {point, 0, z});
}

void check_points(std::span<const Source> points, std::span<const double> lengths, bool closed) {
  const std::size_t least = closed ? 3 : 2;
  if (points.size() < least)
    throw InvalidArgument("'points' has " + detail::counted(points.size(), "entry") + "; give at least " +
                          std::to_string(least));
  if (lengths.size() != points.size() - (closed ? 0 : 1))
    throw InvalidArgument("'lengths' has " + detail::counted(lengths.size(), "entry") + " for " +
                          detail::counted(points.size(), "point") +
                          "; an open curve has one fewer, a closed one as many");
  for (std::size_t k = 0; k < lengths.size(); ++k)
    if (!(lengths[k] > 0) || !std::isfinite(lengths[k]))
      throw InvalidArgument("'lengths' [" + std::to_string(k) + "] is " + std::to_string(lengths[k]) +
                            ", not positive and finite; leave out points that coincide");
}

/// Weights each point by half of the lengths of its two segments. @param place_of  place_of(k), called in the order of
/// points
template <class PlaceOf>
std::vector<StrokePoint> weighted_by_length(std::span<const Source> points, std::span<const double> lengths,
                                            bool closed, const PlaceOf& place_of) {
  std::vector<StrokePoint> stroke;
  stroke.reserve(points.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    const double before = k > 0 ? lengths[k - 1] : closed ? lengths.back() : 0;
    const double after = k < lengths.size() ? lengths[k] : 0;
    const auto [position, direction] = place_of(k);
    stroke.push_back({points[k], (before + after) / 2, position, std::atan2(direction[1], direction[0])});
  }
  return stroke;
}

}  // namespace

void check_shape(const StrokeOptions& options) {
  if (options.shape == StrokeShape::circle && !options.closed)
    throw InvalidArgument("shape 'circle' requires a closed curve");
}

std::vector<Vec2> directions_of(std::span<const Vec2> positions, std::size_t points, bool closed) {
  if (positions.size() != points)
    throw InvalidArgument("'positions' has " + detail::counted(positions.size(), "entry") + " for " +
                          detail::counted(points, "point"));
  for (std::size_t k = 0; k < points; ++k)
    if (!all_finite(positions[k]))
      throw InvalidArgument("entry " + std::to_string(k) + " of 'positions' is not finite");
  std::vector<Vec2> directions;
  for (std::size_t k = 0; k < points; ++k) {
    const bool arrives = k > 0 || closed, leaves = k + 1 < points || closed;
    directions.push_back(bisector(arrives ? positions[k] - positions[(k + points - 1) % points] : Vec2{},
                                  leaves ? positions[(k + 1) % points] - positions[k] : Vec2{}, k));
  }
  return directions;
}

Source stroke_source(const TangentGraph& graph, std::span<const Vertex> path, const StrokeOptions& options) {
  check_shape(options);
  const Curve curve = follow(graph, path, options.closed);
  Source source(2);
  for (std::size_t k = 0; k < path.size(); ++k) {
    const auto [position, direction] = place_in_plane(curve.s[k], curve.length, options.shape);
    add_sample(source, path[k], curve.weights[k], position, curve.tangents[k], curve.sides[k], direction);
  }
  return source;
}

Source stroke_source(const TangentGraph& graph, std::span<const Vertex> path, std::span<const Vec2> positions,
                     bool closed) {
  const std::vector<Vec2> directions = directions_of(positions, path.size(), closed);
  const Curve curve = follow(graph, path, closed);
  Source source(2);
  for (std::size_t k = 0; k < path.size(); ++k)
    add_sample(source, path[k], curve.weights[k], positions[k], curve.tangents[k], curve.sides[k], directions[k]);
  return source;
}

Source stroke_source(std::span<const StrokePoint> points) {
  if (points.empty()) throw InvalidArgument("'points' is empty");
  Source source(2);
  for (std::size_t k = 0; k < points.size(); ++k) {
    const auto& [point, weight, position, angle] = points[k];
    if (point.dimension() != 2)
      throw InvalidArgument("point " + std::to_string(k) + " is a source of dimension " +
                            std::to_string(point.dimension().value_or(0)) + ", not 2; set its u axis");
    const double c = std::cos(angle), s = std::sin(angle);
    for (std::size_t i = 0; i < point.vertices().size(); ++i) {
      const auto z = point.offsets().subspan(2 * i, 2), U = point.axes().subspan(4 * i, 4);
      const double offset[] = {position[0] + c * z[0] - s * z[1], position[1] + s * z[0] + c * z[1]};
      const double axes[] = {c * U[0] - s * U[1], s * U[0] + c * U[1], c * U[2] - s * U[3], s * U[2] + c * U[3]};
      source.add(point.vertices()[i], weight * point.weights()[i], offset, axes,
                 {static_cast<Index>(k), length(z), position});
    }
  }
  return source;
}

std::vector<StrokePoint> stroke_points(std::span<const Source> points, std::span<const double> lengths,
                                       const StrokeOptions& options) {
  check_shape(options);
  check_points(points, lengths, options.closed);
  const double length = std::accumulate(lengths.begin(), lengths.end(), 0.0);
  double s = 0;
  return weighted_by_length(points, lengths, options.closed, [&](std::size_t k) {
    const PlanePoint at = place_in_plane(s, length, options.shape);
    s += k < lengths.size() ? lengths[k] : 0;
    return at;
  });
}

std::vector<StrokePoint> stroke_points(std::span<const Source> points, std::span<const double> lengths,
                                       std::span<const Vec2> positions, bool closed) {
  check_points(points, lengths, closed);
  const std::vector<Vec2> directions = directions_of(positions, points.size(), closed);
  return weighted_by_length(points, lengths, closed, [&](std::size_t k) {
    return PlanePoint{positions[k], directions[k]};
  });
}

Source stroke_source(std::span<const Source> points, std::span<const double> lengths, const StrokeOptions& options) {
  return stroke_source(stroke_points(points, lengths, options));
}

Source stroke_source(std::span<const Source> points, std::span<const double> lengths, std::span<const Vec2> positions,
                     bool closed) {
  return stroke_source(stroke_points(points, lengths, positions, closed));
}

}  // namespace ahm
