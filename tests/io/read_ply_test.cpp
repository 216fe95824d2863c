#include <cmath>
#include <limits>

#include "files.hpp"

namespace ahm::io::test {
namespace {

using ReadPly = Files;

const std::string xyz = "property double x\nproperty double y\nproperty double z\n";

std::string text_header(const std::string& vertices, const std::string& more = "") {
  return "ply\nformat ascii 1.0\nelement vertex " + vertices + "\n" + xyz + more + "end_header\n";
}

const std::string faces = "element face 1\nproperty list uchar int vertex_indices\n";
const std::string triangle = "0 0 0\n1 0 0\n0 1 0\n";

/// A triangle with a normal and a color per vertex, an extra property, an extra element between, and a quality per
/// face.
std::string rich_binary(std::endian order) {
  std::string file =
      std::string("ply\nformat binary_") + (order == std::endian::big ? "big" : "little") + "_endian 1.0\n";
  file +=
      "comment x first is not the rule\nobj_info scanner\nelement vertex 3\nproperty uchar red\nproperty float nx\n"
      "property float ny\nproperty float nz\nproperty double z\nproperty short extra\nproperty double y\nproperty "
      "double x\n"
      "property uchar green\nproperty uchar blue\nelement strange 2\nproperty list ushort double things\nproperty int "
      "id\n"
      "element face 1\nproperty float quality\nproperty list uint ushort vertex_index\nend_header\n";
  for (int i = 0; i < 3; ++i) {
    file += bytes_of<std::uint8_t>(10, order) + bytes_of(0.0f, order) + bytes_of(0.0f, order) + bytes_of(1.0f, order);
    file += bytes_of(3.0 + i, order) + bytes_of<std::int16_t>(-7, order) + bytes_of(2.0 + i, order) +
            bytes_of(1.0 + i, order);
    file += bytes_of<std::uint8_t>(20, order) + bytes_of<std::uint8_t>(30, order);
  }
  file += bytes_of<std::uint16_t>(2, order) + bytes_of(1.0, order) + bytes_of(2.0, order) +
          bytes_of<std::int32_t>(1, order);
  file += bytes_of<std::uint16_t>(0, order) + bytes_of<std::int32_t>(2, order);
  file += bytes_of(0.5f, order) + bytes_of<std::uint32_t>(3, order);
  for (std::uint16_t k : {2, 0, 1}) file += bytes_of(k, order);
  return file;
}

TEST_F(ReadPly, ReadsEitherByteOrderWithExtraElementsAndPropertiesInAnyOrder) {
  for (std::endian order : {std::endian::little, std::endian::big}) {
    const Geometry g = read_bytes("rich.ply", rich_binary(order));
    ASSERT_EQ(g.points.size(), 3u);
    EXPECT_EQ(g.points[2], (Vec3{3, 4, 5}));
    EXPECT_EQ(g.normals[1], (Vec3{0, 0, 1}));
    EXPECT_EQ(g.colors[0], (std::array<std::uint8_t, 3>{10, 20, 30}));
    EXPECT_EQ(g.face_vertices, (std::vector<Index>{2, 0, 1}));
    EXPECT_EQ(g.face_begin, (std::vector<Offset>{0, 3}));
    ASSERT_EQ(g.warnings.size(), 1u);
    EXPECT_EQ(g.warnings[0].id, "element_ignored");
    EXPECT_EQ(g.warnings[0].name, "strange");
  }
}

TEST_F(ReadPly, KeepsFurtherPropertiesOfTheVerticesUnderNamesOfTheirOwn) {
  const Geometry g = read_bytes("p.ply",
                                "ply\nformat ascii 1.0\nelement vertex 2\nproperty float intensity\nproperty float x\n"
                                "property float y\nproperty float z\nproperty uchar scalar-field\n"
                                "property uchar scalar_field\nend_header\n0.25 1 2 3 7 8\n0.5 4 5 6 9 10\n");
  EXPECT_EQ(g.points, (std::vector<Vec3>{{1, 2, 3}, {4, 5, 6}}));
  ASSERT_EQ(g.properties.size(), 3u);
  EXPECT_EQ(g.properties[0].name, "intensity");
  EXPECT_EQ(g.properties[0].values, (std::vector<double>{0.25, 0.5}));
  EXPECT_EQ(g.properties[1].name, "scalar_field");
  EXPECT_EQ(g.properties[2].name, "scalar_field_2");
  EXPECT_EQ(g.properties[2].values, (std::vector<double>{8, 10}));
}

TEST_F(ReadPly, KeepsPolygonsAndTheirOrder) {
  const std::string list = "element face 2\nproperty list uchar int vertex_indices\n";
  const Geometry g =
      read_bytes("p.ply", text_header("5", list) + "0 0 0\n1 0 0\n1 1 0\n0 1 0\n2 2 0\n4 0 1 2 3\n3 4 1 0\n");
  EXPECT_EQ(g.face_begin, (std::vector<Offset>{0, 4, 7}));
  EXPECT_EQ(g.face_vertices, (std::vector<Index>{0, 1, 2, 3, 4, 1, 0}));
  EXPECT_EQ(g.format, "PLY text");
}

TEST_F(ReadPly, KeepsTheDigitsOfTextEvenWhenDeclaredFloat) {
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
  EXPECT_EQ(read_bytes("utm.ply", header + "431234.567 5412345.678 1e-310\n").points[0],
            (Vec3{431234.567, 5412345.678, 1e-310}));
}

TEST_F(ReadPly, PassesNanAndInfinityThrough) {
  const Vec3 p = read_bytes("nan.ply", text_header("1") + "nan inf -inf\n").points[0];
  EXPECT_TRUE(std::isnan(p[0]));
  EXPECT_EQ(p[1], std::numeric_limits<double>::infinity());
  EXPECT_EQ(p[2], -std::numeric_limits<double>::infinity());
}

TEST_F(ReadPly, ReadsCarriageReturnsInTextAndBeforeBinary) {
  std::string text = text_header("3", faces) + triangle + "3 0 1 2\n";
  std::string crlf;
  for (char c : text) crlf += c == '\n' ? std::string("\r\n") : std::string(1, c);
  EXPECT_EQ(read_bytes("crlf.ply", crlf).points[1], (Vec3{1, 0, 0}));

  for (const std::string end : {"\n", "\r\n", "\r"}) {
    std::string binary;
    for (char c :
         "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty uchar x\nproperty uchar y\nproperty uchar "
         "z\n"
         "end_header\n" +
             std::string()) {
      binary += c == '\n' ? end : std::string(1, c);
    }
    const Geometry g = read_bytes("payload.ply", binary + "\n\r\n");
    EXPECT_EQ(g.points[0], (Vec3{10, 13, 10})) << "payload must not be eaten as a line end";
    EXPECT_TRUE(g.warnings.empty());
  }
}

TEST_F(ReadPly, RefusesAHeaderCountBeyondTheFile) {
  for (const char* count : {"4", "4294967295", "9223372036854775807"}) {
    expect_refused("count.ply", text_header(count) + triangle, {"line 3", count});
    expect_refused("count.ply",
                   "ply\nformat binary_little_endian 1.0\nelement vertex " + std::string(count) + "\n" + xyz +
                       "end_header\n" + std::string(72, '\0'),
                   {"line 3", count, "72"});
  }
  expect_refused("count.ply",
                 text_header("3", "element face 999999999\nproperty list uchar int vertex_indices\n") + triangle,
                 {"line 7", "999999999"});
  expect_refused("count.ply", text_header("99999999999999999999") + triangle, {"line 3", "99999999999999999999"});
  expect_refused("count.ply", text_header("-3") + triangle, {"line 3", "-3"});
}

TEST_F(ReadPly, RefusesTruncatedTextWithItsLine) {
  const std::string whole = text_header("3", faces) + triangle + "3 0 1 2\n";
  expect_refused("cut.ply", whole.substr(0, whole.size() - 4), {"line 13", "face 0"});
  expect_refused("cut.ply", text_header("4") + "0 0 0 \n1 0 0 \n0 1 0 \n1 1\n", {"line 11", "vertex 3"});
  expect_refused("cut.ply", text_header("2") + "0.0 0.0 0.0\n", {"vertex 1 of 2"});
  expect_refused("cut.ply", whole.substr(0, 60), {"end_header"});
}

TEST_F(ReadPly, RefusesTruncatedBinary) {
  for (std::endian order : {std::endian::little, std::endian::big}) {
    const std::string whole = rich_binary(order);
    for (std::size_t size = whole.find("end_header"); size < whole.size(); ++size) {
      EXPECT_THROW(read_bytes("cut.ply", whole.substr(0, size)), IoError) << size;
    }
  }
  const std::string whole = rich_binary(std::endian::little);
  expect_refused("cut.ply", whole.substr(0, whole.size() - 1), {"byte", "face 0"});
}

TEST_F(ReadPly, RefusesALineWithTooManyValues) {
  expect_refused("long.ply", text_header("3") + "0 0 0\n1 0 0 7\n0 1 0\n", {"line 9", "vertex 1"});
}

TEST_F(ReadPly, RefusesAListCountBeyondTheData) {
  expect_refused("list.ply", text_header("3", faces) + triangle + "200 0 1 2\n", {"line 13", "200"});
  const std::string head =
      "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty uchar x\nproperty uchar y\n"
      "property uchar z\nelement face 1\nproperty list ";
  expect_refused("list.ply", head + "uint int vertex_indices\nend_header\nxyz" + bytes_of<std::uint32_t>(0xffffffff),
                 {"4294967295"});
  expect_refused("list.ply", head + "char int vertex_indices\nend_header\nxyz\xff", {"-1"});
}

TEST_F(ReadPly, RefusesAListAsCoordinate) {
  expect_refused("list.ply",
                 "ply\nformat ascii 1.0\nelement vertex 1\nproperty list uchar double x\nproperty double y\n"
                 "property double z\nend_header\n1 0 0 0\n",
                 {"'x'", "list"});
}

TEST_F(ReadPly, RefusesMissingOrDuplicateCoordinates) {
  const std::string head = "ply\nformat ascii 1.0\nelement vertex 1\n";
  expect_refused("x.ply", head + "property float x\nproperty float z\nend_header\n1 2\n", {"'y'"});
  expect_refused("x.ply", head + xyz + "property float x\nend_header\n1 2 3 4\n", {"'x'", "twice"});
  expect_refused("x.ply", head + "end_header\n1 2\n", {"'x'"});
  expect_refused("x.ply", "ply\nformat ascii 1.0\nend_header\n", {"no element 'vertex'"});
}

TEST_F(ReadPly, RefusesVertexNumbersOutOfRange) {
  for (const char* index : {"3", "-1", "2147483648", "4294967295"}) {
    expect_refused("index.ply", text_header("3", faces) + triangle + "3 0 1 " + index + "\n", {"face 0", index});
  }
}

TEST_F(ReadPly, RefusesWhatIsNoNumber) {
  for (const char* word : {"1,5", "1e400", "1.#IND", "0x10", "one", "1.5f", "--1"}) {
    expect_refused("word.ply", text_header("1") + "0 0 " + word + "\n", {"line 8", word});
  }
  expect_refused("word.ply", text_header("3", faces) + triangle + "3 0 1 1.5\n", {"1.5"});
}

TEST_F(ReadPly, RefusesHeadersItCannotTrust) {
  expect_refused("h.ply", "plx\n", {"line 1"});
  expect_refused("h.ply", "ply\nelement vertex 0\n" + xyz + "end_header\n", {"format"});
  expect_refused("h.ply", "ply\nformat ascii 1.0\nproperty float x\nend_header\n", {"line 3"});
  expect_refused("h.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty int128 x\nend_header\n",
                 {"line 4", "int128"});
  expect_refused("h.ply", "ply\nformat utf8 1.0\nend_header\n", {"line 2", "utf8"});
  expect_refused("h.ply", text_header("1", "element vertex 1\nproperty float x\n"), {"twice"});
  expect_refused("h.ply",
                 text_header("1", "element face 1\nproperty list float int vertex_indices\n") + "0 0 0\n0.5 0\n",
                 {"0.5"});
  expect_refused("h.ply",
                 text_header("1", "element face 1\nproperty list uchar float vertex_indices\n") + "0 0 0\n1 0.5\n",
                 {"whole"});
  expect_refused("h.ply", text_header("1", "element face 1\nproperty uchar flags\n") + "0 0 0\n1\n",
                 {"vertex_indices"});
}

TEST_F(ReadPly, DoesNotLoopOverElementsWithoutProperties) {
  EXPECT_EQ(read_bytes("e.ply", text_header("1", "element ghost 9223372036854775807\n") + "1 2 3\n").points.size(), 1u);
}

TEST_F(ReadPly, UnfoldsTriangleStripsWithTheirOrientation) {
  const std::string strips = "element tristrips 1\nproperty list int int vertex_indices\n";
  const Geometry g = read_bytes("s.ply", text_header("5", strips) + triangle + "1 1 0\n2 2 0\n8 0 1 2 3 -1 2 3 4\n");
  EXPECT_EQ(g.face_vertices, (std::vector<Index>{0, 1, 2, 1, 3, 2, 2, 3, 4}));
  EXPECT_EQ(g.face_begin, (std::vector<Offset>{0, 3, 6, 9}));
  expect_refused("s.ply", text_header("3", strips) + triangle + "3 0 1 -2\n", {"-2"});
}

TEST_F(ReadPly, WarnsOfDataBehindTheLastElement) {
  EXPECT_EQ(read_bytes("more.ply", text_header("1") + "1 2 3\n4 5 6\n").warnings.size(), 1u);
}

TEST_F(ReadPly, ReadsNamesInAnyCase) {
  const std::string head = "ply\nformat ascii 1.0\nelement vertex 1\n";
  const std::string upper = "property float X\nproperty float Y\nproperty float Z\n";
  EXPECT_EQ(read_bytes("u.ply", head + upper + "end_header\n1 2 3\n").points[0], (Vec3{1, 2, 3}));
  expect_refused("u.ply", head + upper + xyz + "end_header\n1 2 3 4 5 6\n", {"twice"});
}

TEST_F(ReadPly, ReadsColorsOfEveryType) {
  using Color = std::array<std::uint8_t, 3>;
  const auto colored = [&](const std::string& type, const std::string& values) {
    return read_bytes("c.ply", "ply\nformat ascii 1.0\nelement vertex 1\n" + std::string(xyz) + "property " + type +
                                   " red\nproperty " + type + " green\nproperty " + type + " blue\nend_header\n1 2 3 " +
                                   values + "\n");
  };
  EXPECT_EQ(colored("float", "1 0.5 0").colors, (std::vector<Color>{{255, 128, 0}}));
  EXPECT_EQ(colored("float", "255 7 0").colors, (std::vector<Color>{{255, 7, 0}}));
  EXPECT_EQ(colored("int", "255 7 0").colors, (std::vector<Color>{{255, 7, 0}}));
  EXPECT_EQ(colored("ushort", "65535 257 0").colors, (std::vector<Color>{{255, 1, 0}}));
  EXPECT_EQ(colored("uchar", "1 1 0").colors, (std::vector<Color>{{1, 1, 0}}));
  for (const char* values : {"-1 0 0", "0.5 2 0", "70000 1 1", "nan 0 0"}) {
    const Geometry none = colored("float", values);
    EXPECT_TRUE(none.colors.empty()) << values;
    ASSERT_EQ(none.warnings.size(), 1u) << values;
    EXPECT_EQ(none.warnings[0].id, "colors_unknown");
  }
}

TEST_F(ReadPly, SkipsHeaderLinesWithoutMeaningWhereNothingCanShift) {
  const auto with = [](const std::string& format, const char* first, const char* last) {
    return "ply\n" + std::string(first) + "format " + format + " 1.0\nelement vertex 1\n" +
           "property uchar x\nproperty uchar y\nproperty uchar z\n" + last + "end_header\n";
  };
  const Geometry text = read_bytes("h.ply", with("ascii", "made by hand\n", "TextureFile a.png\n") + "1 2 3\n");
  EXPECT_EQ(text.points[0], (Vec3{1, 2, 3}));
  ASSERT_EQ(text.warnings.size(), 1u);
  EXPECT_EQ(text.warnings[0].id, "lines_skipped");
  EXPECT_EQ(text.warnings[0].numbers, (std::vector<double>{2, 2}));
  EXPECT_EQ(read_bytes("h.ply", with("binary_little_endian", "made by hand\n", "") + "abc").points.size(), 1u);
  // It could be a misspelt property, which would shift the values of all vertices behind the first.
  expect_refused("h.ply", with("binary_little_endian", "", "proprty uchar red\n") + "abcd", {"line 7", "proprty"});
  expect_refused("h.ply", with("ascii", "", "proprty uchar red\n") + "1 2 3 4\n", {"line 9", "more values"});
}

}  // namespace
}  // namespace ahm::io::test
