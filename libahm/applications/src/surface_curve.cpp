#include "ahm/applications/surface_curve.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "ahm/error.hpp"
#include "ahm/util/vec.hpp"
#include "curve_pieces.hpp"
#include "plane_curve.hpp"

namespace ahm {
namespace {

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

/// The direction of a curve in the tangent plane of a point. Of two segments that meet there, in faces on either side of an edge, the
/// one that lies in it.
Vec3 direction_at(const CurvePiece& piece, const std::optional<Frame>& frame) {
  if (!frame) return piece.leaving;
  const double arriving = std::abs(dot(piece.arriving, frame->normal)),
               leaving = std::abs(dot(piece.leaving, frame->normal));
  return flattened(arriving < leaving ? piece.arriving : piece.leaving, frame);
}

/// @param place_of  place_of(piece, s, length): where the middle of a piece, at arclength s, lies in the plane of coordinates
template <class PlaceOf>
SurfaceCurve draw(const Surface& surface, std::span<const CurvePoint> given, bool closed, const PlaceOf& place_of) {
  SurfaceCurve curve;
  const std::vector<CurvePiece> pieces = cut_curve(surface, given, closed, curve);
  const bool may_mirror = surface.graph().transport_kind() == TransportKind::block;
  std::vector<StrokePoint> stroke;
  Vec3 normal{};
  double side = 1, s = 0;
  // Frames that look to different sides of the surface have different left sides.
  const auto turn_over = [&](const std::optional<Frame>& frame) {
    if (may_mirror && frame && dot(frame->normal, normal) < 0) side = -side;
    if (frame) normal = frame->normal;
  };
  for (const CurvePiece& piece : pieces) {
    const Vec3 along = direction_at(piece, surface.source(piece.point).frame);
    const PlacedSource point = surface.source(piece.point, along);
    if (stroke.empty()) curve.first = point.frame;
    turn_over(point.frame);
    const auto [position, direction] = place_of(piece, s + piece.length / 2, curve.length);
    const double angle = std::atan2(direction[1], direction[0]);
    stroke.push_back({side < 0 ? mirrored(point.source) : point.source, piece.length, position, angle});
    curve.samples.push_back({piece.point, along, position, angle, side < 0});
    s += piece.length;
  }
  if (closed) turn_over(curve.first);
  if (side < 0 && closed)
    throw InvalidArgument("curve_one_sided", "the curve runs along a one-sided band, so it has no left",
                          "leave it open");
  curve.source = stroke_source(stroke);
  return curve;
}

/// Whether coordinates along a curve are those of a flat surface: along straight lines and circles. Beside other bends they are biased.
bool has_exact_coordinates(const SurfaceCurve& curve) {
  if (curve.shape->shape == StrokeShape::circle) return true;
  constexpr double straight = 1 - 1e-6;
  return !curve.shape->closed && distance(curve.points.front(), curve.points.back()) >= straight * curve.length;
}

/// Of a piece and the two beside it, since the curve may be nearest in these.
double longest_about(const SurfaceCurve& curve, std::size_t piece) {
  const std::size_t n = curve.pieces.size();
  const bool closed = curve.shape->closed;
  const double before = piece > 0 || closed ? curve.pieces[(piece + n - 1) % n] : 0,
               after = piece + 1 < n || closed ? curve.pieces[(piece + 1) % n] : 0;
  return std::max({before, curve.pieces[piece], after});
}

/// From a point with these coordinates to the curve, in the plane of coordinates.
double distance_from_curve(double u, double v, double length, const StrokeOptions& shape) {
  if (shape.shape == StrokeShape::circle) return std::abs(std::hypot(u, v) - length / (2 * std::numbers::pi));
  return shape.closed ? std::abs(v) : std::hypot(std::max({0.0, -u, u - length}), v);
}

}  // namespace

SurfaceCurve draw_curve(const Surface& surface, std::span<const CurvePoint> given, const StrokeOptions& options) {
  check_shape(options);
  SurfaceCurve curve = draw(surface, given, options.closed, [&](const CurvePiece&, double s, double length) {
    return place_in_plane(s, length, options.shape);
  });
  curve.shape = options;
  return curve;
}

SurfaceCurve draw_curve(const Surface& surface, std::span<const CurvePoint> given, std::span<const Vec2> positions,
                        bool closed) {
  directions_of(positions, given.size(), closed);  // of corners; inside the lines they are theirs
  return draw(surface, given, closed, [&](const CurvePiece& piece, double, double) {
    const Vec2 &from = positions[piece.after], &to = positions[(piece.after + 1) % positions.size()];
    const Vec2 direction = to - from;
    return PlanePlace{from + piece.along * direction, direction};
  });
}

double reach_from_curve(const SurfaceCurve& curve, double radius) { return radius + 2 * curve.jump; }

RowLogMap rows_from_curve(const Surface& surface, const LogMap& map, const SurfaceCurve& curve, double radius) {
  RowLogMap rows = surface.on_rows(map);
  rows.angle.clear();
  const bool is_exact = map.method() == Method::exact, is_flat = curve.shape && has_exact_coordinates(curve);
  // By so much of the distance coordinates may be nearer to the truth than a front from samples.
  const double slack = is_exact ? 0 : is_flat ? 0.015 : surface.graph().is_delaunay() ? 0 : 0.005;
  for (std::size_t i = 0; i < rows.u.size(); ++i) {
    if (curve.shape && rows.vertex[i] && !std::isnan(rows.distance[i])) {
      // Between its samples the curve is nearer by no more than half a piece makes it, before the first and after the last by half a
      // piece; how much of that, the coordinates tell.
      const double from_samples = rows.distance[i], u = rows.u[i], v = rows.v[i];
      const Index nearest = map.nearest()[rows.vertex[i]->index];
      const Vec2& sample = curve.samples[nearest].position;
      const double half = longest_about(curve, static_cast<std::size_t>(nearest)) / 2;
      const bool is_beyond = !curve.shape->closed && !(u >= 0 && u <= curve.length);
      const double away = std::min(1.0, half / from_samples);
      const double least = is_beyond ? from_samples - half : from_samples * std::sqrt(1 - away * away);
      const double in_plane = distance_from_curve(u, v, curve.length, *curve.shape),
                   sample_in_plane = std::hypot(u - sample[0], v - sample[1]);
      const double share = sample_in_plane > 0 ? std::min(1.0, in_plane / sample_in_plane) : 1;
      const double front = std::max({0.0, least, share * from_samples}), play = std::min(half, slack * from_samples);
      rows.distance[i] = std::clamp(in_plane, std::max(0.0, front - play), front + play);
    }
    if (!(rows.distance[i] > radius)) continue;
    rows.u[i] = rows.v[i] = rows.distance[i] = NAN;
    if (!rows.spread.empty()) rows.spread[i] = NAN;
    rows.status[i] = Status::beyond_radius;
    rows.vertex[i].reset();
  }
  return rows;
}

}  // namespace ahm
