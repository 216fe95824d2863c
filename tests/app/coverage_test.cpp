// Coverage paths as files.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "program.hpp"

namespace ahm::test {
namespace {

using Words = std::vector<std::string>;

TEST(CoverageCommand, LaysARasterOverAPlaneOfPoints) {
  Folder folder;
  const auto points = plane(30);  // point 0 is its middle
  const std::string out = folder / "path.csv";
  const Outcome outcome = run({"coverage", folder.write("plane.xyz", xyz(points)), "--source", "0", "--radius", "0.4",
                               "--spacing", "0.05", "--u-axis", "1,0,0", "-o", out, "--json", folder / "path.json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto rows = read_numbers(out);
  ASSERT_GT(rows.size(), 100U);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    NumberRow p = rows[i];
    const double across = p["y"] - points[0][1], line = (p["line"] - 8) * 0.05;
    EXPECT_EQ(p["index"], static_cast<double>(i));
    EXPECT_NEAR(std::abs(across), std::abs(line), 1e-9);  // the plane may be seen from either side
    EXPECT_NEAR(std::hypot(p["u"], p["v"]), std::hypot(p["x"] - points[0][0], across), 1e-9);
    EXPECT_NEAR(p["z"], 0, 1e-12);
    EXPECT_NEAR(std::abs(p["nz"]), 1, 1e-9);
    EXPECT_NEAR(p["hx"], static_cast<int>(p["line"]) % 2 == 0 ? 1 : -1, 1e-6);
    EXPECT_NEAR(p["spacing"], 0.05, 1e-6);
  }
  const auto json = read_json(folder / "path.json");
  EXPECT_EQ(json.at("points"), rows.size());
  EXPECT_EQ(json.at("pieces"), 17 - 2);  // the outermost lines are points
  EXPECT_GT(json.at("covered").get<double>(), 0.98);
}

/// Where two tables of numbers differ most.
double worst_difference(const std::vector<NumberRow>& a, const std::vector<NumberRow>& b) {
  EXPECT_EQ(a.size(), b.size());
  double worst = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    for (const auto& [name, value] : a[i])
      if (!std::isnan(value) || !std::isnan(b[i].at(name))) worst = std::max(worst, std::abs(value - b[i].at(name)));
  return worst;
}

TEST(CoverageCommand, OfTheSurroundingsAloneIsThatOfTheWholeCloud) {
  Folder folder;
  const auto input = folder.write("plane.xyz", xyz(plane(40), std::vector<Vec3>(1600, Vec3{0, 0, 1})));
  Words words{"coverage", input, "--source", "0", "--radius", "0.2", "--spacing", "0.04", "--u-axis", "1,0,0", "-o"};
  const auto with = [&](const std::string& name, const Words& more) {
    Words all = words;
    all.push_back(folder / name);
    all.insert(all.end(), more.begin(), more.end());
    const Outcome outcome = run(all);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return read_numbers(folder / name);
  };
  const auto whole = with("whole.csv", {}), local = with("local.csv", {"--local"});
  ASSERT_GT(whole.size(), 50U);
  EXPECT_LT(worst_difference(whole, local), 1e-9);  // a plane is exact at any diffusion time
}

TEST(CoverageCommand, WindsASpiralOnASphereOfPoints) {
  Folder folder;
  const std::string out = folder / "path.csv";
  const Outcome outcome = run({"coverage", folder.write("sphere.xyz", xyz(sphere(3000))), "-s", "0", "--radius", "1.2",
                               "--spacing", "0.1", "--pattern", "spiral", "-o", out});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto rows = read_numbers(out);
  ASSERT_GT(rows.size(), 100U);
  double side = 0;
  for (NumberRow p : rows) {
    const double h = 0.07;  // between points
    EXPECT_NEAR(std::hypot(p["x"], p["y"], p["z"]), 1, h * h);
    EXPECT_NEAR(std::acos(std::min(1.0, p["z"])), std::hypot(p["u"], p["v"]), h);
    const double outwards = p["nx"] * p["x"] + p["ny"] * p["y"] + p["nz"] * p["z"];
    EXPECT_GT(std::abs(outwards), 0.9);
    if (side == 0) side = outwards;
    EXPECT_GT(outwards * side, 0);  // all normals on one side
    EXPECT_NEAR(p["hx"] * p["nx"] + p["hy"] * p["ny"] + p["hz"] * p["nz"], 0, 1e-9);
  }
}

TEST(CoverageCommand, StaysOnTheFacesOfAMeshAndSparesItsHole) {
  // A square of quadrilaterals whose middle cells are missing, some faces listed the other way round.
  Folder folder;
  const int m = 21;
  std::string off = "OFF\n441 384 0\n";
  for (int y = 0; y < m; ++y)
    for (int x = 0; x < m; ++x) off += std::to_string(0.1 * x) + " " + std::to_string(0.1 * y) + " 0\n";
  for (int y = 0; y + 1 < m; ++y)
    for (int x = 0; x + 1 < m; ++x) {
      if (x >= 12 && x < 16 && y >= 8 && y < 12) continue;
      const int a = y * m + x, b = a + 1, c = b + m, d = a + m;
      for (int corner : (x + y) % 5 == 0 ? std::vector<int>{4, a, d, c, b} : std::vector<int>{4, a, b, c, d})
        off += std::to_string(corner) + " ";
      off += "\n";
    }
  const std::string out = folder / "path.csv";
  const Outcome outcome = run({"coverage", folder.write("plate.off", off), "--source", "1,1,0", "--radius", "0.9",
                               "--spacing", "0.1", "--angle", "30", "-o", out});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  std::map<double, std::map<double, int>> pieces;
  for (NumberRow p : read_numbers(out)) {
    EXPECT_FALSE(p["x"] > 1.201 && p["x"] < 1.599 && p["y"] > 0.801 && p["y"] < 1.199) << p["x"] << ' ' << p["y"];
    EXPECT_NEAR(p["z"], 0, 1e-12);
    ++pieces[p["line"]][p["piece"]];
  }
  int cut = 0;
  for (const auto& [line, of_line] : pieces) cut += of_line.size() > 1;
  EXPECT_GE(cut, 2);
}

TEST(CoverageCommand, WritesPolylinesAsPly) {
  Folder folder;
  const std::string out = folder / "path.ply";
  const Outcome outcome = run({"coverage", folder.write("plane.xyz", xyz(plane(20))), "--source", "0", "--radius",
                               "0.3", "--spacing", "0.1", "-o", out, "--json", "-"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  const std::size_t points = json.at("points"), pieces = json.at("pieces");
  const std::string text = read_text(out);
  EXPECT_NE(text.find("element vertex " + std::to_string(points) + "\n"), std::string::npos);
  EXPECT_NE(text.find("element edge " + std::to_string(points - pieces) + "\n"), std::string::npos);
  const auto body = text.substr(text.find("end_header\n") + 11);
  EXPECT_EQ(std::count(body.begin(), body.end(), '\n'), static_cast<std::ptrdiff_t>(2 * points - pieces));
}

TEST(CoverageCommand, RefusesNonsense) {
  Folder folder;
  const auto input = folder.write("plane.xyz", xyz(plane(10)));
  const std::string out = folder / "path.csv";
  EXPECT_EQ(run({"coverage", input, "-s", "0", "--radius", "1", "-o", out}).status, 2);
  EXPECT_EQ(run({"coverage", input, "-s", "0", "--radius", "0", "--spacing", "1", "-o", out}).status, 2);
  EXPECT_EQ(run({"coverage", input, "-s", "0", "--radius", "1", "--spacing", "1", "--pattern", "x", "-o", out}).status,
            2);
  EXPECT_EQ(run({"coverage", input, "-s", "0", "--radius", "1", "--spacing", "1", "-o", folder / "path.pcd"}).status,
            1);
  EXPECT_EQ(run({"coverage", input, "-s", "100", "--radius", "1", "--spacing", "1", "-o", out}).status, 1);
  EXPECT_EQ(run({"coverage", input, "-s", "0", "--radius", "1", "--spacing", "1e-9", "-o", out}).status, 1);
  EXPECT_EQ(folder.files(), std::vector<std::string>{"plane.xyz"});
}

}  // namespace
}  // namespace ahm::test
