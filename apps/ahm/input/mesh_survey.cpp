#include "input/mesh_survey.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "ahm/util/vec.hpp"

namespace ahm::app {
namespace {

std::vector<double> edge_lengths(const io::Geometry& input) {
  std::vector<std::pair<Index, Index>> edges;
  for (std::size_t f = 0; f < input.face_count(); ++f) {
    const auto face = input.face(f);
    for (std::size_t c = 0; c < face.size(); ++c) {
      const auto [low, high] = std::minmax(face[c], face[(c + 1) % face.size()]);
      if (low != high) edges.emplace_back(low, high);
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  std::vector<double> lengths;
  for (const auto& [a, b] : edges)
    if (const double length = distance(input.points[a], input.points[b]); std::isfinite(length))
      lengths.push_back(length);
  return lengths;
}

/// Perpendicular to a face, on the side from which it runs counter-clockwise, as long as twice its area by `unit`^2.
Vec3 face_normal(const io::Geometry& input, std::span<const Index> face, double unit) {
  Vec3 sum{};
  for (std::size_t c = 2; c < face.size(); ++c) {
    const Vec3& first = input.points[face[0]];
    sum = sum + cross(1 / unit * (input.points[face[c - 1]] - first), 1 / unit * (input.points[face[c]] - first));
  }
  return sum;
}

std::size_t normals_against_faces(const io::Geometry& input) {
  if (input.normals.empty()) return 0;
  double unit = 0;
  for (const Vec3& p : input.points)
    if (is_finite(p)) unit = std::max(unit, largest(p));
  if (unit == 0) return 0;
  std::vector<Vec3> around(input.points.size(), Vec3{});
  for (std::size_t f = 0; f < input.face_count(); ++f) {
    const Vec3 normal = face_normal(input, input.face(f), unit);
    if (!is_finite(normal)) continue;
    for (const Index corner : input.face(f)) around[corner] = around[corner] + normal;
  }
  std::size_t count = 0;
  for (std::size_t i = 0; i < around.size(); ++i) count += dot(around[i], input.normals[i]) < 0 ? 1 : 0;
  return count;
}

std::size_t faces_without_area(const io::Geometry& input) {
  double unit = 0;
  for (const Vec3& p : input.points)
    if (is_finite(p)) unit = std::max(unit, largest(p));
  std::size_t count = 0;
  for (std::size_t f = 0; unit > 0 && f < input.face_count(); ++f) {
    const auto face = input.face(f);
    double area = 0, longest = 0;
    for (std::size_t c = 1; c < face.size(); ++c) {
      const Vec3& first = input.points[face[0]];
      const Vec3 side = 1 / unit * (input.points[face[c]] - first);
      longest = std::max({longest, norm(side), norm(1 / unit * (input.points[face[c]] - input.points[face[c - 1]]))});
      if (c > 1) area += norm(cross(1 / unit * (input.points[face[c - 1]] - first), side));
    }
    count += area <= std::max(1e-10 * longest, 0x1p-51) * longest ? 1 : 0;
  }
  return count;
}

}  // namespace

std::optional<LengthRange> range_of(std::vector<double> lengths) {
  if (lengths.empty()) return std::nullopt;
  std::sort(lengths.begin(), lengths.end());
  return LengthRange{lengths.front(), lengths[lengths.size() / 2], lengths.back(), lengths.size()};
}

MeshSurvey survey_mesh(const io::Geometry& input) {
  MeshSurvey result;
  for (std::size_t f = 0; f < input.face_count(); ++f) ++result.faces_by_corners[input.face(f).size()];
  result.normals_against = normals_against_faces(input);
  result.without_area = faces_without_area(input);
  result.inspection = inspect_mesh(static_cast<Index>(input.points.size()), input.faces());
  result.edges = range_of(edge_lengths(input));
  return result;
}

}  // namespace ahm::app
