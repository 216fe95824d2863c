// Options whose effect shows in the result.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "program.hpp"

namespace ahm::test {
namespace {

using Words = std::vector<std::string>;

nlohmann::json summary(const std::string& input, const Folder& folder, const Words& more) {
  Words words = {"logmap", input, "-o", folder / "map.csv", "--json", "-"};
  if (std::find(more.begin(), more.end(), "--source") == more.end()) words.insert(words.end(), {"--source", "0"});
  words.insert(words.end(), more.begin(), more.end());
  const auto outcome = run(words);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  return outcome.status == 0 ? nlohmann::json::parse(outcome.out) : nlohmann::json();
}

TEST(Options, UAxisTurnsTheFrame) {
  Folder folder;
  const auto input = folder.write("sphere.xyz", xyz(sphere(1000), sphere(1000)));
  const auto frame = summary(input, folder, {"--u-axis", "0,2,5"}).at("source").at("frame");
  // The source is the north pole with its outward normal: (0, 2, 5) projects to +y, and v completes a right-handed
  // frame.
  const std::vector<Vec3> expected = {{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}};
  const std::vector<std::string> axes = {"u", "v", "normal"};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t a = 0; a < 3; ++a)
      EXPECT_NEAR(frame.at(axes[i]).at(a).get<double>(), expected[i][a], 1e-12) << axes[i];
  for (const Row& row : read_csv(folder / "map.csv"))
    if (row.distance > 0.3 && row.distance < 1.5) {
      EXPECT_NEAR(std::remainder(row.angle - std::atan2(-row.position[0], row.position[1]), 2 * std::numbers::pi), 0,
                  0.05);
    }
}

TEST(Options, UAxisAlongTheCurvatureRunsAroundACylinder) {
  Folder folder;
  std::vector<Vec3> points;
  const int around = 60;
  for (int j = 0; j < 40; ++j)
    for (int i = 0; i < around; ++i) {
      const double angle = 2 * std::numbers::pi * (i + 0.5 * j) / around;
      points.push_back({std::cos(angle), std::sin(angle), 0.09 * j});
    }
  const auto input = folder.write("cylinder.xyz", xyz(points));
  const int source = 20 * around + 7;
  const auto frame = summary(input, folder, {"--source", std::to_string(source), "--u-axis", "curvature"})
                         .at("source")
                         .at("frame")
                         .at("u");
  const double h = 2 * std::numbers::pi / around;
  EXPECT_LT(std::abs(frame.at(2).get<double>()), h);
  EXPECT_LT(std::abs(frame.at(0).get<double>() * points[source][0] + frame.at(1).get<double>() * points[source][1]), h);
}

TEST(Options, UAxisAlongTheCurvatureIsRefusedWhereThereIsNone) {
  for (const auto& points : {plane(20), sphere(2000)}) {
    Folder folder;
    const auto input = folder.write("points.xyz", xyz(points));
    const auto outcome = run({"logmap", input, "-s", "0", "--u-axis", "curvature", "-o", folder / "map.csv"});
    EXPECT_EQ(outcome.status, 1);
    EXPECT_NE(outcome.err.find("--u-axis curvature"), std::string::npos) << outcome.err;
    EXPECT_EQ(folder.files(), Words{"points.xyz"});
  }
}

TEST(Options, GradientPointsAwayFromTheSourceAlongTheSurface) {
  Folder folder;
  const auto points = plane(20);
  summary(folder.write("plane.xyz", xyz(points)), folder, {"--gradient"});
  for (NumberRow p : read_numbers(folder / "map.csv")) {
    const double x = p["x"] - points[0][0], y = p["y"] - points[0][1], r = std::hypot(x, y);
    EXPECT_NEAR(p["gx"], r > 0 ? x / r : 0, 1e-9);
    EXPECT_NEAR(p["gy"], r > 0 ? y / r : 0, 1e-9);
    EXPECT_NEAR(p["gz"], 0, 1e-12);
  }
  summary(folder.write("sphere.xyz", xyz(sphere(2000))), folder, {"--gradient"});
  const double h = std::sqrt(4 * std::numbers::pi / 2000);
  for (NumberRow p : read_numbers(folder / "map.csv")) {  // the source is the north pole
    if (std::abs(p["z"]) > 0.9) continue;
    const double r = std::hypot(p["x"], p["y"]);
    EXPECT_NEAR(std::hypot(p["gx"] - p["z"] * p["x"] / r, p["gy"] - p["z"] * p["y"] / r, p["gz"] + r), 0, 2 * h);
  }
}

TEST(Options, ReachTheLibrary) {
  Folder folder;
  const auto input = folder.write("sphere.xyz", xyz(sphere(1000)));
  EXPECT_EQ(summary(input, folder, {"--variant", "localized"}).at("variant"), "localized");
  EXPECT_EQ(summary(input, folder, {"--k", "12"}).at("pointcloud").at("k"), 12);
  EXPECT_EQ(summary(input, folder, {"--t-coef", "4"}).at("t_coef"), 4.0);
  EXPECT_EQ(summary(input, folder, {"--backend", "pointcloud"}).at("backend"), "pointcloud");
  EXPECT_EQ(summary(input, folder, {"--ordering", "nested-dissection"}).at("status").at("ok"), 1000);
}

TEST(Options, NormalsAreUsedAsTold) {
  Folder folder;
  const auto input = folder.write("sphere.xyz", xyz(sphere(1000), sphere(1000)));
  const auto oriented = [&](const std::string& how) {
    return summary(input, folder, {"--normals", how}).at("pointcloud").at("oriented").get<bool>();
  };
  EXPECT_TRUE(oriented("auto"));
  EXPECT_TRUE(oriented("oriented"));
  EXPECT_FALSE(oriented("unoriented"));
  EXPECT_FALSE(oriented("estimate"));
}

TEST(Options, VerbosePrintsTheStages) {
  Folder folder;
  const auto input = folder.write("sphere.xyz", xyz(sphere(500)));
  const auto expect_stages = [&](const std::string& method, const std::vector<std::string>& words) {
    const auto outcome =
        run({"logmap", input, "--source", "0", "--method", method, "-o", folder / "map.csv", "--verbose"});
    for (const std::string& word : words) EXPECT_NE(outcome.err.find(word), std::string::npos) << outcome.err;
  };
  expect_stages("heat", {"read", "graph", "factor", "solve", "write", "memory"});
  expect_stages("polar", {"read", "graph", "layout", "solve", "write", "memory"});
}

TEST(Options, StrategiesGiveTheSameMap) {
  Folder folder;
  const auto input = folder.write("sphere.xyz", xyz(sphere(4000)));
  const auto global = summary(input, folder, {"--strategy", "global"});
  const std::vector<Row> expected = read_csv(folder / "map.csv");
  const auto march = summary(input, folder, {"--strategy", "march"});
  const std::vector<Row> rows = read_csv(folder / "map.csv");
  EXPECT_EQ(global.at("strategy"), "global");
  EXPECT_GT(global.at("factor").at("nonzeros_A"), 0);
  EXPECT_EQ(march.at("strategy"), "march");
  EXPECT_GT(march.at("march").at("bands"), 0);
  EXPECT_FALSE(march.contains("factor"));
  for (std::size_t i = 0; i < rows.size(); ++i) ASSERT_NEAR(rows[i].distance, expected[i].distance, 1e-8);
}

TEST(Options, EstimateOfASourceLooksAtItsGraph) {
  Folder folder;
  // Two spheres of different size: a march from one does not come to the other.
  std::string points = xyz(sphere(9000));
  for (const Vec3& p : sphere(300))
    points += std::to_string(10 + p[0]) + " " + std::to_string(p[1]) + " " + std::to_string(p[2]) + "\n";
  const auto input = folder.write("spheres.xyz", points);
  const auto march = [&](std::vector<std::string> words) {
    words.insert(words.begin(), {"logmap", input, "--estimate", "--json", "-"});
    const auto outcome = run(words);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return nlohmann::json::parse(outcome.out).at("march").at("peak_bytes").get<double>();
  };
  EXPECT_LT(march({"--source", "9100"}), march({"--source", "100"}) - 1e6);
  EXPECT_LT(march({"--source", "100", "--radius", "0.2"}), march({"--source", "100"}) - 1e6);
  EXPECT_EQ(run({"logmap", input, "--estimate", "--source", "10000"}).status, 1);
  EXPECT_EQ(folder.files(), std::vector<std::string>{"spheres.xyz"});
}

TEST(Options, EstimateRunsNothing) {
  Folder folder;
  const auto input = folder.write("sphere.xyz", xyz(sphere(500)));
  const auto outcome = run({"logmap", input, "--estimate"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  for (const char* word : {"global", "march", "chosen", "machine"})
    EXPECT_NE(outcome.out.find(word), std::string::npos) << outcome.out;
  EXPECT_EQ(folder.files(), std::vector<std::string>{"sphere.xyz"});
  EXPECT_EQ(run({"logmap", input}).status, 2);
}

// Of small inputs the program itself is most. (A sanitizer would be more.)
TEST(Options, EstimateKnowsTheMemoryOfSmallInputs) {
#ifdef AHM_SANITIZED
  GTEST_SKIP() << "a sanitizer takes memory of its own";
#endif
  Folder folder;
  for (const Index n : {1000, 10000}) {
    const auto input = folder.write("sphere.xyz", xyz(sphere(n)));
    const auto json = [&](std::vector<std::string> words) {
      words.insert(words.begin(), {"logmap", input});
      words.insert(words.end(), {"--json", "-"});
      return nlohmann::json::parse(run(words).out);
    };
    const double told = json({"--estimate"}).at("global").at("peak_bytes"),
                 taken = json({"--source", "0", "--strategy", "global", "-o", folder / "map.csv"}).at("peak_rss_bytes");
    EXPECT_LT(std::abs(told / taken - 1), 1.0 / 3) << n << " points: " << told << " told, " << taken << " taken";
    for (const std::string strategy : {"global", "march"})
      for (const char* radius : {"0.4", "3"}) {
        const std::vector<std::string> words{"--source", "0", "--strategy", strategy, "--radius", radius};
        auto with = [&](std::vector<std::string> more) {
          more.insert(more.begin(), words.begin(), words.end());
          return json(more);
        };
        const nlohmann::json estimate = with({"--estimate"}).at(strategy);
        const double near = estimate.at("peak_bytes"), used = with({"-o", folder / "map.csv"}).at("peak_rss_bytes");
        EXPECT_LT(std::abs(near / used - 1), 1.0 / 3) << n << " points: " << near << " told, " << used << " taken";
        EXPECT_EQ(estimate.contains("at_most"), strategy == "march");
      }
  }
}

TEST(ProgressBar, ShowsOnATerminalAndIsGoneAtTheEnd) {
  if (!has_terminals()) GTEST_SKIP() << "this system gives out no pseudo-terminals";
  Folder folder;
  const auto input = folder.write("sphere.xyz", xyz(sphere(60000)));
  const auto outcome = finish_slowly(start({"logmap", input, "--source", "0", "-o", folder / "map.csv"}, true));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("["), std::string::npos) << "no bar in more than a second";
  const std::string clear = "\r\x1b[K";
  ASSERT_GE(outcome.err.size(), clear.size());
  EXPECT_EQ(outcome.err.substr(outcome.err.size() - clear.size()), clear);
  EXPECT_EQ(outcome.out.find("\x1b"), std::string::npos);
}

TEST(Options, StandardOutputCanTakeTheMap) {
  Folder folder;
  const auto input = folder.write("sphere.xyz", xyz(sphere(300)));
  const auto outcome = run({"logmap", input, "--source", "0", "-o", "/dev/stdout"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.out.substr(0, 6), "index,");
  EXPECT_EQ(std::count(outcome.out.begin(), outcome.out.end(), '\n'), 301);
}

}  // namespace
}  // namespace ahm::test
