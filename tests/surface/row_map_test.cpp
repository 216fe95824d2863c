// Rows and vertices lead to each other.
#include "ahm/surface/row_map.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "ahm/error.hpp"

namespace ahm::test {
namespace {

RowMap example() {  // row 0: two vertices, row 1: none, rows 2 and 3 share vertex 0; vertex 3 has no row
  const RowVertex pairs[] = {{Row(3), Vertex(0)}, {Row(0), Vertex(2)}, {Row(2), Vertex(0)}, {Row(0), Vertex(1)}};
  return RowMap(4, 4, pairs);
}

TEST(RowMap, KeepsTheOrderOfARowsVertices) {
  const RowMap map = example();
  ASSERT_EQ(map.vertices(Row(0)).size(), 2U);
  EXPECT_EQ(map.vertices(Row(0))[0], Vertex(2));
  EXPECT_EQ(map.vertices(Row(0))[1], Vertex(1));
  EXPECT_EQ(map.vertex(Row(0)), Vertex(2));
  EXPECT_EQ(map.vertex(Row(1)), std::nullopt);
  EXPECT_TRUE(map.vertices(Row(1)).empty());
}

TEST(RowMap, NamesTheFirstRowOfAVertex) {
  const RowMap map = example();
  EXPECT_EQ(map.row(Vertex(0)), Row(2));
  EXPECT_EQ(map.row(Vertex(1)), Row(0));
  EXPECT_EQ(map.row(Vertex(3)), std::nullopt);
  EXPECT_EQ(map.row_count(), 4);
  EXPECT_EQ(map.vertex_count(), 4);
}

TEST(RowMap, TheLeastVertexOfARowIsTheFirstOfEqualOnesAndNeverNaN) {
  const RowMap map = example();
  const auto least = [&](Row row, std::vector<double> values) {
    return map.least(row, [&](Vertex v) { return values[v.index]; });
  };
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(least(Row(0), {0, 1, 2, 0}), Vertex(1));
  EXPECT_EQ(least(Row(0), {0, 2, 1, 0}), Vertex(2));
  EXPECT_EQ(least(Row(0), {0, 5, 5, 0}), Vertex(2));
  EXPECT_EQ(least(Row(0), {0, 5, nan, 0}), Vertex(1));
  EXPECT_EQ(least(Row(0), {0, nan, infinity, 0}), Vertex(2));
  EXPECT_EQ(least(Row(0), {0, nan, nan, 0}), std::nullopt);
  EXPECT_EQ(least(Row(1), {0, 0, 0, 0}), std::nullopt);
}

TEST(RowMap, BeginsWithTheFirstRowThatHasAVertex) {
  const RowVertex pairs[] = {{Row(2), Vertex(0)}, {Row(1), Vertex(3)}, {Row(3), Vertex(1)}};
  EXPECT_EQ(first_vertex(RowMap(4, 4, pairs)), Vertex(3));
  EXPECT_THROW(first_vertex(RowMap(4, 4, {})), InvalidArgument);
}

TEST(RowMap, RefusesNumbersOutOfRange) {
  const RowMap map = example();
  EXPECT_THROW(map.vertices(Row(4)), InvalidArgument);
  EXPECT_THROW(map.vertex(Row(-1)), InvalidArgument);
  EXPECT_THROW(map.row(Vertex(4)), InvalidArgument);
  const RowVertex bad[] = {{Row(0), Vertex(9)}};
  EXPECT_THROW(RowMap(1, 1, bad), InvalidArgument);
}

}  // namespace
}  // namespace ahm::test
