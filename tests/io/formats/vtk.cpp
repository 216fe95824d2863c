// VTK's polygonal data, XML (.vtp) and legacy (.vtk).
#include <charconv>

#include "io/cases.hpp"
#include "io/files.hpp"

namespace ahm::io::test {
namespace vtk_files {

const std::vector<double> positions = {0, 0, 0.1, 1, 0, 0.2, 1, 1, 0.3, 0, 1, 1.0 / 3.0};
const std::vector<double> flow = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
const std::vector<std::uint8_t> colors = {255, 0, 0, 0, 255, 0, 0, 0, 255, 9, 9, 9};
const std::vector<std::int32_t> corners = {0, 1, 2, 0, 2, 3};

const std::string points = "0 0 0.1, 1 0 0.2, 1 1 0.3, 0 1 0.3333333333333333", mesh = points + "; faces 0 1 2, 0 2 3";
const std::string shades = "; colors 255 0 0, 0 255 0, 0 0 255, 9 9 9", ids = "; id 40 41 42 43";
const std::string flows = "; flowx 1 4 7 10; flowy 2 5 8 11; flowz 3 6 9 12";

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

template <class T>
std::string digits_of(T value) {
  std::array<char, 32> digits;
  return {digits.data(), std::to_chars(digits.begin(), digits.end(), value).ptr};
}

/// A .vtp file of two triangles, with arrays of several kinds that are stored in one of VTK's formats.
struct Square {
  std::string format = "ascii";  ///< or binary, appended
  bool base64_appended = false, wide = false, compressed = false, separate_header = false;
  std::endian order = std::endian::little;
  std::string appended = {};

  std::string length(std::uint64_t count) const {
    return wide ? bytes_of(count, order) : bytes_of(static_cast<std::uint32_t>(count), order);
  }

  /// A block in zlib's format that is stored, not compressed: header, bytes, Adler's sum.
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
    std::string text, raw;
    for (const T value : values) text += digits_of(value) + "\n ", raw += bytes_of(value, order);
    if (format == "ascii") return head + ">" + text + "</DataArray>";
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
    text += "><PolyData><Piece NumberOfPoints=\"4\" NumberOfPolys=\"2\"><PointData>" +
            array("Float64", "flow", 3, flow) + array("UInt8", "RGB", 3, colors) +
            array("Int64", "id", 1, std::vector<std::int64_t>{40, 41, 42, 43}) + "</PointData><Points>" +
            array("Float64", "Points", 3, positions) + "</Points><Polys>" + array("Int32", "connectivity", 1, corners) +
            array("Int64", "offsets", 1, std::vector<std::int64_t>{3, 6}) + "</Polys></Piece></PolyData>";
    if (!appended.empty())
      text += std::string("<AppendedData encoding=\"") + (base64_appended ? "base64" : "raw") + "\">\n _" + appended +
              "\n</AppendedData>";
    return text + "</VTKFile>\n";
  }
};

/// The ascii file with `old` replaced.
std::string square_with(const std::string& old, const std::string& replacement) {
  std::string text = Square{}.file();
  return text.replace(text.find(old), old.size(), replacement);
}

void add_vtp(Cases& c) {
  std::vector<Square> storages = {{}};
  for (const std::endian order : {std::endian::little, std::endian::big})
    for (const bool wide : {false, true})
      for (const bool second : {false, true}) {
        storages.push_back({.format = "binary", .wide = wide, .separate_header = second, .order = order});
        storages.push_back({.format = "appended", .base64_appended = second, .wide = wide, .order = order});
#ifdef AHM_WITH_ZLIB
        storages.push_back({.format = "binary", .wide = wide, .compressed = true, .order = order});
        storages.push_back(
            {.format = "appended", .base64_appended = second, .wide = wide, .compressed = true, .order = order});
#endif
      }
  for (Square& storage : storages) {
    const std::string file = storage.file();
    c.good(storage.format + (storage.compressed ? "_compressed.vtp" : ".vtp"), file, mesh + shades + flows + ids,
           file.find(storage.format == "appended" ? "\n</AppendedData" : "</VTKFile"));
  }
  std::string pieces = Square{}.file();
  const std::size_t begin = pieces.find("<Piece"), end = pieces.find("</PolyData>");
  std::string piece = pieces.substr(begin, end - begin);
  piece.replace(piece.find("\"flow\""), 6, "\"wind\"");
  c.good("pieces.vtp", pieces.insert(end, piece + "<Piece NumberOfPoints=\"0\"/>"),
         points + ", " + points + "; faces 0 1 2, 0 2 3, 4 5 6, 4 6 7" +
             "; colors 255 0 0, 0 255 0, 0 0 255, 9 9 9, 255 0 0, 0 255 0, 0 0 255, 9 9 9; id 40 41 42 43 40 41 42 43; "
             "element_ignored flow; element_ignored wind");
  c.good("no_double.vtp", square_with(">40\n 41", ">9007199254740993\n 41"),
         mesh + shades + flows + "; element_ignored id");

  const auto bad = [&](const std::string& old, const std::string& replacement, std::vector<std::string> parts) {
    c.bad("a.vtp", square_with(old, replacement), std::move(parts));
  };
  bad("PolyData", "ImageData", {"'ImageData'", "PolyData"});
  bad("NumberOfPoints=\"4\"", "NumberOfPoints=\"5\"", {"points", "12 numbers", "each of 5"});
  bad("NumberOfPoints=\"4\"", "NumberOfPoints=\"x\"", {"NumberOfPoints", "'x'"});
  bad("NumberOfPoints=\"4\"", "NumberOfPoints=\"9999999999\"", {"9999999999 vertices"});
  bad("NumberOfPolys=\"2\"", "NumberOfPolys=\"3\"", {"offsets of Polys", "2 numbers"});
  bad(">0\n 0\n 0.1", ">0\n 0\n 0,1", {"points", "'0,1'", "decimals take a point"});
  bad(">0\n 0\n 0.1", ">0\n 0\n 1e400", {"points", "'1e400'"});
  const std::string connectivity = "connectivity\" NumberOfComponents=\"1\" format=\"ascii\">";
  bad(connectivity + "0", connectivity + "9", {"polygon 0", "vertex number 9", "4 vertices"});
  bad(connectivity + "0", connectivity + "-1", {"vertex number -1"});
  bad(connectivity + "0", connectivity + "0.5", {"connectivity", "'0.5'"});
  bad(">3\n 6", ">3\n 7", {"polygon 1", "corner 7 of 6"});
  bad(">3\n 6", ">6\n 3", {"polygon 1"});
  bad("Name=\"connectivity\"", "Name=\"other\"", {"connectivity of Polys is missing"});
  bad("format=\"ascii\"", "format=\"ebcdic\"", {"'ebcdic'"});
  bad("LittleEndian", "Middle", {"'Middle'"});
  std::string foreign = Square{.format = "binary", .compressed = true}.file();
  c.bad("lz4.vtp", foreign.replace(foreign.find("vtkZLib"), 7, "vtkLZ4_"), {"'vtkLZ4_DataCompressor'"});
  c.bad("empty.vtp", "<VTKFile type=\"PolyData\"><PolyData/></VTKFile>", {"no vertex"});
  c.bad("xml.vtp", "<VTKFile type=\"PolyData\"><PolyData></VTKFile>", {"not valid XML", "byte"});
}

/// The square in a legacy file, since version 5 with offsets. A file that ends after one of its arrays is good, too.
void add_legacy(Cases& c, bool binary, bool offsets) {
  std::string text = std::string("# vtk DataFile Version ") + (offsets ? "5.1" : "3.0") + "\na title\n" +
                     (binary ? "BINARY" : "ASCII") + "\nDATASET POLYDATA\n";
  const auto add = [&](const std::string& head, const auto& values, const std::string& contents) {
    text += head + "\n";
    const std::size_t begin = text.size();
    for (const auto value : values) text += binary ? bytes_of(value, std::endian::big) : digits_of(value) + " ";
    if (!contents.empty()) c.good("legacy.vtk", text, contents, binary ? Cases::all : 0, begin);
    text += "\n";
  };
  add("POINTS 4 double", positions, points);
  text += "METADATA\nINFORMATION 0\n\n";
  if (offsets) {
    add("POLYGONS 3 6\nOFFSETS vtktypeint64", std::vector<std::int64_t>{0, 3, 6}, "");
    add("CONNECTIVITY vtktypeint64", std::vector<std::int64_t>{0, 1, 2, 0, 2, 3}, mesh);
  } else {
    add("POLYGONS 2 8", std::vector<std::int32_t>{3, 0, 1, 2, 3, 0, 2, 3}, mesh);
  }
  const std::string ignored = "; element_ignored CellData";
  add("CELL_DATA 2\nSCALARS cell int\nLOOKUP_TABLE default", std::vector<std::int32_t>{7, 8}, mesh + ignored);
  add("POINT_DATA 4\nVECTORS flow double", flow, mesh + flows + ignored);
  const std::vector<double> fractions{1, 0, 0, 0, 1, 0, 0, 0, 1, 0.036, 0.036, 0.036};
  if (binary) add("COLOR_SCALARS shade 3", colors, mesh + shades + flows + ignored);
  if (!binary) add("COLOR_SCALARS shade 3", fractions, mesh + shades + flows + ignored);
  add("FIELD FieldData 1\nid 1 4 int", std::vector<std::int32_t>{40, 41, 42, 43},
      mesh + shades + flows + ids + ignored);
}

void add_vtk(Cases& c) {
  for (const bool binary : {false, true})
    for (const bool offsets : {false, true}) add_legacy(c, binary, offsets);
  c.good("strips.vtk",
         "# vtk DataFile Version 2.0\nt\nASCII\nDATASET POLYDATA\nPOINTS 5 float\n0 0 0 0 1 0 1 0 0 1 1 0 2 0 0\n"
         "TRIANGLE_STRIPS 1 6\n5 0 1 2 3 4\nLINES 1 3\n2 0 1\n",
         "0 0 0, 0 1 0, 1 0 0, 1 1 0, 2 0 0; faces 0 1 2, 2 1 3, 2 3 4; lines_ignored 1");

  const std::string head = "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\n";
  const std::string three = head + "POINTS 3 double\n0 0 0 1 0 0 0 1 0\n";
  c.bad("a.vtk", "# vtk\n", {"byte 0", "DataFile"});
  c.bad("a.vtk", "# vtk DataFile Version 9.0\nt\nASCII\n", {"'9.0'"});
  c.bad("a.vtk", "# vtk DataFile Version 3.0\nt\nEBCDIC\n", {"'EBCDIC'"});
  c.bad("a.vtk", "# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_GRID\n", {"'STRUCTURED_GRID'"});
  c.bad("a.vtk", head, {"no vertex"});
  c.bad("a.vtk", head + "POINTS 3000000000 double\n0 0 0", {"3000000000"});
  c.bad("a.vtk", head + "POINTS 300 double\n0 0 0", {"300 times 3", "cut short"});
  c.bad("a.vtk", head + "POINTS 1 double\n0 0 1,5", {"'1,5'", "decimals take a point"});
  c.bad("a.vtk", head + "POINTS 1 double\n0 0 1e400", {"'1e400'"});
  c.bad("a.vtk", head + "POINTS 1 bit\n0 0 1", {"'bit'"});
  c.bad("a.vtk", three + "POINT_DATA 3\nCOLOR_SCALARS c 3\n1 0 0 0 1 0 0 0 1\nPOINTS 1 double\n0 0 0\n",
        {"POINTS", "twice"});
  c.bad("a.vtk", head + "POINT_DATA 0\nSCALARS s int\nPOINTS 1 double\n0 0 0\n", {"POINT_DATA", "before POINTS"});
  c.bad("a.vtk", three + "POLYGONS 1 4\n3 0 1 3\n", {"polygon 0", "vertex number 3", "3 vertices"});
  c.bad("a.vtk", three + "POLYGONS 1 4\n4 0 1 2\n", {"cell 0 of 1"});
  c.bad("a.vtk", three + "POLYGONS 1 4\n2 0 1 2\n", {"cells end before"});
  c.bad("a.vtk", three + "POLYGONS 2 4\n3 0 1 2\n", {"cell 1 of 2"});
  c.bad("a.vtk", three + "POINT_DATA 4\n", {"4 points", "3 points"});
  c.bad("a.vtk", three + "POINT_DATA 3\nSCALARS s float\n1 2\n", {"'s'"});
  c.good("a.vtk", three + "NONSENSE x\n", "0 0 0, 1 0 0, 0 1 0; lines_skipped 1 7 'NONSENSE x'");
}

}  // namespace vtk_files

Cases vtk_cases() {
  using namespace vtk_files;
  Cases c;
  add_vtp(c), add_vtk(c);
  return c;
}

}  // namespace ahm::io::test
