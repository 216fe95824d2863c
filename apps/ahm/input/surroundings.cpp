#include "input/surroundings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "ahm/error.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/vec.hpp"
#include "cli/source_list.hpp"

namespace ahm::app {

namespace {

/// The position of the source; for a position the nearest vertex that a face uses.
Vec3 center_of(const io::Geometry& input, const SourceSpec& source) {
  const Vec3 given = position_in(input, source, "--source");
  if (!std::holds_alternative<SourcePosition>(source)) return given;
  const Index nearest = *std::ranges::min_element(input.face_vertices, {},
                                                  [&](Index vertex) { return distance(input.points[vertex], given); });
  return input.points[nearest];
}

/// Distance from a point to the bounding box of a face; not larger than the distance to the face.
double distance_to_box(const Vec3& p, std::span<const Index> face, const std::vector<Vec3>& points) {
  Vec3 away{};
  for (std::size_t c = 0; c < 3; ++c) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Index vertex : face) low = std::min(low, points[vertex][c]), high = std::max(high, points[vertex][c]);
    away[c] = std::max({low - p[c], p[c] - high, 0.0});
  }
  return std::hypot(away[0], away[1], away[2]);
}

void keep_faces(std::vector<Offset>& begin, std::vector<Index>& vertices, const std::vector<Index>& kept) {
  std::vector<Offset> kept_begin{0};
  std::vector<Index> kept_vertices;
  for (const Index f : kept) {
    kept_vertices.insert(kept_vertices.end(), vertices.begin() + begin[f], vertices.begin() + begin[f + 1]);
    kept_begin.push_back(static_cast<Offset>(kept_vertices.size()));
  }
  begin = std::move(kept_begin);
  vertices = std::move(kept_vertices);
}

std::int64_t used_vertices(const io::Geometry& input) {
  std::vector<bool> used(input.points.size(), false);
  for (const Index vertex : input.face_vertices) used[vertex] = true;
  return std::count(used.begin(), used.end(), true);
}

/// Vertices whose kept faces form several fans: they have more faces than edges that two of these faces share.
std::vector<bool> pinched_vertices(const io::Geometry& input, const std::vector<bool>& kept) {
  std::vector<std::pair<Index, Index>> sides;
  std::vector<Index> fans(input.points.size(), 0);
  for (std::size_t f = 0; f < kept.size(); ++f) {
    if (!kept[f]) continue;
    const auto face = input.face(f);
    for (std::size_t c = 0; c < face.size(); ++c) {
      ++fans[face[c]];
      sides.emplace_back(std::minmax(face[c], face[(c + 1) % face.size()]));
    }
  }
  std::sort(sides.begin(), sides.end());
  for (std::size_t k = 1; k < sides.size(); ++k)
    if (sides[k] == sides[k - 1]) --fans[sides[k].first], --fans[sides[k].second];
  std::vector<bool> result(fans.size());
  for (std::size_t v = 0; v < fans.size(); ++v) result[v] = fans[v] > 1;
  return result;
}

/// Adds the faces around pinched vertices until only vertices that are pinched in the input remain.
void close_fans(const io::Geometry& input, std::vector<bool>& kept) {
  for (bool more = true; more;) {
    more = false;
    const std::vector<bool> pinched = pinched_vertices(input, kept);
    for (std::size_t f = 0; f < kept.size(); ++f) {
      if (kept[f] || std::ranges::none_of(input.face(f), [&](Index v) { return pinched[v]; })) continue;
      kept[f] = more = true;
    }
  }
}

}  // namespace

std::vector<std::uint8_t> Surroundings::counts_as_reversed() const {
  std::vector<std::uint8_t> result;
  if (!whole.reversed.empty())
    for (const Index f : faces) result.push_back(whole.reversed[f]);
  return result;
}

std::vector<Index> Surroundings::part_of_vertices(const io::Geometry& input) const {
  std::vector<Index> result(input.points.size(), -1);
  for (std::size_t f = 0; f < whole.part.size(); ++f)
    for (const Index v : input.face(f)) result[v] = whole.part[f];
  return result;
}

Surroundings surroundings(const io::Geometry& input, double radius, const SourceSpec& source) {
  const Vec3 center = center_of(input, source);
  std::vector<bool> kept(input.face_count());
  for (std::size_t f = 0; f < kept.size(); ++f)
    kept[f] = distance_to_box(center, input.face(f), input.points) <= 1.5 * radius;
  close_fans(input, kept);
  Surroundings result;
  for (std::size_t f = 0; f < kept.size(); ++f)
    if (kept[f]) result.faces.push_back(static_cast<Index>(f));
  if (result.faces.empty())
    throw InvalidArgument(
        fmt::format("--local: no face is within {:.6g} of the source {}; use a larger radius, or leave it out",
                    1.5 * radius, to_string(source)));
  try {
    result.whole = face_parts(static_cast<Index>(input.points.size()), input.faces());
  } catch (const InvalidGeometry&) {  // NOLINT(bugprone-empty-catch): no surface can be built from all faces
  }
  return result;
}

std::int64_t keep_faces(io::Geometry& input, const std::vector<Index>& kept) {
  const std::int64_t before = used_vertices(input);
  keep_faces(input.face_begin, input.face_vertices, kept);
  return before - used_vertices(input);
}

void keep_faces(RepairedMesh& mesh, const std::vector<Index>& kept) {
  keep_faces(mesh.face_begin, mesh.face_vertices, kept);
  std::vector<Index> given;
  for (const Index f : kept) given.push_back(mesh.given_face[f]);
  mesh.given_face = std::move(given);
}

}  // namespace ahm::app
