#include "tool_path/links.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ahm/util/small_math.hpp"

namespace ahm {

Vec3 any_perpendicular(const Vec3& axis) {
  const Vec3 any = std::abs(axis[0]) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  return normalized(any - dot(any, axis) * axis);
}

Linker::Linker(const MeshTree& part, const PathDomain& domain, const ToolPlacer& placer, double clearance)
    : part_(part),
      domain_(domain),
      placer_(placer),
      clearance_(clearance),
      extent_(bounding_box(domain.mesh.points).diagonal()) {
  const BoundingBox box = bounding_box(part.mesh().points);
  center_ = box.center();
  outside_ = 1.05 * (box.diagonal() / 2 + clearance + placer.offset());
}

bool Linker::can_rise(const Spot& spot, double share) const {
  return is_free(spot.position, spot.position + share * clearance_ * spot.axis, 0, share);
}

std::optional<Track> Linker::on_surface(const Spot& from, const Spot& to, double longest) const {
  if (distance(from.contact, to.contact) > longest) return {};
  if (domain_.surface.component(domain_.mesh.faces[to_size(from.point.face)][0]) !=
      domain_.surface.component(domain_.mesh.faces[to_size(to.point.face)][0]))
    return {};
  const exact::GeodesicPath path = domain_.path(from.point, to.point);
  if (path.status != Status::ok || path.length > longest) return {};
  if (placer_.offset() == 0) {
    Track track{from};
    for (std::size_t k = 1; k + 1 < path.points.size(); ++k) track.push_back(*placer_.at(path.points[k]));
    track.push_back(to);
    return track;
  }
  MeshCurve curve;
  append_path(domain_.mesh, path, curve);
  if (curve.faces.empty()) return Track{from, to};  // the same point
  curve.points.push_back(to.point);
  std::vector<Track> tracks = placer_.tracks(curve);
  if (tracks.size() != 1) return {};
  Track& track = tracks[0];
  track.front() = from;
  if (track.size() > 1) track.pop_back();
  track.push_back(to);
  return std::move(track);
}

std::optional<std::vector<Vec3>> Linker::through_space(const Spot& from, const Spot& to) const {
  if (!can_rise(from) || !can_rise(to)) return {};
  const Vec3 a = lifted(from), b = lifted(to);
  if (is_free(a, b)) return std::vector<Vec3>{a, b};
  if (const auto track = on_surface(from, to)) {
    std::vector<Vec3> over;
    double walked = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < track->size(); ++k) {
      if (k > 0) walked += distance((*track)[k].position, (*track)[k - 1].position);
      if (k + 1 < track->size() && walked < 0.25) continue;
      over.push_back(lifted((*track)[k])), walked = 0;
    }
    if (is_free(over)) return over;
  }
  for (double height = 2 * clearance_; height < 2 * extent_; height *= 2) {
    const std::vector<Vec3> over{a, from.position + height * from.axis, to.position + height * to.axis, b};
    if (is_free(over)) return over;
  }
  return {};
}

std::optional<std::vector<Vec3>> Linker::around(const Spot& from, const Spot& to) const {
  std::optional<std::vector<Vec3>> result = path_to_sphere(from);
  const std::optional<std::vector<Vec3>> in = result ? path_to_sphere(to) : std::nullopt;
  if (!in) return {};
  const Vec3 a = normalized(result->back() - center_), b = normalized(in->back() - center_);
  Vec3 side = b - dot(a, b) * a;
  if (!(norm(side) > 1e-6)) side = any_perpendicular(a);  // the same or opposite places
  const double angle = std::atan2(norm(cross(a, b)), dot(a, b));
  const auto parts = static_cast<int>(std::ceil(angle / 0.5));  // chords of 1.05 radii stay outside of the sphere
  for (int k = 1; k < parts; ++k) {
    const double turn = angle * k / parts;
    result->push_back(center_ + outside_ * (std::cos(turn) * a + std::sin(turn) * normalized(side)));
  }
  result->insert(result->end(), in->rbegin(), in->rend());
  return is_free(*result) ? result : std::nullopt;
}

/// Smallest distance from the surface of a lifted path at a share of the clearance.
double Linker::least_height(double share) const { return 0.99 * placer_.offset() + 0.25 * share * clearance_; }

/// Positions from the clearance over a spot, or half of it where there is no room, to the sphere around the surface: along the
/// axis, and straight on in the direction nearest to the axis that is free.
std::optional<std::vector<Vec3>> Linker::path_to_sphere(const Spot& spot) const {
  std::vector<Vec3> directions{spot.axis};
  for (const double x : {-1.0, 0.0, 1.0})
    for (const double y : {-1.0, 0.0, 1.0})
      for (const double z : {-1.0, 0.0, 1.0})
        if (x != 0 || y != 0 || z != 0) directions.push_back(normalized(Vec3{x, y, z}));
  std::stable_sort(directions.begin(), directions.end(),
                   [&](const Vec3& a, const Vec3& b) { return dot(a, spot.axis) > dot(b, spot.axis); });
  const double share = can_rise(spot) ? 1 : 0.5;
  if (share < 1 && !can_rise(spot, share)) return {};
  const double lowest = share * clearance_;
  std::vector<Vec3> path{spot.position + lowest * spot.axis};
  for (double height = lowest; height == lowest || height < 2 * outside_; height *= 2) {
    const Vec3 from = spot.position + height * spot.axis;
    if (height > lowest) {
      if (!is_free(path.front(), from)) return {};
      path = {path.front(), from};
    }
    for (const Vec3& direction : directions) {
      // |from + t direction - center| = radius of the sphere
      const Vec3 offset = from - center_;
      const double along = dot(offset, direction), square = dot(offset, offset) - outside_ * outside_;
      const double t = std::sqrt(std::max(0.0, along * along - square)) - along;
      const Vec3 end = from + t * direction;
      if (!(t > 0 && is_free(from, end))) continue;
      path.push_back(end);
      return path;
    }
  }
  return {};
}

/// Whether a segment keeps its distance from the surface, a quarter of the clearance. From every point, the excess of the distance
/// is a step that cannot reach the surface.
/// @param share_from, share_to  shares of the clearance at the ends; the height that is kept is proportional to them
bool Linker::is_free(const Vec3& from, const Vec3& to, double share_from, double share_to) const {
  const double length = distance(from, to), low = least_height(share_from), high = least_height(share_to);
  const double slope = length > 0 ? std::abs(high - low) / length : 0;
  for (double walked = 0;;) {
    const double share = length > 0 ? std::min(1.0, walked / length) : 1;
    const double excess = part_.distance((1 - share) * from + share * to) - ((1 - share) * low + share * high);
    if (excess < 0) return false;
    if (share >= 1) return true;
    walked += std::max(excess / (1 + slope), 0.025 * clearance_);
  }
}

bool Linker::is_free(const std::vector<Vec3>& points) const {
  for (std::size_t k = 1; k < points.size(); ++k)
    if (!is_free(points[k - 1], points[k])) return false;
  return true;
}

}  // namespace ahm
