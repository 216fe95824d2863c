// Triangle and polygon meshes, and their repair.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <sstream>

#include "ahm/io/read.hpp"
#include "program.hpp"
#include "shapes.hpp"

namespace ahm::test {
namespace {

class MeshFile : public LogmapOf {
 protected:
  MeshFile() : LogmapOf("mesh.obj") {}
};

/// Expects (u, v) = (x, y) relative to a point of a flat sheet with the u axis (1, 0, 0).
void expect_identity(const std::vector<Row>& rows, const Vec3& source) {
  for (const Row& row : rows) {
    ASSERT_NEAR(row["u"], row["x"] - source[0], 1e-10);
    ASSERT_NEAR(row["v"], row["y"] - source[1], 1e-10);
  }
}

/// The point of some rows with these weights.
Vec3 mean(const std::vector<Row>& rows, const std::vector<std::pair<int, double>>& weights) {
  Vec3 p{};
  for (const auto& [row, weight] : weights)
    for (std::size_t c = 0; c < 3; ++c) p[c] += weight * rows.at(row).position()[c];
  return p;
}

TEST_F(MeshFile, HasTheIdentityOnAFlatSheet) {
  for (const std::string flips : {"", " --no-flips"}) {
    const std::string options = " --u-axis 1,0,0 --method heat" + flips;  // straight across notches of the boundary
    const auto rows = map(sheet(20), "-s 0" + options);
    expect_identity(rows, rows[0].position());
    // Face 100 is the lower triangle of cell 50, which is in column 12 of row 2.
    expect_identity(map(sheet(20), "-s face:100:0.2,0.3,0.5" + options), mean(rows, {{52, 0.2}, {53, 0.3}, {73, 0.5}}));
  }
}

TEST_F(MeshFile, IsSolvedWithTheTrianglesUnlessAnotherBackendIsSelected) {
  map(sheet(12), "-s 5");
  expect_values(json, {{"/backend", "trimesh"}, {"/trimesh/faces", 242}});
  EXPECT_GT(number(json, "/trimesh/flips"), 0);
  map(sheet(12), "-s 5 --backend pointcloud");
  expect_values(json, {{"/backend", "pointcloud"}});
  const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n";
  map(square);
  expect_values(json, {{"/backend", "trimesh"}});
  map(square, "-s 0 --discretization polygons");
  expect_values(json, {{"/backend", "polymesh"}});
}

TEST_F(MeshFile, HasNoMapOnOtherComponentsAndUnusedVertices) {
  const auto rows = map(sheet(8) + "v 9 9 9\nv 20 0 0\nv 21 0 0\nv 20 1 0\nf 66 67 68\n", "-s 3");
  EXPECT_EQ(rows[3].status, "ok");
  EXPECT_EQ(rows[64].status, "removed");
  EXPECT_EQ(rows[66].status, "disconnected");
  EXPECT_TRUE(std::isnan(rows[66]["u"]));
}

TEST_F(MeshFile, OfStlIsWelded) {
  std::ostringstream stl;
  stl << "solid\n";
  for (int i = 0; i < 10; ++i)
    for (const int half : {0, 1})
      stl << "facet normal 0 0 1\nouter loop\nvertex " << i << " 0 0\nvertex " << i + 1 << ' ' << half << " 0\nvertex "
          << (half == 1 ? i : i + 1) << " 1 0\nendloop\nendfacet\n";
  write("strip.stl", stl.str() + "endsolid\n");
  const auto rows = table("logmap strip.stl -s 0");
  EXPECT_EQ(rows.size(), 22U);
  for (const Row& row : rows) EXPECT_NEAR(row["distance"], std::hypot(row["x"], row["y"]), 1e-10);
}

TEST_F(MeshFile, ThatIsNoSurfaceIsRejected) {
  const std::string pages = "v 0 0 0\nv 0 0 1\nv 1 0 0\nv 0 1 0\nv -1 0 0\nf 1 2 3\nf 1 2 4\nf 1 2 5\n";
  for (const char* option : {"--non-manifold split", "--repair"}) expect_error(pages, option);
  expect_error(sheet(4), "face", "-s face:18:1,0,0");
  expect_error(sheet(4), "vertices", "-s 16");
  for (const std::string option : {"--voxel 0.1", "--knn flann", "--normals estimate"})
    expect_error(sheet(4), option.substr(0, option.find(' ')), "-s 0 " + option);
  for (const char* option : {"-s 0 --non-manifold split", "-s 0 --repair"}) EXPECT_EQ(map(pages, option).size(), 5U);
}

TEST_F(MeshFile, AllowsNoUAxisAlongTheNormal) {
  write("mesh.obj", sheet(9));
  write("plane.xyz", xyz(plane(12)));
  for (const char* arguments :
       {"mesh.obj -s 40 --method heat", "mesh.obj -s 40 --method exact", "mesh.obj -s face:30:.3,.3,.4 --method heat",
        "mesh.obj -s face:30:.3,.3,.4 --method exact", "plane.xyz -s 70 --method heat"})
    expect_refused("logmap --u-axis 0,0,2 -o map.csv",
                   {{arguments, 1, {"--u-axis 0,0,2: at the source", " 0 degrees from the normal"}}});
}

/// With --local only the surroundings of the source are read into the solver.
class LocalMesh : public MeshFile {
 protected:
  /// Expects the same map with and without --local, and returns it.
  std::vector<Row> expect_same(const std::string& mesh, const std::string& options) {
    const auto expected = map(mesh, options), rows = map(mesh, options + " --local");
    EXPECT_EQ(rows.size(), expected.size());
    for (std::size_t i = 0; i < std::min(rows.size(), expected.size()); ++i) {
      EXPECT_EQ(rows[i].status, expected[i].status) << i;
      if (rows[i].status != "ok") continue;
      EXPECT_NEAR(rows[i]["u"], expected[i]["u"], 1e-10) << i;
      EXPECT_NEAR(rows[i]["v"], expected[i]["v"], 1e-10) << i;
    }
    return rows;
  }
};

TEST_F(LocalMesh, HasTheMapOfTheWholeMesh) {
  // A flat sheet is exact at any diffusion time. One face is a duplicate, so --repair changes the numbers of those after it.
  const std::string repeating = sheet(30) + "f 1 2 32\nf 400 401 431\n";
  for (const std::string source : {"435", "0.4,0.03,0.02", "face:700:.5,.3,.2"})
    for (const std::string choice : {"", " --method exact", " --backend polymesh"})
      for (const bool repaired : {false, true})
        expect_same(repaired ? repeating : sheet(30),
                    "-s " + source + " --radius 0.2 --u-axis 1,0,0" + choice + (repaired ? " --repair" : ""));
}

/// A sheet of 30 x 30 vertices whose faces face down, except for an island near the middle that faces up. Two more sheets: one
/// above it, joined to it at one end by faces that no surroundings reach, and one far away.
std::string islands(bool triangles) {
  constexpr int m = 30;
  Points points;
  Faces faces;
  for (int k = 0; k < 3; ++k) {
    points = joined(points, moved(lattice(m, 1.0 / (m - 1)), {0, 0, std::array{0.0, 0.02, 3.0}[k]}));
    for (std::vector<int> face : cells(m, triangles)) {
      const bool is_up = k == 0 && std::abs(face[0] % m - 15) < 7 && std::abs(face[0] / m - 15) < 7;
      if (!is_up) std::reverse(face.begin() + 1, face.end());
      for (int& v : face) v += k * m * m;
      faces.push_back(face);
    }
  }
  points.push_back({7, 7, 7});
  for (int i = 0; i + 1 < m; ++i) faces.insert(faces.end(), {{i, i + m * m, i + m * m + 1}, {i, i + m * m + 1, i + 1}});
  return obj(points, faces);
}

TEST_F(LocalMesh, IsOrientedLikeTheWholeMesh) {
  for (const bool triangles : {true, false})
    for (const std::string source : {"465", triangles ? "face:840:.5,.3,.2" : "face:420:.4,.3,.2,.1"}) {
      const auto rows = expect_same(islands(triangles), "-s " + source + " --radius 0.15 --u-axis 1,0,0");
      EXPECT_GT(count(rows, "ok"), 10U);
      EXPECT_EQ(count(rows, "disconnected"), 900U);
      EXPECT_EQ(count(rows, "removed"), 1U);
    }
}

TEST_F(LocalMesh, IsNeverCutToFacesThatMeetInAVertex) {
  // A sheet with a square hole in every other cell of a coarser lattice. Balls touch bars beyond holes at single vertices.
  constexpr int m = 41;
  Points points = lattice(m);
  for (Vec3& p : points) p[2] = 0.01 * (static_cast<int>(p[0] * p[0]) % 7);
  Faces faces = cells(m, true);
  std::erase_if(faces, [](const std::vector<int>& face) { return face[0] % m % 4 >= 2 && face[0] / m % 4 >= 2; });
  const std::string mesh = obj(points, faces);
  for (const std::string source : {"0", "420", "861", "1000", "1240"})
    for (const std::string radius : {"2", "3.1", "4.4", "5", "6.3", "7.7", "9", "11"})
      ASSERT_EQ(map(mesh, "-s " + source + " --local --radius " + radius)[std::stoul(source)].status, "ok")
          << source << ", " << radius;
}

TEST_F(LocalMesh, HasAllFacesInItsOutputs) {
  write("mesh.obj", sheet(30) + "v 9 9 9\n");
  const std::string command = "logmap mesh.obj -s face:700:.5,.3,.2 --radius 0.2";
  run_ok(command + " -o whole.ply --corners whole.obj");
  const auto json = summary(command + " --local -o local.ply --corners local.obj");
  const io::Geometry whole = io::read("whole.ply"), local = io::read("local.ply");
  EXPECT_EQ(whole.face_vertices, local.face_vertices);
  ASSERT_EQ(whole.normals.size(), local.normals.size());
  for (std::size_t i = 0; i + 1 < whole.normals.size(); ++i)  // the last vertex is in no face
    for (std::size_t c = 0; c < 3; ++c) ASSERT_NEAR(whole.normals[i][c], local.normals[i][c], 1e-6) << i;
  for (const char* corners : {"whole.obj", "local.obj"}) EXPECT_EQ(io::read(corners).face_count(), whole.face_count());
  EXPECT_LT(number(json, "/trimesh/faces"), 1000);
  EXPECT_GT(number(json, "/trimesh/beyond"), 400);
  expect_values(json, {{"/trimesh/unreferenced", 1}});
}

TEST_F(LocalMesh, NeedsAFaceNearTheSource) {
  expect_error(sheet(5) + "v 9 9 9\n", "no face is within 0.15 of the source 25", "-s 25 --radius 0.1 --local");
}

/// --corners writes the map as texture coordinates.
class CornerFile : public InFolder {
 protected:
  CornerFile() { write("quads.obj", obj(lattice(3), cells(3))); }
};

TEST_F(CornerFile, HasTheMapOfTheVertices) {
  const std::string command = "logmap quads.obj -s 4 --u-axis 1,0,0 -o map.csv --corners ";
  run_ok(command + "near.obj --radius 1.2");
  const auto near = obj_lines("near.obj", "f");
  EXPECT_EQ(near.size(), 4U);
  for (const auto& face : near) EXPECT_EQ(face.size(), 4U);  // vertices only: every face has a corner beyond the radius
  run_ok(command + "whole.obj");
  const auto faces = obj_lines("whole.obj", "f"), v = obj_lines("whole.obj", "v"), vt = obj_lines("whole.obj", "vt");
  ASSERT_EQ(faces.size(), 4U);
  for (const auto& face : faces) {
    ASSERT_EQ(face.size(), 8U);
    for (std::size_t k = 0; k < 8; k += 2) {
      const auto &point = v.at(static_cast<std::size_t>(face[k]) - 1),
                 &uv = vt.at(static_cast<std::size_t>(face[k + 1]) - 1);
      EXPECT_NEAR(uv[0], point[0] - 1, 1e-12);
      EXPECT_NEAR(std::abs(uv[1]), std::abs(point[1] - 1), 1e-12);
    }
  }
  for (const auto& [file, triangles] : std::map<std::string, std::size_t>{{"map.ply", 4}, {"map.glb", 8}}) {
    run_ok(command + file);
    EXPECT_EQ(io::read(file).points.size(), 9U);
    EXPECT_EQ(io::read(file).face_count(), triangles);
  }
  expect_refused(command, {{"map.stl", 1, {"map.stl"}}});
}

TEST_F(CornerFile, KeepsColorsAndColumns) {
  std::string vertices;
  for (int i = 0; i < 9; ++i)
    vertices += std::to_string(i / 3) + " " + std::to_string(i % 3) + " 0 " + std::to_string(20 * i) + " 7 9 " +
                std::to_string(i) + "\n";
  write("quads.ply", ply({"float x", "float y", "float z", "uchar red", "uchar green", "uchar blue", "float t"}, 9,
                         vertices, 4, "4 0 3 4 1\n4 1 4 5 2\n4 3 6 7 4\n4 4 7 8 5\n"));
  run_ok("logmap quads.ply -s 4 -o table.ply --corners map.ply");
  EXPECT_EQ(io::read("table.ply").colors, io::read("quads.ply").colors);
  const io::Geometry map = io::read("map.ply");
  ASSERT_EQ(map.colors.size(), map.points.size());
  const auto values = [&](const std::string& name) {
    const auto found = std::ranges::find(map.properties, name, &io::Property::name);
    return found == map.properties.end() ? std::vector<double>(map.points.size(), not_a_number) : found->values;
  };
  const std::vector<double> t = values("input_t"), point = values("point");  // the map has its own t
  for (std::size_t v = 0; v < map.points.size(); ++v) {
    EXPECT_EQ(t[v], point[v]);
    EXPECT_EQ(map.colors[v], (std::array{static_cast<std::uint8_t>(20 * point[v]), std::uint8_t{7}, std::uint8_t{9}}));
  }
}

using PolygonFile = MeshFile;

/// An uneven sheet of 14 x 14 vertices in the unit square: quads, and an L of eight corners in the middle.
std::string quads(const std::string& more = "") {
  constexpr int m = 14, k = 7;
  const auto at = [](int i, int j) { return (k + j) * m + k + i; };
  Faces faces = cells(m);
  std::erase_if(faces, [&](const std::vector<int>& face) {
    return std::ranges::count(std::array{at(0, 0), at(1, 0), at(0, 1), at(1, 1)}, face[0]) > 0;
  });
  faces.push_back({at(1, 1), at(2, 1), at(2, 2), at(1, 2)});
  faces.push_back({at(0, 0), at(1, 0), at(2, 0), at(2, 1), at(1, 1), at(1, 2), at(0, 2), at(0, 1)});
  return obj(lattice(m, 1.0 / (m - 1), 0.2), faces) + more;
}

TEST_F(PolygonFile, HasTheIdentityOnAFlatSheet) {
  for (const std::string how : {"auto", "polygons", "refined"}) {
    const std::string options = " --u-axis 1,0,0 --discretization " + how;
    const auto rows = map(quads(), "-s 30" + options);
    expect_values(json, {{"/backend", "polymesh"},
                         {"/polymesh/discretization", how == "polygons" ? "polygons" : "refined"},
                         {"/polymesh/largest_face", 8}});
    ASSERT_EQ(rows.size(), 196U);
    expect_identity(rows, rows[30].position());
    // Face 20 is the quad in column 7 of row 1.
    expect_identity(map(quads(), "-s face:20:0.1,0.2,0.3,0.4" + options),
                    mean(rows, {{21, 0.1}, {22, 0.2}, {36, 0.3}, {35, 0.4}}));
  }
}

TEST_F(PolygonFile, WithATwistedFaceIsNotRefined) {
  // A crossed pentagon, which is a separate component.
  const std::string crossed = "v 3 1 0\nv 3 0 0\nv 5 1.5 0\nv 5 -1 0\nv 4 -0.5 0\nf 197 198 199 200 201\n";
  map(quads(crossed));
  expect_values(json, {{"/polymesh/discretization", "polygons"}});
  expect_error(quads(crossed), "--discretization polygons", "-s 0 --discretization refined");
}

TEST_F(PolygonFile, ThatIsNoSurfaceIsRejected) {
  expect_error(quads("v 0 0 9\nv 1 0 9\nv 0 0 8\nv 1 0 8\nf 1 2 198 197\nf 1 2 200 199\n"),
               "1 edge has more than two faces");
  expect_error(quads("f 1 2 3 2\n"), "vertex twice");
  expect_error(quads(), "196 vertices", "-s 196");
  expect_error(quads(), "4 corners", "-s face:3:0.5,0.25,0.25");
}

TEST_F(PolygonFile, IsWrittenWithItsPolygons) {
  map(quads());
  run_ok("logmap mesh.obj -s 0 -o map.ply");
  expect_values(summary("logmap map.ply -s 0 -o again.csv"), {{"/polymesh/largest_face", 8}});
}

// The mean of the corners of a U is outside of it.
TEST_F(PolygonFile, WarnsOfASourceOutsideOfItsFace) {
  const std::string u = obj({{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {2, 3, 0}, {2, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}},
                            {{0, 1, 2, 3, 4, 5, 6, 7}});
  map(u, "-s face:0:.125,.125,.125,.125,.125,.125,.125,.125");
  EXPECT_TRUE(has(err, "outside of its face"));
  map(u, "-s face:0:.4,.3,0,0,.1,.1,0,.1");
  EXPECT_FALSE(has(err, "outside of its face"));
}

/// Flat meshes with faults.
class Repair : public MeshFile {
 protected:
  void expect_plane(const std::string& mesh, const std::string& options) {
    const auto rows = map(mesh, options);
    for (const Row& row : rows) {
      ASSERT_EQ(row.status, "ok");
      EXPECT_NEAR(row["distance"], distance(row.position(), rows[0].position()), 1e-9);
    }
  }
};

TEST_F(Repair, WeldsATornSheet) {
  expect_plane(torn_sheet(9), "-s 0 --weld 0");
  expect_plane(torn_sheet(9), "-s 0 --repair");
  expect_values(json, {{"/trimesh/repair/welded", 384 - 81}});
}

TEST_F(Repair, IsReportedInSingularAndPlural) {
  map(torn_sheet(5) + "f 1 2 3\nv 7 7 7\n", "-s 0 --repair");
  expect_values(json, {{"/input/faces", 33}, {"/trimesh/faces", 32}});
  EXPECT_TRUE(has(err, " 1 duplicate face was dropped\n", " 1 vertex that no face uses was left out\n",
                  " 71 vertices were joined "));
  expect_error(torn_sheet(5) + "f 1 1 2\n", "1 face uses a vertex twice");
  expect_error(torn_sheet(5) + "f 1 1 2\nf 2 2 1\n", "2 faces use a vertex twice");
}

TEST_F(Repair, IsSuggestedByErrors) {
  for (const auto& [more, option] :
       {std::pair<std::string, std::string>{"f 1 1 2\n", "--drop-degenerate"}, {"f 1 2 3\n", "--drop-duplicates"}}) {
    expect_error(torn_sheet(5) + more, option);
    expect_error(torn_sheet(5) + more, "--repair");
    map(torn_sheet(5) + more, "-s 0 " + option);
    expect_plane(torn_sheet(5) + more, "-s 0 --repair");
  }
  expect_error(torn_sheet(5), "--repair", "-s 0 --repair --backend pointcloud");
}

TEST_F(Repair, KeepsTheNumbersOfFacesInSources) {
  // Face 32 is dropped, face 33 is elsewhere.
  const std::string mesh = torn_sheet(5) + "f 1 1 2\nv 5 0 0\nv 6 0 0\nv 5 1 0\nf -3 -2 -1\n";
  map(mesh, "-s face:33:1,0,0 --repair");
  EXPECT_EQ(number(json, "/source/position/0"), 5);
  expect_error(mesh, "face:32", "-s face:32:1,0,0 --repair");
}

}  // namespace
}  // namespace ahm::test
