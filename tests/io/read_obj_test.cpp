#include <cmath>

#include "files.hpp"

namespace ahm::io::test {
namespace {

using ReadObj = Files;

const std::string points = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST_F(ReadObj, KeepsPolygonsAndIgnoresEverythingElse) {
  const Geometry g =
      read_bytes("a.obj",
                 "# c\r\nmtllib a.mtl\r\no thing\r\nv 0 0 0\r\nv\t1 0 0\r\nvt 0 0\r\nv 1 1 0\r\nv 0 1 0\r\ng x\r\n"
                 "usemtl m\r\ns off\r\nvp 1\r\np 1\r\nl 1 2 3\r\nf 1/1 2/1\t3/1 4/1\r\nf 1// 2 \\\r\n 3\r\n");
  EXPECT_EQ(g.points.size(), 4u);
  EXPECT_EQ(g.face_begin, (std::vector<Offset>{0, 4, 7}));
  EXPECT_EQ(g.face_vertices, (std::vector<Index>{0, 1, 2, 3, 0, 1, 2}));
  EXPECT_EQ(g.format, "OBJ");
  EXPECT_TRUE(g.warnings.empty());
}

TEST_F(ReadObj, ResolvesRelativeNumbersWhereTheyStand) {
  const Geometry g = read_bytes("r.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf -3 -2 -1\nv 5 5 5\nf -1 -3 -2\n");
  EXPECT_EQ(g.face_vertices, (std::vector<Index>{0, 1, 2, 3, 1, 2}));
}

TEST_F(ReadObj, ReadsFacesBeforeTheirVertices) {
  EXPECT_EQ(read_bytes("f.obj", "f 1 2 3\n" + points).face_vertices, (std::vector<Index>{0, 1, 2}));
}

TEST_F(ReadObj, ReadsVerticesWithoutFacesAsACloud) { EXPECT_TRUE(read_bytes("c.obj", points).face_begin.empty()); }

TEST_F(ReadObj, RefusesVertexNumbersOutOfRange) {
  for (const char* index :
       {"0", "5", "-5", "2147483648", "-2147483649", "4294967297", "1.5", "x", "1/1/1/1", "/1", "1/x"}) {
    expect_refused("i.obj", points + "f 1 2 " + index + "\n", {"line 5", index});
  }
}

TEST_F(ReadObj, RefusesTruncatedAndShortStatements) {
  expect_refused("t.obj", points + "v 1 2\n", {"line 5", "v 1 2"});
  expect_refused("t.obj", points + "f 1 2", {"line 5", "found 2"});
  expect_refused("t.obj", points + "f", {"line 5"});
  expect_refused("t.obj", "# nothing\n", {"no vertex"});
}

TEST_F(ReadObj, RefusesWhatIsNoNumber) {
  for (const char* word : {"1,5", "1e400", "1.#IND", "1.#INF"}) {
    expect_refused("w.obj", std::string("v 0 0 ") + word + "\n", {"line 1", word});
  }
}

TEST_F(ReadObj, PassesNanThroughAndKeepsDoubles) {
  const Vec3 p = read_bytes("n.obj", "v nan 431234.567891 0.3\n").points[0];
  EXPECT_TRUE(std::isnan(p[0]));
  EXPECT_EQ(p[1], 431234.567891);
  EXPECT_EQ(p[2], 0.3);
}

TEST_F(ReadObj, KeepsNormalsOnlyWhenNumberedLikeTheVertices) {
  const std::string normals = "vn 0 0 1\nvn 0 0 2\nvn 0 0 3\nvn 0 0 4\n";
  EXPECT_EQ(read_bytes("n.obj", points + normals + "f 1//1 2//2 3//3 4//4\n").normals[3], (Vec3{0, 0, 4}));
  const Geometry g = read_bytes("n.obj", points + normals + "f 1//1 2//2 3//3 4//1\n");
  EXPECT_TRUE(g.normals.empty());
  EXPECT_EQ(g.warnings.size(), 1u);
}

TEST_F(ReadObj, SkipsStatementsItDoesNotKnowAndNamesThem) {
  const Geometry g = read_bytes("s.obj", points + "zebra 1\nV 9 9 9\nzebra 2\nf 1 2 3\nadobe_x y\n");
  EXPECT_EQ(g.points.size(), 4u);
  EXPECT_EQ(g.face_vertices, (std::vector<Index>{0, 1, 2}));
  ASSERT_EQ(g.warnings.size(), 1u);
  EXPECT_EQ(g.warnings[0].id, "lines_skipped");
  EXPECT_EQ(g.warnings[0].numbers, (std::vector<double>{4, 5}));
  EXPECT_EQ(g.warnings[0].name, "'zebra 1'");
}

TEST_F(ReadObj, RefusesLinesThatBeginWithNoWord) {
  for (const char* damage : {"0.5 1 2", "-1", "\x01\x02", "v1.5,2"})
    expect_refused("d.obj", points + damage + "\n", {"line 5", "not an OBJ keyword"});
}

TEST_F(ReadObj, ReadsColorsBehindThePosition) {
  using Color = std::array<std::uint8_t, 3>;
  const Geometry g = read_bytes("c.obj", "v 0 0 0 1.0 0.5 0\nv 1 0 0 0 0 1\n");
  EXPECT_EQ(g.colors, (std::vector<Color>{{255, 128, 0}, {0, 0, 255}}));
  EXPECT_EQ(read_bytes("c.obj", "v 0 0 0 200 7 0\n").colors[0], (Color{200, 7, 0}));
  EXPECT_TRUE(g.warnings.empty());
  for (const char* other :
       {"v 0 0 0 1.0 0.5 0\nv 1 0 0\n", "v 0 0 0 0.5 -1 0\n", "v 0 0 0 300 1 1\n", "v 0 0 0 1\n", "v 0 0 0 1 1 x\n"}) {
    const Geometry none = read_bytes("c.obj", other);
    EXPECT_TRUE(none.colors.empty()) << other;
    ASSERT_EQ(none.warnings.size(), 1u) << other;
    EXPECT_EQ(none.warnings[0].id, "vertex_extras");
  }
}

}  // namespace
}  // namespace ahm::io::test
