// Files as other programs write them, in one table: what each contains, and which warning or error it causes.
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "comma_locale.hpp"
#include "files.hpp"
#include "streamed.hpp"

namespace ahm::io::test::dialects {
namespace {

/// A file and what `read` finds in it.
struct Dialect {
  const char* name;  ///< of the file
  std::string bytes;
  std::vector<Vec3> points = {};
  std::vector<Index> corners = {};        ///< of all faces
  std::vector<std::string> columns = {};  ///< names of properties; "normals" and "colors" if there are any
  std::vector<std::string> warnings = {};
  const char* error = nullptr;  ///< a part of the message; null: the file is read
};

const std::vector<Vec3> triangle = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
const std::vector<Vec3> two_points = {{1, 2, 3}, {4, 5, 6}};
const std::vector<Index> corners = {0, 1, 2};

std::vector<std::string> columns_of(const Geometry& g) {
  std::vector<std::string> names;
  if (!g.normals.empty()) names.push_back("normals");
  if (!g.colors.empty()) names.push_back("colors");
  for (const Property& property : g.properties) names.push_back(property.name);
  return names;
}

/// "lines_skipped 2 5 '$ text'": identifier, numbers, name.
std::vector<std::string> warnings_of(const Geometry& g) {
  std::vector<std::string> result;
  for (const Warning& warning : g.warnings) {
    std::string& text = result.emplace_back(warning.id);
    for (const double number : warning.numbers) text += ' ' + std::to_string(std::lround(number));
    if (!warning.name.empty()) text += ' ' + warning.name;
  }
  return result;
}

class Dialects : public Files {
 protected:
  void expect(const Dialect& d) const {
    SCOPED_TRACE(std::string(d.name) + ": " + d.bytes.substr(0, 300));
    if (d.error != nullptr) return expect_refused(d.name, d.bytes, {d.error});
    Geometry g;
    ASSERT_NO_THROW(g = read_bytes(d.name, d.bytes));
    EXPECT_EQ(g.points, d.points);
    EXPECT_EQ(g.face_vertices, d.corners);
    EXPECT_EQ(columns_of(g), d.columns);
    EXPECT_EQ(warnings_of(g), d.warnings);
  }

  void expect_all(const std::vector<Dialect>& table) const {
    for (const Dialect& dialect : table) expect(dialect);
    const CommaLocale comma;
    for (const Dialect& dialect : table) expect(dialect);
  }
};

// ---- PLY ----

std::string ply(const std::string& format, const std::string& vertices, const std::string& vertex_more,
                const std::string& rest, const std::string& body) {
  return "ply\nformat " + format + " 1.0\nelement vertex " + vertices +
         "\nproperty float x\nproperty float y\nproperty float z\n" + vertex_more + rest + "end_header\n" + body;
}

/// A vertex of binary PLY: three floats, then a list of numbers of type `Entry` with a count of one byte, then a float.
template <class Entry>
std::string vertex_with_list(const Vec3& p, const std::vector<Entry>& list, std::endian order) {
  std::string bytes;
  for (const double x : p) bytes += bytes_of(static_cast<float>(x), order);
  bytes += static_cast<char>(list.size());
  for (const Entry entry : list) bytes += bytes_of(entry, order);
  return bytes + bytes_of(0.5f, order);
}

const std::string seen = "property list uint8 uint32 view_indices\nproperty float quality\n";

std::string binary_with_lists(std::endian order) {
  const std::string format = order == std::endian::little ? "binary_little_endian" : "binary_big_endian";
  return ply(format, "3", seen, "",
             vertex_with_list<std::uint32_t>({0, 0, 0}, {7, 8}, order) +
                 vertex_with_list<std::uint32_t>({1, 0, 0}, {}, order) +
                 vertex_with_list<std::uint32_t>({0, 1, 0}, {1, 2, 3, 4, 5}, order));
}

const std::string face_list = "element face 1\nproperty list uchar int vertex_indices\n";

/// A face of binary PLY with a count and corners of the given types.
template <class Count, class Corner>
std::string binary_face(const char* count, const char* corner, Count n, std::initializer_list<Corner> list) {
  std::string body;
  for (const Vec3& p : triangle)
    for (const double x : p) body += bytes_of(static_cast<float>(x));
  body += bytes_of(n);
  for (const Corner c : list) body += bytes_of(c);
  return ply("binary_little_endian", "3", "",
             std::string("element face 1\nproperty list ") + count + ' ' + corner + " vertex_indices\n", body);
}

TEST_F(Dialects, Ply) {
  const std::string three = "0 0 0\n1 0 0\n0 1 0\n";
  const std::string wide = "property uint64 id\n";
  expect_all({
      {"list.ply",
       ply("ascii", "3", seen, "", "0 0 0 2 7 8 0.5\n1 0 0 0 0.5\n0 1 0 3 1 2 3 0.5\n"),
       triangle,
       {},
       {"quality"},
       {"list_ignored view_indices"}},
      {"little.ply", binary_with_lists(std::endian::little), triangle, {}, {"quality"}, {"list_ignored view_indices"}},
      {"big.ply", binary_with_lists(std::endian::big), triangle, {}, {"quality"}, {"list_ignored view_indices"}},
      {"cut.ply", binary_with_lists(std::endian::little).substr(0, 250), {}, {}, {}, {}, "byte"},
      {"lists.ply",
       ply("ascii", "3", "property list uchar float nx\nproperty float ny\nproperty float nz\n", "",
           "0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 1 5 0 1\n"),
       triangle,
       {},
       {"ny", "nz"},
       {"list_ignored nx"}},
      {"x.ply",
       "ply\nformat ascii 1.0\nelement vertex 1\nproperty list uchar float x\nproperty float y\n"
       "property float z\nend_header\n1 0 0 0\n",
       {},
       {},
       {},
       {},
       "must be a number"},
      {"count.ply",
       ply("ascii", "3", "", "element face 1\nproperty list float int64 vertex_indices\n", three + "3 0 1 2\n"),
       triangle, corners},
      {"count.ply", binary_face<float, std::int64_t>("float", "int64", 3, {0, 1, 2}), triangle, corners},
      {"count.ply", binary_face<std::uint64_t, float>("uint64", "float", 3, {0, 1, 2}), triangle, corners},
      {"half.ply", binary_face<float, int>("float", "int", 2.5f, {0, 1, 2}), {}, {}, {}, {}, "has 2.5 where a whole"},
      {"half.ply", binary_face<std::uint8_t, float>("uchar", "float", 3, {0, 1, 1.5f}), {}, {}, {}, {}, "1.5"},
      {"huge.ply", binary_face<std::uint64_t, int>("uint64", "int", ~std::uint64_t{0}, {0}), {}, {}, {}, {}, "2^63"},
      {"huge.ply",
       binary_face<std::int64_t, int>("int64", "int", std::int64_t{1} << 60, {0}),
       {},
       {},
       {},
       {},
       "1152921504606846976"},
      {"id.ply", ply("ascii", "2", wide, "", "1 2 3 7\n4 5 6 9007199254740991\n"), two_points, {}, {"id"}},
      {"id.ply",
       ply("ascii", "2", wide, "", "1 2 3 7\n4 5 6 9007199254740993\n"),
       two_points,
       {},
       {},
       {"element_ignored id"}},
      {"x64.ply",
       "ply\nformat ascii 1.0\nelement vertex 1\nproperty int64 x\nproperty int64 y\nproperty int64 z\n"
       "end_header\n1 2 9007199254740993\n",
       {},
       {},
       {},
       {},
       "2^53"},
      {"header.ply",
       ply("binary_little_endian", "1", "! made by hand\n", "", bytes_of(1.f) + bytes_of(2.f) + bytes_of(3.f)),
       {{1, 2, 3}},
       {},
       {},
       {"lines_skipped 1 7 '! made by hand'"}},
      {"header.ply",
       ply("ascii", "3", "TextureFile a.png\n", face_list, "# points\n" + three + "$ faces\n3 0 1 2\n"),
       triangle,
       corners,
       {},
       {"lines_skipped 3 7 'TextureFile a.png'"}},
  });
}

// ---- PCD ----

#ifdef AHM_WITH_PCL

std::string pcd(const std::string& fields, const std::string& size, const std::string& type, const std::string& count,
                const std::string& more, const std::string& data) {
  return "# .PCD v0.7\nVERSION 0.7\nFIELDS " + fields + "\nSIZE " + size + "\nTYPE " + type + "\nCOUNT " + count +
         "\n" + more + "WIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA " + data + "\n";
}

/// LZF that only copies: runs of at most 32 literal bytes, after both sizes.
std::string stored(const std::string& bytes, std::size_t plain) {
  std::string packed;
  for (std::size_t k = 0; k < bytes.size(); k += 32) {
    const std::string run = bytes.substr(k, 32);
    packed += static_cast<char>(run.size() - 1) + run;
  }
  return bytes_of(static_cast<std::uint32_t>(packed.size())) + bytes_of(static_cast<std::uint32_t>(plain)) + packed;
}

std::string column(std::initializer_list<float> values) {
  std::string bytes;
  for (const float x : values) bytes += bytes_of(x);
  return bytes;
}

TEST_F(Dialects, Pcd) {
  const std::string xyz = column({1, 2, 3, 4, 5, 6}), padded = "x _ y ring z", sizes = "4 1 4 2 4", types = "F U F U F";
  const std::string with = column({1, 4}) + "padded" + column({2, 5}) + bytes_of(std::uint16_t{8}) +
                           bytes_of(std::uint16_t{9}) + column({3, 6});
  const std::string without = column({1, 4}) + column({2, 5}) + std::string(4, '\0') + column({3, 6});
  expect_all({
      {"zero.pcd", pcd("x y z empty", "4 4 4 4", "F F F F", "1 1 1 0", "", "ascii") + "1 2 3\n4 5 6\n", two_points},
      {"zero.pcd", pcd("x none y z", "4 8 4 4", "F F F F", "1 0 1 1", "", "binary") + xyz, two_points},
      {"zero.pcd", pcd("x y z", "4 4 4", "F F F", "1 0 1", "", "ascii") + "1 3\n4 6\n", {}, {}, {}, {}, "no field 'y'"},
      {"with.pcd",
       pcd(padded, sizes, types, "1 3 1 1 1", "", "binary_compressed") + stored(with, with.size()),
       two_points,
       {},
       {"ring"}},
      {"without.pcd",
       pcd(padded, sizes, types, "1 3 1 1 1", "", "binary_compressed") + stored(without, without.size()),
       two_points,
       {},
       {"ring"}},
      {"lying.pcd",
       pcd(padded, sizes, types, "1 3 1 1 1", "", "binary_compressed") + stored(with, with.size() - 1),
       {},
       {},
       {},
       {},
       "uncompressed size"},
      {"unknown.pcd",
       pcd("x y z", "4 4 4", "F F F", "1 1 1", "SENSOR front\n", "ascii") + "; first\n1 2 3\n# next\n4 5 6\n",
       two_points,
       {},
       {},
       {"lines_skipped 2 7 'SENSOR front'"}},
      {"unknown.pcd",
       pcd("x y z", "4 4 4", "F F F", "1 1 1", "SENSOR front\n", "binary") + xyz,
       two_points,
       {},
       {},
       {"lines_skipped 1 7 'SENSOR front'"}},
      {"unknown.pcd",
       pcd("x y z", "4 4 4", "F F F", "1 1 1", "CONT 1 1 2\n", "binary") + xyz + "more",
       {},
       {},
       {},
       {},
       "CONT 1 1 2"},
  });
}

#endif

// ---- OBJ, OFF, STL ----

TEST_F(Dialects, ObjAndOff) {
  const std::string v = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  expect_all({
      {"a.obj", v + "$ made by hand\nf 1 2 3\n", triangle, corners, {}, {"lines_skipped 1 4 '$ made by hand'"}},
      {"a.obj", "// one\n" + v + "zebra 1\n! two\nf 1 2 3\n", triangle, corners, {}, {"lines_skipped 3 1 '// one'"}},
      {"a.obj", v + "v1 2 3\nf 1 2 3\n", {}, {}, {}, {}, "line 4"},
      {"a.obj", v + "12 3\nf 1 2 3\n", {}, {}, {}, {}, "line 4"},
      {"a.obj", "<!DOCTYPE html>\n<html>\n</html>\n", {}, {}, {}, {}, "line 1: '<!DOCTYPE html>'"},
      {"a.off",
       "OFF\n$ made by hand\n3 1 0\n0 0 0\n// next\n1 0 0\n0 1 0\n3 0 1 2\n",
       triangle,
       corners,
       {},
       {"lines_skipped 2 2 '$ made by hand'"}},
      {"a.off", "OFF\n3 1 0\n0 0 0\nx 0 0\n0 1 0\n3 0 1 2\n", {}, {}, {}, {}, "line 4"},
  });
}

std::string facet(const std::string& end) {
  return "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n" + end;
}

TEST_F(Dialects, Stl) {
  const std::string whole = facet("endloop\nendfacet\n"), comment = "; exported from a drawing of many years ago\n";
  const std::string floats = bytes_of(0.f), header(80, ' ');
  std::string facets(50, '\0');
  expect_all({
      {"a.stl", "solid a\n" + whole + "end solid a\n", triangle, corners},
      {"a.stl", "solid a\n" + facet("end loop\nend facet\n") + "endsolid\n", triangle, corners},
      {"a.stl", "solid a\n" + whole, triangle, corners, {}, {"no_end endsolid"}},
      {"a.stl", "solid a\n" + whole.substr(0, whole.size() - 10), {}, {}, {}, {}, "cut short"},
      {"a.stl",
       "solid a\ncolor 0.5 0.5 0.5\n" + whole + "endsolid\n",
       triangle,
       corners,
       {},
       {"lines_skipped 1 2 'color 0.5 0.5 0.5'"}},
      {"a.stl",
       comment + "solid a\n" + whole + "endsolid\n",
       triangle,
       corners,
       {},
       {"lines_skipped 1 1 '; exported from a drawing of many years ago'"}},
      {"a.stl",
       "solid a\nfacet normal 0 0 1\nvertx 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendfacet\nendsolid\n",
       {},
       {},
       {},
       {},
       "line 6"},
      {"a.stl",
       header + bytes_of(std::uint32_t{0}) + facets + facets,
       {},
       {},
       {},
       {},
       "announces 0 triangles, but 100 bytes"},
      {"a.stl", header + bytes_of(std::uint32_t{0}), {}, {}, {}, {}, "no triangles"},
  });
}

// ---- columns ----

TEST_F(Dialects, Columns) {
  expect_all({
      {"a.xyz", "1 2 3 0.5\n4 5 6 0.25\n", two_points, {}, {"column_4"}, {"columns_unnamed 4 4"}},
      {"a.xyz",
       "1 2 3 wall 7\n4 5 6 door 8\n",
       two_points,
       {},
       {"column_5"},
       {"column_ignored column_4", "columns_unnamed 4 5"}},
      {"a.xyz",
       "1 2 3 0 0 1 0 0 1\n4 5 6 0 0 1 0 0 1\n",
       two_points,
       {},
       {"column_4", "column_5", "column_6", "column_7", "column_8", "column_9"},
       {"columns_unnamed 4 9"}},
      {"a.xyz", "# x y z height\n1 2 3 0.5\n4 5 6 0.25\n", two_points, {}, {"height"}},
      {"a.xyz", "# x y z height\n1 2 3\n4 5 6\n", two_points},
      {"a.xyz", "x y z\n1 2 3 0.5\n", {}, {}, {}, {}, "expected 3 columns, the number of names in line 1, found 4"},
      {"a.txt",
       "Survey of the old harbor\nScan 12\n1 2 3\n4 5 6\n",
       two_points,
       {},
       {},
       {"lines_skipped 2 1 'Survey of the old harbor'"}},
      {"a.txt",
       "Survey of 1999, revised\nx;y;z;ring\n1;2;3;7\n4;5;6;8\n",
       two_points,
       {},
       {"ring"},
       {"lines_skipped 1 1 'Survey of 1999, revised'"}},
      {"a.csv", "lat,lon,height\n1,2,3\n", {}, {}, {}, {}, "line 1: no column is named 'x'"},
      {"a.xyz", "1 2 3\n$ second scan\n4 5 6\n", two_points, {}, {}, {"lines_skipped 1 2 '$ second scan'"}},
      {"a.asc", "; exported\n1;2;3\n4;5;6\n", two_points, {}, {}, {"lines_skipped 1 1 '; exported'"}},
      {"a.asc", "1;2;3\n;5;6\n", {}, {}, {}, {}, "line 2"},
      {"a.csv", "x\ty\tz\tring\n1\t2\t3\t7\n4\t5\t6\t\n", two_points, {}, {"ring"}},
      {"a.xyz", "x\ty\tz\tring\n1\t2\t3\t\t\n4\t5\t6\t8\r\n", two_points, {}, {"ring"}},
      {"a.csv", "ring\tx\ty\tz\n\t1\t2\t3\n8\t4\t5\t6\t\n", two_points, {}, {"ring"}},
      {"a.xyz", "1\t2\t3\t7\n4\t5\t6\t\t\t\n", {}, {}, {}, {}, "expected 4 columns, as in the lines before, found 6"},
      {"a.csv", "x\ty\tz\n1\t2\t\n", {}, {}, {}, {}, "line 2"},
      {"a.xyz", "1 2 3\n4 x 6\n", {}, {}, {}, {}, "line 2"},
      {"a.xyz", "1 2 x\n4 5 6\n", {}, {}, {}, {}, "line 1"},
      {"a.xyz", "1 2 3\n\"\"\n", {}, {}, {}, {}, "line 2"},
      {"a.xyz", "only words\n", {}, {}, {}, {}, "no points; not understood: 1 line, the first is line 1: 'only words'"},
  });
}

// ---- LAS ----

std::string text_of(std::string text, std::size_t size) {
  text.resize(size, '\0');
  return text;
}

/// A description of extra bytes. @param options  8: scale, 16: offset, 1: no data
std::string description(int type, int options, const std::string& name, double no_data_bits = 0) {
  std::string bytes(192, '\0');
  bytes[2] = static_cast<char>(type);
  bytes[3] = static_cast<char>(options);
  bytes.replace(4, 32, text_of(name, 32));
  bytes.replace(40, 8, bytes_of(static_cast<std::int64_t>(no_data_bits)));
  bytes.replace(112, 8, bytes_of(0.5));
  bytes.replace(136, 8, bytes_of(100.0));
  return bytes;
}

/// LAS 1.4 of two points in format 6, with extra bytes and their descriptions.
std::string las(const std::string& descriptions, const std::string& first, const std::string& second) {
  const std::string record = descriptions.empty()
                                 ? ""
                                 : std::string(2, '\0') + text_of("LASF_Spec", 16) + bytes_of(std::uint16_t{4}) +
                                       bytes_of(static_cast<std::uint16_t>(descriptions.size())) + text_of("", 32) +
                                       descriptions;
  std::string bytes(375, '\0');
  const auto put = [&](std::size_t at, const std::string& value) { bytes.replace(at, value.size(), value); };
  put(0, "LASF"), put(24, std::string("\x01\x04", 2)), put(94, bytes_of(std::uint16_t{375}));
  put(96, bytes_of(static_cast<std::uint32_t>(375 + record.size())));
  put(100, bytes_of(std::uint32_t{descriptions.empty() ? 0u : 1u}));
  put(104, "\x06"), put(105, bytes_of(static_cast<std::uint16_t>(30 + first.size())));
  for (std::size_t c = 0; c < 3; ++c) put(131 + 8 * c, bytes_of(1.0));
  put(247, bytes_of(std::uint64_t{2}));
  for (int p = 0; p < 2; ++p) {
    if (p == 0) bytes += record;
    for (int c = 1; c <= 3; ++c) bytes += bytes_of(std::int32_t{3 * p + c});
    bytes += std::string(18, '\0') + (p == 0 ? first : second);
  }
  return bytes;
}

TEST_F(Dialects, Las) {
  const std::string first = bytes_of(std::int16_t{4}) + bytes_of(2.5f),
                    second = bytes_of(std::int16_t{-1}) + bytes_of(0.f);
  const std::string both = description(4, 8 | 16 | 1, "Reflectance", -1) + description(9, 0, "Deviation");
  const std::vector<std::string> plain = {"intensity", "classification"};
  expect_all({
      {"a.las", las("", "", ""), two_points, {}, plain},
      {"a.las", las("", "abc", "def"), two_points, {}, plain, {"bytes_ignored 3"}},
      {"a.las", las(both, first, second), two_points, {}, {"intensity", "classification", "Reflectance", "Deviation"}},
      {"a.las",
       las(both, first.substr(0, 3), second.substr(0, 3)),
       two_points,
       {},
       {"intensity", "classification", "Reflectance"},
       {"bytes_ignored 1"}},
      {"a.las", las(description(23, 0, "echo"), "abc", "def"), two_points, {}, plain, {"bytes_ignored 3"}},
      {"a.las",
       las(description(21, 0, "echo"), "abc", "def"),
       two_points,
       {},
       {"intensity", "classification", "echo_0", "echo_1", "echo_2"}},
      {"a.las", las(description(0, 3, "raw"), "abc", "def"), two_points, {}, plain},
      {"a.las",
       las(description(8, 0, "stamp"), bytes_of(std::int64_t{7}), bytes_of(std::int64_t{1} << 60)),
       two_points,
       {},
       plain,
       {"element_ignored stamp"}},
  });
  const Geometry g = read_bytes("a.las", las(both, first, second));
  EXPECT_EQ(g.properties[2].values[0], 102);  // 4 * 0.5 + 100
  EXPECT_TRUE(std::isnan(g.properties[2].values[1]));
  EXPECT_EQ(g.properties[3].values, (std::vector<double>{2.5, 0}));
}

// ---- VTK ----

/// The text with the line ends of old Macintosh systems.
std::string with_returns(std::string text) {
  std::ranges::replace(text, '\n', '\r');
  return text;
}

TEST_F(Dialects, Vtk) {
  const std::string head = "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\n";
  const std::string points = "POINTS 4 float\n0 0 0 1 0 0 0 1 0 1 1 0\n";
  const std::vector<Vec3> square = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  const std::vector<Index> strip = {0, 1, 2, 2, 1, 3};
  std::string binary = "# vtk DataFile Version 3.0\nt\nBINARY\nDATASET POLYDATA\nPOINTS 4 double\n";
  for (const Vec3& p : square)
    for (const double x : p) binary += bytes_of(x, std::endian::big);
  binary += "\nTRIANGLE_STRIPS 1 5\n";
  for (const int corner : {4, 0, 1, 2, 3}) binary += bytes_of(corner, std::endian::big);
  expect_all({
      {"a.vtk", head + points + "TRIANGLE_STRIPS 1 5\n4 0 1 2 3\n", square, strip},
      {"a.vtk", binary, square, strip},
      {"a.vtk",
       head + "$ by hand\n" + points + "EDGE_FLAGS\n1 1\n1 1\nTRIANGLE_STRIPS 1 5\n4 0 1 2 3\n",
       square,
       strip,
       {},
       {"lines_skipped 4 5 '$ by hand'"}},
      {"a.vtk", with_returns(head + points + "TRIANGLE_STRIPS 1 5\n4 0 1 2 3\n"), square, strip},
      {"a.vtk", head + points + "7 8\n", {}, {}, {}, {}, "'7' is not a VTK keyword"},
      {"a.vtk", binary + "\nEDGE_FLAGS", {}, {}, {}, {}, "'EDGE_FLAGS'"},
  });
}

// ---- glTF ----

using Json = nlohmann::json;

/// Two triangles that share no vertex, each a primitive: positions and indices interleaved in views with a stride.
Json scene() {
  return Json::parse(R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
    "nodes": [{"children": [1], "translation": [10, 0, 0]}, {"mesh": 0, "scale": [2, 2, 2]}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}},
                               {"attributes": {"POSITION": 2}}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
                  {"bufferView": 0, "byteOffset": 12, "componentType": 5126, "count": 3, "type": "VEC3"},
                  {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                   "sparse": {"count": 1, "indices": {"bufferView": 1, "componentType": 5121},
                              "values": {"bufferView": 2}}}],
    "bufferViews": [{"buffer": 0, "byteLength": 72, "byteStride": 24}, {"buffer": 0, "byteOffset": 72, "byteLength": 4},
                    {"buffer": 0, "byteOffset": 76, "byteLength": 12}],
    "buffers": [{"byteLength": 88}]})");
}

std::string scene_bytes() {
  std::string bytes;
  for (const Vec3& p : triangle) {
    for (const double x : p) bytes += bytes_of(static_cast<float>(x));
    for (const float x : {0.f, 0.f, 1.f}) bytes += bytes_of(x);
  }
  bytes += std::string("\x02\0\0\0", 4);  // the sparse accessor moves its last vertex
  for (const float x : {0.f, -1.f, 0.f}) bytes += bytes_of(x);
  return bytes;
}

std::string glb(const Json& json) {
  std::string text = json.dump(), binary = scene_bytes();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const auto size = static_cast<std::uint32_t>(text.size()), all = static_cast<std::uint32_t>(binary.size());
  return "glTF" + bytes_of(std::uint32_t{2}) + bytes_of(28 + size + all) + bytes_of(size) + "JSON" + text +
         bytes_of(all) + std::string("BIN\0", 4) + binary;
}

/// The scene with a value changed.
Json with(const char* where, const Json& value) {
  Json json = scene();
  json[Json::json_pointer(where)] = value;
  return json;
}

TEST_F(Dialects, Gltf) {
  const std::vector<Vec3> points = {{10, 0, 0}, {12, 0, 0}, {10, 2, 0}, {10, -2, 0}};
  const std::vector<Index> faces = {0, 1, 2, 0, 1, 3};
  Json zeros = with("/accessors/2/bufferView", 0);
  zeros["accessors"][2].erase("bufferView");
  Json packed = with("/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression", Json{{"bufferView", 0}});
  Json only_packed = packed;
  only_packed["accessors"][0].erase("bufferView");
  Json placed = with("/nodes/1/scale", {-2, 2, 2});  // a mirror turns the faces
  expect_all({
      {"a.glb", glb(scene()), points, faces},
      {"a.glb", glb(zeros), {{10, 0, 0}, {12, 0, 0}, {10, 2, 0}, {10, -2, 0}}, {0, 1, 2, 0, 0, 3}},
      {"a.glb", glb(placed), {{10, 0, 0}, {8, 0, 0}, {10, 2, 0}, {10, -2, 0}}, {0, 2, 1, 0, 3, 1}},
      {"a.glb", glb(with("/nodes/1", {{"mesh", 0}, {"matrix", {2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1}}})),
       points, faces},
      {"a.glb", glb(packed), points, faces},
      {"a.glb", glb(only_packed), {}, {}, {}, {}, "compressed (Draco)"},
      {"a.glb", glb(with("/extensionsRequired", {"KHR_draco_mesh_compression"})), {}, {}, {}, {}, "compressed (Draco)"},
      {"a.glb",
       glb(with("/extensionsUsed", {"EXT_mesh_gpu_instancing"})),
       points,
       faces,
       {},
       {"element_ignored EXT_mesh_gpu_instancing"}},
      {"a.glb", glb(with("/accessors/2/sparse/count", 2)), {}, {}, {}, {}, "accessor 2 (sparse)"},
      {"a.glb", glb(with("/accessors/2/count", 2)), {}, {}, {}, {}, "(sparse) changes element 2 of 2"},
      {"a.glb", glb(with("/accessors/2/sparse", {{"count", 1}})), {}, {}, {}, {}, "(sparse) has no indices"},
      {"a.glb", glb(with("/bufferViews/0/buffer", 1)), {}, {}, {}, {}, "no entry 1 in 'buffers'"},
  });
}

TEST_F(Dialects, GltfFromWindows) {
  std::filesystem::create_directory(path("parts"));
  make("parts/a b.bin", scene_bytes());
  make("here.bin", scene_bytes());
  for (const char* uri : {"parts\\\\a%20b.bin", "parts/a b.bin", "C:\\\\models\\\\here.bin", "c:/models/here.bin"}) {
    const std::string text = with("/buffers/0/uri", "URI").dump();
    const std::size_t at = text.find("URI");
    const Geometry g = read_bytes("w.gltf", text.substr(0, at) + uri + text.substr(at + 3));
    EXPECT_EQ(g.points.size(), 4u) << uri;
  }
}

// ---- encodings ----

std::string utf16(const std::u16string& text, std::endian order) {
  std::string bytes = bytes_of(char16_t{0xFEFF}, order);
  for (const char16_t unit : text) bytes += bytes_of(unit, order);
  return bytes;
}

TEST_F(Dialects, Utf16) {
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    expect_all({
        {"a.xyz", utf16(u"1 2 3\r\n4 5 6\r\n", order), two_points},
        {"a.csv", utf16(u"x,y,z,h\u00f6he\r\n1,2,3,4\r\n4,5,6,5\r\n", order), two_points, {}, {"h__he"}},
        {"a.obj", utf16(u"# \U0001F600\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", order), triangle, corners},
        {"a.off", utf16(u"OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", order), triangle, corners},
        {"a.ply",
         utf16(u"ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
               u"property float z\nend_header\n1 2 3\n4 5 6\n",
               order),
         two_points},
        {"a.xyz", utf16(u"1 2 3\n", order) + "x", {}, {}, {}, {}, "within a character"},
    });
    const std::string error = find_streamed(make("a.xyz", utf16(u"1 2 3\n", order))).error;
    EXPECT_NE(error.find("UTF-16"), std::string::npos) << error;
  }
}

// ---- points block by block ----

TEST_F(Dialects, StreamsTheSamePoints) {
  std::string many = ply("binary_little_endian", "40000", seen, "", "");
  for (int k = 0; k < 40000; ++k)
    many += vertex_with_list<std::uint32_t>({double(k), 1, 2}, std::vector<std::uint32_t>(k % 7), std::endian::little);
  EXPECT_TRUE(expect_streamed_as_read(make("many.ply", many)));
  EXPECT_FALSE(expect_streamed_as_read(make("cut.ply", many.substr(0, many.size() - 1))));
  for (const char* text : {"# x y z height\n1 2 3 0.5\n", "Survey\nScan 12\n1 2 3\n", "$ a\n1 2 3\n; b\n4 5 6\n"})
    EXPECT_TRUE(expect_streamed_as_read(make("a.xyz", text))) << text;
  EXPECT_FALSE(expect_streamed_as_read(make("a.csv", "lat,lon,height\n1,2,3\n")));
  EXPECT_TRUE(expect_streamed_as_read(make("a.las", las(description(4, 0, "echo"), "ab", "cd"))));
#ifdef AHM_WITH_PCL
  const std::string padded = column({1, 4}) + "padded" + column({2, 5}) + column({3, 6});
  const std::string plain = column({1, 4}) + column({2, 5}) + column({3, 6});
  const std::string head = pcd("x _ y z", "4 1 4 4", "F U F F", "1 3 1 1", "", "binary_compressed");
  EXPECT_TRUE(expect_streamed_as_read(make("a.pcd", head + stored(padded, padded.size()))));
  EXPECT_TRUE(expect_streamed_as_read(make("b.pcd", head + stored(plain, plain.size()))));
#endif
}

}  // namespace
}  // namespace ahm::io::test::dialects
