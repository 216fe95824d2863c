// Coverage paths, and points at coordinates of a map.
#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "program.hpp"
#include "shapes.hpp"

namespace ahm::test {
namespace {

using Coverage = InFolder;

TEST_F(Coverage, IsARasterOnAPlaneOfPoints) {
  const auto points = plane(30);  // point 0 is its middle
  write("plane.xyz", xyz(points));
  const auto json = summary("coverage plane.xyz --source 0 --radius 0.4 --spacing 0.05 --u-axis 1,0,0 -o path.csv");
  const auto rows = read_csv("path.csv");
  ASSERT_GT(rows.size(), 100U);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row& p = rows[i];
    const double across = p["y"] - points[0][1], line = (p["line"] - 8) * 0.05;
    EXPECT_EQ(p["index"], static_cast<double>(i));
    EXPECT_NEAR(std::abs(across), std::abs(line), 1e-9);  // the normal of the plane may have either sign
    EXPECT_NEAR(std::hypot(p["u"], p["v"]), std::hypot(p["x"] - points[0][0], across), 1e-9);
    EXPECT_NEAR(p["z"], 0, 1e-12);
    EXPECT_NEAR(std::abs(p["nz"]), 1, 1e-9);
    EXPECT_NEAR(p["hx"], static_cast<int>(p["line"]) % 2 == 0 ? 1 : -1, 1e-6);
    EXPECT_NEAR(p["spacing"], 0.05, 1e-6);
  }
  expect_values(json, {{"/points", rows.size()}, {"/pieces", 17 - 2}});  // the outermost lines are points
  EXPECT_GT(number(json, "/covered"), 0.98);
}

TEST_F(Coverage, IsASpiralOnASphereOfPoints) {
  write("sphere.xyz", xyz(sphere(3000)));
  const auto rows = table("coverage sphere.xyz -s 0 --radius 1.2 --spacing 0.1 --pattern spiral");
  ASSERT_GT(rows.size(), 100U);
  const double h = 0.07;  // spacing of the points
  double side = 0;
  for (const Row& p : rows) {
    EXPECT_NEAR(std::hypot(p["x"], p["y"], p["z"]), 1, h * h);
    EXPECT_NEAR(std::acos(std::min(1.0, p["z"])), std::hypot(p["u"], p["v"]), h);
    const double outwards = p["nx"] * p["x"] + p["ny"] * p["y"] + p["nz"] * p["z"];
    EXPECT_GT(std::abs(outwards), 0.9);
    if (side == 0) side = outwards;
    EXPECT_GT(outwards * side, 0);  // all normals on one side
    EXPECT_NEAR(p["hx"] * p["nx"] + p["hy"] * p["ny"] + p["hz"] * p["nz"], 0, 1e-9);
  }
}

TEST_F(Coverage, StaysOnTheFacesOfAMesh) {
  // A square of quads with a hole of 4 x 4 cells; some faces are listed with the opposite orientation.
  constexpr int m = 21;
  Faces faces = cells(m);
  std::erase_if(faces, [](const std::vector<int>& face) {
    const int x = face[0] % m, y = face[0] / m;
    return x >= 12 && x < 16 && y >= 8 && y < 12;
  });
  for (auto& face : faces)
    if ((face[0] % m + face[0] / m) % 5 == 0) std::swap(face[1], face[3]);
  write("plate.obj", obj(lattice(m, 0.1), faces));
  std::map<double, std::map<double, int>> pieces;
  for (const Row& p : table("coverage plate.obj --source 1,1,0 --radius 0.9 --spacing 0.1 --angle 30")) {
    EXPECT_FALSE(p["x"] > 1.201 && p["x"] < 1.599 && p["y"] > 0.801 && p["y"] < 1.199) << p["x"] << ' ' << p["y"];
    EXPECT_NEAR(p["z"], 0, 1e-12);
    ++pieces[p["line"]][p["piece"]];
  }
  EXPECT_GE(std::ranges::count_if(pieces, [](const auto& line) { return line.second.size() > 1; }), 2);
}

TEST_F(Coverage, IsWrittenAsPolylinesToPly) {
  write("plane.xyz", xyz(plane(20)));
  const auto json = summary("coverage plane.xyz --source 0 --radius 0.3 --spacing 0.1 -o path.ply");
  const std::size_t points = json.at("points"), pieces = json.at("pieces");
  const std::string text = read_text("path.ply"), body = text.substr(text.find("end_header\n") + 11);
  EXPECT_TRUE(has(text, "element vertex " + std::to_string(points) + "\n",
                  "element edge " + std::to_string(points - pieces) + "\n"));
  EXPECT_EQ(std::ranges::count(body, '\n'), static_cast<std::ptrdiff_t>(2 * points - pieces));
}

// A plane is exact at any diffusion time.
TEST_F(Coverage, AndInverseMapAreTheSameOnTheSurroundings) {
  write("plane.xyz", xyz(plane(40), Points(1600, Vec3{0, 0, 1})));
  for (const auto& [command, least] : std::map<std::string, std::size_t>{
           {"coverage plane.xyz --radius 0.2 --spacing 0.04", 50}, {"inverse plane.xyz --at '0.1,0.2 -0.05,0.1'", 2}}) {
    const auto expected = table(command + " -s 0 --u-axis 1,0,0"),
               rows = table(command + " -s 0 --u-axis 1,0,0 --local");
    EXPECT_GE(expected.size(), least);
    ASSERT_EQ(rows.size(), expected.size());
    for (std::size_t i = 0; i < rows.size(); ++i)
      for (const auto& [name, value] : expected[i].numbers)
        if (!std::isnan(value) || !std::isnan(rows[i][name])) EXPECT_NEAR(rows[i][name], value, 1e-9) << name;
  }
}

// The whole sphere of points, and a disc of it: poses, kinds, and the report.
TEST_F(Coverage, CoversAWholePart) {
  write("sphere.xyz", xyz(sphere(3000)));
  write("circle.txt", "0.8,0,0.6\n0.5,0.7,0.5\n0,0.8,0.6\n-0.8,0,0.6\n0,-0.8,0.6\n");
  for (const std::string region : {"", " --source 0 --radius 1", " --inside circle.txt"}) {
    const auto json = summary("coverage sphere.xyz --whole --spacing 0.2 -o path.csv" + region);
    EXPECT_GT(number(json, "/covered"), 0.99);
    EXPECT_LT(number(json, "/largest_gap"), 1.25);
    EXPECT_LT(number(json, "/double_covered"), 0.03);
    EXPECT_NEAR(number(json, "/area"),
                region.empty()          ? 4 * pi
                : region.ends_with("1") ? 2 * pi * (1 - std::cos(1))
                                        : 2,
                0.3);
    const auto rows = read_csv("path.csv");
    expect_values(json, {{"/points", rows.size()}, {"/links/missing", 0}});
    std::size_t on_passes = 0;
    for (const auto& pass : json.at("passes")) on_passes += pass.at("points").get<std::size_t>();
    EXPECT_LT(on_passes, rows.size());
    for (const Row& p : rows) {
      EXPECT_LE(p["pass"], static_cast<double>(json.at("passes").size() - 1));
      EXPECT_NEAR(std::hypot(p["nx"], p["ny"], p["nz"]), 1, 1e-9);
      EXPECT_NEAR(std::hypot(std::hypot(p["qw"], p["qx"]), std::hypot(p["qy"], p["qz"])), 1, 1e-9);
    }
  }
}

/// A box around the origin.
std::pair<Points, Faces> box_around(double size) {
  Points points;
  for (int k = 0; k < 8; ++k)
    points.push_back({size * ((k & 1) - 0.5), size * ((k & 2) / 2 - 0.5), size * (k / 4 - 0.5)});
  return {points, {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
}

// No link leads to a box in a box.
TEST_F(Coverage, MarksMissingLinks) {
  auto [points, faces] = box_around(3);
  const auto [inner, inner_faces] = box_around(1);
  for (const std::vector<int>& face : inner_faces)
    faces.push_back({face[0] + 8, face[1] + 8, face[2] + 8, face[3] + 8});
  points.insert(points.end(), inner.begin(), inner.end());
  write("nested.obj", obj(points, faces));
  const auto json = summary("coverage nested.obj --whole --spacing 0.4 -o path.csv");
  expect_values(json, {{"/links/missing", 1}});
  const auto rows = read_csv("path.csv");
  double length = 0, missing = 0;
  for (std::size_t k = 1; k < rows.size(); ++k) {
    const bool is_missing = rows[k].status == "missing";
    missing += is_missing;
    if (!is_missing)
      length +=
          std::hypot(rows[k]["x"] - rows[k - 1]["x"], rows[k]["y"] - rows[k - 1]["y"], rows[k]["z"] - rows[k - 1]["z"]);
    EXPECT_NEAR(rows[k]["arclength"], length, 1e-9 * length);
  }
  EXPECT_EQ(missing, 1);
  const std::string ply = (run_ok("coverage nested.obj --whole --spacing 0.4 -o path.ply"), read_text("path.ply"));
  EXPECT_TRUE(has(ply, "element edge " + std::to_string(rows.size() - 2) + "\n"));
  expect_refused("coverage nested.obj --whole --spacing 0.4",
                 {{"-o path.ngc --axes 5 --feed 800", 1, {"1 missing link"}}, {"-o path.yaml", 1, {"1 missing link"}}});
}

TEST_F(Coverage, IsParallelToAFeatureEdge) {
  const auto [points, faces] = box_around(2);
  write("box.obj", obj(points, faces));
  for (const auto& [near, axis] : std::map<std::string, std::string>{{"0,1,1", "x"}, {"-1,0.2,-1", "y"}}) {
    const auto json =
        summary("coverage box.obj --whole --spacing 0.3 --seed-feature 80 --seed-near " + near + " -o path.csv");
    EXPECT_GT(number(json, "/covered"), 0.99);
    const auto rows = read_csv("path.csv");
    for (const auto& pass : json.at("passes"))
      if (pass.at("kind") == "seed") {
        EXPECT_NEAR(pass.at("length").get<double>(), 2, 1e-9);
        const std::size_t first = pass.at("first"), last = first + pass.at("points").get<std::size_t>() - 1;
        EXPECT_NEAR(std::abs(rows[last][axis] - rows[first][axis]), 2, 1e-9);
      }
  }
  expect_refused(
      "coverage box.obj --whole --spacing 0.3 -o path.csv",
      {{"--seed-feature 100", 1, {"nowhere by 100 degrees"}},
       {"--seed-feature 0", 2, {"the angle is zero"}},
       {"--seed-near 1,1,1", 2, {"--seed-near requires --seed-feature"}},
       {"--seed-feature 80 --seed-near 9,9,9", 1, {"the point near the feature edge is", "from the surface"}},
       {"--seed-feature 80 --seed-boundary", 2, {"excludes"}}});
}

// A scan of a sphere without a cap, with outliers and a point without return.
TEST_F(Coverage, GivesTheReasonOfEveryRowOfAScan) {
  Points scan;
  for (const Vec3& p : sphere(3000))
    if (p[2] < 0.7) scan.push_back(p);
  const std::size_t good = scan.size();
  for (const Vec3& p : {Vec3{0, 0, 9}, Vec3{0, 20, 0}, Vec3{40, 0, 0}}) scan.push_back(p);
  write("scan.xyz", xyz(scan) + "nan 0 0\n");
  const auto json = summary("coverage scan.xyz --drop-nan --whole --spacing 0.2 -o path.csv --rows rows.csv");
  const auto rows = read_csv("rows.csv");
  ASSERT_EQ(rows.size(), good + 4);
  std::map<std::string, std::size_t> counts;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const std::string& reason = rows[r].status;
    ++counts[reason];
    if (r < good) EXPECT_TRUE(reason == "covered" || reason == "gap") << reason;
    if (r >= good) EXPECT_TRUE(reason == "removed" || reason == "no_triangle") << reason;
  }
  EXPECT_GT(counts["covered"], 0.99 * static_cast<double>(good));
  for (const auto& [reason, count] : counts) expect_values(json, {{"/rows/" + reason, count}});
  EXPECT_TRUE(has(run_ok("coverage scan.xyz --drop-nan --whole --spacing 0.2 -o path.csv").out, "rows not covered: "));
  // Outliers that triangles join are named.
  std::mt19937 random(1);
  std::uniform_real_distribution<double> far(-4, 4);
  for (int k = 0; k < 40; ++k) scan.push_back({far(random), far(random), far(random)});
  write("scan.xyz", xyz(scan));
  EXPECT_TRUE(has(run_ok("coverage scan.xyz --whole --spacing 0.3 -o path.csv").err, "between outliers"));
  expect_refused("coverage scan.xyz --whole --spacing 0.3 -o path.csv",
                 {{"--rows path.csv", 1, {"--rows", "the same file"}}, {"--rows rows.gif", 1, {"rows.gif"}}});
}

TEST_F(Coverage, JoinsClosedPassesToASpiral) {
  write("sphere.xyz", xyz(sphere(3000)));
  const std::string command = "coverage sphere.xyz --whole --spacing 0.1 --pattern spiral -o path.csv";
  const auto json = summary(command + " --seed-plane 0,0,0,0,0,1");
  expect_values(json, {{"/spirals", 2}});
  EXPECT_GT(number(json, "/covered"), 0.99);
  EXPECT_LT(number(json, "/double_covered"), 0.03);
  EXPECT_LE(json.at("passes").size(), 5U);
  EXPECT_TRUE(has(run_ok(command + " --facing 0,0,1 --max-angle 5 --seed-line 0,0,1 --direction 30").err, "no spiral"));
}

TEST_F(Coverage, OfAWholePartIsWrittenForMachinesAndRobots) {
  write("box.obj", obj({{0, 0, 0}, {4, 0, 0}, {4, 3, 0}, {0, 3, 0}, {0, 0, 2}, {4, 0, 2}, {4, 3, 2}, {0, 3, 2}},
                       {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}));
  const std::string command = "coverage box.obj --whole --spacing 0.5 --offset 0.25 --lag 10 ";
  run_ok(command + "--feed 30 -o path.csv");
  const auto rows = read_csv("path.csv");
  for (const Row& p : rows) EXPECT_NEAR(p["time"], 2 * p["arclength"], 1e-9);
  for (const std::string name : {"path.obj", "path.json", "path.yaml"}) run_ok(command + "-o " + name);
  run_ok(command + "--feed 800 --axes 5 -o path.ngc");
  EXPECT_TRUE(has(read_text("path.ngc"), "G21 ", "G64 P0.0025", " F800"));
  EXPECT_TRUE(has(read_text("path.yaml"), "frame_id: \"map\"", "\npose"));
  EXPECT_TRUE(has(read_text("path.obj"), "g pass\n", "g link\n"));
  std::size_t runs = 0, points = 0;
  const auto json = read_json("path.json");
  for (const auto& run : json.at("runs")) {
    if (run.at("position").size() > 1) ++runs, points += run.at("position").size();
    EXPECT_EQ(run.at("quaternion").size(), run.at("position").size());
    const auto matrix = run.at("matrix").at(0);
    for (int r = 0; r < 3; ++r) EXPECT_EQ(matrix[r][3], run.at("position")[0][r]);
  }
  EXPECT_EQ(obj_lines("path.obj", "l").size(), runs);
  EXPECT_EQ(obj_lines("path.obj", "v").size(), points);
  expect_refused("coverage box.obj --whole --spacing 0.5",
                 {{"-o path.ngc", 1, {"G-code needs a feed rate; use --feed"}},
                  {"-o path.ngc --feed 800", 1, {"faces sideways or down", "use 5 axes"}},
                  {"-o path.txt", 1, {"must end in", ".ngc or .yaml"}},
                  {"-o path.csv --axes 5", 1, {"--axes has no effect"}},
                  {"-o path.ngc --feed 800 --frame part", 1, {"--frame has no effect"}},
                  {"-o path.yaml --feed 800", 1, {"--feed has no effect", "PoseArray"}},
                  {"-o path.csv --format ngc", 1, {"use --feed"}},
                  {"-o path.yaml --frame 'a\nb'", 1, {"line break"}},
                  {"-o path.csv --lead 90", 2, {"not between -90 and 90 degrees"}},
                  {"-o path.csv --lead 10 --lag 10", 2, {"--lag"}}});
}

TEST_F(Coverage, RefusesPartsItCannotCover) {
  write("sphere.xyz", xyz(sphere(500)));
  expect_refused(
      "coverage sphere.xyz -o path.csv",
      {{"--whole --spacing 9", 1, {"the spacing, 9, is larger than the region"}},
       {"--whole --spacing 0.2 --seed-boundary", 1, {"no boundary"}},
       {"--whole --spacing 0.2 --seed-plane 0,0,4,0,0,1", 1, {"does not cross the region"}},
       {"--whole --spacing 0.2 --seed-plane 0,0,4", 2, {"six numbers"}},
       {"--whole --spacing 0.2 --seed-curve '0,0,1 0,0,3'", 1, {"point 1 of the seed curve"}},
       {"--whole --spacing 0.2 --inside '1,0,0 0,1,0 0,0,3'", 1, {"point 2 of the region curve"}},
       {"--whole --spacing 0.2 --inside '1,0,0 0,1,0'", 1, {"2 points", "at least three"}},
       {"--whole --spacing 0.2 --angle 30", 2, {"--angle", "--whole"}},
       {"--whole --spacing 0.2 --seed-line 0,0,3 --direction 1,0,0",
        1,
        {"the point of the seed line is", "from the surface"}},
       {"--whole --spacing 0.2 --seed-line 0,0,1 --direction 0,0,1", 1, {"perpendicular to the surface"}},
       {"--whole --spacing 0.2 --source 0,0,3 --radius 1", 1, {"the center of the region is", "from the surface"}},
       {"--whole --spacing 0.2 --mask m", 1, {"--mask m"}},
       {"--whole --spacing 0.2 --facing 0,0,1 --max-angle 0.001", 1, {"no triangle lies in the region"}},
       {"--whole --spacing 0.2 --facing 0,0,1 --max-angle 200", 2, {"not between 0 and 180"}},
       {"--spacing 0.2 --clearance 1", 2, {"--clearance requires --whole"}},
       {"--spacing 0.2", 2, {"--source is required"}}});
}

using Isolines = InFolder;

TEST_F(Isolines, OfAColumnAndOfTheDistanceAreCirclesOnASphere) {
  write("sphere.xyz", xyz(sphere(3000)));
  run_ok("logmap sphere.xyz -s 0 -o map.ply");
  const double h = 0.07;  // spacing of the points
  for (const std::string function : {"map.ply --column distance", "sphere.xyz --source 0"}) {
    const auto json = summary("isolines " + function + " --levels 0.5,1 -o lines.csv");
    expect_values(json, {{"/lines", 2}, {"/closed", 2}});
    for (const Row& p : read_csv("lines.csv")) {
      EXPECT_EQ(p["level"], p["curve"] == 0 ? 0.5 : 1);
      EXPECT_NEAR(std::acos(std::min(1.0, p["z"])), p["level"], h);
    }
  }
  run_ok("isolines sphere.xyz --column z --every 0.25 -o lines.obj");
  EXPECT_EQ(obj_lines("lines.obj", "l").size(), 7U);
}

TEST_F(Isolines, RefusesWhatHasNoLines) {
  write("sphere.xyz", xyz(sphere(500)));
  expect_refused("isolines sphere.xyz -o lines.csv",
                 {{"--column w --every 1", 1, {"--column w", "no such column", "x, y, z"}},
                  {"--column z --levels 7", 1, {"no triangle contains a level"}},
                  {"--column z --source 3 --every 1", 2, {"--source"}},
                  {"--column z", 2, {"--levels or --every"}},
                  {"--every 1", 2, {"--column or --source"}}});
}

using Inverse = InFolder;

TEST_F(Inverse, FindsThePointsOfAPlane) {
  const auto points = plane(30);  // point 0 is its middle
  write("plane.xyz", xyz(points));
  write("at.txt", "# pairs\n0 0\n0.1,0.2\n-0.3 0.05\n50 0\n");
  const auto json = summary("inverse plane.xyz -s 0 --u-axis 1,0,0 --at at.txt -o points.csv");
  const auto rows = read_csv("points.csv");
  ASSERT_EQ(rows.size(), 4U);
  for (std::size_t i = 0; i < 3; ++i) {
    const Row& p = rows[i];
    EXPECT_NEAR(p["x"], points[0][0] + p["u"], 1e-9);
    EXPECT_NEAR(p["y"], points[0][1] + p["nz"] * p["v"], 1e-9);  // the normal of the plane may have either sign
    EXPECT_NEAR(p["z"], 0, 1e-12);
    EXPECT_NEAR(p["hx"], 1, 1e-9);
  }
  EXPECT_NE(rows[1]["y"], rows[0]["y"]);
  EXPECT_TRUE(std::isnan(rows[3]["x"]));  // beyond the boundary
  expect_values(json, {{"/found", 3}});
}

TEST_F(Inverse, InvertsALogmapWithTheSameOptions) {
  const auto points = sphere(2000);
  write("sphere.xyz", xyz(points));
  const auto farthest = [&](const std::string& options, const std::string& inverse_options) {
    const auto map = table("logmap sphere.xyz -s 0 " + options);
    std::string at;
    Points expected;
    for (std::size_t i = 1; i < map.size(); i += 97)
      if (map[i]["distance"] <= 2) {
        at += std::to_string(map[i]["u"]) + "," + std::to_string(map[i]["v"]) + " ";
        expected.push_back(points[i]);
      }
    const auto found = table("inverse sphere.xyz -s 0 --at '" + at + "' " + inverse_options);
    EXPECT_EQ(found.size(), expected.size());
    EXPECT_GT(found.size(), 5U);
    double worst = 0;
    for (std::size_t k = 0; k < found.size(); ++k)
      worst = std::max(worst, distance(found[k].position(), expected.at(k)));
    return worst;
  };
  for (const char* options : {"", "--t-coef 4", "--strategy march", "--variant localized"})
    EXPECT_LT(farthest(options, options), 1e-5);
  EXPECT_GT(farthest("--t-coef 4", ""), 1e-3);
}

}  // namespace
}  // namespace ahm::test
