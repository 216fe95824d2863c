#include <cmath>

#include "files.hpp"

namespace ahm::io::test {
namespace {

using ReadStl = Files;

std::string facet(const std::string& a, const std::string& b, const std::string& c) {
  return "facet normal 0 0 1\n outer loop\n  vertex " + a + "\n  vertex " + b + "\n  vertex " + c +
         "\n endloop\nendfacet\n";
}

const std::string square =
    "solid square\n" + facet("0 0 0", "1 0 0", "1 1 0") + facet("0 0 0", "1 1 0", "0 1 0") + "endsolid square\n";

std::string binary_square(std::uint32_t count) {
  const float corners[2][9] = {{0, 0, 0, 1, 0, 0, 1, 1, 0}, {0, 0, 0, 1, 1, 0, 0, 1, 0}};
  std::string bytes = "solid in name only" + std::string(62, ' ') + bytes_of(count);
  for (const auto& triangle : corners) {
    bytes += std::string(12, '\0');
    for (float x : triangle) bytes += bytes_of(x);
    bytes += std::string(2, '\0');
  }
  return bytes;
}

void expect_square(const Geometry& g) {
  EXPECT_EQ(g.points, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
  EXPECT_EQ(g.face_vertices, (std::vector<Index>{0, 1, 2, 0, 2, 3}));
  EXPECT_EQ(g.face_begin, (std::vector<Offset>{0, 3, 6}));
}

TEST_F(ReadStl, WeldsATextSoup) {
  expect_square(read_bytes("a.stl", square));
  EXPECT_EQ(read_bytes("a.stl", square).format, "STL text");
}

TEST_F(ReadStl, WeldsABinarySoupEvenIfItsHeaderSaysSolid) {
  expect_square(read_bytes("b.STL", binary_square(2)));
  EXPECT_EQ(read_bytes("b.stl", binary_square(2)).format, "STL binary");
}

TEST_F(ReadStl, KeepsCornersThatAreNotNumbersApart) {
  const Geometry g = read_bytes("n.stl", "solid\n" + facet("nan 0 0", "nan 0 0", "1 1 0") + "endsolid\n");
  EXPECT_EQ(g.points.size(), 3u);
  EXPECT_TRUE(std::isnan(g.points[1][0]));
}

TEST_F(ReadStl, RefusesEveryTruncation) {
  for (std::size_t size = 1; size < square.size() - 16; ++size) {
    const std::string part = square.substr(0, size);
    const bool between_facets = part.ends_with("endfacet") || part.ends_with("endfacet\n");
    if (!between_facets) {
      EXPECT_THROW(read_bytes("t.stl", part), IoError) << size;
    } else {
      EXPECT_EQ(read_bytes("t.stl", part).warnings.at(0).id, "no_end") << size;
    }
  }
  const std::string binary = binary_square(2);
  for (std::size_t size = 1; size < binary.size(); ++size)
    EXPECT_THROW(read_bytes("t.stl", binary.substr(0, size)), IoError) << size;
}

TEST_F(ReadStl, RefusesCountsBeyondTheFile) {
  std::string bytes = binary_square(4000000000u);
  bytes[0] = 'x';
  expect_refused("c.stl", bytes, {"byte 80", "4000000000 triangles"});
}

TEST_F(ReadStl, RefusesBrokenFacets) {
  expect_refused("f.stl", "solid\n" + facet("0 0 0", "1,5 0 0", "1 1 0") + "endsolid\n", {"line 5", "1,5"});
  expect_refused("f.stl",
                 "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\nendfacet\nendsolid\n",
                 {"line 7", "found 2"});
  expect_refused("f.stl", "solid\nfacet normal 0 0 1\nvertex 0 0\n", {"line 3"});
  expect_refused("f.stl", "solid\ntriangle\nendsolid\n", {"line 2", "triangle"});
  expect_refused("f.stl", "solid\nendsolid\n", {"no triangles"});
}

TEST_F(ReadStl, ReadsWordsInAnyCase) {
  std::string upper = square;
  for (char& c : upper) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 32) : c;
  expect_square(read_bytes("u.stl", upper));
  expect_square(read_bytes("u.stl", " \r\n" + upper));
}

TEST_F(ReadStl, RefusesABinaryFileThatSaysSolidForItsSizeAndNotForItsWords) {
  std::string bytes = binary_square(3);
  bytes.replace(20, 1, 1, '\0');
  expect_refused("s.stl", bytes, {"byte 80", "3 triangles"});
}

}  // namespace
}  // namespace ahm::io::test
