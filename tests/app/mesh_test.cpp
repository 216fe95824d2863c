// Triangle meshes through the program.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "ahm/io/read.hpp"
#include "program.hpp"
#include "sheet.hpp"

namespace ahm::test {
namespace {

std::vector<Row> map(const std::string& mesh, const std::string& source, const std::vector<std::string>& more = {},
                     const std::string& name = "mesh.obj") {
  Folder folder;
  std::vector<std::string> words{"logmap", folder.write(name, mesh), "--source=" + source, "-o", folder / "map.csv"};
  words.insert(words.end(), more.begin(), more.end());
  const Outcome outcome = run(words);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  return read_csv(folder / "map.csv");
}

void expect_refused(const std::string& mesh, const std::string& text, const std::vector<std::string>& more = {},
                    const std::string& source = "0") {
  Folder folder;
  std::vector<std::string> words{"logmap", folder.write("mesh.obj", mesh), "--source=" + source, "-o",
                                 folder / "map.csv"};
  words.insert(words.end(), more.begin(), more.end());
  const Outcome outcome = run(words);
  EXPECT_EQ(outcome.status, 1) << outcome.out;
  EXPECT_NE(outcome.err.find(text), std::string::npos) << outcome.err;
  EXPECT_EQ(folder.files(), std::vector<std::string>{"mesh.obj"});
}

TEST(Mesh, IsTheIdentityOnAFlatSheetFromAVertexAndFromInsideAFace) {
  for (const std::vector<std::string>& flips : {std::vector<std::string>{}, {"--no-flips"}}) {
    auto more = flips;
    more.insert(more.end(), {"--u-axis", "1,0,0", "--method", "heat"});  // straight across notches of the boundary
    const auto from_corner = map(sheet(20), "0", more);
    for (const Row& row : from_corner) {
      ASSERT_NEAR(row.u, row.position[0] - from_corner[0].position[0], 1e-10);
      ASSERT_NEAR(row.v, row.position[1] - from_corner[0].position[1], 1e-10);
    }
    // Face 100 is the lower triangle of a cell; find its corners from the numbering.
    const int cell = 50, a = cell / 19 * 20 + cell % 19;
    const auto rows = map(sheet(20), "face:100:0.2,0.3,0.5", more);
    double p[2];
    for (int c : {0, 1})
      p[c] = 0.2 * rows[a].position[c] + 0.3 * rows[a + 1].position[c] + 0.5 * rows[a + 21].position[c];
    for (const Row& row : rows) {
      ASSERT_NEAR(row.u, row.position[0] - p[0], 1e-10);
      ASSERT_NEAR(row.v, row.position[1] - p[1], 1e-10);
    }
  }
}

/// Two maps, exact to rounding, of the same rows.
void expect_same(const std::vector<Row>& a, const std::vector<Row>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i].status, b[i].status) << i;
    if (a[i].status != "ok") continue;
    ASSERT_NEAR(a[i].u, b[i].u, 1e-10) << i;
    ASSERT_NEAR(a[i].v, b[i].v, 1e-10) << i;
  }
}

TEST(Mesh, OfTheSurroundingsAloneGivesTheSameMap) {
  // A flat sheet is exact at any diffusion time. One face comes twice, so that --repair gives those after it new numbers.
  const std::string twice = sheet(30) + "f 1 2 32\nf 400 401 431\n";
  const std::vector<std::vector<std::string>> choices = {{}, {"--method", "exact"}, {"--backend", "polymesh"}};
  for (const std::string source : {"435", "0.4,0.03,0.02", "face:700:.5,.3,.2"})
    for (const auto& choice : choices)
      for (const bool repaired : {false, true}) {
        std::vector<std::string> more{"--radius", "0.2", "--u-axis", "1,0,0"};
        more.insert(more.end(), choice.begin(), choice.end());
        if (repaired) more.emplace_back("--repair");
        const std::string& mesh = repaired ? twice : sheet(30);
        const auto whole = map(mesh, source, more);
        more.emplace_back("--local");
        expect_same(whole, map(mesh, source, more));
      }
}

/// A sheet of 30 x 30 vertices whose faces face down but for an island of some beside the middle; three more sheets: above it,
/// off its end, and one that reaches around both in a loop far away.
std::string islands(bool triangles) {
  constexpr int m = 30;
  std::ostringstream text;
  for (const double z : {0.0, 0.02, 3.0})
    for (int j = 0; j < m; ++j)
      for (int i = 0; i < m; ++i) text << "v " << i / 29.0 << ' ' << j / 29.0 << ' ' << z << '\n';
  text << "v 7 7 7\n";
  const auto add = [&](std::vector<int> face, bool up) {
    if (!up) std::reverse(face.begin() + 1, face.end());
    text << "f";
    for (const int v : face) text << ' ' << v + 1;
    text << '\n';
  };
  for (int sheet = 0; sheet < 3; ++sheet)
    for (int j = 0; j + 1 < m; ++j)
      for (int i = 0; i + 1 < m; ++i) {
        const int a = (sheet * m + j) * m + i;
        const bool up = sheet == 0 && std::abs(i - 15) < 7 && std::abs(j - 15) < 7;
        if (!triangles) {
          add({a, a + 1, a + m + 1, a + m}, up);
        } else {
          add({a, a + 1, a + m + 1}, up);
          add({a, a + m + 1, a + m}, up);
        }
      }
  // The sheet above hangs together with that below at one end, by faces that no surroundings reach.
  for (int i = 0; i + 1 < m; ++i) add({i, i + m * m, i + m * m + 1}, true), add({i, i + m * m + 1, i + 1}, true);
  return text.str();
}

TEST(Mesh, OfTheSurroundingsIsOrientedLikeAllOfIt) {
  for (const bool triangles : {true, false})
    for (const std::string& source :
         {std::string("465"), std::string(triangles ? "face:840:.5,.3,.2" : "face:420:.4,.3,.2,.1")}) {
      std::vector<std::string> more{"--radius", "0.15", "--u-axis", "1,0,0"};
      const auto whole = map(islands(triangles), source, more);
      more.emplace_back("--local");
      const auto local = map(islands(triangles), source, more);
      expect_same(whole, local);
      // Not the orientation of the island.
      const auto mapped = std::ranges::count(whole, "ok", &Row::status);
      EXPECT_GT(mapped, 10);
      EXPECT_EQ(std::ranges::count(whole, "disconnected", &Row::status), 900);
      EXPECT_EQ(std::ranges::count(whole, "removed", &Row::status), 1);
    }
}

TEST(Mesh, OfTheSurroundingsIsNeverPinchedByTheCut) {
  // A sheet with a square hole in every other cell of a coarser grid: balls touch the bars beyond holes at corners alone.
  constexpr int m = 41;
  std::ostringstream text;
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < m; ++i) text << "v " << i << ' ' << j << ' ' << 0.01 * (i * i % 7) << '\n';
  for (int j = 0; j + 1 < m; ++j)
    for (int i = 0; i + 1 < m; ++i) {
      if (i % 4 >= 2 && j % 4 >= 2) continue;
      const int a = j * m + i + 1;
      text << "f " << a << ' ' << a + 1 << ' ' << a + m + 1 << "\nf " << a << ' ' << a + m + 1 << ' ' << a + m << '\n';
    }
  for (const std::string source : {"0", "420", "861", "1000", "1240"})
    for (const std::string radius : {"2", "3.1", "4.4", "5", "6.3", "7.7", "9", "11"}) {
      const auto rows = map(text.str(), source, {"--radius", radius, "--local"});
      ASSERT_EQ(rows[static_cast<std::size_t>(std::stoi(source))].status, "ok") << source << ", " << radius;
    }
}

TEST(Mesh, OfTheSurroundingsKeepsAllFacesInItsOutputs) {
  Folder folder;
  const auto input = folder.write("mesh.obj", sheet(30) + "v 9 9 9\n");
  const auto out = [&](const std::string& name, const std::vector<std::string>& more) {
    std::vector<std::string> words{"logmap",    input,
                                   "-s",        "face:700:.5,.3,.2",
                                   "--radius",  "0.2",
                                   "-o",        folder / (name + ".ply"),
                                   "--corners", folder / (name + ".obj"),
                                   "--json",    folder / (name + ".json")};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return io::read(folder / (name + ".ply"));
  };
  const io::Geometry whole = out("whole", {}), local = out("local", {"--local"});
  EXPECT_EQ(whole.face_vertices, local.face_vertices);
  ASSERT_EQ(whole.normals.size(), local.normals.size());
  for (std::size_t i = 0; i + 1 < whole.normals.size(); ++i)  // the last lies in no face
    for (std::size_t c = 0; c < 3; ++c) ASSERT_NEAR(whole.normals[i][c], local.normals[i][c], 1e-6) << i;
  EXPECT_EQ(io::read(folder / "whole.obj").face_count(), whole.face_count());
  EXPECT_EQ(io::read(folder / "local.obj").face_count(), whole.face_count());
  const auto json = read_json(folder / "local.json").at("trimesh");
  EXPECT_LT(json.at("faces"), 1000);
  EXPECT_GT(json.at("beyond"), 400);
  EXPECT_EQ(json.at("unreferenced"), 1);
}

TEST(Mesh, HasNoSurroundingsWhereNoFaceIs) {
  expect_refused(sheet(5) + "v 9 9 9\n", "no face is within 0.15 of the source 25", {"--radius", "0.1", "--local"},
                 "25");
}

TEST(Mesh, IsChosenForTrianglesAndReportsItself) {
  Folder folder;
  const auto input = folder.write("mesh.obj", sheet(12));
  ASSERT_EQ(run({"logmap", input, "-s", "5", "-o", folder / "map.ply", "--json", folder / "run.json"}).status, 0);
  const auto json = read_json(folder / "run.json");
  EXPECT_EQ(json.at("backend"), "trimesh");
  EXPECT_EQ(json.at("trimesh").at("faces"), 242);
  EXPECT_GT(json.at("trimesh").at("flips").get<long>(), 0);
  ASSERT_EQ(run({"logmap", input, "-s", "5", "-o", folder / "map.ply", "--json", folder / "cloud.json", "--backend",
                 "pointcloud"})
                .status,
            0);
  EXPECT_EQ(read_json(folder / "cloud.json").at("backend"), "pointcloud");
}

TEST(Mesh, MasksOtherComponentsAndUnusedVertices) {
  const std::string mesh = sheet(8) + "v 9 9 9\nv 20 0 0\nv 21 0 0\nv 20 1 0\nf 66 67 68\n";
  const auto rows = map(mesh, "3");
  EXPECT_EQ(rows[3].status, "ok");
  EXPECT_EQ(rows[64].status, "removed");
  EXPECT_EQ(rows[66].status, "disconnected");
  EXPECT_TRUE(std::isnan(rows[66].u));
}

TEST(Mesh, WeldsStl) {
  std::string stl = "solid\n";
  for (int i = 0; i < 10; ++i)
    for (int half = 0; half < 2; ++half) {
      auto vertex = [&](int x, int y) { stl += "vertex " + std::to_string(x) + " " + std::to_string(y) + " 0\n"; };
      stl += "facet normal 0 0 1\nouter loop\n";
      vertex(i, 0), vertex(i + 1, half), vertex(half ? i : i + 1, 1);
      stl += "endloop\nendfacet\n";
    }
  const auto rows = map(stl + "endsolid\n", "0", {}, "strip.stl");
  EXPECT_EQ(rows.size(), 22u);
  for (const Row& row : rows) EXPECT_NEAR(row.distance, std::hypot(row.position[0], row.position[1]), 1e-10);
}

TEST(Mesh, RefusesWhatHasNoSurface) {
  const std::string book = "v 0 0 0\nv 0 0 1\nv 1 0 0\nv 0 1 0\nv -1 0 0\nf 1 2 3\nf 1 2 4\nf 1 2 5\n";
  expect_refused(book, "--non-manifold split");
  expect_refused(sheet(4) + "f 1 2 2\n", "face");
  expect_refused(sheet(4), "face", {}, "face:18:1,0,0");
  expect_refused(sheet(4), "vertices", {}, "16");
  for (const std::vector<std::string>& words :
       std::vector<std::vector<std::string>>{{"--voxel", "0.1"}, {"--knn", "flann"}, {"--normals", "estimate"}})
    expect_refused(sheet(4), words[0], words);
  EXPECT_EQ(map(book, "0", {"--non-manifold", "split"}).size(), 5u);
}

TEST(MeshCommand, AnAxisAlongTheNormalIsRefusedAndSaysWhy) {
  const Folder folder;
  const std::string mesh = folder.write("sheet.obj", sheet(9)), cloud = folder.write("plane.xyz", xyz(plane(12)));
  for (const auto& [input, source] :
       {std::pair{mesh, "40"}, std::pair{mesh, "face:30:.3,.3,.4"}, std::pair{cloud, "70"}})
    for (const char* method : {"heat", "exact"}) {
      if (input == cloud && method == std::string("exact")) continue;
      const Outcome outcome =
          run({"logmap", input, "--source", source, "--u-axis", "0,0,2", "--method", method, "-o", folder / "map.csv"});
      EXPECT_EQ(outcome.status, 1);
      for (const char* words : {"--u-axis 0,0,2: at the source", " 0 degrees from the normal"})
        EXPECT_NE(outcome.err.find(words), std::string::npos) << outcome.err;
    }
}

/// The faces of an .obj file as lists of (v, vt), each vertex and pair of coordinates as numbers.
struct Corners {
  std::vector<std::vector<double>> points, places;
  std::vector<std::vector<std::array<std::size_t, 2>>> faces;

  explicit Corners(const std::string& path) {
    std::istringstream lines(read_text(path));
    for (std::string line, word; std::getline(lines, line);) {
      std::istringstream words(line);
      words >> word;
      if (word == "v" || word == "vt") {
        auto& row = (word == "v" ? points : places).emplace_back();
        for (double x; words >> x;) row.push_back(x);
      } else if (word == "f") {
        faces.emplace_back();
        for (std::string corner; words >> corner;) {
          const std::size_t slash = corner.find('/');
          faces.back().push_back({std::stoul(corner) - 1, slash == std::string::npos
                                                              ? std::string::npos
                                                              : std::stoul(corner.substr(slash + 1)) - 1});
        }
      }
    }
  }
};

TEST(MeshCommand, CornersKeepColorsAndColumns) {
  const Folder folder;
  std::string sheet = "ply\nformat ascii 1.0\nelement vertex 9\n";
  for (const char* name : {"float x", "float y", "float z", "uchar red", "uchar green", "uchar blue", "float t"})
    sheet += std::string("property ") + name + "\n";
  sheet += "element face 4\nproperty list uchar int vertex_indices\nend_header\n";
  for (int i = 0; i < 9; ++i)
    sheet += std::to_string(i / 3) + " " + std::to_string(i % 3) + " 0 " + std::to_string(20 * i) + " 7 9 " +
             std::to_string(i) + "\n";
  sheet += "4 0 3 4 1\n4 1 4 5 2\n4 3 6 7 4\n4 4 7 8 5\n";
  const Outcome outcome = run({"logmap", folder.write("quads.ply", sheet), "--source", "4", "-o", folder / "map.csv",
                               "--corners", folder / "map.ply"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const io::Geometry back = io::read(folder / "map.ply");
  ASSERT_EQ(back.colors.size(), back.points.size());
  const auto of = [&](const std::string& name) {
    for (const io::Property& property : back.properties)
      if (property.name == name) return property.values;
    ADD_FAILURE() << name;
    return std::vector<double>(back.points.size());
  };
  const std::vector<double> number = of("input_t"), point = of("point");  // t is the map's
  for (std::size_t v = 0; v < back.points.size(); ++v) {
    EXPECT_EQ(number[v], point[v]);
    EXPECT_EQ(back.colors[v], (std::array{static_cast<std::uint8_t>(20 * point[v]), std::uint8_t{7}, std::uint8_t{9}}));
  }
}

TEST(MeshCommand, CornersHoldTheMapOfTheirVertices) {
  const Folder folder;
  std::string sheet = "OFF\n9 4 0\n";
  for (int i = 0; i < 9; ++i) sheet += std::to_string(i / 3) + " " + std::to_string(i % 3) + " 0\n";
  for (int a : {0, 1, 3, 4})
    for (int word : {4, a, a + 3, a + 4, a + 1}) sheet += std::to_string(word) + (word == a + 1 ? "\n" : " ");
  const Outcome outcome = run({"logmap", folder.write("quads.off", sheet), "--source", "4", "--u-axis", "1,0,0", "-o",
                               folder / "map.csv", "--corners", folder / "map.obj", "--radius", "1.2"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const Corners mesh(folder / "map.obj");
  EXPECT_EQ(mesh.faces.size(), 4U);
  for (const auto& face : mesh.faces)
    for (const auto& [v, vt] : face) EXPECT_EQ(vt, std::string::npos);  // every face has a corner beyond the radius

  ASSERT_EQ(run({"logmap", folder / "quads.off", "--source", "4", "--u-axis", "1,0,0", "-o", folder / "map.csv",
                 "--corners", folder / "map.obj"})
                .status,
            0);
  const Corners whole(folder / "map.obj");
  ASSERT_EQ(whole.faces.size(), 4U);
  for (const auto& face : whole.faces) {
    ASSERT_EQ(face.size(), 4U);
    for (const auto& [v, vt] : face) {
      EXPECT_NEAR(whole.places.at(vt)[0], whole.points.at(v)[0] - 1, 1e-12);
      EXPECT_NEAR(std::abs(whole.places.at(vt)[1]), std::abs(whole.points.at(v)[1] - 1), 1e-12);
    }
  }
  EXPECT_EQ(
      run({"logmap", folder / "quads.off", "--source", "4", "-o", folder / "map.csv", "--corners", folder / "m.stl"})
          .status,
      1);
  for (const char* name : {"m.ply", "m.glb"}) {
    const auto other =
        run({"logmap", folder / "quads.off", "--source", "4", "-o", folder / "map.csv", "--corners", folder / name});
    ASSERT_EQ(other.status, 0) << other.err;
    const io::Geometry back = io::read(folder / name);
    EXPECT_EQ(back.points.size(), 9U);
    EXPECT_EQ(back.face_count(), std::string(name) == "m.ply" ? 4U : 8U);
  }
}

}  // namespace
}  // namespace ahm::test
