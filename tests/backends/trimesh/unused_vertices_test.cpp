// Vertices that no face uses may have any coordinates. They change nothing, and their rows are removed.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/solved_mesh.hpp"

namespace ahm::test {
namespace {

TEST(UnusedVertices, MayBeNanOrInfinite) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  const Mesh mesh = icosphere(3);
  Mesh more = mesh;
  more.positions.insert(more.positions.end(), {{nan, 0, 0}, {0, -infinity, infinity}});
  const SolvedMesh plain(mesh), solved(more);
  const auto n = static_cast<std::size_t>(mesh.vertices());
  const RowLogMap expected = plain.map(plain.surface.source(Row(3)).source),
                  map = solved.map(solved.surface.source(Row(3)).source);
  ASSERT_EQ(map.status.size(), n + 2);
  for (std::size_t i = 0; i < n; ++i) {
    EXPECT_EQ(map.u[i], expected.u[i]) << i;
    EXPECT_EQ(map.distance[i], expected.distance[i]) << i;
    EXPECT_EQ(map.status[i], expected.status[i]) << i;
  }
  for (std::size_t i = n; i < n + 2; ++i) {
    EXPECT_EQ(map.status[i], Status::removed);
    EXPECT_TRUE(std::isnan(map.u[i]) && std::isnan(map.distance[i]));
  }
  EXPECT_EQ(solved.surface.nearest_row({1e6, 0, 0}), plain.surface.nearest_row({1e6, 0, 0}));
  ASSERT_EQ(solved.surface.warnings().size(), plain.surface.warnings().size() + 1);
  EXPECT_EQ(solved.surface.warnings()[0].id, "unreferenced");
}

}  // namespace
}  // namespace ahm::test
