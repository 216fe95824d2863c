// Exact maps, paths and lines, through the program.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

#include "ahm/conformance/triangle_meshes.hpp"
#include "program.hpp"

namespace ahm::test {
namespace {

using Words = std::vector<std::string>;

std::string off(const std::vector<Vec3>& positions, const std::vector<std::vector<int>>& faces) {
  std::ostringstream text;
  text.precision(17);
  text << "OFF\n" << positions.size() << ' ' << faces.size() << " 0\n";
  for (const Vec3& p : positions) text << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
  for (const auto& face : faces) {
    text << face.size();
    for (int v : face) text << ' ' << v;
    text << '\n';
  }
  return text.str();
}

std::string off(const Mesh& mesh) {
  std::vector<std::vector<int>> faces;
  for (const Triangle& t : mesh.faces) faces.push_back({t[0], t[1], t[2]});
  return off(mesh.positions, faces);
}

/// A cube of quads: corner k lies at the bits of k.
std::string cube() {
  std::vector<Vec3> corners;
  for (int k = 0; k < 8; ++k) corners.push_back({1.0 * (k & 1), 1.0 * (k >> 1 & 1), 1.0 * (k >> 2 & 1)});
  return off(corners, {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}});
}

Words with(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

void expect_same_numbers(const std::string& a, const std::string& b, const Words& columns) {
  auto first = read_numbers(a), second = read_numbers(b);
  ASSERT_EQ(first.size(), second.size());
  ASSERT_FALSE(first.empty());
  for (std::size_t i = 0; i < first.size(); ++i)
    for (const std::string& column : columns) ASSERT_NEAR(first[i].at(column), second[i].at(column), 1e-9) << column;
}

TEST(ExactMethod, IsThatOfHeatOnAPlaneInEverySubcommandOfOneMap) {
  Folder folder;
  const std::string input = folder.write("square.off", off(flat_square(15)));
  const auto both = [&](Words words, const Words& columns) {
    for (const std::string method : {"heat", "exact"}) {
      const Outcome outcome = run(with(words, {"--method", method, "-o", folder / (method + ".csv")}));
      ASSERT_EQ(outcome.status, 0) << outcome.err;
    }
    expect_same_numbers(folder / "heat.csv", folder / "exact.csv", columns);
  };
  for (const std::string source : {"112", "face:40:.2,.3,.5"}) {
    both({"logmap", input, "--source", source, "--gradient"}, {"u", "v", "distance", "quality"});
    both({"inverse", input, "--source", source, "--at", "0.1,0.1 -.2,.15"}, {"x", "y", "z", "hx", "hy", "hz"});
    both({"coverage", input, "--source", source, "--radius", ".2", "--spacing", ".05"}, {"x", "y", "z", "arclength"});
  }
  both({"stroke", input, "--curve", "0.2,0.3,0 0.8,0.6,0"}, {"u", "v", "distance"});
  both({"cells", input, "--sources", "17 100 201"}, {"distance"});
}

TEST(ExactMethod, FindsTheCenterOfAPlane) {
  Folder folder;
  const std::string input = folder.write("square.off", off(flat_square(15)));
  for (const char* median : {"", "--median"}) {
    std::vector<Vec3> found;
    for (const std::string method : {"heat", "exact"}) {
      Words words{"center", input, "--points", "20 130 201", "--method", method, "--json", folder / "center.json"};
      if (*median != 0) words.push_back(median);
      const Outcome outcome = run(words);
      ASSERT_EQ(outcome.status, 0) << outcome.err;
      found.push_back(read_json(folder / "center.json").at("center").at("position").get<Vec3>());
    }
    for (std::size_t a = 0; a < 3; ++a) EXPECT_NEAR(found[0][a], found[1][a], 1e-9);
  }
}

TEST(ExactMethod, LabelsCellsByExactDistance) {
  Folder folder;
  const std::string input = folder.write("cube.off", cube());
  const Outcome outcome = run({"cells", input, "--sources", "0 7", "--method", "exact", "-o", folder / "cells.csv"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const double expected[] = {0, 1, 1, 1, 1, 1, 1, 0};
  const auto rows = read_numbers(folder / "cells.csv");
  for (std::size_t k = 0; k < 8; ++k) EXPECT_NEAR(rows[k].at("distance"), expected[k], 1e-12);
  for (std::size_t k : {1, 2, 4}) EXPECT_EQ(rows[k].at("label"), 0);
  for (std::size_t k : {3, 5, 6}) EXPECT_EQ(rows[k].at("label"), 1);
}

TEST(ExactMethod, MakesAnAtlas) {
  Folder folder;
  const std::string input = folder.write("square.off", off(flat_square(15)));
  const Outcome outcome = run({"atlas", input, "--charts", "5", "--method", "exact", "-o", folder / "atlas.obj",
                               "--json", folder / "atlas.json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto json = read_json(folder / "atlas.json");
  EXPECT_EQ(json.at("uncharted"), 0);
  EXPECT_NEAR(json.at("distortion").at("largest").get<double>(), 1, 1e-9);
}

TEST(ExactMethod, UnfoldsACube) {
  Folder folder;
  const std::string input = folder.write("cube.off", cube());
  const Outcome outcome = run(
      {"logmap", input, "--source", "0", "--method", "exact", "-o", folder / "map.csv", "--json", folder / "map.json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const double root2 = std::sqrt(2.0), expected[] = {0, 1, 1, root2, 1, root2, root2, std::sqrt(5.0)};
  const auto rows = read_csv(folder / "map.csv");
  ASSERT_EQ(rows.size(), 8U);
  for (std::size_t k = 0; k < 8; ++k) EXPECT_NEAR(rows[k].distance, expected[k], 1e-12);
  const auto json = read_json(folder / "map.json");
  EXPECT_EQ(json.at("method"), "exact");
  EXPECT_FALSE(json.contains("variant") || json.contains("strategy") || json.contains("t_coef"));
}

TEST(PolarMethod, IsTheDefaultWhereTrianglesAgree) {
  Folder folder;
  const std::string input = folder.write("sphere.off", off(icosphere(12)));
  const Words words{"logmap", input, "--source", "0", "-o", folder / "map.csv", "--json", folder / "map.json"};
  const auto map = [&](const Words& more) {
    const Outcome outcome = run(with(words, more));
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return read_json(folder / "map.json");
  };
  EXPECT_EQ(map({"--method", "exact"}).at("method"), "exact");
  const auto exact = read_numbers(folder / "map.csv");
  const auto chosen = map({});
  EXPECT_EQ(chosen.at("method"), "polar");
  EXPECT_EQ(chosen.at("bounded"), 0);
  EXPECT_FALSE(chosen.contains("variant") || chosen.contains("strategy"));
  auto polar = read_numbers(folder / "map.csv");
  for (std::size_t i = 0; i < polar.size(); ++i) {
    for (const char* name : {"u", "v", "distance"}) EXPECT_NEAR(polar[i][name], exact[i].at(name), 1e-9);
    EXPECT_EQ(polar[i]["error_estimate"], 0);  // windows cover so small a mesh
  }
  EXPECT_EQ(map({"--method", "polar"}).at("method"), "polar");
  EXPECT_TRUE(chosen.contains("median_error_estimate"));
  const auto heat = map({"--method", "heat"});
  EXPECT_EQ(heat.at("method"), "heat");
  EXPECT_FALSE(heat.contains("median_error_estimate"));
  EXPECT_EQ(map({"--t-coef", "2"}).at("method"), "heat");
  EXPECT_EQ(map({"--backend", "pointcloud"}).at("method"), "polar");
  EXPECT_EQ(map({"--backend", "pointcloud", "--method", "polar"}).at("method"), "polar");
  const Outcome outcome = run(with(words, {"--method", "polar", "--t-coef", "2"}));
  EXPECT_NE(outcome.status, 0);
  EXPECT_NE(outcome.err.find("polar does not use --t-coef"), std::string::npos) << outcome.err;
}

TEST(PolarMethod, MakesAnAtlasAndACenter) {
  Folder folder;
  const std::string input = folder.write("sphere.off", off(icosphere(12)));
  for (const Words& backend : {Words{}, Words{"--backend", "pointcloud"}}) {
    const Outcome atlas =
        run(with({"atlas", input, "--charts", "12", "--method", "polar", "-o", folder / "atlas.obj"}, backend));
    EXPECT_EQ(atlas.status, 0) << atlas.err;
    const Outcome center = run(with({"center", input, "--points", "3 40 77", "--method", "polar"}, backend));
    EXPECT_EQ(center.status, 0) << center.err;
  }
}

TEST(ExactMethod, TakesATolerance) {
  Folder folder;
  const std::string input = folder.write("sphere.off", off(icosphere(12)));
  const Words words{"logmap", input, "--source", "0", "-o", folder / "map.csv", "--json", folder / "map.json"};
  const auto distances = [&](const Words& more) {
    const Outcome outcome = run(with(words, more));
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return read_csv(folder / "map.csv");
  };
  const auto exact = distances({"--method", "exact"}), near = distances({"--method", "exact", "--tolerance", "0.01"});
  EXPECT_EQ(read_json(folder / "map.json").at("tolerance"), 0.01);
  ASSERT_EQ(exact.size(), near.size());
  double apart = 0;
  for (std::size_t k = 1; k < exact.size(); ++k)
    apart = std::max(apart, std::abs(near[k].distance / exact[k].distance - 1));
  EXPECT_GT(apart, 0);
  EXPECT_LE(apart, 0.01);
  EXPECT_EQ(run(with(words, {"--tolerance", "0.01"})).status, 2);
  EXPECT_EQ(run(with(words, {"--method", "exact", "--tolerance", "0.5"})).status, 2);
}

TEST(ExactMethod, TakesAToleranceInEverySubcommand) {
  Folder folder;
  const std::string input = folder.write("sphere.off", off(icosphere(8)));
  const std::vector<Words> commands{
      {"stroke", input, "--curve", "0 100 200", "-o", folder / "out.csv"},
      {"cells", input, "--count", "4", "-o", folder / "out.csv"},
      {"coverage", input, "--source", "0", "--radius", "1", "--spacing", ".3", "-o", folder / "out.csv"},
      {"inverse", input, "--source", "0", "--at", ".3,.4 .5,.1", "-o", folder / "out.csv"},
      {"atlas", input, "--charts", "3", "-o", folder / "out.obj"},
      {"center", input, "--points", "0 100 200", "--quiet"}};
  const auto result = [&](const Words& words, const Outcome& outcome) {
    return words[0] == "center" ? outcome.out : read_text(words[words.size() - 1]);
  };
  for (const Words& words : commands) {
    const Words tolerant = with(words, {"--method", "exact", "--tolerance", "0.01"});
    const Outcome outcome = run(tolerant);
    EXPECT_EQ(outcome.status, 0) << words[0] << ": " << outcome.err;
    const std::string near = result(words, outcome);
    EXPECT_FALSE(near.empty()) << words[0];
    EXPECT_EQ(result(words, run(tolerant)), near) << words[0];
    EXPECT_NE(result(words, run(with(words, {"--method", "exact"}))), near) << words[0];
    const Outcome by_heat = run(with(words, {"--tolerance", "0.01"}));
    EXPECT_EQ(by_heat.status, 2) << words[0];
    EXPECT_NE(by_heat.err.find("--tolerance"), std::string::npos) << by_heat.err;
    const Outcome too_much = run(with(words, {"--method", "exact", "--tolerance", "0.5"}));
    EXPECT_EQ(too_much.status, 2) << words[0];
    EXPECT_NE(too_much.err.find("--tolerance: '0.5' is greater than 0.1"), std::string::npos) << too_much.err;
  }
  EXPECT_NE(run({"decal", "--help"}).out.find("--tolerance"), std::string::npos);
}

TEST(ExactMethod, IsRefusedWhereThereAreNoFlatFaces) {
  Folder folder;
  const Words more{"--source", "0", "--method", "exact", "-o", folder / "map.csv"};
  const auto refused = [&](const Words& input) {
    const Outcome outcome = run(with(with({"logmap"}, input), more));
    EXPECT_EQ(outcome.status, 1);
    EXPECT_NE(outcome.err.find("--method heat"), std::string::npos) << outcome.err;
    EXPECT_FALSE(std::ifstream(folder / "map.csv").good());
  };
  refused({folder.write("plane.xyz", xyz(plane(12)))});
  refused({folder.write("square.off", off(flat_square(9))), "--backend", "pointcloud"});
  refused({folder.write("cube.off", cube()), "--discretization", "polygons"});
}

TEST(ExactMethod, RefusesTheOptionsOfHeat) {
  Folder folder;
  const std::string input = folder.write("square.off", off(flat_square(9)));
  for (const Words& option : std::vector<Words>{{"--variant", "adaptive"},
                                                {"--strategy", "auto"},
                                                {"--t-coef", "1"},
                                                {"--ordering", "amd"},
                                                {"--accuracy", "1e-6"}}) {
    const Words words{"logmap", input, "--source", "0", "-o", folder / "map.csv", "--method"};
    const Outcome outcome = run(with(with(words, {"exact"}), option));
    EXPECT_EQ(outcome.status, 2) << option[0];
    EXPECT_NE(outcome.err.find(option[0]), std::string::npos) << outcome.err;
    EXPECT_EQ(run(with(with(words, {"heat"}), option)).status, 0) << option[0];
  }
}

}  // namespace
}  // namespace ahm::test
