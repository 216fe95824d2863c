#include "ahm/surface/mapped_positions.hpp"

#include <limits>

#include "ahm/error.hpp"
#include "ahm/surface/exact/flat_triangles.hpp"

namespace ahm {
namespace {

/// Fewer vertices for each that is in no triangle, and the triangles are no picture of the cloud.
constexpr Index least_per_unused = 50;

}  // namespace

std::vector<Vec3> mapped_positions(const Surface& surface) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<Vec3> result(surface.positions().begin(), surface.positions().end());
  for (std::size_t r = 0; r < result.size(); ++r) {
    const auto vertex = surface.rows().vertex(Row(static_cast<Index>(r)));
    if (!vertex)
      result[r] = {nan, nan, nan};
    else if (const auto frame = surface.graph().frame(vertex->index))
      result[r] = frame->origin;
  }
  return result;
}

std::vector<Triangle> mapped_triangles(const Surface& surface) try {
  if (surface.faces().size() > 0) return {};
  const FlatTriangles flat = surface.flat_approximation();
  const Index vertices = flat.surface.vertex_count();
  Index unused = 0;
  std::vector<Index> rows;
  for (Index v = 0; v < vertices; ++v) {
    unused += flat.surface.first_corner(v).half < 0;
    const auto row = surface.rows().row(Vertex(v));
    if (!row) return {};
    rows.push_back(row->index);
  }
  if (least_per_unused * unused > vertices) return {};
  std::vector<Triangle> triangles;
  for (Index f = 0; f < flat.surface.face_count(); ++f) {
    const exact::HalfRecord side = flat.surface.record(3 * f);
    triangles.push_back({rows[side.tail], rows[side.head], rows[side.apex]});
  }
  return triangles;
} catch (const InvalidArgument&) {  // no triangles
  return {};
} catch (const InvalidGeometry&) {
  return {};
}

}  // namespace ahm
