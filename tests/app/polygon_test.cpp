// Polygon meshes through the program.
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "program.hpp"

namespace ahm::test {
namespace {

/// A grid of m x m vertices in the unit square: quads, and an L of eight corners in the middle.
std::string quads(int m, const std::string& more = "") {
  std::ostringstream text;
  text.precision(17);
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < m; ++i)
      text << "v " << (i + 0.2 * std::sin(7.0 * j * i)) / (m - 1) << ' ' << 1.0 * j / (m - 1) << " 0\n";
  auto at = [m](int i, int j) { return j * m + i + 1; };
  const int k = m / 2;
  for (int j = 0; j + 1 < m; ++j)
    for (int i = 0; i + 1 < m; ++i)
      if ((i != k && i != k + 1) || (j != k && j != k + 1))
        text << "f " << at(i, j) << ' ' << at(i + 1, j) << ' ' << at(i + 1, j + 1) << ' ' << at(i, j + 1) << '\n';
  text << "f " << at(k + 1, k + 1) << ' ' << at(k + 2, k + 1) << ' ' << at(k + 2, k + 2) << ' ' << at(k + 1, k + 2)
       << '\n';
  text << 'f';
  for (const auto& [i, j] : {std::pair{0, 0}, {1, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}, {0, 1}})
    text << ' ' << at(k + i, k + j);
  return text.str() + "\n" + more;
}

struct Result {
  nlohmann::json json;
  std::vector<Row> rows;
};

Result solved(const std::string& mesh, const std::string& source, const std::vector<std::string>& more = {}) {
  Folder folder;
  std::vector<std::string> words{
      "logmap",           folder.write("mesh.obj", mesh), "--source=" + source, "-o", folder / "map.csv", "--json",
      folder / "run.json"};
  words.insert(words.end(), more.begin(), more.end());
  const Outcome outcome = run(words);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  if (outcome.status != 0) return {};
  return {read_json(folder / "run.json"), read_csv(folder / "map.csv")};
}

TEST(PolygonFiles, OfTrianglesAreSolvedAsPolygonsWhereThatIsAskedFor) {
  const std::string triangles = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n";
  EXPECT_EQ(solved(triangles, "0", {"--discretization", "polygons"}).json.at("backend"), "polymesh");
  EXPECT_EQ(solved(triangles, "0").json.at("backend"), "trimesh");
}

TEST(PolygonFiles, AreTheIdentityOnAFlatSheetByEitherDiscretization) {
  for (const std::string how : {"auto", "polygons", "refined"}) {
    const auto [json, rows] = solved(quads(14), "30", {"--discretization", how, "--u-axis", "1,0,0"});
    EXPECT_EQ(json.at("backend"), "polymesh");
    EXPECT_EQ(json.at("polymesh").at("discretization"), how == "polygons" ? "polygons" : "refined");
    EXPECT_EQ(json.at("polymesh").at("largest_face"), 8);
    ASSERT_EQ(rows.size(), 196u);
    for (const Row& row : rows) {
      ASSERT_NEAR(row.u, row.position[0] - rows[30].position[0], 1e-10) << how;
      ASSERT_NEAR(row.v, row.position[1] - rows[30].position[1], 1e-10) << how;
    }
  }
}

TEST(PolygonFiles, StartInsideAFace) {
  for (const std::string how : {"polygons", "refined"}) {
    const auto [json, rows] =
        solved(quads(14), "face:20:0.1,0.2,0.3,0.4", {"--discretization", how, "--u-axis", "1,0,0"});
    // Face 20 is the quad in column 7 of row 1.
    const int corner = 14 + 7;
    double p[2];
    for (int c : {0, 1})
      p[c] = 0.1 * rows[corner].position[c] + 0.2 * rows[corner + 1].position[c] + 0.3 * rows[corner + 15].position[c] +
             0.4 * rows[corner + 14].position[c];
    for (const Row& row : rows) {
      ASSERT_NEAR(row.u, row.position[0] - p[0], 1e-10) << how;
      ASSERT_NEAR(row.v, row.position[1] - p[1], 1e-10) << how;
    }
  }
}

TEST(PolygonFiles, AreNotRefinedWhereAFaceIsTwisted) {
  // A crossed pentagon beside the sheet, which falls into a component of its own.
  const std::string crossed = "v 3 1 0\nv 3 0 0\nv 5 1.5 0\nv 5 -1 0\nv 4 -0.5 0\nf 197 198 199 200 201\n";
  const auto [json, rows] = solved(quads(14, crossed), "0");
  EXPECT_EQ(json.at("polymesh").at("discretization"), "polygons");
  Folder folder;
  const Outcome refused = run({"logmap", folder.write("mesh.obj", quads(14, crossed)), "-s", "0", "-o",
                               folder / "map.csv", "--discretization", "refined"});
  EXPECT_EQ(refused.status, 1);
  EXPECT_NE(refused.err.find("--discretization polygons"), std::string::npos) << refused.err;
}

TEST(PolygonFiles, ThatAreBadAreRefused) {
  const auto refuse = [](const std::string& mesh, const std::string& source, const std::string& text) {
    Folder folder;
    const Outcome outcome =
        run({"logmap", folder.write("mesh.obj", mesh), "--source=" + source, "-o", folder / "map.csv"});
    EXPECT_EQ(outcome.status, 1);
    EXPECT_NE(outcome.err.find(text), std::string::npos) << outcome.err;
    EXPECT_EQ(folder.files(), std::vector<std::string>{"mesh.obj"});
  };
  refuse(quads(8, "v 0 0 9\nv 1 0 9\nv 0 0 8\nv 1 0 8\nf 1 2 66 65\nf 1 2 68 67\n"), "0",
         "1 edge has more than two faces");
  refuse(quads(8, "f 1 2 3 2\n"), "0", "vertex twice");
  refuse(quads(8), "64", "64 vertices");
  refuse(quads(8), "face:3:0.5,0.25,0.25", "4 corners");
}

TEST(PolygonFiles, KeepTheirFacesInPly) {
  Folder folder;
  const auto input = folder.write("mesh.obj", quads(14));
  ASSERT_EQ(run({"logmap", input, "-s", "0", "-o", folder / "map.ply"}).status, 0);
  // What was written is a polygon mesh again.
  const Outcome again = run({"logmap", folder / "map.ply", "-s", "0", "-o", folder / "again.csv", "--json", "-"});
  ASSERT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(nlohmann::json::parse(again.out).at("polymesh").at("largest_face"), 8);
}

// The mean of the corners of a U lies between its arms.
TEST(PolygonCommand, SaysThatAPointLiesOutsideOfItsFace) {
  Folder folder;
  const std::string input =
      folder.write("u.off", "OFF\n8 1 0\n0 0 0\n3 0 0\n3 3 0\n2 3 0\n2 1 0\n1 1 0\n1 3 0\n0 3 0\n8 0 1 2 3 4 5 6 7\n");
  const auto outcome = [&](const std::string& weights) {
    const Outcome found =
        run({"logmap", input, "--source", "face:0:" + weights, "-o", folder / "map.csv", "--json", "-"});
    EXPECT_EQ(found.status, 0) << found.err;
    return found;
  };
  const Outcome outside = outcome(".125,.125,.125,.125,.125,.125,.125,.125");
  EXPECT_NE(outside.err.find("outside of its face"), std::string::npos) << outside.err;
  EXPECT_EQ(outcome(".4,.3,0,0,.1,.1,0,.1").err.find("outside of its face"), std::string::npos);
}

}  // namespace
}  // namespace ahm::test
