// No file, however damaged, does anything but be read or refused.
#include <random>

#include "ahm/io/formats.hpp"
#include "files.hpp"

namespace ahm::io::test {
namespace {

class ReadNoise : public Files {
 protected:
  /// Reads; what comes out obeys the laws of `Geometry`.
  void read_or_refuse(const std::string& name, std::string_view bytes) const {
    try {
      const Geometry g = read_bytes(name, bytes);
      EXPECT_TRUE(g.normals.empty() || g.normals.size() == g.points.size());
      EXPECT_TRUE(g.colors.empty() || g.colors.size() == g.points.size());
      for (const Property& property : g.properties) EXPECT_EQ(property.values.size(), g.points.size());
      for (std::size_t f = 0; f < g.face_count(); ++f)
        for (const Index vertex : g.face(f)) ASSERT_LT(static_cast<std::size_t>(vertex), g.points.size());
    } catch (const IoError&) {
    }
  }
  std::mt19937 random_{42};
};

TEST_F(ReadNoise, ReadsOrRefusesRandomBytesOfEveryType) {
  const std::string beginnings[] = {
      "",
      "ply\nformat binary_little_endian 1.0\n",
      "solid",
      "OFF\n",
      "LASF",
      "//X Y Z\n",
      "v ",
      "\x1f\x8b\x08",
      "# vtk DataFile Version 3.0\nt\nBINARY\nDATASET POLYDATA\nPOINTS 4 float\n",
      "<VTKFile type=\"PolyData\"><PolyData><Piece NumberOfPoints=\"4\"><Points><DataArray type=\"Float32\" "
      "NumberOfComponents=\"3\" format=\"appended\" offset=\"0\"/></Points></Piece></PolyData>"
      "<AppendedData encoding=\"raw\">_"};
  for (const std::string& extension : extensions(Use::read))
    for (const std::string& beginning : beginnings)
      for (int round = 0; round < 20; ++round) {
        std::string bytes = beginning;
        for (int k = 0; k < 400; ++k) bytes += static_cast<char>(random_());
        read_or_refuse("n" + extension, bytes);
      }
}

TEST_F(ReadNoise, ReadsOrRefusesWordsOfItsFormatInAnyOrder) {
  const std::vector<std::string> words = {"OFF",     "off", "v",        "f",     "1",     "2",     "3",
                                          "-1",      "0.5", "1,5",      ",",     ";",     "\n",    "\n",
                                          "\t",      "//",  "x y z",    "r g b", "facet", "SOLID", "vertex",
                                          "element", "ply", "property", "nan",   "1e400", "65535", "\\\n"};
  for (const std::string& extension : extensions(Use::read))
    for (int round = 0; round < 200; ++round) {
      std::string text;
      for (int k = 0; k < 40; ++k) text += words[random_() % words.size()] + " ";
      read_or_refuse("n" + extension, text);
    }
}

TEST_F(ReadNoise, ReadsOrRefusesGoodFilesWithBytesChanged) {
  const std::pair<const char*, std::string> good[] = {
      {"a.off", "COFF\n3 1 0\n0 0 0 1 0 0 1\n1 0 0 1 0 0 1\n0 1 0 1 0 0 1\n3 0 1 2\n"},
      {"a.obj", "v 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 0 1 0 1 0 0\nvn 0 0 1\nf 1//1 2//1 3//1\n"},
      {"a.stl",
       "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
       "endsolid\n"},
      {"a.ply",
       "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
       "property float red\nproperty float green\nproperty float blue\nelement face 1\n"
       "property list uchar int vertex_indices\nend_header\n0 0 0 1 0 0\n1 0 0 1 0 0\n0 1 0 1 0 0\n3 0 1 2\n"},
      {"a.vtk",
       "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\nPOINTS 3 float\n0 0 0 1 0 0 0 1 0\nPOLYGONS 1 4\n"
       "3 0 1 2\nPOINT_DATA 3\nSCALARS s float\nLOOKUP_TABLE default\n1 2 3\n"},
      {"a.pts", "2\n1 2 3 4 5 6 7\n1 2 3 4 5 6 7\n"},
      {"a.csv", "x;y;z;nx;ny;nz;r;g;b\n1;2;3;0;0;1;255;0;0\n"}};
  for (const auto& [name, bytes] : good) {
    EXPECT_NO_THROW(read_bytes(name, bytes)) << name;
    for (int round = 0; round < 500; ++round) {
      std::string changed = bytes;
      for (std::size_t k = 0; k <= random_() % 3; ++k)
        changed[random_() % changed.size()] = static_cast<char>(round % 2 == 0 ? random_() : ' ' + random_() % 64);
      read_or_refuse(name, changed);
    }
  }
}

}  // namespace
}  // namespace ahm::io::test
