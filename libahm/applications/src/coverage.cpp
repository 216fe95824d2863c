#include "coverage.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <variant>

#include "ahm/applications/coverage.hpp"
#include "ahm/error.hpp"
#include "ahm/maps/cost.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/text.hpp"
#include "surface_curve.hpp"

namespace ahm {
namespace {

/// Removes the component of `v` along the unit vector `axis`.
void remove_component(Vec3& v, const Vec3& axis) {
  const double along = v[0] * axis[0] + v[1] * axis[1] + v[2] * axis[2];
  for (std::size_t c = 0; c < 3; ++c) v[c] -= along * axis[c];
}

/// @param has  begin of the message, for example "the path has 7"
/// @param points  number of points that memory must hold at once
void check_memory(const std::string& has, double points) {
  if (const double machine = machine_memory(); machine > 0 && points * sizeof(CoveragePoint) > machine)
    throw ResourceExhausted(has + " points, which do not fit into memory; enlarge spacing or step, or lower radius");
}

void check(const CoverageOptions& o) {
  const auto check_positive = [](const char* name, double value) {
    if (!(value > 0 && std::isfinite(value)))
      throw InvalidArgument(std::string(name) + " is " + detail::number(value) + "; it must be finite and > 0");
  };
  check_positive("radius", o.radius);
  check_positive("spacing", o.spacing);
  if (o.step != 0) check_positive("step", o.step);
  if (!std::isfinite(o.angle)) throw InvalidArgument("angle is not finite");
  const double step = o.step > 0 ? o.step : o.spacing / 2;
  const double points = (o.radius / o.spacing + 1) * (o.radius / step + 1) * std::numbers::pi;
  if (!(points < 1 << 30))
    throw InvalidArgument("the pattern has about " + detail::number(points) +
                          " points, more than 2^30; enlarge spacing or step, or lower radius");
  check_memory("the pattern has about " + detail::number(points), points);
}

/// A line of the raster at distance `across` from the source, in the direction (1, 0).
std::vector<Vec2> raster_line(double across, double radius, double step) {
  const double unit = power_of_two_below(radius), r = radius / unit, y = across / unit;
  const double half = unit * std::sqrt(std::max(0.0, (r - y) * (r + y)));
  const auto steps = static_cast<std::size_t>(std::ceil(2 * half / step * (1 - 1e-12)));
  std::vector<Vec2> line{{-half, across}};
  for (std::size_t k = 1; k <= steps; ++k)
    line.push_back({2 * half * static_cast<double>(k) / static_cast<double>(steps) - half, across});
  return line;
}

/// The Archimedean spiral r = b angle in steps of equal arclength s(angle) = b/2 (angle sqrt(1 + angle^2) + asinh angle).
std::vector<Vec2> spiral(double spacing, double radius, double step) {
  const double b = spacing / (2 * std::numbers::pi), last = radius / b;
  const auto arclength = [&](double angle) { return b / 2 * (angle * std::hypot(1, angle) + std::asinh(angle)); };
  const auto steps = static_cast<std::size_t>(std::ceil(arclength(last) / step));
  std::vector<Vec2> line{{0, 0}};
  double angle = 0;
  for (std::size_t k = 1; k <= steps; ++k) {
    const double s = arclength(last) * static_cast<double>(k) / static_cast<double>(steps);
    for (int newton = 0; newton < 50; ++newton) {  // s is convex: from the second iterate on, the angle decreases
      const double change = (arclength(angle) - s) / (b * std::hypot(1, angle));
      angle -= change;
      if (std::abs(change) <= 1e-14 * angle) break;
    }
    line.push_back({b * angle * std::cos(angle), b * angle * std::sin(angle)});
  }
  return line;
}

/// Maps planar lines to the surface, one after the other.
class SurfaceMapper {
 public:
  /// @param geodesics  joins the points by shortest paths; null: straight lines
  SurfaceMapper(const InverseMap& inverse, const CoverageOptions& options, const ExactGeodesics* geodesics)
      : inverse_(inverse),
        geodesics_(geodesics),
        spacing_(options.spacing),
        c_(std::cos(options.angle)),
        s_(std::sin(options.angle)) {}

  void add(const std::vector<Vec2>& line, Index number) {
    Vec2 before{};
    for (std::size_t k = 0; k < line.size(); ++k) {
      const Vec2 q{c_ * line[k][0] - s_ * line[k][1], s_ * line[k][0] + c_ * line[k][1]};
      auto point = inverse_.at(q[0], q[1]);
      const SurfacePoint last = last_place_;
      if (point && geodesics_ != nullptr) place(*point);
      if (!point || (size() > 0 && !reaches(last, *point, q, inverse_.max_stretch() * length(q - before)))) end_piece();
      if (point) append(*point, q, number);
      before = q;
    }
    end_piece();
    path_.planned += static_cast<Offset>(line.size());
  }

  CoveragePath result() { return std::move(path_); }

 private:
  std::size_t size() const { return path_.points.size() - begin_; }  // number of points of the current piece
  double distance(const InversePoint& point) const { return length(point.position - path_.points.back().position); }

  /// Finds the point on the surface. In polygons that are not flat, moves it to the triangles on which paths run.
  void place(InversePoint& point) {
    const Surface& surface = geodesics_->surface();
    last_place_ = surface.closest_point(point.position).point;
    const auto* inside = std::get_if<FacePoint>(&last_place_);
    if (inside != nullptr && surface.faces()[static_cast<std::size_t>(inside->face)].size() > 3)
      point.position = geodesics_->position(geodesics_->point(last_place_));
  }

  /// Whether the path from the last point to this one is at most `most` long. Appends the points where it bends to the
  /// piece.
  bool reaches(const SurfacePoint& from, const InversePoint& point, const Vec2& q, double most) {
    if (distance(point) > most) return false;
    if (geodesics_ == nullptr) return true;
    const CoveragePoint last = path_.points.back();
    const exact::GeodesicPath way = geodesics_->locally_shortest_path(from, last_place_);
    if (way.status != Status::ok || way.length > most) return false;
    const std::vector<Vec3> corners = bends(*geodesics_, way);
    double walked = 0;
    for (std::size_t k = 1; k + 1 < corners.size(); ++k) {
      walked += length(corners[k] - corners[k - 1]);
      const Vec2 at = last.coordinates + walked / way.length * (q - last.coordinates);
      InversePoint bend = inverse_.at(at[0], at[1]).value_or(point);
      bend.position = corners[k];
      append(bend, at, last.line);
      path_.points.back().between = true;
    }
    return true;
  }

  void append(const InversePoint& point, const Vec2& q, Index line) {
    if (path_.points.size() == path_.points.capacity()) check_room();
    const double arclength = size() == 0 ? 0.0 : path_.points.back().arclength + distance(point);
    path_.points.push_back(
        {point.position, point.normal, point.frame().x, q, path_.pieces, line, arclength, 0.0, false});
  }

  /// Checks memory before the vector of points doubles its capacity.
  void check_room() const {
    const std::size_t count = path_.points.size();
    check_memory("the path has more than " + std::to_string(count), 3.0 * static_cast<double>(count));
  }

  /// Completes headings and spacings of the current piece; a single point has none and is dropped.
  void end_piece() {
    const std::size_t count = size();
    if (count == 1) path_.points.pop_back();
    for (std::size_t k = 0; k < count && count > 1; ++k) complete(k, count);
    if (count > 1) ++path_.pieces;
    begin_ = path_.points.size();
  }

  /// Computes heading and spacing of a point from its neighbors in the piece.
  void complete(std::size_t k, std::size_t count) {
    const CoveragePoint &from = path_.points[begin_ + (k > 0 ? k - 1 : k)],
                        &to = path_.points[begin_ + std::min(k + 1, count - 1)];
    CoveragePoint& p = path_.points[begin_ + k];
    Vec3 chord = to.position - from.position;
    remove_component(chord, p.normal);
    if (const double norm = length(chord); norm > 0)
      for (std::size_t c = 0; c < 3; ++c) p.heading[c] = chord[c] / norm;

    const Vec2 t{to.coordinates[0] - from.coordinates[0], to.coordinates[1] - from.coordinates[1]};
    const double norm = length(t);
    p.spacing = std::numeric_limits<double>::quiet_NaN();
    for (double side : {spacing_, -spacing_}) {
      const Vec2 left{-t[1] / norm, t[0] / norm};
      const auto across = inverse_.at(p.coordinates[0] + side * left[0], p.coordinates[1] + side * left[1]);
      if (!across) continue;
      Vec3 way = across->position - p.position;
      if (length(way) > inverse_.max_stretch() * spacing_) continue;  // another sheet
      remove_component(way, p.heading);
      p.spacing = length(way);
      break;
    }
  }

  const InverseMap& inverse_;
  const ExactGeodesics* geodesics_;
  double spacing_, c_, s_;
  SurfacePoint last_place_ = Row{};  ///< last point of the pattern on the surface; used where paths join the points
  CoveragePath path_;
  std::size_t begin_ = 0;
};

CoveragePath map_to_surface(const InverseMap& inverse, const CoverageOptions& options,
                            const ExactGeodesics* geodesics) {
  const double step = options.step > 0 ? options.step : options.spacing / 2;
  SurfaceMapper mapper(inverse, options, geodesics);
  if (options.pattern == CoveragePattern::spiral) {
    mapper.add(spiral(options.spacing, options.radius, step), 0);
    return mapper.result();
  }
  const auto outermost = static_cast<Index>(options.radius / options.spacing);
  for (Index k = -outermost; k <= outermost; ++k) {
    std::vector<Vec2> line = raster_line(k * options.spacing, options.radius, step);
    if ((k + outermost) % 2 == 1) std::reverse(line.begin(), line.end());
    mapper.add(line, k + outermost);
  }
  return mapper.result();
}

}  // namespace

CoveragePath coverage_path(const InverseMap& inverse, const CoverageOptions& options) {
  check(options);
  return map_to_surface(inverse, options, nullptr);
}

CoveragePath coverage_path(const ExactGeodesics& geodesics, const InverseMap& inverse, const CoverageOptions& options) {
  check(options);
  return map_to_surface(inverse, options, &geodesics);
}

CoveragePath coverage_path(const Surface& surface, const InverseMap& inverse, const CoverageOptions& options) {
  check(options);
  const FlatFaces faces(surface);
  CoveragePath path =
      faces.geodesics ? coverage_path(*faces.geodesics, inverse, options) : coverage_path(inverse, options);
  path.straight_reason = faces.reason;
  return path;
}

}  // namespace ahm
