#include "tool_path/track.hpp"

#include <algorithm>
#include <unordered_set>

#include "ahm/util/small_math.hpp"
#include "ahm/util/vec.hpp"

namespace ahm {
namespace {

using exact::MeshPoint;

/// Positions that are closer than this are one place, times the radius of the ball.
constexpr double same_place = 10 * BallPlacer::tolerance;
/// Axes are one axis if the cosine between them is larger.
constexpr double same_axis = 0.99;

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

ToolPlacer::ToolPlacer(const MeshTree& part, const FaceMesh& mesh, const Options& options)
    : ball_(part, options.offset), mesh_(mesh), options_(options), normals_(mesh, options.tool_radius) {}

std::optional<Spot> ToolPlacer::at(const MeshPoint& point) const {
  Spot spot{point, mesh_.position(point), {}, normals_.at(point)};
  spot.position = spot.contact;
  if (options_.offset == 0) return spot;
  const std::optional<Vec3> center = ball_.center(spot.contact, spot.axis, normals_at(point));
  if (!center) return {};
  spot.position = *center;
  return spot;
}

std::vector<Track> ToolPlacer::tracks(const MeshCurve& curve) const {
  std::vector<MeshPoint> points = samples(mesh_, curve, options_.step);
  if (curve.closed) points.push_back(points.front());
  if (options_.offset > 0) {
    std::vector<Track> result = offset_tracks(points);
    const bool is_whole = result.size() == 1 && result[0].front().contact == mesh_.position(points.front());
    if (curve.closed && is_whole && result[0].back().position != result[0].front().position)
      result[0].push_back(result[0].front());
    return result;
  }
  std::vector<Vec3> positions;
  for (const MeshPoint& point : points) positions.push_back(mesh_.position(point));
  Track track;
  for (const std::size_t k : simplified(positions, nullptr)) track.push_back(*at(points[k]));
  return {std::move(track)};
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

/// @param points  consecutive ones lie in the face of the first
std::vector<Track> ToolPlacer::offset_tracks(const std::vector<MeshPoint>& points) const {
  std::vector<Track> result(1);
  std::optional<Spot> before;
  constexpr int max_depth = 6;
  for (const MeshPoint& point : points) {
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
  for (Track& track : result) {
    std::vector<Vec3> positions;
    for (const Spot& spot : track) positions.push_back(spot.position);
    Track kept;
    for (const std::size_t k : simplified(positions, &track)) kept.push_back(track[k]);
    track = std::move(kept);
  }
  return result;
}

/// Appends a pose to an offset track. In concave places, the tool turns without moving.
void ToolPlacer::append(Spot spot, Track& track) const {
  if (!track.empty() && distance(track.back().position, spot.position) < same_place * options_.offset)
    spot.position = track.back().position;
  track.push_back(spot);
}

/// Appends poses up to `to`. Between the two it adds as many as the step and the chord error require.
void ToolPlacer::refine(const Spot& from, const Spot& to, int depth, std::vector<Track>& tracks) const {
  const auto is_along_axis = [&](const Spot& spot) {
    return distance(spot.position, spot.contact + options_.offset * spot.axis) < 1e-3 * options_.offset;
  };
  const double tolerance = 0.5 * options_.chord_error;  // the simplification adds the other half
  const Vec3& start = tracks.back().back().position;
  const double chord = distance(start, to.position), turn = distance(from.axis, to.axis);
  // Between balls that touch the surface along their axes, the center moves on an arc.
  const bool is_arc = is_along_axis(from) && is_along_axis(to) && turn < 1;
  const bool is_near = chord <= options_.step;
  if (is_near && (depth == 0 || (is_arc && options_.offset * turn * turn / 8 <= tolerance)))
    return append(to, tracks.back());
  const std::optional<Spot> middle =
      depth > 0 ? at(between(from.point, in_face(mesh_, to.point, from.point.face), 0.5)) : std::nullopt;
  if (!middle) {  // the ball does not fit there, or jumps
    tracks.emplace_back();
    return append(to, tracks.back());
  }
  const Deviation off = deviation(middle->position, start, to.position);
  if (is_near && off.distance <= tolerance && follows(middle->axis, from.axis, to.axis, off.share))
    return append(to, tracks.back());
  refine(from, *middle, depth - 1, tracks);
  refine(*middle, to, depth - 1, tracks);
}

/// Numbers of the points that remain where chords replace others. Chords are at most a step long, and stay within a tolerance of
/// the points between their ends, and of their axes.
/// @param axes  the axes at the points; nullptr: the path is on the surface, and points at one place are one pose
std::vector<std::size_t> ToolPlacer::simplified(const std::vector<Vec3>& path, const Track* axes) const {
  const double tolerance = (axes ? 0.5 : 1) * options_.chord_error;
  const auto fits = [&](std::size_t from, std::size_t to) {
    if (distance(path[from], path[to]) > options_.step) return false;
    for (std::size_t k = from + 1; k < to; ++k) {
      const Deviation off = deviation(path[k], path[from], path[to]);
      if (off.distance > tolerance) return false;
      if (axes && !follows((*axes)[k].axis, (*axes)[from].axis, (*axes)[to].axis, off.share)) return false;
    }
    return true;
  };
  std::vector<std::size_t> result{0};
  for (std::size_t from = 0; from + 1 < path.size();) {
    std::size_t to = from + 1;
    while (to + 1 < path.size() && fits(from, to + 1)) ++to;
    if (axes || to + 1 == path.size() || distance(path[to], path[from]) > 0) result.push_back(to);
    from = to;
  }
  return result;
}

}  // namespace ahm
