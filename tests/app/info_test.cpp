// `ahm info`: counts, advice, and commands that work.
#include <cmath>

#include "program.hpp"
#include "shapes.hpp"

namespace ahm::test {
namespace {

class Info : public InFolder {
 protected:
  static nlohmann::json info(const std::string& file, const std::string& bytes) {
    write(file, bytes);
    return summary("info " + file);
  }

  /// Runs the command that info suggests, and returns it.
  static std::string run_suggestion(const std::string& file, const std::string& bytes) {
    const std::string suggestion = info(file, bytes).at("suggestion");
    EXPECT_TRUE(suggestion.starts_with("ahm ")) << suggestion;
    run_ok(suggestion.substr(4));
    return suggestion;
  }

  /// A closed torus, and a square with two holes as another component.
  static std::string two_parts() {
    const Mesh closed = torus(400);
    Mesh open = holed_square(20);
    open.positions = moved(open.positions, {10, 0, 0});
    return obj(closed) + obj(open, closed.vertices() + 1);
  }
};

TEST_F(Info, CountsPoints) {
  auto points = plane(20);
  points.push_back(points[3]);
  points.push_back({not_a_number, 0, 0});
  const auto json = info("plane.xyz", xyz(points));
  expect_values(json, {{"/points", 402},
                       {"/faces", 0},
                       {"/normals", false},
                       {"/duplicates", 1},
                       {"/non_finite", 1},
                       {"/components", 1},
                       {"/unit_guess", nullptr}});
  EXPECT_GT(number(json, "/spacing/smallest"), 0);
  EXPECT_LE(number(json, "/spacing/smallest"), number(json, "/spacing/median"));
  EXPECT_LE(number(json, "/spacing/median"), number(json, "/spacing/largest"));
  EXPECT_LT(number(json, "/spacing/largest"), 0.1);
  EXPECT_TRUE(has(json.at("suggestion"), "--drop-nan"));
  const auto two = info("two.xyz", xyz(joined(plane(20), moved(plane(10), {40, 0, 0}))));
  expect_values(two, {{"/components", 2}, {"/component_sizes", {400, 100}}});
  EXPECT_LT(number(two, "/central_point"), 400);
}

TEST_F(Info, SuggestsACommandThatWorks) {
  const Points points = sphere(1000);
  Points strays;  // thirty triples
  for (int k = 0; k < 30; ++k)
    strays = joined(strays, moved({{0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}}, {3. * k + 9, 0, 0}));
  for (const Points& cloud : {points, joined(points, {{not_a_number, 0, 0}}), joined(points, strays)})
    run_suggestion("cloud.xyz", xyz(cloud));
  for (const std::string& mesh :
       {obj(torus(400)), two_parts(), obj(cube_sphere(6)), obj(moebius_mesh(40, 6)), obj(voronoi_square(200))}) {
    const std::string suggestion = run_suggestion("mesh.obj", mesh);
    for (const char* option : {"--backend", "--non-manifold", "--repair"}) EXPECT_FALSE(has(suggestion, option));
  }
  EXPECT_TRUE(has(run_suggestion("book.obj", book(2)), "--non-manifold split"));
}

TEST_F(Info, SuggestsARepairWhereTheFacesHaveNoMap) {
  EXPECT_TRUE(has(run_suggestion("repeating.obj", obj(torus(400)) + "f 1 1 2\n"), "--repair"));
  const auto json = summary("info repeating.obj");
  EXPECT_TRUE(has(json.at("problem"), "twice"));
  expect_values(json, {{"/mesh/wrong_faces/repeating", 1}});
  Mesh hole = torus(400);
  hole.positions[7][1] = not_a_number;
  EXPECT_TRUE(has(run_suggestion("nan.obj", obj(hole)), "--repair"));
  const auto torn = info("torn.obj", torn_sheet(5));
  expect_values(torn, {{"/repair/welded", 96 - 25}, {"/repair/parts", 1}});
  EXPECT_TRUE(has(torn.at("suggestion"), " --repair"));
  expect_values(info("twice.obj", torn_sheet(5) + "f 1 2 3\n"), {{"/repair/duplicates", 1}});
}

TEST_F(Info, SuggestsACloudWhereNoFaceCanBeRepaired) {
  Mesh points = torus(400);
  points.faces.clear();
  const std::string suggestion = run_suggestion("points.obj", obj(points) + "f 1 1 2\n");
  EXPECT_TRUE(has(suggestion, "--backend pointcloud"));
  EXPECT_FALSE(has(suggestion, "--repair"));
  points.positions[7][1] = not_a_number;
  EXPECT_TRUE(has(run_suggestion("nan.obj", obj(points) + "f 1 1 2\n"), "--drop-nan"));
  for (const char* cloud : {"0 0 0\n1 0 0\n", "0 0 0\n1 0 0\n2 0 0\n3 0 0\n"}) {
    const auto json = info("line.xyz", cloud);
    EXPECT_NE(json.at("problem"), "");
    EXPECT_EQ(json.at("suggestion"), "");
  }
}

TEST_F(Info, HasTheTopologyOfMeshes) {
  struct Case {
    const char* file;
    std::string bytes;
    int parts, loops, euler;
    nlohmann::json genus;
  };
  for (const auto& [file, bytes, parts, loops, euler, genus] :
       std::vector<Case>{{"torus.obj", obj(torus(400)), 1, 0, 0, 1},
                         {"holes.obj", obj(holed_square(20)), 1, 3, -1, 0},
                         {"parts.obj", two_parts(), 2, 3, -1, 1},
                         {"cube.obj", obj(cube_sphere(6)), 1, 0, 2, 0},
                         {"band.obj", obj(moebius_quads(40, 6)), 1, 1, 0, nullptr}}) {
    SCOPED_TRACE(file);
    const auto json = info(file, bytes);
    expect_values(json, {{"/components", parts},
                         {"/mesh/parts", parts},
                         {"/mesh/boundary_loops", loops},
                         {"/mesh/euler_characteristic", euler},
                         {"/mesh/genus", genus},
                         {"/mesh/orientable", !genus.is_null()},
                         {"/mesh/edge_lengths/edges", json.at("mesh").at("edges")}});
    EXPECT_EQ(number(json, "/points") - number(json, "/mesh/edges") + number(json, "/faces"), euler);
    EXPECT_FALSE(json.contains("spacing"));
  }
}

TEST_F(Info, AdvisesExactMapsWhereFacesAreCoarse) {
  const auto coarse = info("coarse.obj", obj(icosphere(4)));
  expect_values(coarse, {{"/method/advice", "exact"}});
  EXPECT_GT(number(coarse, "/method/median_bend_degrees"), 5);
  expect_values(info("fine.obj", obj(icosphere(30))), {{"/method/advice", "polar"}});
  const auto flat = info("flat.obj", obj(holed_square(20)));
  expect_values(flat, {{"/method/advice", "polar"}});
  EXPECT_NEAR(number(flat, "/method/sharp_bend_degrees"), 0, 1e-6);
  expect_values(info("cloud.xyz", xyz(sphere(500))), {{"/method/advice", "polar"}, {"/method/exact_possible", false}});
}

TEST_F(Info, CountsFaultsOfMeshes) {
  expect_values(info("book.obj", book(2) + "v 5 5 5\n"), {{"/mesh/non_manifold_edges", 1},
                                                          {"/mesh/unreferenced", 1},
                                                          {"/mesh/non_manifold_vertices", 2},
                                                          {"/mesh/added_vertices", 4}});
  Mesh flat = icosphere(3);
  flat.positions[flat.faces[0][0]] = flat.positions[flat.faces[0][1]];
  EXPECT_GT(number(info("flat.obj", obj(flat)), "/mesh/degenerate_faces"), 0);
  // A square, a quad and a pentagon whose corners lie on a line, and a needle whose height is 1e-12 of its length.
  expect_values(info("lines.off",
                     "OFF\n9 4 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n2 1 0\n3 1 0\n4 1 0\n0.5 1e-12 0\n0 2 0\n"
                     "4 0 1 2 3\n4 2 4 5 6\n5 3 2 4 5 6\n3 0 1 7\n"),
                {{"/mesh/degenerate_faces", 3}});
  EXPECT_TRUE(has(run_ok("info lines.off").out, "faces without area  3\n"));
  // Two fans of faces meet in one vertex.
  expect_values(info("bow.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv -1 0 0\nv -1 -1 0\nf 1 2 3\nf 1 4 5\n"),
                {{"/mesh/non_manifold_vertices", 1}});
  EXPECT_TRUE(has(run_ok("info bow.obj").out, "1 vertex with several fans", "--non-manifold split", "adds 1 vertex"));
  Polygons turned = cube_sphere(4);
  turned.reverse(5);
  expect_values(info("turned.obj", obj(turned)), {{"/mesh/reoriented", 1}});
  expect_values(
      info("house.off",
           "OFF\n7 3 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0.5 1.5 0\n2 0 0\n2 1 0\n"
           "5 0 1 2 4 3\n4 1 5 6 2\n3 2 6 4\n"),
      {{"/mesh/faces_by_corners", {{"3", 1}, {"4", 1}, {"5", 1}}}, {"/mesh/triangles", 1}, {"/mesh/other_faces", 1}});
}

TEST_F(Info, CountsNormalsThatContradictTheFaces) {
  const Mesh sphere = icosphere(3);
  for (const int turned : {0, 5}) {
    Points normals = sphere.positions;
    for (int i = 0; i < turned; ++i) normals[i] = moved({normals[i]}, {0, 0, 0}, -1)[0];
    std::string faces;
    for (const auto& [a, b, c] : sphere.faces)
      faces += "3 " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(c) + "\n";
    expect_values(info("sphere.ply", ply({"double x", "double y", "double z", "double nx", "double ny", "double nz"},
                                         normals.size(), xyz(sphere.positions, normals), sphere.faces.size(), faces)),
                  {{"/mesh/normals_against_faces", turned}});
  }
}

TEST_F(Info, GuessesUnitsFromTheFormatOrTheCoordinates) {
  expect_values(info("far.xyz", xyz(moved(plane(10), {432000, 5412000, 0}, 50))), {{"/unit_guess", "meters"}});
  expect_values(info("part.stl",
                     "solid p\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 10 0 0\nvertex 0 10 0\n"
                     "endloop\nendfacet\nendsolid p\n"),
                {{"/unit_guess", "millimeters"}});
}

TEST_F(Info, IsReadable) {
  write("parts.obj", two_parts());
  EXPECT_TRUE(has(run_ok("info parts.obj").out, "triangles", "edge lengths", "boundary", "genus", "Euler",
                  "orientation", "components", "ahm logmap"));
  write("sphere.xyz", xyz(sphere(500), sphere(500)));
  EXPECT_TRUE(has(run_ok("info sphere.xyz").out, "points", "normals", "bounds", "spacing", "components", "ahm logmap"));
}

}  // namespace
}  // namespace ahm::test
