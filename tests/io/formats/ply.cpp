#include "io/cases.hpp"
#include "io/files.hpp"

namespace ahm::io::test {
namespace ply_files {

const std::string xyz = "property double x\nproperty double y\nproperty double z\n";
const std::string faces = "element face 1\nproperty list uchar int vertex_indices\n";
const std::string triangle = "0 0 0\n1 0 0\n0 1 0\n", corners = "0 0 0, 1 0 0, 0 1 0";

std::string text_header(const std::string& vertices, const std::string& more = "") {
  return "ply\nformat ascii 1.0\nelement vertex " + vertices + "\n" + xyz + more + "end_header\n";
}

/// Three unsigned bytes per vertex.
std::string binary_header(const std::string& more = "", const std::string& vertices = "1") {
  return "ply\nformat binary_little_endian 1.0\nelement vertex " + vertices +
         "\nproperty uchar x\nproperty uchar y\nproperty uchar z\n" + more + "end_header\n";
}

std::string with_line_ends(const std::string& text, const std::string& end) {
  std::string result;
  for (const char c : text) result += c == '\n' ? end : std::string(1, c);
  return result;
}

/// A triangle with properties in any order, an element before the faces, and a quality per face.
std::string rich_binary(std::endian order) {
  std::string file =
      std::string("ply\nformat binary_") + (order == std::endian::big ? "big" : "little") +
      "_endian 1.0\ncomment x first is not the rule\nobj_info scanner\nelement vertex 3\nproperty uchar red\n"
      "property float nx\nproperty float ny\nproperty float nz\nproperty double z\nproperty short extra\n"
      "property double y\nproperty double x\nproperty uchar green\nproperty uchar blue\nelement strange 2\n"
      "property list ushort double things\nproperty int id\nelement face 1\nproperty float quality\n"
      "property list uint ushort vertex_index\nend_header\n";
  const auto add = [&](auto... values) { file += (bytes_of(values, order) + ...); };
  for (int i = 0; i < 3; ++i) {
    add(std::uint8_t{10}, 0.0f, 0.0f, 1.0f, 3.0 + i, std::int16_t{-7}, 2.0 + i, 1.0 + i);
    add(std::uint8_t{20}, std::uint8_t{30});
  }
  add(std::uint16_t{2}, 1.0, 2.0, std::int32_t{1}, std::uint16_t{0}, std::int32_t{2});
  add(0.5f, std::uint32_t{3}, std::uint16_t{2}, std::uint16_t{0}, std::uint16_t{1});
  return file;
}

void add_good(Cases& c) {
  for (const std::endian order : {std::endian::little, std::endian::big})
    c.good("rich.ply", rich_binary(order),
           "1 2 3, 2 3 4, 3 4 5; faces 2 0 1; normals 0 0 1, 0 0 1, 0 0 1; colors 10 20 30, 10 20 30, 10 20 30; "
           "extra -7 -7 -7; element_ignored strange",
           Cases::all);
  c.good("properties.ply",
         "ply\nformat ascii 1.0\nelement vertex 2\nproperty float intensity\nproperty float x\nproperty float y\n"
         "property float z\nproperty uchar scalar-field\nproperty uchar scalar_field\nend_header\n"
         "0.25 1 2 3 7 8\n0.5 4 5 6 9 10\n",
         "1 2 3, 4 5 6; intensity 0.25 0.5; scalar_field 7 9; scalar_field_2 8 10");
  c.good("polygons.ply",
         text_header("5", "element face 2\nproperty list uchar int vertex_indices\n") + triangle +
             "0 1 0\n2 2 0\n4 0 1 2 3\n3 4 1 0\n",
         corners + ", 0 1 0, 2 2 0; faces 0 1 2 3, 4 1 0");
  c.good("digits.ply",
         "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n"
         "431234.567 5412345.678 1e-310\n",
         "431234.567 5412345.678 1e-310");
  c.good("special.ply", text_header("1") + "nan inf -inf\n", "nan inf -inf");
  c.good("crlf.ply", with_line_ends(text_header("3", faces) + triangle + "3 0 1 2\n", "\r\n"),
         corners + "; faces 0 1 2");
  for (const char* end : {"\n", "\r\n", "\r"})  // the points look like line ends, too
    c.good("line_ends.ply", with_line_ends(binary_header(), end) + "\n\r\n", "10 13 10");
  c.good("ghosts.ply", text_header("1", "element ghost 9223372036854775807\n") + "1 2 3\n",
         "1 2 3; element_ignored ghost");
  c.good("camera.ply",
         "ply\nformat ascii 1.0\nelement camera 1\nproperty list uchar int of\nelement vertex 1\n" + xyz +
             "element more 2\nproperty int a\nend_header\n3 1 2 3\n1 2 3\n7\n8\nand more\n",
         "1 2 3; element_ignored camera; element_ignored more; data_after_elements");
  c.good("none.ply", text_header("0"), "");
  c.good("more.ply", text_header("1") + "1 2 3\n4 5 6\n", "1 2 3; data_after_elements");
  c.good("strips.ply",
         text_header("5", "element tristrips 1\nproperty list int int vertex_indices\n") + triangle +
             "1 1 0\n2 2 0\n8 0 1 2 3 -1 2 3 4\n",
         corners + ", 1 1 0, 2 2 0; faces 0 1 2, 1 3 2, 2 3 4");
  c.good("upper.ply",
         "ply\nformat ascii 1.0\nelement vertex 1\nproperty float X\nproperty float Y\nproperty float Z\nend_header\n1 "
         "2 3\n",
         "1 2 3");
  const auto colored = [&](const std::string& type, const std::string& values, const std::string& contents) {
    const std::string p = "property " + type + " ";
    c.good("colors.ply", text_header("1", p + "red\n" + p + "green\n" + p + "blue\n") + "1 2 3 " + values + "\n",
           "1 2 3; " + contents);
  };
  colored("float", "1 0.5 0", "colors 255 128 0"), colored("float", "255 7 0", "colors 255 7 0");
  colored("int", "255 7 0", "colors 255 7 0"), colored("ushort", "65535 257 0", "colors 255 1 0");
  colored("uchar", "1 1 0", "colors 1 1 0");
  for (const char* values : {"-1 0 0", "0.5 2 0", "70000 1 1", "nan 0 0"}) colored("float", values, "colors_unknown");
  c.good("level.ply", text_header("1", "property uchar red\n") + "1 2 3 256\n", "1 2 3; red 256");
  c.good("ignored.ply", text_header("1", "element more 1\nproperty int a\n") + "1 2 3\nx\n",
         "1 2 3; element_ignored more");
  // Lines without meaning are ignored where they cannot shift values.
  std::string text = text_header("1", "TextureFile a.png\n") + "1 2 3\n";
  c.good("lines.ply", text.insert(4, "made by hand\n"), "1 2 3; lines_skipped 2 2 'made by hand'");
  c.good("line.ply", std::string(binary_header()).insert(4, "made by hand\n") + "abc",
         "97 98 99; lines_skipped 1 2 'made by hand'");
}

void add_bad_headers(Cases& c) {
  const std::string head = "ply\nformat ascii 1.0\nelement vertex 1\n";
  c.bad("misspelt.ply", binary_header("proprty uchar red\n") + "abcd", {"line 7", "proprty"});
  c.bad("misspelt.ply", text_header("1", "proprty uchar red\n") + "1 2 3 4\n", {"line 9", "more values"});
  for (const std::string count : {"4", "4294967295", "9223372036854775807"}) {
    c.bad("count.ply", text_header(count) + triangle, {"line 3", count});
    c.bad("count.ply", binary_header("", count) + "bytes", {"line 3", count, "5"});
  }
  for (const std::string count : {"99999999999999999999", "-3"})
    c.bad("count.ply", text_header(count), {"line 3", count});
  c.bad("faces.ply", text_header("3", "element face 999999999\nproperty list uchar int vertex_indices\n") + triangle,
        {"line 7", "999999999"});
  c.bad("cut.ply", text_header("3").substr(0, 60), {"end_header"});
  c.bad("list.ply",
        head + "property list uchar double x\nproperty double y\nproperty double z\nend_header\n1 0 0 0 0\n",
        {"x", "list"});
  c.good("list.ply", head + "property list uchar double things\n" + xyz + "end_header\n1 0 0 0 0\n",
         "0 0 0; list_ignored things");
  c.bad("missing.ply", head + "property float x\nproperty float z\nend_header\n1 2\n", {"'y'"});
  c.bad("twice.ply", head + xyz + "property float x\nend_header\n1 2 3 4\n", {"'x'", "twice"});
  c.bad("upper.ply", head + xyz + "property float X\nend_header\n1 2 3 4\n", {"twice"});
  c.bad("none.ply", head + "end_header\n1 2\n", {"'x'"});
  c.bad("no_vertex.ply", "ply\nformat ascii 1.0\nend_header\n", {"no element 'vertex'"});
  c.bad("point.ply", "ply\nformat ascii 1.0\nelement point 1\n" + xyz + "end_header\n1 2 3\n", {"no element 'vertex'"});
  c.bad("level.ply",
        text_header("1", "property uchar red\nproperty uchar green\nproperty uchar blue\n") + "1 2 3 256 4 5\n",
        {"256"});
  c.bad("plx.ply", "plx\n", {"line 1"});
  c.bad("format.ply", "ply\nelement vertex 0\n" + xyz + "end_header\n", {"format"});
  c.bad("property.ply", "ply\nformat ascii 1.0\nproperty float x\nend_header\n", {"line 3"});
  c.bad("type.ply", head + "property int65 x\nend_header\n", {"line 4", "int65"});
  c.bad("utf8.ply", "ply\nformat utf8 1.0\nend_header\n", {"line 2", "utf8"});
  c.bad("vertices.ply", text_header("1", "element vertex 1\nproperty float x\n"), {"twice"});
  const std::string face = "element face 1\nproperty ";
  c.good("float.ply", text_header("1", face + "list float int vertex_indices\n") + "0 0 0\n1 0\n", "0 0 0; faces 0");
  c.good("index.ply", text_header("1", face + "list uchar float vertex_indices\n") + "0 0 0\n1 0\n", "0 0 0; faces 0");
  c.bad("flags.ply", text_header("1", face + "uchar flags\n") + "0 0 0\n1\n", {"vertex_indices"});
}

void add_bad_data(Cases& c) {
  c.bad("cut.ply", text_header("3", faces) + triangle + "3 0 ", {"line 13", "face 0"});
  c.bad("cut.ply", text_header("4") + "0 0 0 \n1 0 0 \n0 1 0 \n1 1\n", {"line 11", "vertex 3"});
  c.bad("cut.ply", text_header("2") + "0.0 0.0 0.0\n", {"vertex 1 of 2"});
  std::string binary = rich_binary(std::endian::little);
  binary.pop_back();
  c.bad("cut.ply", binary, {"byte", "face 0"});
  c.bad("long.ply", text_header("3") + "0 0 0\n1 0 0 7\n0 1 0\n", {"line 9", "vertex 1"});
  c.bad("corners.ply", text_header("3", faces) + triangle + "200 0 1 2\n", {"line 13", "200"});
  c.bad("corners.ply", binary_header("element face 1\nproperty list uint int vertex_indices\n") + "xyz\xff\xff\xff\xff",
        {"4294967295"});
  c.bad("corners.ply", binary_header("element face 1\nproperty list char int vertex_indices\n") + "xyz\xff", {"-1"});
  for (const char* index : {"3", "-1", "2147483648", "4294967295"})
    c.bad("index.ply", text_header("3", faces) + triangle + "3 0 1 " + index + "\n", {"face 0", index});
  c.bad("index.ply", text_header("3", faces) + triangle + "3 0 1 1.5\n", {"1.5"});
  c.bad("strip.ply",
        text_header("3", "element tristrips 1\nproperty list int int vertex_indices\n") + triangle + "3 0 1 -2\n",
        {"-2"});
  for (const char* word : {"1,5", "1e400", "1.#IND", "0x10", "one", "1.5f", "--1"})
    c.bad("number.ply", text_header("1") + "0 0 " + word + "\n", {"line 8", word});
}

}  // namespace ply_files

Cases ply_cases() {
  using namespace ply_files;
  Cases c;
  add_good(c), add_bad_headers(c), add_bad_data(c);
  return c;
}

}  // namespace ahm::io::test
