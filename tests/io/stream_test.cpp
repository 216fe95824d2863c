// What comes through a pipe has no name: the format is told, or seen in the first bytes.
#include <sstream>

#include "ahm/io/write.hpp"
#include "files.hpp"
#include "table.hpp"

namespace ahm::io::test {
namespace {

using Stream = Files;

Geometry read_text(const std::string& text, const std::string& extension = {}) {
  std::istringstream stream(text);
  return read(stream, extension);
}

TEST_F(Stream, HoldsWhatTheFileHolds) {
  const Result result;
  write(path("a.ply"), result.table());
  const Geometry file = read(path("a.ply")), stream = read_text(contents(path("a.ply")));
  EXPECT_EQ(stream.points, file.points);
  EXPECT_EQ(stream.face_vertices, file.face_vertices);
  EXPECT_EQ(stream.format, file.format);
}

TEST_F(Stream, IsKnownByItsFirstBytes) {
  EXPECT_EQ(read_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n").format, "OFF text");
  EXPECT_EQ(read_text("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
                      "endloop\nendfacet\nendsolid a\n")
                .face_count(),
            1u);
}

TEST_F(Stream, NeedsItsFormatWhereTheBytesTellNone) {
  EXPECT_EQ(read_text("1 2 3\n", ".xyz").points[0], (Vec3{1, 2, 3}));
  try {
    read_text("1 2 3\n");
    FAIL();
  } catch (const IoError& error) {
    EXPECT_EQ(error.fault(), "unknown_bytes");
  }
  EXPECT_THROW(read_text("1 2 3\n", ".nothing"), IoError);
  EXPECT_THROW(read_text("", ".xyz"), IoError);
}

TEST_F(Stream, IsReadToItsEndWhateverItsLength) {
  std::string text;
  for (int i = 0; i < 300000; ++i) text += "1 2 " + std::to_string(i) + "\n";  // more than a block
  const Geometry g = read_text(text, ".xyz");
  ASSERT_EQ(g.points.size(), 300000u);
  EXPECT_EQ(g.points.back(), (Vec3{1, 2, 299999}));
}

TEST_F(Stream, FilesOfAnyNameAreReadAndWrittenInTheFormatThatIsTold) {
  EXPECT_EQ(read(make("points.dat", "1 2 3\n"), ".xyz").points[0], (Vec3{1, 2, 3}));
  const Result result;
  write(path("map.dat"), result.table(), ".csv");
  write(path("map.csv"), result.table());
  EXPECT_EQ(contents(path("map.dat")), contents(path("map.csv")));
}

}  // namespace
}  // namespace ahm::io::test
