#include "ahm/applications/surface_curve.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "ahm/error.hpp"
#include "ahm/surface/surface_lines.hpp"
#include "ahm/util/text.hpp"
#include "ahm/util/vec.hpp"
#include "joined_points.hpp"

namespace ahm {
namespace {

constexpr double most_points = 1e6;

/// A point of the curve: how the surface finds it, and where it is.
struct CurveSample {
  SurfacePoint point;
  Vec3 position;
  std::size_t piece;  ///< after which of the given points
  double along;       ///< the piece: in [0, 1)
};

/// Joins points by shortest paths: over flat faces, and without faces over tangent planes.
class Joiner {
 public:
  explicit Joiner(const Surface& surface)
      : surface_(surface), over_planes_(surface.faces().size() == 0), faces_(surface), reason_(faces_.reason) {}

  /// Corners of the shortest path; none where the surface has no paths, or does not join the points: then `reason` tells why.
  std::vector<Vec3> path(const SurfacePoint& from, const SurfacePoint& to) {
    std::vector<Vec3> corners;
    if (over_planes_) {
      corners = shortest_line(surface_, from, to).points;
    } else if (faces_.geodesics) {
      for (const exact::MeshPoint& point : faces_.geodesics->path(std::array{from, to}).points)
        corners.push_back(faces_.geodesics->position(point));
    } else {
      return corners;
    }
    if (corners.empty()) reason_ = "the surface does not connect their ends";
    return corners;
  }
  /// The same of points nearby: where it bends. None where there are no flat faces.
  std::vector<Vec3> short_path(const SurfacePoint& from, const SurfacePoint& to) const {
    if (!faces_.geodesics) return {};
    return bends(*faces_.geodesics, faces_.geodesics->locally_shortest_path(from, to));
  }
  const std::string& reason() const { return reason_; }

 private:
  const Surface& surface_;
  bool over_planes_;
  FlatFaces faces_;
  std::string reason_;
};

/// Places between the ends of a line of corners, no farther apart than a step.
std::vector<Vec3> along_line(const std::vector<Vec3>& corners, double step) {
  std::vector<Vec3> places;
  for (std::size_t k = 1; k < corners.size(); ++k) {
    const Vec3 &a = corners[k - 1], &b = corners[k];
    const int pieces = std::max(1, static_cast<int>(std::ceil(distance(a, b) / step)));
    for (int p = 1; p <= pieces; ++p) places.push_back(a + static_cast<double>(p) / pieces * (b - a));
  }
  if (!places.empty()) places.pop_back();
  return places;
}

/// How far along a line from `from` to `to` its places are: shares of its length.
std::vector<double> shares(const Vec3& from, const std::vector<Vec3>& places, const Vec3& to) {
  std::vector<double> along;
  double length = 0;
  for (std::size_t p = 0; p < places.size(); ++p)
    along.push_back(length += distance(p > 0 ? places[p - 1] : from, places[p]));
  length += places.empty() ? 0 : distance(places.back(), to);
  for (double& x : along) x /= length;
  return along;
}

double length_of(const std::vector<Vec3>& corners) {
  double length = 0;
  for (std::size_t k = 0; k + 1 < corners.size(); ++k) length += distance(corners[k], corners[k + 1]);
  return length;
}

/// The given points as corners, and points between them: on the shortest path, locally shortest between points closer than
/// four steps, else on the straight line. Notes the largest distance of these from the surface, and which lines are
/// straight against the rule.
std::vector<CurveSample> sample(const Surface& surface, std::span<const CurvePoint> given, bool closed, double step,
                                SurfaceCurve& curve) {
  std::vector<Vec3> corners;
  corners.reserve(given.size() + 1);
  for (const CurvePoint& point : given) {
    const auto* in_space = std::get_if<Vec3>(&point);
    corners.push_back(in_space ? *in_space : surface.position(std::get<SurfacePoint>(point)));
  }
  if (closed && !corners.empty()) corners.push_back(corners.front());
  if (const double length = length_of(corners); !(length / step < most_points))
    throw InvalidArgument("curve_too_long",
                          "the curve is " + detail::number(length) + " long, more than " + detail::number(most_points) +
                              " times half the mean edge length of " + detail::number(2 * step),
                          "is it in the units of the surface?");

  std::vector<CurveSample> samples;
  Joiner joiner(surface);
  const auto end_point = [&](std::size_t k) {
    const CurvePoint& end = given[k % given.size()];
    const auto* on_surface = std::get_if<SurfacePoint>(&end);
    return on_surface ? *on_surface : surface.closest_point(std::get<Vec3>(end)).point;
  };
  const auto project = [&](const Vec3& p, std::size_t piece, double along) {
    ClosestPoint closest = surface.closest_point(p);
    samples.push_back({std::move(closest.point), closest.position, piece, along});
    curve.gap = std::max(curve.gap, distance(closest.position, p));
  };
  for (std::size_t k = 0; k < corners.size(); ++k) {
    if (k + 1 == corners.size() && closed) break;
    if (const auto* on_surface = std::get_if<SurfacePoint>(&given[k]))
      samples.push_back({*on_surface, corners[k], k, 0});
    else
      project(corners[k], k, 0);
    if (k + 1 == corners.size()) break;
    std::vector<Vec3> line{corners[k], corners[k + 1]};
    const bool is_far = distance(line[0], line[1]) > 4 * step;
    if (std::vector<Vec3> path =
            is_far ? joiner.path(end_point(k), end_point(k + 1)) : joiner.short_path(end_point(k), end_point(k + 1));
        path.size() > 2 || (is_far && !path.empty()))
      line = std::move(path);
    else if (is_far && !(curve.straight_reason = joiner.reason()).empty())
      ++curve.straight;
    const std::vector<Vec3> places = along_line(line, step);
    const std::vector<double> along = shares(corners[k], places, corners[k + 1]);
    for (std::size_t p = 0; p < places.size(); ++p) project(places[p], k, along[p]);
  }
  return samples;
}

/// Leaves out points that coincide with the one before.
void thin(std::vector<CurveSample>& samples, bool closed, double least) {
  const auto close = [&](const CurveSample& a, const CurveSample& b) {
    return distance(a.position, b.position) < least;
  };
  samples.erase(std::unique(samples.begin(), samples.end(), close), samples.end());
  while (closed && samples.size() > 1 && close(samples.front(), samples.back())) samples.pop_back();
  const std::size_t needed = closed ? 3 : 2;
  if (samples.size() < needed)
    throw InvalidArgument("curve_too_short",
                          "the curve has " + std::to_string(samples.size()) + " different points on the surface",
                          "give at least " + std::to_string(needed) + (closed ? " for a closed curve" : ""));
}

/// Direction that halves the angle between arriving at point k and leaving it.
Vec3 tangent(const std::vector<CurveSample>& samples, std::size_t k, bool closed) {
  const std::size_t n = samples.size();
  Vec3 sum{};
  const auto add = [&](std::size_t from, std::size_t to) {
    const double length = distance(samples[from].position, samples[to].position);
    for (std::size_t a = 0; a < 3; ++a) sum[a] += (samples[to].position[a] - samples[from].position[a]) / length;
  };
  if (k > 0 || closed) add((k + n - 1) % n, k);
  if (k + 1 < n || closed) add(k, (k + 1) % n);
  if (!(dot(sum, sum) > 1e-6)) {
    const Vec3& p = samples[k].position;
    throw InvalidArgument(
        "curve_turns_back",
        "the curve turns back at " + detail::number(p[0]) + " " + detail::number(p[1]) + " " + detail::number(p[2]),
        "split it there");
  }
  return sum;
}

/// Without what is along the normal: a curve may run as steep as noise lets it.
Vec3 flattened(const Vec3& along, const std::optional<Frame>& frame) {
  return frame ? dot(along, frame->x) * frame->x + dot(along, frame->y) * frame->y : along;
}

/// The source seen from the other side of the surface.
Source mirrored(const Source& source) {
  Source result(2);
  for (std::size_t k = 0; k < source.vertices().size(); ++k) {
    std::vector<double> offset(source.offsets().begin() + static_cast<std::ptrdiff_t>(2 * k),
                               source.offsets().begin() + static_cast<std::ptrdiff_t>(2 * k + 2)),
        axes(source.axes().begin() + static_cast<std::ptrdiff_t>(4 * k),
             source.axes().begin() + static_cast<std::ptrdiff_t>(4 * k + 4));
    offset[1] = -offset[1], axes[1] = -axes[1], axes[3] = -axes[3];
    result.add(source.vertices()[k], source.weights()[k], offset, axes, source.place(k));
  }
  return result;
}

/// @param stroke_of  makes the stroke of samples, their sources and the lengths between them
template <class StrokeOf>
SurfaceCurve draw(const Surface& surface, std::span<const CurvePoint> given, bool closed, const StrokeOf& stroke_of) {
  const TangentGraph& graph = surface.graph();
  const double edge = graph.mean_edge_length() * graph.length_unit();
  SurfaceCurve curve;
  std::vector<CurveSample> samples = sample(surface, given, closed, edge / 2, curve);
  thin(samples, closed, 1e-6 * edge);

  const bool may_mirror = graph.transport_kind() == TransportKind::block;
  const std::size_t n = samples.size();
  std::vector<Source> sources;
  std::vector<double> lengths;
  Vec3 normal{};
  double side = 1;
  // Frames that look to different sides of the surface have different left sides.
  const auto turn_over = [&](const std::optional<Frame>& frame) {
    if (may_mirror && frame && dot(frame->normal, normal) < 0) side = -side;
    if (frame) normal = frame->normal;
  };
  for (std::size_t k = 0; k < n; ++k) {
    const Vec3 along = flattened(tangent(samples, k, closed), surface.source(samples[k].point).frame);
    const PlacedSource point = surface.source(samples[k].point, along);
    if (k == 0) curve.first = point.frame;
    turn_over(point.frame);
    sources.push_back(side < 0 ? mirrored(point.source) : point.source);
    curve.samples.push_back({samples[k].point, along, {}, 0, side < 0});
    curve.points.push_back(samples[k].position);
    if (k + 1 < n || closed) lengths.push_back(distance(samples[k].position, samples[(k + 1) % n].position));
  }
  if (closed) turn_over(curve.first);
  if (side < 0 && closed)
    throw InvalidArgument("curve_one_sided", "the curve runs along a one-sided band, so it has no left",
                          "leave it open");
  for (double length : lengths) curve.length += length, curve.jump = std::max(curve.jump, length);
  const std::vector<StrokePoint> stroke = stroke_of(samples, sources, lengths);
  for (std::size_t k = 0; k < n; ++k) {
    curve.samples[k].position = stroke[k].position;
    curve.samples[k].angle = stroke[k].angle;
  }
  curve.source = stroke_source(stroke);
  return curve;
}

/// Whether coordinates along a curve are those of a flat surface: along straight lines and circles. Beside other bends they are biased.
bool has_exact_coordinates(const SurfaceCurve& curve) {
  if (curve.shape->shape == StrokeShape::circle) return true;
  constexpr double straight = 1 - 1e-6;
  return !curve.shape->closed && distance(curve.points.front(), curve.points.back()) >= straight * curve.length;
}

/// From a point with these coordinates to the curve, in the plane of coordinates.
double distance_from_curve(double u, double v, double length, const StrokeOptions& shape) {
  if (shape.shape == StrokeShape::circle) return std::abs(std::hypot(u, v) - length / (2 * std::numbers::pi));
  return shape.closed ? std::abs(v) : std::hypot(std::max({0.0, -u, u - length}), v);
}

}  // namespace

SurfaceCurve draw_curve(const Surface& surface, std::span<const CurvePoint> given, const StrokeOptions& options) {
  SurfaceCurve curve = draw(surface, given, options.closed, [&](const auto&, const auto& sources, const auto& lengths) {
    return stroke_points(sources, lengths, options);
  });
  curve.shape = options;
  return curve;
}

SurfaceCurve draw_curve(const Surface& surface, std::span<const CurvePoint> given, std::span<const Vec2> positions,
                        bool closed) {
  if (positions.size() != given.size())
    throw InvalidArgument("'positions' has " + std::to_string(positions.size()) + " entries for " +
                          std::to_string(given.size()) + " points");
  return draw(surface, given, closed, [&](const auto& samples, const auto& sources, const auto& lengths) {
    std::vector<Vec2> places;
    for (const CurveSample& sample : samples) {
      const Vec2 &from = positions[sample.piece], &to = positions[(sample.piece + 1) % positions.size()];
      places.push_back(from + sample.along * (to - from));
    }
    return stroke_points(sources, lengths, places, closed);
  });
}

double reach_from_curve(const TangentGraph& graph, double radius) {
  return radius + 2 * graph.mean_edge_length() * graph.length_unit();
}

RowLogMap rows_from_curve(const Surface& surface, const LogMap& map, const SurfaceCurve& curve, double radius) {
  RowLogMap rows = surface.on_rows(map);
  rows.angle.clear();
  const TangentGraph& graph = surface.graph();
  const double quarter = 0.25 * graph.mean_edge_length() * graph.length_unit();
  const bool is_exact = map.method() == Method::exact, is_flat = curve.shape && has_exact_coordinates(curve);
  // By so much coordinates may be nearer to the truth than a front from samples.
  const auto slack_at = [&](double from_samples) {
    if (is_exact) return 0.0;
    if (is_flat) return quarter;
    return graph.is_delaunay() ? 0.0 : std::min(quarter, 0.005 * from_samples);
  };
  for (std::size_t i = 0; i < rows.u.size(); ++i) {
    if (curve.shape) {
      // Between samples the curve is nearer by no more than half a piece makes it, in the plane.
      const double from_samples = rows.distance[i], share = std::min(1.0, curve.jump / 2 / from_samples);
      const double least = from_samples * std::sqrt(1 - share * share);
      const double slack = slack_at(from_samples);
      const double in_plane = distance_from_curve(rows.u[i], rows.v[i], curve.length, *curve.shape);
      if (!std::isnan(from_samples))
        rows.distance[i] = std::clamp(in_plane, std::max(0.0, least - slack), from_samples + slack);
    }
    if (!(rows.distance[i] > radius)) continue;
    rows.u[i] = rows.v[i] = rows.distance[i] = NAN;
    for (std::vector<double>* more : {&rows.spread, &rows.error_estimate})
      if (!more->empty()) (*more)[i] = NAN;
    rows.status[i] = Status::beyond_radius;
    rows.vertex[i].reset();
  }
  return rows;
}

}  // namespace ahm
