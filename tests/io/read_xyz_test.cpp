#include <cmath>
#include <limits>

#include "files.hpp"

namespace ahm::io::test {
namespace {

using ReadXyz = Files;

TEST_F(ReadXyz, ReadsPointsInFileOrderWithEveryDigit) {
  const Geometry g = read_bytes("a.xyz", "# utm\n431234.567891 5412345.678912 12\n\n  +1 -2e-3\t.5  # tail\r\n");
  ASSERT_EQ(g.points.size(), 2u);
  EXPECT_EQ(g.points[0], (Vec3{431234.567891, 5412345.678912, 12}));
  EXPECT_EQ(g.points[1], (Vec3{1, -2e-3, 0.5}));
  EXPECT_TRUE(g.normals.empty());
  EXPECT_TRUE(g.face_begin.empty());
}

TEST_F(ReadXyz, TakesSixColumnsAsNormalsUnlessTheyAreColours) {
  EXPECT_EQ(read_bytes("n.xyz", "1 2 3 0 0 1\n4 5 6 0 1 0\n").normals[1], (Vec3{0, 1, 0}));
  const Geometry g = read_bytes("c.txt", "1 2 3 0 0 1\n4 5 6 200 1 0\n");
  EXPECT_TRUE(g.normals.empty());
  EXPECT_EQ(g.colors[1], (std::array<std::uint8_t, 3>{200, 1, 0}));
  EXPECT_EQ(g.warnings.size(), 1u);
}

TEST_F(ReadXyz, WarnsOfOtherColumns) {
  const Geometry g = read_bytes("i.xyz", "1 2 3 0.7\n4 5 6 word\n");
  EXPECT_EQ(g.points[1], (Vec3{4, 5, 6}));
  EXPECT_EQ(g.warnings.size(), 1u);
}

TEST_F(ReadXyz, RefusesLinesWithAnotherNumberOfColumns) {
  expect_refused("r.xyz", "1 2 3\n4 5\n", {"line 2", "2 columns"});
  expect_refused("r.xyz", "1 2 3\n4 5 6 7\n", {"line 2", "4 columns"});
  expect_refused("r.xyz", "1 2\n", {"line 1", "three"});
  expect_refused("r.xyz", "# only this\n", {"no point"});
}

TEST_F(ReadXyz, RefusesWhatIsNoNumber) {
  for (const char* word : {"1,5", "1e400", "-1e400", "1.#IND", "0x1p3", "1d5", "abc", "+-1"}) {
    expect_refused("w.xyz", std::string("0 0 0\n0 0 ") + word + "\n", {"line 2", word});
  }
  expect_refused("w.xyz", "1,5 2,5 3,5\n", {"line 1", "1,5"});
  expect_refused("w.xyz", "1.0, 2.0, 3.0\n", {"line 1"});
}

TEST_F(ReadXyz, ReadsInfinityNanAndTheSmallest) {
  const Vec3 p = read_bytes("s.xyz", "nan -inf 1e-400\n").points[0];
  EXPECT_TRUE(std::isnan(p[0]));
  EXPECT_EQ(p[1], -std::numeric_limits<double>::infinity());
  EXPECT_EQ(p[2], 0.0);
}

TEST_F(ReadXyz, ReadsAByteOrderMarkAndOldLineEnds) {
  EXPECT_EQ(read_bytes("b.xyz",
                       "\xEF\xBB\xBF"
                       "1 2 3\r4 5 6\r")
                .points.size(),
            2u);
}

using ReadCsv = Files;

TEST_F(ReadCsv, FindsColumnsByName) {
  const Geometry g = read_bytes("a.csv", "id,Z,\"x\",note,y\n7,3,1,hello,2\n");
  EXPECT_EQ(g.points[0], (Vec3{1, 2, 3}));
  EXPECT_EQ(read_bytes("n.csv", "x;y;z;nx;ny;nz\n1;2;3;0;0;1\n").normals[0], (Vec3{0, 0, 1}));
}

TEST_F(ReadCsv, ReadsColumnsWithoutNames) {
  EXPECT_EQ(read_bytes("p.csv", "1, 2, 3\n4,5,6\n").points[1], (Vec3{4, 5, 6}));
  EXPECT_EQ(read_bytes("s.csv", "1 2 3\n").points[0], (Vec3{1, 2, 3}));
}

TEST_F(ReadCsv, RefusesMissingDuplicateAndBrokenColumns) {
  expect_refused("m.csv", "x,y,w\n1,2,3\n", {"'z'"});
  expect_refused("m.csv", "x,y,z,x\n1,2,3,4\n", {"'x'"});
  expect_refused("m.csv", "x,y,z\n1,2\n", {"line 2"});
  expect_refused("m.csv", "x,y,z\n", {"no point"});
  expect_refused("m.csv", "x;y;z\n1,5;2;3\n", {"line 2", "1,5"});
  expect_refused("m.csv", "1,,3\n", {"line 1"});
}

}  // namespace
}  // namespace ahm::io::test
