// VTK's XML PolyData: a header that says where every array stands, and the arrays there.
#include <cstring>
#include <regex>

#include "ahm/io/write.hpp"
#include "files.hpp"
#include "table.hpp"

namespace ahm::io::test {
namespace {

struct Vtp {
  std::string text;

  /// The bytes of the array of this name in this element, as the header says; the length stands before them.
  std::string bytes(const std::string& element, const std::string& name) const {
    const std::size_t begin = text.find("<" + element + ">"), end = text.find("</" + element + ">");
    const std::string part = text.substr(begin, end - begin);
    std::smatch found;
    EXPECT_TRUE(std::regex_search(part, found, std::regex("Name=\"" + name + "\"[^>]*offset=\"([0-9]+)\""))) << name;
    const std::size_t data = text.find("encoding=\"raw\">\n_") + 17;
    const std::size_t at = data + std::stoull(found[1]);
    std::uint64_t length = 0;
    std::memcpy(&length, text.data() + at, sizeof length);
    return text.substr(at + sizeof length, length);
  }
  template <class T>
  std::vector<T> array(const std::string& element, const std::string& name) const {
    const std::string raw = bytes(element, name);
    std::vector<T> values(raw.size() / sizeof(T));
    std::memcpy(values.data(), raw.data(), raw.size());
    return values;
  }
  std::size_t count(const std::string& what) const {
    std::smatch found;
    EXPECT_TRUE(std::regex_search(text, found, std::regex("NumberOf" + what + "=\"([0-9]+)\""))) << what;
    return std::stoull(found[1]);
  }
};

using WriteVtp = Files;

template <class T>
std::string bytes_of_all(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

TEST_F(WriteVtp, HoldsEveryColumnWithEveryBit) {
  const Result result;
  write(path("a.vtp"), result.table());
  const Vtp file{contents(path("a.vtp"))};
  EXPECT_EQ(file.bytes("Points", "Points"), bytes_of_all(result.points));
  EXPECT_EQ(file.bytes("PointData", "Normals"), bytes_of_all(result.normals));
  EXPECT_EQ(file.bytes("PointData", "u"), bytes_of_all(result.u));
  EXPECT_EQ(file.bytes("PointData", "distance"), bytes_of_all(result.distance));
  EXPECT_EQ(file.bytes("PointData", "status"), bytes_of_all(result.status));
  EXPECT_NE(file.text.find("<!-- status: 0 ok, 1 disconnected"), std::string::npos);
}

TEST_F(WriteVtp, HoldsFacesOrEdgesOrElseThePoints) {
  const Result result;
  Table table = result.table();
  write(path("a.vtp"), table);
  const Vtp faces{contents(path("a.vtp"))};
  EXPECT_EQ(faces.array<std::int32_t>("Polys", "connectivity"), result.face_vertices);
  EXPECT_EQ(faces.array<std::int64_t>("Polys", "offsets"), (std::vector<std::int64_t>{3, 7}));
  EXPECT_EQ(faces.count("Points"), 4u);
  EXPECT_EQ(faces.count("Polys"), 2u);
  EXPECT_EQ(faces.count("Verts"), 0u);
  table.faces = {};
  table.edges = {{0, 1}, {1, 3}};
  write(path("a.vtp"), table);
  const Vtp edges{contents(path("a.vtp"))};
  EXPECT_EQ(edges.array<std::int32_t>("Lines", "connectivity"), (std::vector<std::int32_t>{0, 1, 1, 3}));
  EXPECT_EQ(edges.array<std::int64_t>("Lines", "offsets"), (std::vector<std::int64_t>{2, 4}));
  table.edges.clear();
  write(path("a.vtp"), table);
  const Vtp points{contents(path("a.vtp"))};
  EXPECT_EQ(points.array<std::int32_t>("Verts", "connectivity"), (std::vector<std::int32_t>{0, 1, 2, 3}));
  EXPECT_EQ(points.count("Polys"), 0u);
}

TEST_F(WriteVtp, NeedsPositions) {
  const Result result;
  Table table;
  table.add("u", result.u);
  EXPECT_THROW(write(path("a.vtp"), table), InvalidArgument);
  EXPECT_EQ(files_left(), 0u);
}

}  // namespace
}  // namespace ahm::io::test
