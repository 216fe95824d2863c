// Vertices that no polygon uses may have any coordinates; those of polygons must be finite.
#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "ahm/error.hpp"
#include "ahm/polymesh/polygon_mesh_surface.hpp"
#include "support/expect_error.hpp"

namespace ahm::test {
namespace {

TEST(UnusedVertices, MayBeNanOrInfinite) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  const std::vector<Vec3> points = {{nan, nan, nan}, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, infinity}};
  const std::vector<Offset> begin = {0, 4};
  const auto build = [&](std::vector<Index> corners) {
    return polymesh::PolygonMeshSurface::build(points, begin, corners, {});
  };
  const polymesh::PolygonMeshSurface surface = build({1, 2, 3, 4});
  EXPECT_FALSE(surface.rows().vertex(Row(0)));
  EXPECT_TRUE(surface.rows().vertex(Row(1)));
  EXPECT_FALSE(surface.rows().vertex(Row(5)));
  expect_error<InvalidGeometry>([&] { build({1, 2, 3, 5}); }, "vertex 5");
}

}  // namespace
}  // namespace ahm::test
