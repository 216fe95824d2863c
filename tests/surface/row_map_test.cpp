// Rows and vertices lead to each other.
#include "ahm/surface/row_map.hpp"

#include <gtest/gtest.h>

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
