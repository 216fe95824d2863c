#include <cmath>

#include "files.hpp"

namespace ahm::io::test {
namespace {

using ReadOff = Files;

const std::string four_points = "0 0 0\n1 0 0\n0 1 0\n1 1 0\n";

TEST_F(ReadOff, ReadsPolygonsAcrossLinesWithCommentsAndColors) {
  const Geometry g =
      read_bytes("a.off",
                 "# made by hand\r\nOFF # keyword\r\n4 2 0\r\n0 0 0\r\n1 0 0\r\n\r\n0 1 0 # third\r\n1 1 0.5\r\n"
                 "4 0 1\r\n3 2\r\n3 0 1 2 255 0 0\r\n");
  EXPECT_EQ(g.points[3], (Vec3{1, 1, 0.5}));
  EXPECT_EQ(g.face_begin, (std::vector<Offset>{0, 4, 7}));
  EXPECT_EQ(g.face_vertices, (std::vector<Index>{0, 1, 3, 2, 0, 1, 2}));
  EXPECT_TRUE(g.warnings.empty());
}

TEST_F(ReadOff, ReadsCountsOnTheKeywordsLineAndWithoutEdges) {
  EXPECT_EQ(read_bytes("a.off", "OFF 4 1\n" + four_points + "3 0 1 2\n").points.size(), 4u);
}

TEST_F(ReadOff, ReadsNormalsOfNoff) {
  const Geometry n = read_bytes("n.off", "NOFF\n1 0 0\n1 2 3 0 0 1\n");
  EXPECT_EQ(n.normals[0], (Vec3{0, 0, 1}));
  EXPECT_TRUE(n.face_begin.empty());
  expect_refused("n.off", "NOFF\n1 0 0\n1 2 3 0 0\n", {"line 3", "6 numbers", "found 5"});
}

TEST_F(ReadOff, PassesNanThrough) {
  EXPECT_TRUE(std::isnan(read_bytes("n.off", "OFF\n1 0 0\n1 nan 3\n").points[0][1]));
}

TEST_F(ReadOff, RefusesCountsBeyondTheFile) {
  for (const char* count : {"5", "4294967295", "9223372036854775807", "99999999999999999999", "-1"}) {
    EXPECT_THROW(read_bytes("c.off", std::string("OFF\n") + count + " 1 0\n" + four_points + "3 0 1 2\n"), IoError)
        << count;
    if (std::string(count) == "5") continue;
    EXPECT_THROW(read_bytes("c.off", std::string("OFF\n4 ") + count + " 0\n" + four_points + "3 0 1 2\n"), IoError)
        << count;
    EXPECT_THROW(read_bytes("c.off", "OFF\n4 1 0\n" + four_points + count + " 0 1 2\n"), IoError) << count;
  }
  expect_refused("c.off", "OFF\n400000000 1 0\n" + four_points, {"line 2", "400000000"});
}

TEST_F(ReadOff, RefusesEveryTruncation) {
  const std::string whole = "OFF\n4 2 0\n" + four_points + "3 0 1 2\n3 1 3 2";
  for (std::size_t size = 1; size < whole.size(); ++size) {
    EXPECT_THROW(read_bytes("cut.off", whole.substr(0, size)), IoError) << size;
  }
  expect_refused("cut.off", whole.substr(0, whole.size() - 1), {"line 8"});
}

TEST_F(ReadOff, RefusesVertexNumbersOutOfRange) {
  for (const char* index : {"4", "-1", "4294967296", "1.5"}) {
    expect_refused("i.off", "OFF\n4 1 0\n" + four_points + "3 0 1 " + index + "\n", {"line 7", index});
  }
}

TEST_F(ReadOff, RefusesWhatIsNoNumber) {
  for (const char* word : {"1,5", "1e400", "1.#IND", "1.#INF"}) {
    expect_refused("w.off", std::string("OFF\n1 0 0\n0 0 ") + word + "\n", {"line 3", word});
  }
}

TEST_F(ReadOff, RefusesOtherKinds) {
  expect_refused("k.off", "4OFF\n1 0 0\n1 2 3 4\n", {"4OFF"});
  expect_refused("k.off", "nOFF\n3\n1 0 0\n1 2 3\n", {"nOFF"});
  expect_refused("k.off", "OFF BINARY\n1234", {"binary"});
  expect_refused("k.off", "ply\n", {"ply"});
}

TEST_F(ReadOff, ReadsColorsAsLevelsAndAsFractions) {
  using Color = std::array<std::uint8_t, 3>;
  EXPECT_EQ(read_bytes("c.off", "COFF\n1 0 0\n1 2 3 255 7 0 255\n").colors, (std::vector<Color>{{255, 7, 0}}));
  const Geometry g = read_bytes("c.off", "COFF\n2 0 0\n1 2 3 1.0 0.5 0 1\n1 2 3 0 0 1 0.25\n");
  EXPECT_EQ(g.points[0], (Vec3{1, 2, 3}));
  EXPECT_EQ(g.colors, (std::vector<Color>{{255, 128, 0}, {0, 0, 255}}));
  EXPECT_EQ(read_bytes("c.off", "CNOFF\n1 0 0\n1 2 3 0 0 1 9 8 7\n").colors[0], (Color{9, 8, 7}));
  for (const char* other : {"COFF\n1 0 0\n1 2 3\n", "COFF\n1 0 0\n1 2 3 4\n", "COFF\n1 0 0\n1 2 3 300 0 0\n"}) {
    const Geometry none = read_bytes("c.off", other);
    EXPECT_TRUE(none.colors.empty()) << other;
    ASSERT_EQ(none.warnings.size(), 1u) << other;
    EXPECT_EQ(none.warnings[0].id, "colors_unknown");
  }
  expect_refused("c.off", "COFF\n1 0 0\n1 2 3 0,5 0 0\n", {"line 3", "0,5"});
}

TEST_F(ReadOff, ReadsTheKeywordInAnyCaseAndWithoutIt) {
  for (const char* keyword : {"OFF", "off", "Off", "COFF", "coff", "STOFF", ""})
    EXPECT_EQ(read_bytes("k.off", std::string(keyword) + "\n4 1 0\n" + four_points + "3 0 1 2\n").face_vertices,
              (std::vector<Index>{0, 1, 2}))
        << keyword;
  EXPECT_EQ(read_bytes("k.off", "noff\n1 0 0\n1 2 3 0 0 1\n").normals[0], (Vec3{0, 0, 1}));
}

}  // namespace
}  // namespace ahm::io::test
