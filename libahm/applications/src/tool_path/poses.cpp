#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <unordered_set>
#include <utility>

#include "ahm/error.hpp"
#include "ahm/util/parallel.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/text.hpp"
#include "ahm/util/vec.hpp"
#include "tool_path/tool_path.hpp"

namespace ahm {
namespace {

using exact::MeshPoint;

constexpr double unlimited = std::numeric_limits<double>::infinity();

/// A point of the path on the mesh, with the position and the axis of the tool.
struct Spot {
  MeshPoint point;
  Vec3 contact, position, axis;
};
using Track = std::vector<Spot>;

/// The mean normal of the faces within a radius, weighted by area and falling to zero at the radius.
class SmoothNormals {
 public:
  SmoothNormals(const FaceMesh& mesh, double radius) : mesh_(mesh), radius_(radius) {
    for (std::size_t f = 0; f < mesh.size(); ++f) {
      normals_.push_back(mesh.area_normal(static_cast<Index>(f)));
      centers_.push_back(mesh.position({static_cast<Index>(f), {1.0 / 3, 1.0 / 3, 1.0 / 3}}));
    }
  }

  Vec3 at(const MeshPoint& point) const {
    const Vec3 position = mesh_.position(point);
    std::vector<Index> faces{point.face};
    std::unordered_set<Index> seen{point.face};
    Vec3 sum{};
    for (std::size_t k = 0; k < faces.size(); ++k) {
      const double share = distance(centers_[to_size(faces[k])], position) / radius_;
      if (k > 0 && share >= 1) continue;
      sum = sum + std::max(1 - share * share, 1e-3) * normals_[to_size(faces[k])];
      for (std::size_t s = 0; s < 3; ++s)
        if (const detail::Half twin = mesh_.twin[3 * to_size(faces[k]) + s]; twin >= 0 && seen.insert(twin / 3).second)
          faces.push_back(twin / 3);
    }
    const double length = norm(sum);
    const Vec3 own = normals_[to_size(point.face)];
    return length > 1e-6 * norm(own) ? (1 / length) * sum : normalized(own);
  }

 private:
  const FaceMesh& mesh_;
  double radius_;
  std::vector<Vec3> normals_, centers_;
};

/// Leaves out points where the chord stays within a tolerance of the points between its ends.
std::vector<MeshPoint> simplified(const FaceMesh& mesh, const std::vector<MeshPoint>& points, double step,
                                  double tolerance) {
  std::vector<Vec3> at;
  for (const MeshPoint& p : points) at.push_back(mesh.position(p));
  const auto fits = [&](std::size_t from, std::size_t to) {
    const Vec3 chord = at[to] - at[from];
    const double length = norm(chord);
    if (length > step) return false;
    for (std::size_t k = from + 1; k < to; ++k) {
      const Vec3 offset = at[k] - at[from];
      const double along = length > 0 ? std::clamp(dot(offset, chord) / (length * length), 0.0, 1.0) : 0;
      if (norm(offset - along * chord) > tolerance) return false;
    }
    return true;
  };
  std::vector<MeshPoint> result{points.front()};
  for (std::size_t from = 0; from + 1 < points.size();) {
    std::size_t to = from + 1;
    while (to + 1 < points.size() && fits(from, to + 1)) ++to;
    if (to + 1 == points.size() || distance(at[to], at[from]) > 0) result.push_back(points[to]);
    from = to;
  }
  return result;
}

/// A pass as a track; a closed one ends at its first point.
struct TrackedPass {
  Track track;
  PassOrigin origin;
  double distance;
  bool closed;

  const Vec3& first() const { return track.front().position; }
  const Vec3& last() const { return track.back().position; }

  void reverse() { std::reverse(track.begin(), track.end()); }
  /// Starts a closed pass at its point nearest to a position.
  void start_near(const Vec3& position) {
    if (!closed) return;
    track.pop_back();
    const auto nearest =
        std::ranges::min_element(track, {}, [&](const Spot& spot) { return ahm::distance(spot.position, position); });
    std::rotate(track.begin(), nearest, track.end());
    track.push_back(track.front());
  }
  /// Distance to its nearest possible start.
  double reach(const Vec3& position, bool may_reverse) const {
    if (!closed)
      return may_reverse ? std::min(ahm::distance(first(), position), ahm::distance(last(), position))
                         : ahm::distance(first(), position);
    double least = unlimited;
    const std::size_t stride = std::max<std::size_t>(1, track.size() / 64);
    for (std::size_t k = 0; k < track.size(); k += stride)
      least = std::min(least, ahm::distance(track[k].position, position));
    return least;
  }
};

/// Gives all passes the direction of the nearest pass that is nearer to the seed.
void align(std::vector<TrackedPass>& passes) {
  struct Sample {
    Vec3 position, direction;
  };
  std::vector<Sample> done;
  std::stable_sort(passes.begin(), passes.end(),
                   [](const TrackedPass& a, const TrackedPass& b) { return a.distance < b.distance; });
  const auto samples_of = [](const TrackedPass& pass) {
    std::vector<Sample> result;
    double walked = unlimited;
    for (std::size_t k = 0; k + 1 < pass.track.size(); ++k) {
      const Vec3 step = pass.track[k + 1].position - pass.track[k].position;
      if (walked >= 1) result.push_back({pass.track[k].position, step}), walked = 0;
      walked += norm(step);
    }
    return result;
  };
  for (TrackedPass& pass : passes) {
    double agreement = 0;
    const std::vector<Sample> own = samples_of(pass);
    const std::size_t stride = std::max<std::size_t>(1, own.size() / 8);
    for (std::size_t k = 0; k < own.size() && !done.empty(); k += stride) {
      const auto nearest = std::ranges::min_element(
          done, {}, [&](const Sample& sample) { return distance(sample.position, own[k].position); });
      agreement += dot(nearest->direction, own[k].direction);
    }
    if (agreement < 0) pass.reverse();
    const std::vector<Sample> now = samples_of(pass);
    done.insert(done.end(), now.begin(), now.end());
  }
}

/// Orders passes by their nearest ends, starting with the farthest pass from the seed.
std::vector<TrackedPass> by_nearest(std::vector<TrackedPass> passes, bool may_reverse) {
  std::vector<TrackedPass> result;
  std::vector<bool> used(passes.size(), false);
  std::size_t next = 0;
  for (std::size_t k = 1; k < passes.size(); ++k)
    if (passes[k].distance > passes[next].distance) next = k;
  while (result.size() < passes.size()) {
    used[next] = true;
    TrackedPass& pass = passes[next];
    if (!result.empty()) {
      const Vec3 from = result.back().last();
      if (pass.closed)
        pass.start_near(from);
      else if (may_reverse && distance(pass.last(), from) < distance(pass.first(), from))
        pass.reverse();
    }
    result.push_back(std::move(pass));
    const Vec3 from = result.back().last();
    double least = unlimited;
    for (std::size_t k = 0; k < passes.size(); ++k)
      if (!used[k])
        if (const double reach = passes[k].reach(from, may_reverse); reach < least) least = reach, next = k;
  }
  return result;
}

/// Shortens the links by 2-opt exchanges: reverses runs of passes while that shortens the travel.
void exchange(std::vector<TrackedPass>& passes) {
  const std::size_t n = passes.size();
  const auto gap = [&](std::size_t a, bool a_reversed, std::size_t b, bool b_reversed) {
    return distance(a_reversed ? passes[a].first() : passes[a].last(),
                    b_reversed ? passes[b].last() : passes[b].first());
  };
  constexpr int max_sweeps = 30;
  for (int sweep = 0; sweep < max_sweeps; ++sweep) {
    bool improved = false;
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = i; j < n; ++j) {
        // Reverses the run i ... j.
        double change = 0;
        if (i > 0) change += gap(i - 1, false, j, true) - gap(i - 1, false, i, false);
        if (j + 1 < n) change += gap(i, true, j + 1, false) - gap(j, false, j + 1, false);
        if (!(change < -1e-6)) continue;
        std::reverse(passes.begin() + static_cast<std::ptrdiff_t>(i),
                     passes.begin() + static_cast<std::ptrdiff_t>(j) + 1);
        for (std::size_t k = i; k <= j; ++k) passes[k].reverse();
        improved = true;
      }
    if (!improved) break;
  }
  for (std::size_t k = 1; k < n; ++k) passes[k].start_near(passes[k - 1].last());
}

/// A unit vector perpendicular to another one.
Vec3 any_perpendicular(const Vec3& axis) {
  const Vec3 any = std::abs(axis[0]) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  return normalized(any - dot(any, axis) * axis);
}

/// Finds links that do not cut the surface.
class Linker {
 public:
  Linker(const Surface& surface, const PathDomain& domain, const SmoothNormals& normals, double spacing,
         double clearance, double offset)
      : surface_(surface),
        domain_(domain),
        normals_(normals),
        spacing_(spacing),
        clearance_(clearance),
        offset_(offset) {
    Vec3 low = domain.mesh.points.front(), high = low;
    const auto enlarge = [&](const Vec3& p) {
      for (std::size_t axis = 0; axis < 3; ++axis)
        low[axis] = std::min(low[axis], p[axis]), high[axis] = std::max(high[axis], p[axis]);
    };
    for (const Vec3& p : domain.mesh.points) enlarge(p);
    extent_ = distance(low, high);
    for (const Vec3& p : surface.positions())
      if (is_finite(p)) enlarge((1 / spacing) * p);
    center_ = 0.5 * (low + high);
    outside_ = 1.05 * (distance(low, high) / 2 + clearance + offset);
  }

  Vec3 lifted(const Spot& spot) const { return spot.position + clearance_ * spot.axis; }

  /// Whether the tool can rise from the surface to a share of the clearance.
  bool can_rise(const Spot& spot, double highest = 1) const {
    for (const double part : {0.25, 0.5, 0.75, 1.0}) {
      const double share = part * highest;
      if (distance_from_surface(spot.position + share * clearance_ * spot.axis) < least_height(share)) return false;
    }
    return true;
  }

  /// The path on the surface, with both ends; none if it is longer than `longest`, or the surface does not connect the ends.
  std::optional<Track> on_surface(const Spot& from, const Spot& to, double longest) const {
    if (distance(from.contact, to.contact) > longest) return {};
    if (domain_.surface.component(domain_.mesh.faces[to_size(from.point.face)][0]) !=
        domain_.surface.component(domain_.mesh.faces[to_size(to.point.face)][0]))
      return {};
    const exact::GeodesicPath path = domain_.path(from.point, to.point);
    if (path.status != Status::ok || path.length > longest) return {};
    Track track{from};
    for (std::size_t k = 1; k + 1 < path.points.size(); ++k)
      if (!append(path.points[k], track)) return {};
    track.push_back(to);
    return track;
  }

  /// Positions from the clearance over one spot to the clearance over another, with both ends; none if there is no free path.
  std::optional<std::vector<Vec3>> through_space(const Spot& from, const Spot& to) const {
    if (!can_rise(from) || !can_rise(to)) return {};
    const Vec3 a = lifted(from), b = lifted(to);
    if (is_free(a, b)) return std::vector<Vec3>{a, b};
    if (const auto track = on_surface(from, to, unlimited)) {
      std::vector<Vec3> over;
      double walked = unlimited;
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

  /// Positions as of `through_space`, away from the surface to a sphere around it, along the sphere, and back.
  std::optional<std::vector<Vec3>> around(const Spot& from, const Spot& to) const {
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

  /// Appends the pose at a point to a track, unless the pose is the last one. @return whether a ball of the offset fits there
  bool append(const MeshPoint& point, Track& track) const {
    Spot spot{point, domain_.mesh.position(point), {}, normals_.at(point)};
    const std::optional<Vec3> position = offset_ > 0 ? ball_center(spot.contact, spot.axis) : spot.contact;
    if (!position) return false;
    spot.position = *position;
    if (offset_ > 0 && !track.empty() && distance(track.back().position, spot.position) < same_place) {
      if (dot(track.back().axis, spot.axis) > same_axis) return true;
      spot.position = track.back().position;  // the tool turns at this place
    }
    track.push_back(spot);
    return true;
  }

 private:
  /// Poses of an offset path that are closer are one place, in spacings, and directions with a larger cosine one axis.
  static constexpr double same_place = 0.0125, same_axis = 0.99;

  /// Smallest distance from the surface of a lifted path at a share of the clearance.
  double least_height(double share) const { return 0.99 * offset_ + 0.25 * share * clearance_; }

  /// The center of a ball that touches the surface from above, near a point. The ball grows there, and moves away from the
  /// surface where it would intersect. None: it does not fit.
  std::optional<Vec3> ball_center(const Vec3& contact, const Vec3& axis) const {
    constexpr int stages = 8, max_moves = 40;
    constexpr double tolerance = 1e-4;
    Vec3 center = contact;
    for (int stage = 1; stage <= stages; ++stage) {
      const double radius = stage * offset_ / stages;
      center = center + (offset_ / stages) * axis;
      for (int move = 0;; ++move) {
        const Vec3 nearest = (1 / spacing_) * surface_.closest_point(spacing_ * center).position;
        const double away = distance(center, nearest);
        if (away >= (1 - tolerance) * radius) break;
        if (move == max_moves || !(away > 0)) return {};
        center = nearest + (radius / away) * (center - nearest);
      }
    }
    return center;
  }
  /// Positions from the clearance over a spot, or half of it where there is no room, to the sphere around the surface: along the
  /// axis, and straight on in the direction nearest to the axis that is free.
  std::optional<std::vector<Vec3>> path_to_sphere(const Spot& spot) const {
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

  double distance_from_surface(const Vec3& position) const {
    return surface_.closest_point(spacing_ * position).distance / spacing_;
  }
  /// Whether a segment keeps a quarter of the clearance to the surface: from every point the distance to the surface is a
  /// step that cannot reach it.
  bool is_free(const Vec3& from, const Vec3& to) const {
    const double length = distance(from, to), least = least_height(1);
    for (double walked = 0;;) {
      const double share = length > 0 ? std::min(1.0, walked / length) : 1;
      const double away = distance_from_surface((1 - share) * from + share * to);
      if (away < least) return false;
      if (share >= 1) return true;
      walked += std::max(away - least, 0.025 * clearance_);
    }
  }
  bool is_free(const std::vector<Vec3>& points) const {
    for (std::size_t k = 1; k < points.size(); ++k)
      if (!is_free(points[k - 1], points[k])) return false;
    return true;
  }

  const Surface& surface_;
  const PathDomain& domain_;
  const SmoothNormals& normals_;
  double spacing_, clearance_, offset_, extent_ = 0;
  Vec3 center_{};       ///< of the bounding box of the surface
  double outside_ = 0;  ///< radius of a sphere around the surface
};

/// Appends poses to a path. Positions are converted to world units.
class PoseWriter {
 public:
  PoseWriter(ToolPath& path, double spacing) : path_(path), spacing_(spacing) {}

  void add(const Spot& spot, ToolMotion kind, Index pass) {
    add(spot.position, spot.axis, kind, pass);
    path_.poses.back().contact = spacing_ * spot.contact;
  }
  void add(const Vec3& position, const Vec3& axis, ToolMotion kind, Index pass) {
    if (!path_.poses.empty()) arclength_ += spacing_ * distance(position, last_);
    path_.poses.push_back({spacing_ * position, spacing_ * position, axis, {}, {}, pass, kind, arclength_});
    last_ = position;
  }
  double arclength() const { return arclength_; }

  /// Computes directions of travel, leans the axes and computes rotations.
  void finish(double lead, double tilt) {
    std::vector<ToolPose>& poses = path_.poses;
    for (std::size_t k = 0; k < poses.size(); ++k) poses[k].travel = travel(k);
    for (std::size_t k = poses.size(); k-- > 1;) {  // along the axis: the direction of the pass that begins there
      if (poses[k - 1].kind != ToolMotion::approach) continue;
      const Vec3 flat = poses[k].travel - dot(poses[k].travel, poses[k - 1].axis) * poses[k - 1].axis;
      if (norm(flat) > 1e-6) poses[k - 1].travel = normalized(flat);
    }
    for (std::size_t k = 0; k < poses.size(); ++k) {
      const Vec3 normal = poses[k].axis, ahead = poses[k].travel, left = cross(normal, ahead);
      poses[k].axis = std::cos(tilt) * (std::cos(lead) * normal + std::sin(lead) * ahead) + std::sin(tilt) * left;
      poses[k].travel = std::cos(lead) * ahead - std::sin(lead) * normal;
      poses[k].quaternion = rotation(poses[k].travel, poses[k].axis);
      if (k == 0) continue;
      double cosine = 0;
      for (std::size_t c = 0; c < 4; ++c) cosine += poses[k].quaternion[c] * poses[k - 1].quaternion[c];
      if (cosine < 0)
        for (double& c : poses[k].quaternion) c = -c;
    }
  }

 private:
  /// The direction from the previous to the next pose of the same kind, perpendicular to the axis.
  Vec3 travel(std::size_t k) const {
    const std::vector<ToolPose>& poses = path_.poses;
    const auto is_same = [&](std::size_t j) {
      return poses[j].kind == poses[k].kind && poses[j].pass == poses[k].pass;
    };
    const std::size_t from = k > 0 && is_same(k - 1) ? k - 1 : k,
                      to = k + 1 < poses.size() && is_same(k + 1) ? k + 1 : k;
    const Vec3& axis = poses[k].axis;
    for (const auto& [a, b] : {std::pair{from, to}, {k > 0 ? k - 1 : k, k}, {k, std::min(k + 1, poses.size() - 1)}}) {
      const Vec3 chord = poses[b].position - poses[a].position, flat = chord - dot(chord, axis) * axis;
      if (norm(flat) > 1e-6 * norm(chord) && norm(flat) > 0) return normalized(flat);
    }
    if (k > 0) {  // along the axis: the previous direction
      const Vec3 flat = poses[k - 1].travel - dot(poses[k - 1].travel, axis) * axis;
      if (norm(flat) > 1e-6) return normalized(flat);
    }
    return any_perpendicular(axis);
  }

  /// The rotation with these x and z axes, as a quaternion (w, x, y, z).
  static std::array<double, 4> rotation(const Vec3& x, const Vec3& z) {
    const Vec3 y = cross(z, x);
    const double trace = x[0] + y[1] + z[2];
    std::array<double, 4> q{trace, x[0], y[1], z[2]};
    const auto largest = static_cast<std::size_t>(std::ranges::max_element(q) - q.begin());
    if (largest == 0)
      q = {1 + trace, y[2] - z[1], z[0] - x[2], x[1] - y[0]};
    else if (largest == 1)
      q = {y[2] - z[1], 1 + 2 * x[0] - trace, x[1] + y[0], z[0] + x[2]};
    else if (largest == 2)
      q = {z[0] - x[2], x[1] + y[0], 1 + 2 * y[1] - trace, y[2] + z[1]};
    else
      q = {x[1] - y[0], z[0] + x[2], y[2] + z[1], 1 + 2 * z[2] - trace};
    double length = 0;
    for (const double c : q) length = std::hypot(length, c);
    for (double& c : q) c /= length;
    return q;
  }

  ToolPath& path_;
  double spacing_, arclength_ = 0;
  Vec3 last_{};
};

}  // namespace

std::array<std::array<double, 4>, 4> pose_matrix(const ToolPose& pose) {
  const Vec3 &x = pose.travel, &z = pose.axis, &p = pose.position, y = cross(z, x);
  return {{{x[0], y[0], z[0], p[0]}, {x[1], y[1], z[1], p[1]}, {x[2], y[2], z[2], p[2]}, {0, 0, 0, 1}}};
}

void add_poses(const Surface& surface, const PathDomain& domain, std::vector<PassCurve> passes,
               const ToolPathOptions& options, ToolPath& path) {
  const double spacing = options.spacing;
  const auto or_else = [&](double length, double otherwise) { return length > 0 ? length / spacing : otherwise; };
  const double step = or_else(options.step, 0.25), tolerance = or_else(options.chord_error, 0.005);
  const SmoothNormals normals(domain.mesh, or_else(options.tool_radius, 0.5));
  const double clearance = or_else(options.clearance, 1), max_link = or_else(options.max_link, 3);
  const Linker linker(surface, domain, normals, spacing, clearance, options.offset / spacing);

  constexpr double max_poses = 1 << 24;
  double length = 0;
  for (const PassCurve& pass : passes) length += curve_length(domain.mesh, pass.curve);
  if (length / step > max_poses)
    throw ResourceExhausted("the step, " + detail::number(spacing * step) +
                            ", requires more than 2^24 poses; enlarge it, or cover a smaller region");

  std::vector<std::vector<TrackedPass>> pieces(passes.size());  // a pass ends where a ball of the offset does not fit
  detail::parallel_chunks(static_cast<Offset>(passes.size()), 1, options.threads, [&](Offset k, Offset) {
    const PassCurve& pass = passes[static_cast<std::size_t>(k)];
    std::vector<MeshPoint> points = samples(domain.mesh, pass.curve, step);
    if (pass.curve.closed) points.push_back(points.front());
    points = simplified(domain.mesh, points, step, tolerance);
    if (pass.curve.closed) points.pop_back();
    std::vector<Track> parts(1);
    bool is_whole = true;
    for (const MeshPoint& point : points)
      if (!linker.append(point, parts.back())) {
        is_whole = false;
        if (!parts.back().empty()) parts.emplace_back();
      }
    const bool closed = pass.curve.closed && is_whole;
    if (closed && !parts.back().empty()) parts.back().push_back(parts.back().front());
    for (Track& part : parts)
      pieces[static_cast<std::size_t>(k)].push_back({std::move(part), pass.origin, pass.distance, closed});
  });
  std::vector<TrackedPass> tracks;
  for (std::vector<TrackedPass>& of_pass : pieces)
    tracks.insert(tracks.end(), std::make_move_iterator(of_pass.begin()), std::make_move_iterator(of_pass.end()));
  std::erase_if(tracks, [](const TrackedPass& pass) { return pass.track.size() < 2; });
  if (tracks.empty() && options.offset == 0)
    throw InvalidArgument("spacing_too_large", "every pass on the region has only one pose",
                          "choose a smaller spacing");
  if (tracks.empty())
    throw InvalidArgument(
        "offset_too_large",
        "a ball with the radius of the offset, " + detail::number(options.offset) + ", fits nowhere on the region",
        "choose a smaller offset");
  if (options.one_way) align(tracks);
  tracks = by_nearest(std::move(tracks), !options.one_way);
  if (!options.one_way) exchange(tracks);

  PoseWriter writer(path, spacing);
  const auto rise = [&](const Spot& spot, Index pass) {
    if (linker.can_rise(spot)) writer.add(linker.lifted(spot), spot.axis, ToolMotion::retreat, pass);
  };
  for (std::size_t k = 0; k < tracks.size(); ++k) {
    const TrackedPass& pass = tracks[k];
    const auto number = static_cast<Index>(k);
    const Spot& start = pass.track.front();
    if (k == 0) {
      if (linker.can_rise(start)) {
        writer.add(linker.lifted(start), start.axis, ToolMotion::approach, number);
        writer.add(start, ToolMotion::approach, number);
      }
    } else {
      const Spot& end = tracks[k - 1].track.back();
      std::optional<Track> along = linker.on_surface(end, start, max_link);
      std::optional<std::vector<Vec3>> over;
      if (!along) over = linker.through_space(end, start);
      if (!along && !over) along = linker.on_surface(end, start, unlimited);
      if (!along && !over) over = linker.around(end, start);
      if (along) {
        ++path.surface_links;
        for (std::size_t i = 1; i < along->size(); ++i) writer.add((*along)[i], ToolMotion::link, number);
      } else if (over) {
        ++path.lifted_links;
        writer.add(over->front(), end.axis, ToolMotion::retreat, number);
        for (std::size_t i = 1; i < over->size(); ++i) {
          const double share = static_cast<double>(i) / static_cast<double>(over->size() - 1);
          const Vec3 mixed = (1 - share) * end.axis + share * start.axis;
          writer.add((*over)[i], norm(mixed) > 1e-3 ? normalized(mixed) : start.axis, ToolMotion::link, number);
        }
        writer.add(start, ToolMotion::approach, number);
      } else {
        ++path.missing_links;
        rise(end, number);
      }
    }
    const std::size_t begin = path.poses.size();
    double before = writer.arclength();
    for (std::size_t i = 0; i < pass.track.size(); ++i) {
      writer.add(pass.track[i], ToolMotion::pass, number);
      if (i == 0) before = writer.arclength();
    }
    path.passes.push_back(
        {begin, path.poses.size(), pass.closed, pass.origin, spacing * pass.distance, writer.arclength() - before});
    path.pass_length += path.passes.back().length;
  }
  rise(tracks.back().track.back(), static_cast<Index>(tracks.size()) - 1);
  path.link_length = writer.arclength() - path.pass_length;
  writer.finish(options.lead, options.tilt);
}

}  // namespace ahm
