#include "surface_curve.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <utility>
#include <variant>

#include "ahm/applications/stroke.hpp"
#include "ahm/error.hpp"
#include "ahm/graph/components.hpp"
#include "ahm/surface/surface_paths.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/text.hpp"
#include "ahm/util/vec.hpp"
#include "coverage.hpp"

namespace ahm {

/// A piece of the curve, described at its midpoint.
struct CurvePiece {
  SurfacePoint point;
  Vec3 arriving, leaving;  ///< directions of the segments that end and begin at `point`
  std::size_t after;       ///< index of the input point before the piece
  double along;            ///< share of the line to the next input point, in (0, 1)
  double length;
};

/// Joins the input points and cuts the lines into pieces (see `draw_curve`).
/// @param curve  receives points, pieces, length, gap, jump and the straight lines
/// @throws InvalidArgument (as `draw_curve`)
std::vector<CurvePiece> cut_curve(const Surface& surface, std::span<const CurvePoint> given, bool closed,
                                  SurfaceCurve& curve);

namespace {

/// Points within this distance of a straight line, relative to its length, lie on it.
constexpr double straight = 1e-11;

bool lies_between(const Vec3& from, const Vec3& at, const Vec3& to) {
  const double far = length(to - from);
  return !(far > 0) || length(cross((1 / far) * (at - from), (1 / far) * (to - from))) <= straight;
}

}  // namespace

FlatFaces::FlatFaces(const Surface& surface) {
  if (surface.faces().size() == 0 || surface.positions().empty()) return;
  try {
    geodesics.emplace(surface);
  } catch (const Cancelled&) {
    throw;
  } catch (const Error& e) {  // twisted polygons, faces without area
    reason = e.what();
  }
}

std::vector<Vec3> bends(const ExactGeodesics& geodesics, const exact::GeodesicPath& path) {
  std::vector<Vec3> kept;
  for (std::size_t k = 0; k < path.points.size(); ++k) {
    const Vec3 at = geodesics.position(path.points[k]);
    if (k > 0 && k + 1 < path.points.size() && lies_between(kept.back(), at, geodesics.position(path.points[k + 1])))
      continue;
    kept.push_back(at);
  }
  return kept;
}

namespace {

constexpr double max_points = 1e6;

/// Mean length of the edges around a point, world units.
double edge_length_at(const Surface& surface, const SurfacePoint& point) {
  return mean_edge(surface.graph(), surface.source(point).source.vertices());
}

/// A place on a line, with the directions of the segments that end and begin there. Inside a segment both are equal.
struct PlaceOnLine {
  Vec3 position, arriving, leaving;
};

/// A polyline, parameterized by arclength.
class Line {
 public:
  explicit Line(std::span<const Vec3> corners) {
    for (const Vec3& corner : corners) {
      const double along = corners_.empty() ? 0 : distance(corners_.back(), corner);
      if (!corners_.empty() && !(along > 0)) continue;
      begins_.push_back(length() + along);
      corners_.push_back(corner);
    }
  }
  double length() const { return begins_.empty() ? 0 : begins_.back(); }
  std::span<const Vec3> corners() const { return corners_; }
  /// @param s  in [0, length], length > 0
  PlaceOnLine at(double s) const {
    const double near = same_place * length();
    const auto next = std::ranges::lower_bound(begins_, s - near) - begins_.begin();
    const auto end = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(next, 1, std::ssize(corners_) - 1));
    const double share = (s - begins_[end - 1]) / (begins_[end] - begins_[end - 1]);
    const bool is_corner = std::abs(s - begins_[end]) <= near && end + 1 < corners_.size();
    return {corners_[end - 1] + share * (corners_[end] - corners_[end - 1]), direction(end),
            direction(is_corner ? end + 1 : end)};
  }

 private:
  /// A place this near to a corner, as a share of the length, is the corner.
  static constexpr double same_place = 1e-9;

  Vec3 direction(std::size_t end) const {
    return 1 / (begins_[end] - begins_[end - 1]) * (corners_[end] - corners_[end - 1]);
  }

  std::vector<Vec3> corners_;
  std::vector<double> begins_;  ///< arclength of each corner
};

/// Joins points by shortest paths: over flat faces or, on surfaces without faces, over tangent planes.
class PathJoiner {
 public:
  explicit PathJoiner(const Surface& surface)
      : surface_(surface), over_planes_(surface.faces().size() == 0), faces_(surface), reason_(faces_.reason) {}

  /// Corners of the shortest path. Empty if the surface has no paths or does not connect the points; `reason` returns
  /// which.
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
  /// Bends of the locally shortest path between nearby points. Empty where there are no flat faces.
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

double length_of(const std::vector<Vec3>& corners) {
  double length = 0;
  for (std::size_t k = 0; k + 1 < corners.size(); ++k) length += distance(corners[k], corners[k + 1]);
  return length;
}

[[noreturn]] void throw_too_long(double length, double edge) {
  throw InvalidArgument("curve_too_long",
                        "the curve has length " + detail::number(length) + ", more than " + detail::number(max_points) +
                            " times half an edge length of " + detail::number(edge),
                        "check that it is in the units of the surface");
}

[[noreturn]] void throw_turns_back(const Vec3& p) {
  throw InvalidArgument(
      "curve_turns_back",
      "the curve turns back at " + detail::number(p[0]) + " " + detail::number(p[1]) + " " + detail::number(p[2]),
      "split it there");
}

/// One line between input points, or several short lines that form one piece together.
struct CurveSection {
  std::vector<Vec3> corners;
  std::vector<std::size_t> lines;  ///< indices of the input points where its lines begin
  std::vector<double> ends;        ///< arclengths where its lines end
  bool is_path = false;            ///< on the surface, not only near it
};

/// Cuts a curve into pieces of about half of the local edge length. A face contains few pieces, and distant parts of the
/// surface do not change their number.
class CurveCutter {
 public:
  CurveCutter(const Surface& surface, std::span<const CurvePoint> given, bool closed, SurfaceCurve& curve)
      : surface_(surface), closed_(closed), curve_(curve), joiner_(surface) {
    for (const CurvePoint& point : given) {
      if (const auto* in_space = std::get_if<Vec3>(&point)) {
        corners_.push_back(*in_space);
        ClosestPoint closest = project(*in_space);
        ends_.push_back(std::move(closest.point));
        end_positions_.push_back(closest.position);
      } else {
        ends_.push_back(std::get<SurfacePoint>(point));
        end_positions_.push_back(surface.position(ends_.back()));
        corners_.push_back(end_positions_.back());
      }
    }
    if (!closed || given.empty()) return;
    corners_.push_back(corners_.front());
    ends_.push_back(ends_.front());
    end_positions_.push_back(end_positions_.front());
  }

  std::vector<CurvePiece> cut() {
    const double edge = ends_.empty() ? 0 : edge_length_at(surface_, ends_.front()), length = length_of(corners_);
    if (!(length <= max_points * edge / 2)) throw_too_long(length, edge);
    min_distance_ = 1e-6 * edge;
    CurveSection open;
    for (std::size_t k = 0; k + 1 < corners_.size(); ++k) {
      if (!(distance(corners_[k], corners_[k + 1]) > min_distance_)) continue;
      const double there = edge_length_at(surface_, ends_[k]);
      CurveSection line = join(k, there);
      const double least = 0.75 * (there / 2);
      if (line.ends.back() < least) {
        append(line, open);
        if (open.ends.back() < least) continue;
        line = std::exchange(open, {});
      } else {
        cut(std::exchange(open, {}));
      }
      cut(line);
    }
    cut(open);
    if (closed_ && begin_) check_turn(*last_, *begin_, corners_.front());
    if (closed_ && curve_.points.size() > 1) curve_.points.pop_back();  // the first one, repeated
    const std::size_t needed = closed_ ? 3 : 2;
    if (const std::size_t points = pieces_.size() + (closed_ || corners_.empty() ? 0 : 1); points < needed)
      throw InvalidArgument("curve_too_short",
                            "the curve has " + detail::counted(points, "different point") + " on the surface",
                            "give at least " + std::to_string(needed) + (closed_ ? " for a closed curve" : ""));
    return std::move(pieces_);
  }

 private:
  ClosestPoint project(const Vec3& p) {
    ClosestPoint closest = surface_.closest_point(p);
    curve_.gap = std::max(curve_.gap, distance(closest.position, p));
    return closest;
  }

  /// Joins an input point and the next one by a shortest path, or a locally shortest one if they are near; else by a
  /// straight line.
  /// @param edge  local edge length, world units
  CurveSection join(std::size_t k, double edge) {
    CurveSection line{{corners_[k], corners_[k + 1]}, {k}, {}, false};
    const bool is_far = distance(corners_[k], corners_[k + 1]) > 2 * edge;
    if (std::vector<Vec3> path =
            is_far ? joiner_.path(ends_[k], ends_[k + 1]) : joiner_.short_path(ends_[k], ends_[k + 1]);
        path.size() > 2 || (is_far && !path.empty())) {
      line.corners = std::move(path);
      line.is_path = surface_.faces().size() > 0;
    } else if (is_far && !(curve_.straight_reason = joiner_.reason()).empty()) {
      ++curve_.straight;
    }
    line.ends = {length_of(line.corners)};
    return line;
  }

  static void append(const CurveSection& line, CurveSection& to) {
    to.lines.push_back(line.lines.front());
    to.ends.push_back((to.ends.empty() ? 0 : to.ends.back()) + line.ends.back());
    to.corners.insert(to.corners.end(), line.corners.begin(), line.corners.end());
  }

  void check_turn(const Vec3& arriving, const Vec3& leaving, const Vec3& at) const {
    const Vec3 sum = arriving + leaving;
    if (!(dot(sum, sum) > 1e-6)) throw_turns_back(at);
  }

  void cut(const CurveSection& section) {
    const Line line(section.corners);
    if (!(line.length() > min_distance_)) return;
    if (last_) check_turn(*last_, line.at(0).leaving, corners_[section.lines.front()]);
    if (!begin_) begin_ = line.at(0).leaving;
    last_ = line.at(line.length()).arriving;
    if (section.lines.size() > 1) return add_short_lines(section, line);
    const auto on_surface = [&](double s) {
      return section.is_path ? line.at(s).position : project(line.at(s).position).position;
    };
    const std::vector<double> cuts = cuts_of(line);
    Vec3 from = on_surface(0);
    add_point(from);
    for (std::size_t p = 1; p < cuts.size(); ++p) {
      const double begin = cuts[p - 1], end = cuts[p], middle = (begin + end) / 2;
      const Vec3 to = on_surface(end);
      const double length = section.is_path ? end - begin : distance(from, to);
      if (!(length > min_distance_)) continue;
      const auto [position, arriving, leaving] = line.at(middle);
      const double along = middle / line.length();
      add_piece({project(position).point, arriving, leaving, section.lines.front(), along, length});
      if (!section.is_path) add_point(to);
      from = to;
    }
    if (section.is_path)
      for (const Vec3& corner : line.corners()) add_point(corner);
  }

  /// Adds short lines as one piece, in the direction from their begin to their end.
  void add_short_lines(const CurveSection& section, const Line& line) {
    double length = 0;
    for (const std::size_t k : section.lines) {
      length += distance(end_positions_[k], end_positions_[k + 1]);
      add_point(end_positions_[k]);
    }
    const Vec3 &from = end_positions_[section.lines.front()], &to = end_positions_[section.lines.back() + 1];
    add_point(to);
    if (!(distance(from, to) > min_distance_)) return;
    const double middle = line.length() / 2;
    const auto own = std::ranges::lower_bound(section.ends, middle) - section.ends.begin();
    const double begin = own > 0 ? section.ends[own - 1] : 0, along = (middle - begin) / (section.ends[own] - begin);
    const Vec3 direction = 1 / distance(from, to) * (to - from);
    add_piece({project(line.at(middle).position).point, direction, direction, section.lines[own], along, length});
  }

  void add_piece(CurvePiece piece) {
    curve_.length += piece.length;
    curve_.jump = std::max(curve_.jump, piece.length);
    curve_.pieces.push_back(piece.length);
    pieces_.push_back(std::move(piece));
  }

  /// Arclengths of the ends of pieces.
  std::vector<double> cuts_of(const Line& line) const {
    const double length = line.length();
    std::vector<double> cuts{0};
    while (cuts.back() < length) {
      const double edge = edge_length_at(surface_, surface_.closest_point(line.at(cuts.back()).position).point);
      if (!(edge > 0) || static_cast<double>(pieces_.size() + cuts.size()) > max_points) throw_too_long(length, edge);
      cuts.push_back(cuts.back() + edge / 2);
    }
    // Of the last two cuts, the one nearer to the line's end becomes the end.
    if (cuts.size() > 2 && cuts.back() - length > length - cuts[cuts.size() - 2]) cuts.pop_back();
    const double share = length / cuts.back();
    for (double& cut : cuts) cut *= share;
    cuts.back() = length;
    return cuts;
  }

  void add_point(const Vec3& p) {
    if (curve_.points.empty() || distance(curve_.points.back(), p) > min_distance_) curve_.points.push_back(p);
  }

  const Surface& surface_;
  bool closed_;
  SurfaceCurve& curve_;
  PathJoiner joiner_;
  std::vector<Vec3> corners_;        ///< input points in space; a closed curve repeats the first
  std::vector<SurfacePoint> ends_;   ///< the same points on the surface
  std::vector<Vec3> end_positions_;  ///< positions of `ends_`
  std::vector<CurvePiece> pieces_;
  std::optional<Vec3> begin_, last_;  ///< first direction of the curve, and last direction of its last line
  double min_distance_ = 0;           ///< points nearer than this coincide, world units
};

}  // namespace

std::vector<CurvePiece> cut_curve(const Surface& surface, std::span<const CurvePoint> given, bool closed,
                                  SurfaceCurve& curve) {
  return CurveCutter(surface, given, closed, curve).cut();
}

namespace {

/// Removes the normal component. On noisy points, a curve may run steeply.
Vec3 tangential(const Vec3& along, const std::optional<Frame>& frame) {
  return frame ? dot(along, frame->x) * frame->x + dot(along, frame->y) * frame->y : along;
}

/// The source mirrored: seen from the other side of the surface, v is negated.
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

/// The direction of a curve in the tangent plane of a point. Where two segments meet on an edge between faces, the one
/// nearer to that plane is used.
Vec3 direction_at(const CurvePiece& piece, const std::optional<Frame>& frame) {
  if (!frame) return piece.leaving;
  const double arriving = std::abs(dot(piece.arriving, frame->normal)),
               leaving = std::abs(dot(piece.leaving, frame->normal));
  return tangential(arriving < leaving ? piece.arriving : piece.leaving, frame);
}

/// @param place_of  place_of(piece, s, length): place of a piece's midpoint, at arclength s, in the plane of coordinates
template <class PlaceOf>
SurfaceCurve draw(const Surface& surface, std::span<const CurvePoint> given, bool closed, const PlaceOf& place_of) {
  SurfaceCurve curve;
  const std::vector<CurvePiece> pieces = cut_curve(surface, given, closed, curve);
  const bool may_mirror = surface.graph().transport_kind() == TransportKind::block;
  std::vector<StrokePoint> stroke;
  Vec3 normal{};
  double side = 1, s = 0;
  // Frames on opposite sides of the surface have opposite left sides.
  const auto update_side = [&](const std::optional<Frame>& frame) {
    if (may_mirror && frame && dot(frame->normal, normal) < 0) side = -side;
    if (frame) normal = frame->normal;
  };
  for (const CurvePiece& piece : pieces) {
    const Vec3 along = direction_at(piece, surface.source(piece.point).frame);
    const SurfaceSource point = surface.source(piece.point, along);
    if (stroke.empty()) curve.first = point.frame;
    update_side(point.frame);
    const auto [position, direction] = place_of(piece, s + piece.length / 2, curve.length);
    const double angle = std::atan2(direction[1], direction[0]);
    stroke.push_back({side < 0 ? mirrored(point.source) : point.source, piece.length, position, angle});
    curve.samples.push_back({piece.point, along, position, angle, side < 0});
    s += piece.length;
  }
  if (closed) update_side(curve.first);
  if (side < 0 && closed)
    throw InvalidArgument("curve_one_sided", "the curve runs along a one-sided band, so its left side is undefined",
                          "use an open curve");
  curve.source = stroke_source(stroke);
  return curve;
}

/// Whether coordinates are exact next to the curve on a flat surface: they are for straight lines and circles, and biased
/// at other bends.
bool has_exact_coordinates(const SurfaceCurve& curve) {
  if (curve.shape->shape == StrokeShape::circle) return true;
  constexpr double straight = 1 - 1e-6;
  return !curve.shape->closed && distance(curve.points.front(), curve.points.back()) >= straight * curve.length;
}

/// Length of the longest of a piece and its two neighbors; the nearest point of the curve may be in any of them.
double longest_nearby_piece(const SurfaceCurve& curve, std::size_t piece) {
  const std::size_t n = curve.pieces.size();
  const bool closed = curve.shape->closed;
  const double before = piece > 0 || closed ? curve.pieces[(piece + n - 1) % n] : 0,
               after = piece + 1 < n || closed ? curve.pieces[(piece + 1) % n] : 0;
  return std::max({before, curve.pieces[piece], after});
}

/// Distance of a point with these coordinates from the curve, in the plane of coordinates.
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
  directions_of(positions, given.size(), closed);  // checks the positions; the directions inside the lines are used
                                                   // below
  return draw(surface, given, closed, [&](const CurvePiece& piece, double, double) {
    const Vec2 &from = positions[piece.after], &to = positions[(piece.after + 1) % positions.size()];
    const Vec2 direction = to - from;
    return PlanePoint{from + piece.along * direction, direction};
  });
}

double map_radius_of_curve(const SurfaceCurve& curve, double radius) { return radius + 2 * curve.jump; }

RowLogMap rows_from_curve(const Surface& surface, const LogMap& map, const SurfaceCurve& curve, double radius) {
  RowLogMap rows = surface.to_rows(map);
  rows.angle.clear();
  const bool is_exact = map.method() == Method::exact, is_flat = curve.shape && has_exact_coordinates(curve);
  // Distances may follow the coordinates by this share, where coordinates are more accurate than a front from samples.
  const double slack = is_exact ? 0 : is_flat ? 0.015 : surface.graph().is_delaunay() ? 0 : 0.005;
  for (std::size_t i = 0; i < rows.u.size(); ++i) {
    if (curve.shape && rows.vertex[i] && !std::isnan(rows.distance[i])) {
      // The distance from samples is too long: beyond an end of the curve by up to half a piece, elsewhere by what half a
      // piece along the curve changes. The coordinates determine by how much.
      const double from_samples = rows.distance[i], u = rows.u[i], v = rows.v[i];
      const Index nearest = map.nearest()[rows.vertex[i]->index];
      const Vec2& sample = curve.samples[nearest].position;
      const double half = longest_nearby_piece(curve, static_cast<std::size_t>(nearest)) / 2;
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
