#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <sstream>

#include "ahm/conformance/polygon_meshes.hpp"
#include "ahm/conformance/triangle_meshes.hpp"
#include "program.hpp"

namespace ahm::test {
namespace {

TEST(Info, CountsWhatIsThere) {
  Folder folder;
  auto points = plane(20);
  points.push_back(points[3]);
  points.push_back({std::numeric_limits<double>::quiet_NaN(), 0, 0});
  const auto input = folder.write("plane.xyz", xyz(points));
  const auto outcome = run({"info", input, "--json", "-"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json.at("points"), points.size());
  EXPECT_EQ(json.at("faces"), 0);
  EXPECT_EQ(json.at("normals"), false);
  EXPECT_EQ(json.at("duplicates"), 1);
  EXPECT_EQ(json.at("non_finite"), 1);
  EXPECT_EQ(json.at("components"), 1);
  const auto& spacing = json.at("spacing");
  EXPECT_GT(spacing.at("smallest").get<double>(), 0.0);
  EXPECT_LE(spacing.at("smallest").get<double>(), spacing.at("median").get<double>());
  EXPECT_LE(spacing.at("median").get<double>(), spacing.at("largest").get<double>());
  EXPECT_LT(spacing.at("largest").get<double>(), 0.1);
  EXPECT_NE(json.at("suggestion").get<std::string>().find("--drop-nan"), std::string::npos);
}

nlohmann::json info(const std::string& input) {
  const auto outcome = run({"info", input, "--json", "-"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  return nlohmann::json::parse(outcome.out);
}

/// Runs what is suggested, its files in the folder, and returns the words.
std::string run_suggestion(const std::string& input, const Folder& folder) {
  const std::string suggestion = info(input).at("suggestion");
  std::istringstream words(suggestion);
  std::vector<std::string> arguments;
  for (std::string word; words >> word;) arguments.push_back(word);
  EXPECT_EQ(arguments.at(0), "ahm");
  arguments.erase(arguments.begin());
  for (std::size_t i = 0; i + 1 < arguments.size(); ++i)
    if (arguments[i] == "-o" || arguments[i] == "--view") arguments[i + 1] = folder / arguments[i + 1];
  const auto outcome = run(arguments);
  EXPECT_EQ(outcome.status, 0) << suggestion << '\n' << outcome.err;
  return suggestion;
}

std::string vertices(const std::vector<Vec3>& positions) {
  std::ostringstream text;
  text.precision(17);
  for (const Vec3& p : positions) text << "v " << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
  return text.str();
}

/// @param first  number of the mesh's first vertex in the file, from 1
std::string obj(const Mesh& mesh, Index first = 1) {
  std::ostringstream text;
  for (const auto& [a, b, c] : mesh.faces) text << "f " << a + first << ' ' << b + first << ' ' << c + first << '\n';
  return vertices(mesh.positions) + text.str();
}

std::string obj(const Polygons& mesh) {
  std::ostringstream text;
  for (Index f = 0; f < mesh.faces(); ++f) {
    text << "f";
    for (Index corner : mesh.face(f)) text << ' ' << corner + 1;
    text << '\n';
  }
  return vertices(mesh.positions) + text.str();
}

/// A closed torus and, apart from it, a square with two holes.
std::string two_parts() {
  const Mesh closed = torus(400);
  Mesh open = holed_square(20);
  for (Vec3& p : open.positions) p[0] += 10;
  return obj(closed) + obj(open, closed.vertices() + 1);
}

/// Three flat sheets that meet in one edge.
std::string book() {
  std::string text = "v 0 0 0\nv 0 0 1\n";
  for (int sheet = 0; sheet < 3; ++sheet) {
    const double angle = 2.1 * sheet, x = std::cos(angle), y = std::sin(angle);
    text += vertices({{x, y, 0}, {x, y, 1}});
    const std::string c = std::to_string(3 + 2 * sheet), d = std::to_string(4 + 2 * sheet);
    text += "f 1 " + c + " 2\nf 2 " + c + " " + d + "\n";
  }
  return text;
}

TEST(Info, SuggestsACommandThatWorksOnClouds) {
  Folder folder;
  run_suggestion(folder.write("sphere.xyz", xyz(sphere(1000))), folder);
  auto points = sphere(1000);
  points.push_back({std::numeric_limits<double>::quiet_NaN(), 0, 0});
  run_suggestion(folder.write("hole.xyz", xyz(points)), folder);
  points = sphere(1000);  // and thirty triples of stray points
  for (int k = 0; k < 30; ++k)
    for (const Vec3& p : {Vec3{0, 0, 0}, Vec3{0.1, 0, 0}, Vec3{0, 0.1, 0}})
      points.push_back({p[0] + 3. * k + 9, p[1], p[2]});
  run_suggestion(folder.write("strays.xyz", xyz(points)), folder);
}

TEST(Info, SuggestsACommandThatWorksOnMeshes) {
  Folder folder;
  const std::pair<const char*, std::string> meshes[] = {{"torus.obj", obj(torus(400))},
                                                        {"parts.obj", two_parts()},
                                                        {"cube.obj", obj(cube_sphere(6))},
                                                        {"band.obj", obj(moebius_mesh(40, 6))},
                                                        {"cells.obj", obj(voronoi_square(200))}};
  for (const auto& [name, text] : meshes) {
    const std::string words = run_suggestion(folder.write(name, text), folder);
    EXPECT_EQ(words.find("--backend"), std::string::npos) << words;
    EXPECT_EQ(words.find("--non-manifold"), std::string::npos) << words;
  }
  const std::string words = run_suggestion(folder.write("book.obj", book()), folder);
  EXPECT_NE(words.find("--non-manifold split"), std::string::npos) << words;
}

TEST(Info, SuggestsToRepairWhereTheFacesAsTheyAreHaveNoMap) {
  Folder folder;
  const std::string wrong_face = folder.write("wrong.obj", obj(torus(400)) + "f 1 1 2\n");
  EXPECT_NE(run_suggestion(wrong_face, folder).find("--repair"), std::string::npos);
  const auto json = info(wrong_face);
  EXPECT_NE(json.at("problem").get<std::string>().find("twice"), std::string::npos);
  EXPECT_EQ(json.at("mesh").at("wrong_faces").at("repeating"), 1);
  Mesh hole = torus(400);
  hole.positions[7][1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(run_suggestion(folder.write("nan.obj", obj(hole)), folder).find("--repair"), std::string::npos);
}

TEST(Info, SuggestsTheVerticesAsACloudWhereNoFaceCanBeRepaired) {
  Folder folder;
  Mesh points = torus(400);
  points.faces.clear();
  const std::string words = run_suggestion(folder.write("points.obj", obj(points) + "f 1 1 2\n"), folder);
  EXPECT_NE(words.find("--backend pointcloud"), std::string::npos) << words;
  EXPECT_EQ(words.find("--repair"), std::string::npos) << words;
  points.positions[7][1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(run_suggestion(folder.write("nan.obj", obj(points) + "f 1 1 2\n"), folder).find("--drop-nan"),
            std::string::npos);
}

TEST(Info, TellsTheTopologyOfMeshes) {
  struct Expected {
    const char* name;
    std::string text;
    int parts, loops, euler;
    nlohmann::json genus;
  };
  const Expected all[] = {{"torus.obj", obj(torus(400)), 1, 0, 0, 1},
                          {"holes.obj", obj(holed_square(20)), 1, 3, -1, 0},
                          {"parts.obj", two_parts(), 2, 3, -1, 1},
                          {"cube.obj", obj(cube_sphere(6)), 1, 0, 2, 0},
                          {"band.obj", obj(moebius_quads(40, 6)), 1, 1, 0, nullptr}};
  Folder folder;
  for (const auto& [name, text, parts, loops, euler, genus] : all) {
    const auto json = info(folder.write(name, text));
    const auto& mesh = json.at("mesh");
    EXPECT_EQ(mesh.at("parts"), parts) << name;
    EXPECT_EQ(json.at("components"), parts) << name;
    EXPECT_EQ(mesh.at("boundary_loops"), loops) << name;
    EXPECT_EQ(mesh.at("euler_characteristic"), euler) << name;
    EXPECT_EQ(json.at("points").get<int>() - mesh.at("edges").get<int>() + json.at("faces").get<int>(), euler) << name;
    EXPECT_EQ(mesh.at("genus"), genus) << name;
    EXPECT_EQ(mesh.at("orientable"), !genus.is_null()) << name;
    EXPECT_EQ(mesh.at("edge_lengths").at("edges"), mesh.at("edges")) << name;
    EXPECT_FALSE(json.contains("spacing")) << name;
  }
}

TEST(Info, AdvisesExactMapsWhereFacesAreCoarse) {
  Folder folder;
  const auto method = [&](const std::string& name, const std::string& text) {
    return info(folder.write(name, text)).at("method");
  };
  const auto coarse = method("coarse.obj", obj(icosphere(4)));
  EXPECT_EQ(coarse.at("advice"), "exact");
  EXPECT_GT(coarse.at("median_bend_degrees").get<double>(), 5);
  // Fine, flat, and without faces.
  EXPECT_EQ(method("fine.obj", obj(icosphere(30))).at("advice"), "polar");
  const auto flat = method("flat.obj", obj(holed_square(20)));
  EXPECT_EQ(flat.at("advice"), "polar");
  EXPECT_NEAR(flat.at("sharp_bend_degrees").get<double>(), 0, 1e-6);
  const auto cloud = method("cloud.xyz", xyz(sphere(500)));
  EXPECT_EQ(cloud.at("advice"), "polar");
  EXPECT_EQ(cloud.at("exact_possible"), false);
}

TEST(Info, CountsWhatIsWrongWithAMesh) {
  Folder folder;
  const auto json = info(folder.write("book.obj", book() + "v 5 5 5\n"));
  EXPECT_EQ(json.at("mesh").at("non_manifold_edges"), 1);
  EXPECT_EQ(json.at("mesh").at("unreferenced"), 1);
  Mesh flat = icosphere(3);
  flat.positions[flat.faces[0][0]] = flat.positions[flat.faces[0][1]];
  EXPECT_GT(info(folder.write("flat.obj", obj(flat))).at("mesh").at("degenerate_faces"), 0);
  // A square, a quadrilateral and a pentagon whose corners lie on a line, and a needle of a 10^12th of its length.
  const std::string lines =
      folder.write("lines.off",
                   "OFF\n9 4 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n2 1 0\n3 1 0\n4 1 0\n0.5 1e-12 0\n0 2 0\n"
                   "4 0 1 2 3\n4 2 4 5 6\n5 3 2 4 5 6\n3 0 1 7\n");
  EXPECT_EQ(info(lines).at("mesh").at("degenerate_faces"), 3);
  const std::string text = run({"info", lines}).out;
  EXPECT_NE(text.find("faces without area  3\n"), std::string::npos) << text;
  // Two fans of faces meet in one vertex; three pages in an edge.
  const std::string bow = folder.write("bow.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv -1 0 0\nv -1 -1 0\nf 1 2 3\nf 1 4 5\n");
  EXPECT_EQ(info(bow).at("mesh").at("non_manifold_vertices"), 1);
  EXPECT_NE(
      run({"info", bow})
          .out.find("1 vertex with several fans of faces; --non-manifold split cuts the mesh there and adds 1 vertex"),
      std::string::npos);
  EXPECT_EQ(json.at("mesh").at("non_manifold_vertices"), 2);
  EXPECT_EQ(json.at("mesh").at("added_vertices"), 4);
  Polygons turned = cube_sphere(4);
  turned.reverse(5);
  EXPECT_EQ(info(folder.write("turned.obj", obj(turned))).at("mesh").at("reoriented"), 1);
}

TEST(Info, CountsFacesByTheirCorners) {
  Folder folder;
  const auto mesh = info(folder.write("house.off",
                                      "OFF\n7 3 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0.5 1.5 0\n2 0 0\n2 1 0\n"
                                      "5 0 1 2 4 3\n4 1 5 6 2\n3 2 6 4\n"))
                        .at("mesh");
  EXPECT_EQ(mesh.at("faces_by_corners"), (nlohmann::json{{"3", 1}, {"4", 1}, {"5", 1}}));
  EXPECT_EQ(mesh.at("triangles"), 1);
  EXPECT_EQ(mesh.at("other_faces"), 1);
}

TEST(Info, CountsNormalsThatContradictTheFaces) {
  Folder folder;
  const Mesh sphere = icosphere(3);
  for (const int turned : {0, 5}) {
    std::string text = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(sphere.positions.size()) + "\n";
    for (const char* name : {"x", "y", "z", "nx", "ny", "nz"}) text += std::string("property double ") + name + "\n";
    text += "element face " + std::to_string(sphere.faces.size()) +
            "\nproperty list uchar int vertex_indices\nend_header\n";
    for (std::size_t i = 0; i < sphere.positions.size(); ++i) {
      const double side = static_cast<int>(i) < turned ? -1 : 1;
      for (const double scale : {1.0, side})
        for (const double x : sphere.positions[i]) text += std::to_string(scale * x) + " ";
      text += "\n";
    }
    for (const Triangle& t : sphere.faces)
      text += "3 " + std::to_string(t[0]) + " " + std::to_string(t[1]) + " " + std::to_string(t[2]) + "\n";
    EXPECT_EQ(info(folder.write("sphere.ply", text)).at("mesh").at("normals_against_faces"), turned);
  }
}

TEST(Info, GuessesUnitsWhereTheFormatOrTheCoordinatesTell) {
  Folder folder;
  std::vector<Vec3> far = plane(10);
  for (Vec3& p : far) p = {432000 + 50 * p[0], 5412000 + 50 * p[1], p[2]};
  EXPECT_EQ(info(folder.write("far.xyz", xyz(far))).at("unit_guess"), "meters");
  EXPECT_EQ(info(folder.write("near.xyz", xyz(plane(10)))).at("unit_guess"), nullptr);
  EXPECT_EQ(info(folder.write("part.stl",
                              "solid p\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 10 0 0\n"
                              "vertex 0 10 0\nendloop\nendfacet\nendsolid p\n"))
                .at("unit_guess"),
            "millimeters");
}

TEST(Info, SpeaksOfMeshesToPeopleToo) {
  Folder folder;
  const auto outcome = run({"info", folder.write("parts.obj", two_parts())});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  for (const char* word :
       {"triangles", "edge lengths", "boundary", "genus", "Euler", "orientation", "components", "ahm logmap"})
    EXPECT_NE(outcome.out.find(word), std::string::npos) << outcome.out;
}

TEST(Info, SpeaksToPeopleToo) {
  Folder folder;
  const auto outcome = run({"info", folder.write("sphere.xyz", xyz(sphere(500), sphere(500)))});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  for (const char* word : {"points", "normals", "bounds", "spacing", "components", "ahm logmap"})
    EXPECT_NE(outcome.out.find(word), std::string::npos) << outcome.out;
}

TEST(Info, NamesTheProblemOfACloudThatCannotBeMapped) {
  Folder folder;
  for (const std::string cloud : {"0 0 0\n1 0 0\n", "0 0 0\n1 0 0\n2 0 0\n3 0 0\n"}) {
    const auto outcome = run({"info", folder.write("line.xyz", cloud), "--json", "-"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const auto json = nlohmann::json::parse(outcome.out);
    EXPECT_FALSE(json.at("problem").get<std::string>().empty());
    EXPECT_EQ(json.at("suggestion"), "");
  }
}

TEST(Info, CountsComponents) {
  Folder folder;
  auto points = plane(20);
  for (Vec3 p : plane(10)) points.push_back({p[0] + 40, p[1], p[2]});
  const auto json = nlohmann::json::parse(run({"info", folder.write("two.xyz", xyz(points)), "--json", "-"}).out);
  EXPECT_EQ(json.at("components"), 2);
  EXPECT_EQ(json.at("component_sizes"), (std::vector<int>{400, 100}));
  EXPECT_LT(json.at("central_point").get<int>(), 400);
}

}  // namespace
}  // namespace ahm::test
