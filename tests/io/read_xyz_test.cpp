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

TEST_F(ReadXyz, TakesSixColumnsAsNormalsUnlessTheyAreColors) {
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
  expect_refused("r.xyz", "1 2 3\n4 5\n", {"line 2", "expected 3 columns", "found 2"});
  expect_refused("r.xyz", "1 2 3\n4 5 6 7\n", {"line 2", "found 4"});
  expect_refused("r.xyz", "1 2\n", {"line 1", "three"});
  expect_refused("r.xyz", "# only this\n", {"no point"});
}

TEST_F(ReadXyz, RefusesWhatIsNoNumber) {
  for (const char* word : {"1,5", "1e400", "-1e400", "1.#IND", "0x1p3", "1d5", "abc", "+-1"}) {
    expect_refused("w.xyz", std::string("0 0 0\n0 0 ") + word + "\n", {"line 2", word});
  }
  expect_refused("w.xyz", "1,5 2,5 3,5\n", {"line 1", "1,5"});
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

TEST_F(ReadXyz, ReadsCommasAndSemicolons) {
  for (const char* text : {"1.5,2,3\n4,5,6\n", "1.5, 2, 3\n4,5, 6\n", "1.5 , 2 ,3\n4,5,6\n", "1.5;2;3\n4;5;6\n",
                           "1.5;2;3;\n4;5;6;\n", "1.5,2,3,\n4,5,6,\n"})
    EXPECT_EQ(read_bytes("s.xyz", text).points, (std::vector<Vec3>{{1.5, 2, 3}, {4, 5, 6}})) << text;
  expect_refused("s.xyz", "1;2;3\n4,5,6\n", {"line 2", "found 1"});
  expect_refused("s.xyz", "1;;3\n", {"line 1", "''"});
}

TEST_F(ReadXyz, TellsThatDecimalsTakeAPoint) {
  for (const char* text : {"1,5 2,5 3,5\n", "1,5\t2,5\t3,5\n", "1,5;2,5;3,5\n", "1,5; 2,5; 3,5;\n", "x;y;z\n1,5;2;3\n"})
    expect_refused("d.asc", text, {"'1,5'", "point", "'1.5'"});
}

TEST_F(ReadXyz, ReadsNamesOfColumns) {
  using Color = std::array<std::uint8_t, 3>;
  const Geometry g = read_bytes("n.asc", "//X Y Z R G B Scalar Nx Ny Nz\n1 2 3 255 0 7 0.5 0 0 1\n");
  EXPECT_EQ(g.points[0], (Vec3{1, 2, 3}));
  EXPECT_EQ(g.colors[0], (Color{255, 0, 7}));
  EXPECT_EQ(g.normals[0], (Vec3{0, 0, 1}));
  EXPECT_TRUE(g.warnings.empty());
  EXPECT_EQ(read_bytes("n.txt", "// scanned\n//X,Y,Z,Rf,Gf,Bf\n// more\n1\n1,2,3,1,0.5,0\n").colors[0],
            (Color{255, 128, 0}));
  EXPECT_EQ(read_bytes("n.txt", "z y x\n1 2 3\n").points[0], (Vec3{3, 2, 1}));
  expect_refused("n.asc", "//X Y Z R G B\n1 2 3\n", {"line 2", "found 3"});
  expect_refused("n.asc", "//X Y Z\n", {"no point"});
  expect_refused("n.asc", "// only this\n", {"no point"});
}

TEST_F(ReadXyz, TellsColorsFromNormalsInNineColumns) {
  const Geometry g = read_bytes("n.xyz", "1 2 3 200 10 0 0 0 1\n4 5 6 0 0 0 0 1 0\n");
  EXPECT_EQ(g.colors[0], (std::array<std::uint8_t, 3>{200, 10, 0}));
  EXPECT_EQ(g.normals[1], (Vec3{0, 1, 0}));
  ASSERT_EQ(g.warnings.size(), 1u);
  EXPECT_EQ(g.warnings[0].numbers, (std::vector<double>{4, 6}));
  for (const char* unclear : {"1 2 3 0 0 1 0 0 1\n", "1 2 3 9 9 9 9 9 9\n"}) {
    const Geometry none = read_bytes("n.xyz", unclear);
    EXPECT_TRUE(none.colors.empty() && none.normals.empty());
    EXPECT_EQ(none.properties.size(), 6u);
    EXPECT_EQ(none.warnings.back().id, "columns_unnamed");
  }
}

TEST_F(ReadXyz, HoldsAnAnnouncedNumberOfPointsToItsWord) {
  EXPECT_EQ(read_bytes("c.xyz", "2\n1 2 3\n4 5 6\n").points.size(), 2u);
  expect_refused("c.xyz", "3\n1 2 3\n4 5 6\n", {"line 3", "missing: 1"});
  expect_refused("c.xyz", "1\n1 2 3\n4 5 6\n", {"line 3", "more points"});
  expect_refused("c.xyz", "9223372036854775807\n1 2 3\n", {"announced"});
  expect_refused("c.xyz", "1 2 3\n2\n1 2 3\n", {"line 2", "found 1"});
}

using ReadPts = Files;

TEST_F(ReadPts, ReadsScansOneAfterTheOtherWithIntensityAndColors) {
  const Geometry g = read_bytes("a.pts", "2\n1 2 3 -700 255 0 7\n4 5 6 12 0 0 0\n1\n7 8 9 2047 1 2 3\n");
  EXPECT_EQ(g.points, (std::vector<Vec3>{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}}));
  EXPECT_EQ(g.colors[2], (std::array<std::uint8_t, 3>{1, 2, 3}));
  ASSERT_EQ(g.properties.size(), 1u);
  EXPECT_EQ(g.properties[0].name, "intensity");
  EXPECT_EQ(g.properties[0].values, (std::vector<double>{-700, 12, 2047}));
  EXPECT_TRUE(g.warnings.empty());
  EXPECT_EQ(read_bytes("a.pts", "1\n1 2 3 0.25\n").properties[0].values[0], 0.25);
  EXPECT_TRUE(read_bytes("a.pts", "1\n1 2 3\n").properties.empty());
}

TEST_F(ReadPts, RefusesEveryTruncationBetweenLines) {
  const std::string whole = "2\n1 2 3 4\n5 6 7 8\n2\n1 2 3 4\n5 6 7 8\n";
  const std::size_t first_scan = whole.size() / 2;
  for (std::size_t size = 1; size < whole.size() - 1; ++size) {
    if (size + 1 == first_scan || size == first_scan) continue;
    EXPECT_THROW(read_bytes("t.pts", whole.substr(0, size)), IoError) << size;
  }
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

TEST_F(ReadXyz, KeepsNamedColumnsOfNumbers) {
  const Geometry g = read_bytes("n.csv", "id,x,y,z,status,height (m),empty\n7,1,2,3,ok,0.5,\n8,4,5,6,1,0.25,2\n");
  EXPECT_EQ(g.points, (std::vector<Vec3>{{1, 2, 3}, {4, 5, 6}}));
  ASSERT_EQ(g.properties.size(), 3u);
  EXPECT_EQ(g.properties[0].name, "id");
  EXPECT_EQ(g.properties[0].values, (std::vector<double>{7, 8}));
  EXPECT_EQ(g.properties[1].name, "height__m_");
  EXPECT_EQ(g.properties[1].values, (std::vector<double>{0.5, 0.25}));
  EXPECT_TRUE(std::isnan(g.properties[2].values[0]));
  EXPECT_EQ(g.properties[2].values[1], 2);
  ASSERT_EQ(g.warnings.size(), 1u);
  EXPECT_EQ(g.warnings[0].id, "column_ignored");
  EXPECT_EQ(g.warnings[0].name, "status");
}

}  // namespace
}  // namespace ahm::io::test
