// VTK's polygonal data, XML and legacy: every way in which arrays are stored reads alike, and what was written reads back.
#include <charconv>
#include <cmath>

#include "ahm/io/write.hpp"
#include "files.hpp"
#include "table.hpp"

namespace ahm::io::test {
namespace {

using ReadVtp = Files;
using ReadVtk = Files;

std::string base64(std::string_view bytes) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (at + k < bytes.size() ? static_cast<unsigned char>(bytes[at + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += at + k > bytes.size() ? '=' : digits[bits >> (18 - 6 * k) & 63u];
  }
  return text;
}

/// A square of two triangles, or a quad, with an array of every kind, stored in a given way.
struct Square {
  std::string format = "ascii";  ///< or binary, appended
  bool base64_appended = false, wide = false, compressed = false, separate_header = false;
  std::endian order = std::endian::little;

  std::vector<double> x = {0, 0, 0.1, 1, 0, 0.2, 1, 1, 0.3, 0, 1, 1.0 / 3.0};
  std::vector<double> flow = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
  std::vector<std::uint8_t> colors = {255, 0, 0, 0, 255, 0, 0, 0, 255, 9, 9, 9};
  std::vector<std::int32_t> corners = {0, 1, 2, 0, 2, 3};
  std::vector<std::int64_t> ends = {3, 6};

  std::string appended = {};

  std::string length(std::uint64_t count) const {
    return wide ? bytes_of(count, order) : bytes_of(static_cast<std::uint32_t>(count), order);
  }

  /// Stored blocks of zlib's format, which need no compressor: header, blocks as they are, Adler's sum.
  static std::string stored(std::string_view bytes) {
    std::uint32_t a = 1, b = 0;
    for (const char c : bytes) a = (a + static_cast<unsigned char>(c)) % 65521, b = (b + a) % 65521;
    const auto size = static_cast<std::uint16_t>(bytes.size());
    return std::string("\x78\x01\x01", 3) + bytes_of(size) + bytes_of(static_cast<std::uint16_t>(~size)) +
           std::string(bytes) + bytes_of(b << 16 | a, std::endian::big);
  }

  std::pair<std::string, std::string> packed(std::string_view raw) const {
    if (!compressed) return {length(raw.size()), std::string(raw)};
    constexpr std::size_t block = 32;
    std::string sizes, data;
    std::size_t blocks = 0;
    for (std::size_t at = 0; at < raw.size(); at += block, ++blocks) {
      const std::string part = stored(raw.substr(at, block));
      sizes += length(part.size()), data += part;
    }
    return {length(blocks) + length(block) + length(raw.size() % block) + sizes, data};
  }

  template <class T>
  std::string array(const std::string& type, const std::string& name, std::size_t width, const std::vector<T>& values) {
    std::string head = "<DataArray type=\"" + type + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
                       std::to_string(width) + "\" format=\"" + format + "\"";
    if (format == "ascii") {
      std::string text;
      for (const T value : values) {
        std::array<char, 32> digits;
        text += std::string(digits.data(), std::to_chars(digits.data(), digits.data() + 32, value).ptr) + "\n ";
      }
      return head + ">" + text + "</DataArray>";
    }
    std::string raw;
    for (const T value : values) raw += bytes_of(value, order);
    const auto [header, data] = packed(raw);
    const bool encoded = format == "binary" || base64_appended;
    const std::string all = !encoded                        ? header + data
                            : compressed || separate_header ? base64(header) + base64(data)
                                                            : base64(header + data);
    if (format == "binary") return head + ">\n  " + all + "\n</DataArray>";
    head += " offset=\"" + std::to_string(appended.size()) + "\"/>";
    appended += all;
    return head;
  }

  std::string file() {
    std::string text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"";
    text += order == std::endian::little ? "LittleEndian\"" : "BigEndian\"";
    if (wide) text += " header_type=\"UInt64\"";
    if (compressed) text += " compressor=\"vtkZLibDataCompressor\"";
    text += "><PolyData><Piece NumberOfPoints=\"4\" NumberOfPolys=\"2\"><PointData>";
    text += array("Float64", "flow", 3, flow) + array("UInt8", "RGB", 3, colors) +
            array("Int64", "id", 1, std::vector<std::int64_t>{40, 41, 42, 43}) + "</PointData>";
    text += "<Points>" + array("Float64", "Points", 3, x) + "</Points><Polys>";
    text += array("Int32", "connectivity", 1, corners) + array("Int64", "offsets", 1, ends);
    text += "</Polys></Piece></PolyData>";
    if (!appended.empty())
      text += std::string("<AppendedData encoding=\"") + (base64_appended ? "base64" : "raw") + "\">\n _" + appended +
              "\n</AppendedData>";
    return text + "</VTKFile>\n";
  }
};

void expect_square(const Geometry& g) {
  EXPECT_EQ(g.points, (std::vector<Vec3>{{0, 0, 0.1}, {1, 0, 0.2}, {1, 1, 0.3}, {0, 1, 1.0 / 3.0}}));
  EXPECT_EQ(g.face_begin, (std::vector<Offset>{0, 3, 6}));
  EXPECT_EQ(g.face_vertices, (std::vector<Index>{0, 1, 2, 0, 2, 3}));
  ASSERT_EQ(g.colors.size(), 4u);
  EXPECT_EQ(g.colors[1], (std::array<std::uint8_t, 3>{0, 255, 0}));
  ASSERT_EQ(g.properties.size(), 4u);
  EXPECT_EQ(g.properties[1].name, "flowy");
  EXPECT_EQ(g.properties[1].values, (std::vector<double>{2, 5, 8, 11}));
  EXPECT_EQ(g.properties[3].name, "id");
  EXPECT_EQ(g.properties[3].values, (std::vector<double>{40, 41, 42, 43}));
  EXPECT_TRUE(g.warnings.empty());
}

std::vector<Square> every_storage() {
  std::vector<Square> all = {{}};
  for (const std::endian order : {std::endian::little, std::endian::big})
    for (const bool wide : {false, true})
      for (const bool second : {false, true}) {
        all.push_back({.format = "binary", .wide = wide, .separate_header = second, .order = order});
        all.push_back({.format = "appended", .base64_appended = second, .wide = wide, .order = order});
#ifdef AHM_WITH_ZLIB
        all.push_back({.format = "binary", .wide = wide, .compressed = true, .order = order});
        all.push_back(
            {.format = "appended", .base64_appended = second, .wide = wide, .compressed = true, .order = order});
#endif
      }
  return all;
}

TEST_F(ReadVtp, ReadsEveryStorageAlike) {
  for (Square& square : every_storage()) {
    SCOPED_TRACE(square.format + (square.compressed ? " compressed" : ""));
    expect_square(read_bytes("s.vtp", square.file()));
  }
}

TEST_F(ReadVtp, ReadsWhatIsWrittenBitByBit) {
  const Result result;
  write(path("a.vtp"), result.table());
  const Geometry g = read(path("a.vtp"));
  ASSERT_NO_FATAL_FAILURE(expect_geometry_of(result, g));
  ASSERT_EQ(g.properties.size(), 5u);
  const std::vector<double>* columns[] = {&result.u, &result.v, &result.distance, &result.angle};
  const char* names[] = {"u", "v", "distance", "angle"};
  for (std::size_t c = 0; c < 4; ++c) {
    EXPECT_EQ(g.properties[c].name, names[c]);
    for (std::size_t i = 0; i < 4; ++i)
      EXPECT_EQ(std::bit_cast<std::uint64_t>(g.properties[c].values[i]),
                std::bit_cast<std::uint64_t>((*columns[c])[i]));
  }
  EXPECT_EQ(g.properties[4].values, (std::vector<double>{0, 0, static_cast<double>(Status::removed), 1}));
}

TEST_F(ReadVtp, RefusesEveryTruncation) {
  for (Square& square : every_storage()) {
    const std::string whole = square.file();
    const std::size_t needed = square.format == "appended" ? whole.find("\n</AppendedData") : whole.find("</VTKFile");
    constexpr std::size_t step = 41;
    for (std::size_t size = needed - 1; size > step; size -= step)
      EXPECT_THROW(read_bytes("t.vtp", whole.substr(0, size)), IoError) << square.format << " " << size;
  }
}

TEST_F(ReadVtp, RefusesByNameWhatItCannotTrust) {
  const std::string whole = Square{}.file();
  const auto with = [&](const std::string& old, const std::string& replacement) {
    std::string changed = whole;
    const std::size_t at = changed.find(old);
    EXPECT_NE(at, std::string::npos) << old;
    return changed.replace(at, old.size(), replacement);
  };
  expect_refused("a.vtp", with("PolyData", "ImageData"), {"'ImageData'", "PolyData"});
  expect_refused("a.vtp", with("NumberOfPoints=\"4\"", "NumberOfPoints=\"5\""), {"points", "12 numbers", "each of 5"});
  expect_refused("a.vtp", with("NumberOfPoints=\"4\"", "NumberOfPoints=\"x\""), {"NumberOfPoints", "'x'"});
  expect_refused("a.vtp", with("NumberOfPoints=\"4\"", "NumberOfPoints=\"9999999999\""), {"9999999999 vertices"});
  expect_refused("a.vtp", with("NumberOfPolys=\"2\"", "NumberOfPolys=\"3\""), {"offsets of Polys", "2 numbers"});
  expect_refused("a.vtp", with(">0\n 0\n 0.1", ">0\n 0\n 0,1"), {"points", "'0,1'", "decimals take a point"});
  expect_refused("a.vtp", with(">0\n 0\n 0.1", ">0\n 0\n 1e400"), {"points", "'1e400'"});
  expect_refused(
      "a.vtp", with("connectivity\" NumberOfComponents=\"1\" format=\"ascii\">0", "connectivity\" format=\"ascii\">9"),
      {"polygon 0", "vertex number 9", "4 vertices"});
  expect_refused(
      "a.vtp", with("connectivity\" NumberOfComponents=\"1\" format=\"ascii\">0", "connectivity\" format=\"ascii\">-1"),
      {"vertex number -1"});
  expect_refused(
      "a.vtp",
      with("connectivity\" NumberOfComponents=\"1\" format=\"ascii\">0", "connectivity\" format=\"ascii\">0.5"),
      {"connectivity", "'0.5'"});
  expect_refused("a.vtp", with(">3\n 6", ">3\n 7"), {"polygon 1", "corner 7 of 6"});
  expect_refused("a.vtp", with(">3\n 6", ">6\n 3"), {"polygon 1"});
  expect_refused("a.vtp", with("Name=\"connectivity\"", "Name=\"other\""), {"connectivity of Polys is missing"});
  expect_refused("a.vtp", with("format=\"ascii\"", "format=\"ebcdic\""), {"'ebcdic'"});
  expect_refused("a.vtp", with("LittleEndian", "Middle"), {"'Middle'"});
  Square packed{.format = "binary", .compressed = true};
  std::string foreign = packed.file();
  foreign.replace(foreign.find("vtkZLib"), 7, "vtkLZ4_");
  expect_refused("z.vtp", foreign, {"'vtkLZ4_DataCompressor'"});
  expect_refused("u.vtu", whole, {".vtu", "save its surface as .vtp"});
  expect_refused("e.vtp", "<VTKFile type=\"PolyData\"><PolyData/></VTKFile>", {"no vertex"});
  expect_refused("e.vtp", "<VTKFile type=\"PolyData\"><PolyData></VTKFile>", {"not valid XML", "byte"});
}

TEST_F(ReadVtp, JoinsPiecesAndIgnoresWhatNotAllOfThemHave) {
  std::string text = Square{}.file();
  const std::size_t begin = text.find("<Piece"), end = text.find("</PolyData>");
  std::string piece = text.substr(begin, end - begin);
  piece.replace(piece.find("\"flow\""), 6, "\"wind\"");
  const Geometry g = read_bytes("p.vtp", text.insert(end, piece + "<Piece NumberOfPoints=\"0\"/>"));
  ASSERT_EQ(g.points.size(), 8u);
  EXPECT_EQ(g.face_vertices, (std::vector<Index>{0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7}));
  EXPECT_EQ(g.colors.size(), 8u);
  ASSERT_EQ(g.properties.size(), 1u);
  EXPECT_EQ(g.properties[0].values, (std::vector<double>{40, 41, 42, 43, 40, 41, 42, 43}));
  ASSERT_EQ(g.warnings.size(), 2u);
  EXPECT_EQ(g.warnings[0].name, "flow");
  EXPECT_EQ(g.warnings[1].name, "wind");
}

TEST_F(ReadVtp, KeepsNoWholeNumbersThatNoDoubleHolds) {
  std::string text = Square{}.file();
  text.replace(text.find(">40\n 41"), 7, ">9007199254740993\n 41");
  const Geometry g = read_bytes("i.vtp", text);
  EXPECT_EQ(g.properties.size(), 3u);
  ASSERT_EQ(g.warnings.size(), 1u);
  EXPECT_EQ(g.warnings[0].name, "id");
}

/// The square in a legacy file, from version 5 on with offsets.
std::string legacy(bool binary, bool offsets) {
  const auto be = [&](auto value) { return bytes_of(value, std::endian::big); };
  std::string text = std::string("# vtk DataFile Version ") + (offsets ? "5.1" : "3.0") + "\na title\n" +
                     (binary ? "BINARY" : "ASCII") + "\nDATASET POLYDATA\nPOINTS 4 double\n";
  const Square square;
  const auto add = [&](const auto& values) {
    for (const auto value : values) {
      std::array<char, 32> digits;
      text += binary ? be(value)
                     : std::string(digits.data(), std::to_chars(digits.data(), digits.data() + 32, value).ptr) + " ";
    }
    text += "\n";
  };
  add(square.x);
  text += "METADATA\nINFORMATION 0\n\n";
  if (offsets) {
    text += "POLYGONS 3 6\nOFFSETS vtktypeint64\n";
    add(std::vector<std::int64_t>{0, 3, 6});
    text += "CONNECTIVITY vtktypeint64\n";
    add(std::vector<std::int64_t>{0, 1, 2, 0, 2, 3});
  } else {
    text += "POLYGONS 2 8\n";
    add(std::vector<std::int32_t>{3, 0, 1, 2, 3, 0, 2, 3});
  }
  text += "CELL_DATA 2\nSCALARS cell int\nLOOKUP_TABLE default\n";
  add(std::vector<std::int32_t>{7, 8});
  text += "POINT_DATA 4\nVECTORS flow double\n";
  add(square.flow);
  text += "COLOR_SCALARS shade 3\n";
  if (binary) add(square.colors);
  if (!binary) add(std::vector<double>{1, 0, 0, 0, 1, 0, 0, 0, 1, 0.04, 0.04, 0.04});
  text += "FIELD FieldData 1\nid 1 4 int\n";
  add(std::vector<std::int32_t>{40, 41, 42, 43});
  return text;
}

TEST_F(ReadVtk, ReadsTextAndBinaryOfOldAndNewVersionsAlike) {
  for (const bool binary : {false, true})
    for (const bool offsets : {false, true}) {
      Geometry g = read_bytes("l.vtk", legacy(binary, offsets));
      ASSERT_EQ(g.warnings.size(), 1u);
      EXPECT_EQ(g.warnings[0].name, "CellData");
      g.warnings.clear();
      expect_square(g);
    }
}

TEST_F(ReadVtk, MakesTrianglesOfStripsThatAllLookTheSameWay) {
  const Geometry g = read_bytes("s.vtk",
                                "# vtk DataFile Version 2.0\nt\nASCII\nDATASET POLYDATA\nPOINTS 5 float\n"
                                "0 0 0 0 1 0 1 0 0 1 1 0 2 0 0\nTRIANGLE_STRIPS 1 6\n5 0 1 2 3 4\nLINES 1 3\n2 0 1\n");
  EXPECT_EQ(g.face_vertices, (std::vector<Index>{0, 1, 2, 2, 1, 3, 2, 3, 4}));
  ASSERT_EQ(g.warnings.size(), 1u);
  EXPECT_EQ(g.warnings[0].id, "lines_ignored");
}

TEST_F(ReadVtk, RefusesByNameWhatItCannotTrust) {
  const std::string head = "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\n";
  const std::string points = head + "POINTS 3 double\n0 0 0 1 0 0 0 1 0\n";
  expect_refused("a.vtk", "# vtk\n", {"byte 0", "DataFile"});
  expect_refused("a.vtk", "# vtk DataFile Version 9.0\nt\nASCII\n", {"'9.0'"});
  expect_refused("a.vtk", "# vtk DataFile Version 3.0\nt\nEBCDIC\n", {"'EBCDIC'"});
  expect_refused("a.vtk", "# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_GRID\n", {"'STRUCTURED_GRID'"});
  expect_refused("a.vtk", head, {"no vertex"});
  expect_refused("a.vtk", head + "POINTS 3000000000 double\n0 0 0", {"3000000000"});
  expect_refused("a.vtk", head + "POINTS 300 double\n0 0 0", {"300 times 3", "cut short"});
  expect_refused("a.vtk", head + "POINTS 1 double\n0 0 1,5", {"'1,5'", "decimals take a point"});
  expect_refused("a.vtk", head + "POINTS 1 double\n0 0 1e400", {"'1e400'"});
  expect_refused("a.vtk", head + "POINTS 1 bit\n0 0 1", {"'bit'"});
  expect_refused("a.vtk", points + "POINT_DATA 3\nCOLOR_SCALARS c 3\n1 0 0 0 1 0 0 0 1\nPOINTS 1 double\n0 0 0\n",
                 {"POINTS", "twice"});
  expect_refused("a.vtk", head + "POINT_DATA 0\nSCALARS s int\nPOINTS 1 double\n0 0 0\n",
                 {"POINT_DATA", "before POINTS"});
  expect_refused("a.vtk", points + "POLYGONS 1 4\n3 0 1 3\n", {"polygon 0", "vertex number 3", "3 vertices"});
  expect_refused("a.vtk", points + "POLYGONS 1 4\n4 0 1 2\n", {"cell 0 of 1"});
  expect_refused("a.vtk", points + "POLYGONS 1 4\n2 0 1 2\n", {"cells end before"});
  expect_refused("a.vtk", points + "POLYGONS 2 4\n3 0 1 2\n", {"cell 1 of 2"});
  expect_refused("a.vtk", points + "POINT_DATA 4\n", {"4 points", "3 points"});
  expect_refused("a.vtk", points + "POINT_DATA 3\nSCALARS s float\n1 2\n", {"'s'"});
}

TEST_F(ReadVtk, RefusesEveryTruncationWithinBinaryData) {
  for (const bool offsets : {false, true}) {
    const std::string whole = legacy(true, offsets);
    const std::pair<const char*, const char*> blocks[] = {
        {"POINTS", "\nMETADATA"}, {"VECTORS", "\nCOLOR_SCALARS"}, {"COLOR_SCALARS", "\nFIELD"}, {"FIELD", "\n"}};
    for (const auto& [first, behind] : blocks) {
      const std::size_t begin = whole.find(first) + 8, end = whole.rfind(behind);
      ASSERT_LT(begin, end);
      for (std::size_t size = begin; size < end; ++size)
        EXPECT_THROW(read_bytes("t.vtk", whole.substr(0, size)), IoError) << first << " " << size;
    }
  }
}

}  // namespace
}  // namespace ahm::io::test
