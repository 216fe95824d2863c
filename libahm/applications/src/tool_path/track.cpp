#include "tool_path/track.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "ahm/util/small_math.hpp"
#include "ahm/util/vec.hpp"

namespace ahm {
namespace {

using exact::MeshPoint;

/// Positions that are closer than this are one place, times the radius of the ball.
constexpr double same_place = 10 * BallPlacer::tolerance;
/// Axes are one axis if the cosine between them is larger.
constexpr double same_axis = 0.99;

/// Length of the difference of two axes between which the path needs another pose (20 degrees), and which are one axis.
constexpr double largest_turn = 0.35, least_turn = 1e-3;
/// Bisections of the curve between two samples, and then of the turn of the axis.
constexpr int max_depth = 6;

/// Distance of a point from a segment, and its place on the segment, from 0 to 1.
struct Deviation {
  double distance, share;
};
Deviation deviation(const Vec3& point, const Vec3& from, const Vec3& to) {
  const Vec3 chord = to - from, offset = point - from;
  const double square = dot(chord, chord), share = square > 0 ? std::clamp(dot(offset, chord) / square, 0.0, 1.0) : 0;
  return {norm(offset - share * chord), share};
}

/// Whether an axis is near the one that is interpolated between two others.
bool follows(const Vec3& axis, const Vec3& from, const Vec3& to, double share) {
  const Vec3 mixed = (1 - share) * from + share * to;
  return dot(axis, mixed) > same_axis * norm(mixed);
}

}  // namespace

SmoothNormals::SmoothNormals(const FaceMesh& mesh, double radius) : mesh_(mesh), radius_(radius) {
  for (std::size_t f = 0; f < mesh.size(); ++f) {
    normals_.push_back(mesh.area_normal(static_cast<Index>(f)));
    centers_.push_back(mesh.position({static_cast<Index>(f), {1.0 / 3, 1.0 / 3, 1.0 / 3}}));
  }
}

Vec3 SmoothNormals::at(const MeshPoint& point) const {
  const Vec3 position = mesh_.position(point);
  std::vector<Index> faces{point.face};
  Vec3 sum{};
  for (std::size_t k = 0; k < faces.size(); ++k) {
    const double share = distance(centers_[to_size(faces[k])], position) / radius_;
    if (k > 0 && share >= 1) continue;
    sum = sum + std::max(1 - share * share, 1e-3) * normals_[to_size(faces[k])];
    for (std::size_t s = 0; s < 3; ++s)
      if (const detail::Half twin = mesh_.twin[3 * to_size(faces[k]) + s];
          twin >= 0 && std::ranges::find(faces, twin / 3) == faces.end())  // there are few
        faces.push_back(twin / 3);
  }
  const double length = norm(sum);
  const Vec3 own = normals_[to_size(point.face)];
  return length > 1e-6 * norm(own) ? (1 / length) * sum : normalized(own);
}

ToolPlacer::ToolPlacer(const MeshTree& part, const FaceMesh& mesh, const Options& options)
    : ball_(part, options.offset), mesh_(mesh), options_(options), normals_(mesh, options.tool_radius) {}

std::optional<Spot> ToolPlacer::at(const MeshPoint& point) const { return at(point, normals_.at(point)); }

std::optional<Spot> ToolPlacer::at(const MeshPoint& point, const Vec3& axis) const {
  Spot spot{point, mesh_.position(point), {}, axis};
  spot.position = spot.contact;
  if (options_.offset == 0) return spot;
  spot.axis = turned_away(normals_at(point), axis);
  const std::optional<Vec3> center = ball_.center(spot.contact, spot.axis);
  if (!center) return {};
  spot.position = *center;
  return spot;
}

std::vector<Track> ToolPlacer::tracks(const MeshCurve& curve) const {
  std::vector<MeshPoint> points = samples(mesh_, curve, options_.step);
  if (curve.closed) points.push_back(points.front());
  std::vector<Track> result(1);
  std::optional<Spot> before;
  for (const MeshPoint& point : points) {  // consecutive points lie in the face of the first
    const std::optional<Spot> spot = at(point);
    if (!spot) {
      if (!result.back().empty()) result.emplace_back();
    } else if (before) {
      refine(*before, *spot, max_depth, result);
    } else {
      append(*spot, result.back());
    }
    before = spot;
  }
  if (result.back().empty()) result.pop_back();
  for (Track& track : result) track = simplified(track);
  const bool is_whole = result.size() == 1 && result[0].front().contact == mesh_.position(points.front());
  if (curve.closed && is_whole && result[0].back().position != result[0].front().position)
    result[0].push_back(result[0].front());
  return result;
}

/// The unit normals of the faces at a point.
std::vector<Vec3> ToolPlacer::normals_at(const MeshPoint& point) const {
  const double on_side = same_place * options_.offset;
  const Vec3 position = mesh_.position(point);
  std::vector<Index> faces{point.face};
  std::vector<Vec3> result;
  for (std::size_t k = 0; k < faces.size(); ++k) {
    result.push_back(normalized(mesh_.area_normal(faces[k])));
    for (std::size_t h = 3 * to_size(faces[k]); h < 3 * to_size(faces[k]) + 3; ++h) {
      const Vec3 tail = mesh_.points[to_size(mesh_.tail(static_cast<detail::Half>(h)))],
                 head = mesh_.points[to_size(mesh_.head(static_cast<detail::Half>(h)))];
      if (mesh_.twin[h] < 0 || deviation(position, tail, head).distance > on_side) continue;
      if (std::ranges::find(faces, mesh_.twin[h] / 3) == faces.end()) faces.push_back(mesh_.twin[h] / 3);
    }
  }
  return result;
}

/// Appends a pose to an offset track. In concave places, the tool turns without moving.
void ToolPlacer::append(Spot spot, Track& track) const {
  if (!track.empty() && distance(track.back().position, spot.position) < same_place * options_.offset)
    spot.position = track.back().position;
  track.push_back(spot);
}

/// A pose at one of two points that are close, with an axis between theirs: at the point where the tool can turn so.
std::optional<Spot> ToolPlacer::turned(const Spot& from, const Spot& to) const {
  const Vec3 axis = normalized(from.axis + to.axis);
  const std::optional<Spot> first = at(from.point, axis), second = at(to.point, axis);
  if (!first || !second) return first ? first : second;
  return dot(first->axis, axis) >= dot(second->axis, axis) ? first : second;
}

/// Appends poses up to `to`. Between the two it adds as many as the step, the chord error and the turn of the axis require.
/// @param depth  number of bisections of the curve that remain; <= 0: the tool turns at one point
void ToolPlacer::refine(const Spot& from, const Spot& to, int depth, std::vector<Track>& tracks) const {
  const auto is_along_axis = [&](const Spot& spot) {
    return distance(spot.position, spot.contact + options_.offset * spot.axis) <= 1e-3 * options_.offset;
  };
  const double tolerance = 0.25 * options_.chord_error;  // tested in the middle; the simplification adds a half
  const Vec3& start = tracks.back().back().position;
  const double chord = distance(start, to.position), turn = distance(from.axis, to.axis);
  const bool is_near = chord <= options_.step && turn <= largest_turn;
  // Between balls that touch the surface along their axes, the center moves on an arc.
  const bool is_arc = is_along_axis(from) && is_along_axis(to);
  const bool can_turn = depth > -max_depth && turn > least_turn && norm(from.axis + to.axis) > least_turn;
  if (is_near && ((depth <= 0 && !can_turn) || (is_arc && options_.offset * turn * turn / 8 <= tolerance)))
    return append(to, tracks.back());
  std::optional<Spot> middle;
  if (depth > 0)
    middle = at(between(from.point, in_face(mesh_, to.point, from.point.face), 0.5));
  else if (can_turn)
    middle = turned(from, to);
  if (!middle) {  // the ball does not fit there, or jumps
    if (options_.offset > 0) tracks.emplace_back();
    return append(to, tracks.back());
  }
  const Deviation off = deviation(middle->position, start, to.position);
  const bool tests_both_halves = chord <= tolerance || std::abs(off.share - 0.5) < 0.4;
  if (is_near && tests_both_halves && off.distance <= tolerance && follows(middle->axis, from.axis, to.axis, off.share))
    return append(to, tracks.back());
  refine(from, *middle, depth - 1, tracks);
  refine(*middle, to, depth - 1, tracks);
}

/// The poses that remain where chords replace others. Chords are at most a step long, and stay near the poses between their ends, and
/// their axes.
Track ToolPlacer::simplified(const Track& track) const {
  const double tolerance = (options_.offset > 0 ? 0.5 : 1) * options_.chord_error;  // `refine` uses the rest
  const auto fits = [&](const Spot& from, std::span<const Spot> inner, const Spot& to) {
    if (distance(from.position, to.position) > options_.step || distance(from.axis, to.axis) > largest_turn)
      return false;
    return std::ranges::all_of(inner, [&](const Spot& spot) {
      const Deviation off = deviation(spot.position, from.position, to.position);
      return off.distance <= tolerance && follows(spot.axis, from.axis, to.axis, off.share);
    });
  };
  const std::span<const Spot> all(track);
  Track result{track.front()};
  for (std::size_t from = 0; from + 1 < track.size();) {
    std::size_t to = from + 1;
    while (to + 1 < track.size() && fits(track[from], all.subspan(from + 1, to - from), track[to + 1])) ++to;
    result.push_back(track[to]);
    from = to;
  }
  return result;
}

}  // namespace ahm
