#include "input/left_out.hpp"

#include <algorithm>
#include <cmath>

#include "ahm/util/small_math.hpp"
#include "ahm/util/vec.hpp"

namespace ahm::app {
namespace {

/// The part of the whole mesh that contains the source: the part of the kept face with the most vertices of the source.
Index part_of(const Input& input, const SurfaceSource& source) {
  std::vector<Index> rows;
  for (const Vertex v : source.source.vertices())
    if (const auto row = input.surface().rows().row(v)) rows.push_back(row->index);
  Index best = input.near->faces.front();
  std::ptrdiff_t most = 0;
  for (const Index f : input.near->faces) {
    const auto hits = std::ranges::count_if(input.geometry.face(f),
                                            [&](Index v) { return std::ranges::find(rows, v) != rows.end(); });
    if (hits > most) most = hits, best = f;
  }
  return input.near->whole.part[best];
}

}  // namespace

std::vector<Vec3> Input::normals(unsigned threads) const {
  std::vector<Vec3> result = surface().normals(threads);
  if (!near || near->whole.reversed.empty()) return result;
  double size = 0;
  for (const Vec3& point : geometry.points)
    if (is_finite(point)) size = std::max(size, largest(point));
  const double scale = 1 / power_of_two_below(size);
  std::vector<Vec3> area(rows(), Vec3{});
  for (std::size_t f = 0; f < geometry.face_count(); ++f) {
    const auto face = geometry.face(f);
    Vec3 of_face{};
    for (std::size_t c = 1; c + 1 < face.size(); ++c)
      of_face = of_face + cross(scale * (geometry.points[face[c]] - geometry.points[face[0]]),
                                scale * (geometry.points[face[c + 1]] - geometry.points[face[0]]));
    for (const Index v : face) area[v] = area[v] + (near->whole.reversed[f] ? -1.0 : 1.0) * of_face;
  }
  for (std::size_t r = 0; r < result.size(); ++r)
    if (std::isnan(result[r][0])) result[r] = normalized(area[repaired ? repaired->joined[r] : r]);
  return result;
}

void set_left_out_statuses(const Input& input, const SurfaceSource& source, double radius, RowLogMap& rows) {
  const std::vector<Vec3>& points = input.geometry.points;
  if (!input.near || input.near->whole.part.empty()) {
    for (std::size_t r = 0; r < points.size(); ++r)
      if (rows.status[r] == Status::removed && distance(points[r], source.position) > radius)
        rows.status[r] = Status::beyond_radius;
    return;
  }
  const std::vector<Index> part = input.near->part_of_vertices(input.geometry);
  const Index own = part_of(input, source);
  std::vector<bool> is_left(points.size());
  for (const Index f : input.near->faces)
    for (const Index v : input.geometry.face(f)) is_left[v] = true;
  for (std::size_t r = 0; r < points.size(); ++r) {
    const auto v = static_cast<std::size_t>(input.repaired ? input.repaired->joined[r] : r);
    if (part[v] < 0 || (is_left[v] && rows.status[r] != Status::disconnected)) continue;
    rows.status[r] = part[v] == own ? Status::beyond_radius : Status::disconnected;
  }
}

}  // namespace ahm::app
