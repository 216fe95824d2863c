#include "io/cases.hpp"
#include "io/files.hpp"

namespace ahm::io::test {
namespace stl_files {

std::string facet(const std::string& a, const std::string& b, const std::string& c) {
  return "facet normal 0 0 1\n outer loop\n  vertex " + a + "\n  vertex " + b + "\n  vertex " + c +
         "\n endloop\nendfacet\n";
}

/// A square of two triangles, and the number of triangles in the header.
std::string binary_stl(std::uint32_t count) {
  std::string bytes = "solid in name only" + std::string(62, ' ') + bytes_of(count);
  for (const auto& triangle : {std::array{0, 0, 0, 1, 0, 0, 1, 1, 0}, {0, 0, 0, 1, 1, 0, 0, 1, 0}}) {
    bytes += std::string(12, '\0');
    for (const int x : triangle) bytes += bytes_of(static_cast<float>(x));
    bytes += std::string(2, '\0');
  }
  return bytes;
}

}  // namespace stl_files

Cases stl_cases() {
  using namespace stl_files;
  const std::string square = "0 0 0, 1 0 0, 1 1 0, 0 1 0; faces 0 1 2, 0 2 3";
  const std::string text =
      "solid square\n" + facet("0 0 0", "1 0 0", "1 1 0") + facet("0 0 0", "1 1 0", "0 1 0") + "endsolid";
  std::string upper = text;
  std::ranges::transform(upper, upper.begin(), [](char c) { return c >= 'a' && c <= 'z' ? c - 32 : c; });
  Cases c;
  const std::size_t second = text.rfind(" normal");
  c.good("text.stl", text + " square\n", square, text.rfind("endfacet"), second);
  c.good("upper.stl", " \r\n" + upper, square);
  c.good("binary.STL", binary_stl(2), square, Cases::all);
  c.good("nan.stl", "solid\n" + facet("nan 0 0", "nan 0 0", "1 1 0") + "endsolid\n",
         "nan 0 0, nan 0 0, 1 1 0; faces 0 1 2");

  std::string bytes = binary_stl(4000000000u);
  bytes[0] = 'x';
  c.bad("count.stl", bytes, {"byte 80", "4000000000 triangles"});
  bytes = binary_stl(3);
  bytes[20] = '\0';
  c.bad("solid.stl", bytes, {"byte 80", "3 triangles"});
  const std::string beginning = "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n";
  c.bad("number.stl", beginning + "vertex 1,5 0 0\n", {"line 5", "1,5"});
  c.bad("corners.stl", beginning + "vertex 1 0 0\nendloop\nendfacet\nendsolid\n", {"line 7", "found 2"});
  c.bad("vertex.stl", "solid\nfacet normal 0 0 1\nvertex 0 0\n", {"line 3"});
  c.bad("word.stl", "solid\ntriangle\nendsolid\n", {"line 2", "triangle"});
  c.bad("none.stl", "solid\nendsolid\n", {"no triangles"});
  return c;
}

}  // namespace ahm::io::test
