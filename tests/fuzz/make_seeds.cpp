// Writes the seeds of all fuzzers: make_seeds FOLDER. The seeds of fuzz_NAME are in FOLDER/NAME.
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <span>
#include <string>

#include "ahm/conformance/clouds.hpp"
#include "ahm/conformance/polygon_meshes.hpp"
#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/io/formats.hpp"
#include "ahm/io/textured_mesh.hpp"
#include "ahm/io/write.hpp"

namespace {

using namespace ahm;

class Seeds {
 public:
  explicit Seeds(std::filesystem::path folder) : folder_(std::move(folder)) {}

  std::filesystem::path file(const std::string& fuzzer, const std::string& name) const {
    std::filesystem::create_directories(folder_ / fuzzer);
    return folder_ / fuzzer / name;
  }
  void add(const std::string& fuzzer, const std::string& name, const std::string& bytes) const {
    std::ofstream(file(fuzzer, name), std::ios::binary) << bytes;
  }

 private:
  std::filesystem::path folder_;
};

template <class Number>
void put(std::string& bytes, Number number) {
  bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

template <class... Bytes>
std::string bytes_of(Bytes... bytes) {
  return {static_cast<char>(bytes)...};
}

/// Coordinates as `Bytes::points` reads them: bytes (`coarse`), or doubles.
void put_points(std::string& bytes, const std::vector<Vec3>& points, bool coarse) {
  for (const Vec3& point : points)
    for (const double x : point) coarse ? put(bytes, static_cast<std::int8_t>(std::lround(32 * x))) : put(bytes, x);
}

void put_corners(std::string& bytes, std::span<const Index> corners) {
  for (const Index corner : corners) put(bytes, static_cast<std::uint16_t>(corner));
}

/// CSR arrays of triangles.
struct Polygons {
  explicit Polygons(const std::vector<Triangle>& faces) {
    for (const Triangle& face : faces) {
      corners.insert(corners.end(), face.begin(), face.end());
      begin.push_back(static_cast<Offset>(corners.size()));
    }
  }
  std::vector<Offset> begin{0};
  std::vector<Index> corners;
};

/// Numbers in decimal digits.
std::string words_of(const Vec3& p) {
  return std::to_string(p[0]) + " " + std::to_string(p[1]) + " " + std::to_string(p[2]) + "\n";
}

std::string triangles(const test::Mesh& mesh, std::uint8_t flags, bool count_from_one) {
  const std::uint8_t less = count_from_one ? 1 : 0;
  std::string bytes = bytes_of(flags, mesh.positions.size() - less);
  put_points(bytes, mesh.positions, (flags & 1) == 0);
  bytes += bytes_of(mesh.faces.size() - less);
  for (const Triangle& face : mesh.faces) put_corners(bytes, face);
  return bytes + std::string(40, '\1');
}

void add_meshes(const Seeds& seeds) {
  const std::vector<std::pair<std::string, test::Mesh>> meshes{{"icosahedron", test::icosphere(1)},
                                                               {"hexagon", test::hexagon(2)},
                                                               {"square", test::flat_square(5)},
                                                               {"moebius", test::moebius_mesh(12, 1)},
                                                               {"folded", test::folded_strip(5)}};
  for (const auto& [name, mesh] : meshes) {
    for (const std::uint8_t flags : {0, 1}) {
      seeds.add("triangles", name + std::to_string(flags), triangles(mesh, flags, false));
      seeds.add("exact", name + std::to_string(flags), triangles(mesh, flags, true));
    }
    std::string bytes = bytes_of(0, mesh.positions.size(), mesh.faces.size());
    for (std::size_t i = 0; i <= mesh.positions.size(); ++i) put(bytes, static_cast<std::int8_t>(i % 3));
    for (const Triangle& face : mesh.faces) put_corners(bytes, face);
    seeds.add("lengths", name, bytes + std::string(20, '\1'));
  }
}

void add_polygons(const Seeds& seeds) {
  const std::vector<std::pair<std::string, test::Polygons>> meshes{{"grid", test::quad_grid(5)},
                                                                   {"bricks", test::brick_wall(3)},
                                                                   {"ells", test::l_shapes(2)},
                                                                   {"cube", test::cube_sphere(2)},
                                                                   {"moebius", test::moebius_quads(9, 1)}};
  for (const auto& [name, mesh] : meshes) {
    for (const std::uint8_t flags : {0, 1, 32, 33, 64, 65}) {
      std::string bytes = bytes_of(flags, mesh.vertices());
      put_points(bytes, mesh.positions, (flags & 1) == 0);
      bytes += bytes_of(mesh.faces());
      for (Index f = 0; f < mesh.faces(); ++f) {
        bytes += bytes_of(mesh.face(f).size());
        put_corners(bytes, mesh.face(f));
      }
      seeds.add("polygons", name + std::to_string(flags), bytes + std::string(20, '\1'));
    }
  }
}

void add_clouds(const Seeds& seeds) {
  for (const auto& [name, cloud] : {std::pair<std::string, test::Cloud>{"flat", test::flat_cloud(80)},
                                    {"sphere", test::even_sphere(120)},
                                    {"moebius", test::moebius_cloud(150)}})
    for (const std::uint8_t flags : {0, 1, 2, 3}) {
      std::string bytes = bytes_of(flags, cloud.points.size());
      put_points(bytes, cloud.points, (flags & 1) == 0);
      if ((flags & 2) != 0) put_points(bytes, cloud.normals, (flags & 1) == 0);
      seeds.add("cloud", name + std::to_string(flags), bytes + std::string(20, '\1'));
    }
}

void add_graphs(const Seeds& seeds) {
  // A wheel. Spokes and edges of the rim have weight and length 1.
  for (const std::uint8_t flags : {0, 2}) {
    const int rim = 8;
    std::string bytes = bytes_of(flags, rim, 2 * rim);
    const auto add_edge = [&](int a, int b, int direction) {
      put(bytes, static_cast<std::uint16_t>(a)), put(bytes, static_cast<std::uint16_t>(b));
      bytes += bytes_of(4, 4, direction, 0);
      if (flags == 2) bytes += bytes_of(a % 2);
    };
    for (int k = 0; k < rim; ++k) add_edge(0, 1 + k, 32 * k), add_edge(1 + k, 1 + (k + 1) % rim, 16 * k);
    seeds.add("solver", "wheel" + std::to_string(flags), bytes + std::string(rim + 1, '\4') + std::string(20, '\1'));
  }
  // Two vertices on a line.
  seeds.add("rows", "pair", bytes_of(6, 0, 2, 1, 1, 1, 0, 4, 4, 4, -4, 4, 4, 4, 4) + std::string(20, '\1'));
}

io::Table table_of(const std::vector<Vec3>& points, const std::vector<Vec3>& normals) {
  io::Table table{"points"};
  table.add({"x", "y", "z"}, points);
  if (!normals.empty()) table.add({"nx", "ny", "nz"}, normals);
  return table;
}

void add_files(const Seeds& seeds) {
  const test::Cloud cloud = test::even_sphere(12);
  const test::Mesh mesh = test::icosphere(1);
  const Polygons polygons(mesh.faces);
  for (const bool text : {false, true}) {
    io::Table table = table_of(mesh.positions, mesh.positions);
    table.faces = {polygons.begin, polygons.corners};
    table.text = text;
    io::write(seeds.file("ply", text ? "text.ply" : "binary.ply"), table);
  }
  io::Table table = table_of(mesh.positions, mesh.positions);
  table.faces = {polygons.begin, polygons.corners};
  io::write(seeds.file("vtp", "appended.vtp"), table);
  io::write(seeds.file("csv", "cloud.csv"), table_of(cloud.points, cloud.normals));
  const std::vector<io::MeshPart> parts{
      {.name = "ball", .points = mesh.positions, .faces = {polygons.begin, polygons.corners}}};
  io::write_textured(seeds.file("glb", "ball.glb"), parts);
  std::string xyz, obj = "# a mesh\n", off = "OFF\n12 20 0\n", stl = "solid ball\n";
  for (const Vec3& p : mesh.positions) {
    xyz += words_of(p), off += words_of(p), obj += "v " + words_of(p);
  }
  for (const Triangle& face : mesh.faces) {
    off += "3 " + std::to_string(face[0]) + " " + std::to_string(face[1]) + " " + std::to_string(face[2]) + "\n";
    obj += "f " + std::to_string(face[0] + 1) + "/1/1 " + std::to_string(face[1] + 1) + " " +
           std::to_string(face[2] - 12) + "\n";
    stl += "facet normal 0 0 1\nouter loop\n";
    for (const Index corner : face) stl += "vertex " + words_of(mesh.positions[corner]);
    stl += "endloop\nendfacet\n";
  }
  seeds.add("xyz", "ball.xyz", xyz);
  seeds.add("pts", "ball.pts", "12\n" + xyz);
  seeds.add("off", "ball.off", off);
  seeds.add("obj", "ball.obj", obj);
  seeds.add("stl", "text.stl", stl + "endsolid ball\n");
  std::string binary(80, ' ');
  put(binary, static_cast<std::uint32_t>(2));
  for (int k = 0; k < 2; ++k) {
    for (int i = 0; i < 12; ++i) put(binary, static_cast<float>(i % 5 + k));
    put(binary, static_cast<std::uint16_t>(0));
  }
  seeds.add("stl", "binary.stl", binary);
}

/// A square and triangles: as text, big-endian, and as XML.
void add_vtk(const Seeds& seeds) {
  const std::string head = "# vtk DataFile Version 3.0\nt\n";
  seeds.add("vtk", "text.vtk",
            head +
                "ASCII\nDATASET POLYDATA\nPOINTS 4 float\n0 0 0 1 0 0 1 1 0 0 1 0\nPOLYGONS 1 4\n3 0 1 2\n"
                "TRIANGLE_STRIPS 1 4\n3 0 2 3\nPOINT_DATA 4\nSCALARS s int 1\nLOOKUP_TABLE default\n1 2 3 4\n"
                "COLOR_SCALARS c 3\n1 0 0 1 0 0 1 0 0 1 0 0\nFIELD f 1\ng 2 4 short\n1 2 3 4 5 6 7 8\n");
  seeds.add("vtk", "offsets.vtk",
            "# vtk DataFile Version 5.1\nt\nASCII\nDATASET POLYDATA\nPOINTS 3 double\n0 0 0 1 0 0 0 1 0\nMETADATA\n"
            "INFORMATION 0\n\nPOLYGONS 2 3\nOFFSETS vtktypeint64\n0 3\nCONNECTIVITY vtktypeint64\n0 1 2\n");
  std::string binary = head + "BINARY\nDATASET POLYDATA\nPOINTS 3 float\n";
  for (const int one : {3, 7})
    for (int k = 0; k < 36; ++k) binary += k == 4 * one ? '\x3f' : k == 4 * one + 1 ? '\x80' : '\0';
  binary.resize(binary.size() - 36);
  binary += "\nPOLYGONS 1 4\n" + bytes_of(0, 0, 0, 3, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 2) + "\n";
  seeds.add("vtk", "binary.vtk", binary);
  const std::string array = "<DataArray type=\"", points = "Float32\" NumberOfComponents=\"3\" format=\"";
  seeds.add("vtp", "text.vtp",
            "<VTKFile type=\"PolyData\"><PolyData><Piece NumberOfPoints=\"3\" NumberOfPolys=\"1\"><Points>" + array +
                points + "ascii\">0 0 0 1 0 0 0 1 0</DataArray></Points><PointData>" + array +
                "UInt8\" Name=\"a\" format=\"binary\">AwAAAAECAw==</DataArray></PointData><Polys>" + array +
                "Int32\" Name=\"connectivity\">0 1 2</DataArray>" + array +
                "Int32\" Name=\"offsets\">3</DataArray></Polys></Piece></PolyData></VTKFile>");
}

/// Two points of format 0 after a header of version 1.2.
void add_las(const Seeds& seeds) {
  std::string las(227, '\0');
  const auto at = [&](std::size_t place, auto number) { std::memcpy(las.data() + place, &number, sizeof number); };
  las.replace(0, 4, "LASF");
  at(24, static_cast<std::uint8_t>(1)), at(25, static_cast<std::uint8_t>(2));
  at(94, static_cast<std::uint16_t>(227)), at(96, std::uint32_t{227});
  at(105, static_cast<std::uint16_t>(20)), at(107, std::uint32_t{2});
  for (const std::size_t k : {0, 1, 2}) at(131 + 8 * k, 0.01), at(155 + 8 * k, 1.0);
  for (int k = 0; k < 2; ++k) {
    for (int i = 0; i < 3; ++i) put(las, std::int32_t{100 * k + i});
    las.append(8, '\0');
  }
  seeds.add("las", "two.las", las);
}

/// Two points with a color: text, binary, and compressed to one run of unchanged bytes.
void add_pcd(const Seeds& seeds) {
  const std::string head =
      "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F U\nCOUNT 1 1 1 1\nWIDTH 2\nHEIGHT 1\n"
      "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA ";
  seeds.add("pcd", "text.pcd", head + "ascii\n0 0.5 1 255\n1 nan 0 65280\n");
  std::string records;
  for (int k = 0; k < 8; ++k) put(records, static_cast<float>(k));
  seeds.add("pcd", "binary.pcd", head + "binary\n" + records);
  std::string packed = head + "binary_compressed\n";
  put(packed, static_cast<std::uint32_t>(records.size() + 1));
  put(packed, static_cast<std::uint32_t>(records.size()));
  packed += static_cast<char>(records.size() - 1);  // LZF: the length of the run, minus 1
  seeds.add("pcd", "compressed.pcd", packed + records);
}

/// Files without faces of the formats that are streamed, after the number of the format (points.cpp).
void add_points(const Seeds& seeds) {
  const test::Cloud cloud = test::even_sphere(12);
  io::Table table = table_of(cloud.points, cloud.normals);
  for (const bool text : {false, true}) {
    table.text = text;
    io::write(seeds.file("ply", text ? "points_text.ply" : "points.ply"), table);
  }
  struct Streamed {
    std::uint8_t format;
    const char *fuzzer, *name;
  };
  for (const auto& [format, fuzzer, name] :
       {Streamed{0, "csv", "cloud.csv"}, Streamed{1, "las", "two.las"}, Streamed{2, "pcd", "text.pcd"},
        Streamed{2, "pcd", "binary.pcd"}, Streamed{2, "pcd", "compressed.pcd"}, Streamed{3, "ply", "points.ply"},
        Streamed{3, "ply", "points_text.ply"}, Streamed{4, "pts", "ball.pts"}, Streamed{5, "xyz", "ball.xyz"}}) {
    std::ifstream in(seeds.file(fuzzer, name), std::ios::binary);
    seeds.add("points", name, bytes_of(format) + std::string(std::istreambuf_iterator<char>(in), {}));
  }
}

void add_gltf(const Seeds& seeds) {
  std::string bytes;
  for (const float x : {0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F}) put(bytes, x);
  static constexpr char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string coded;
  for (std::size_t k = 0; k + 2 < bytes.size(); k += 3) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(bytes[k + i]); };
    const unsigned word = byte(0) << 16U | byte(1) << 8U | byte(2);
    for (const unsigned shift : {18U, 12U, 6U, 0U}) coded += letters[word >> shift & 63U];
  }
  seeds.add("gltf", "triangle.gltf",
            R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"scale":[2,1,1]}],)"
            R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)"
            R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],)"
            R"("bufferViews":[{"buffer":0,"byteLength":36}],)"
            R"("buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,)" +
                coded + R"("}]})");
}

void add_command_lines(const Seeds& seeds) {
  const char* lines[] = {
      "logmap\nscan.ply\n--source\n0\n-o\nmap.csv\n--view\nmap.png",
      "logmap\nq.obj\n--source\nface:7:.2,.3,.3,.2\n--u-axis\n1,0,0\n--t-coef\n2\n-o\nmap.ply",
      "path\nmesh.obj\n--from\n7\n--to\n0.1,0.2,1.4\n-o\npath.obj\n--fast",
      "local-maps\nscan.ply\n--radius\n0.02\n--k\n32\n--pad\n--float32\n-o\nn.npz",
      "coverage\nscan.ply\n--source\n7\n--radius\n0.2\n--spacing\n0.01\n-o\npath.csv",
      "atlas\nmesh.obj\n--max-distortion\n2\n-o\natlas.glb",
      "info\nscan.ply\n--json\n-",
      "--version",
      "cells\nm.obj\n--sources\n1,2,3\n-o\nc.csv",
      "decal\nm.obj\n--image\ni.png\n--size\n1e-3\n--source\n1\n-o\nd.ply",
      "stroke\nm.obj\n--help",
  };
  for (std::size_t k = 0; k < std::size(lines); ++k) seeds.add("command_line", std::to_string(k), lines[k]);
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 2) throw std::runtime_error("make_seeds FOLDER");
  const Seeds seeds(argv[1]);
  for (const auto add : {add_meshes, add_polygons, add_clouds, add_graphs, add_files, add_las, add_pcd, add_vtk,
                         add_gltf, add_points, add_command_lines})
    add(seeds);
  return 0;
} catch (const std::exception& error) {
  std::cerr << error.what() << '\n';
  return 1;
}
