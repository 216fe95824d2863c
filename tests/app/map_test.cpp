// Maps of clouds, and the options that change them.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <thread>

#include "ahm/io/image.hpp"
#include "program.hpp"
#include "shapes.hpp"

namespace ahm::test {
namespace {

using Logmap = InFolder;

TEST_F(Logmap, IsTheIdentityOnAPlane) {
  const auto points = plane(40);
  write("plane.xyz", xyz(points, Points(points.size(), {0, 0, 1})));
  const auto rows = table("logmap plane.xyz --source 0 --u-axis 1,0,0");
  ASSERT_EQ(rows.size(), points.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    ASSERT_EQ(rows[i].status, "ok");
    EXPECT_EQ(rows[i]["index"], static_cast<double>(i));
    EXPECT_EQ(rows[i].position(), points[i]);
    const double u = points[i][0] - points[0][0], v = points[i][1] - points[0][1];
    EXPECT_NEAR(rows[i]["u"], u, 1e-9);
    EXPECT_NEAR(rows[i]["v"], v, 1e-9);
    EXPECT_NEAR(rows[i]["distance"], std::hypot(u, v), 1e-9);
    if (i == 0) continue;  // no direction at the source
    EXPECT_NEAR(std::remainder(rows[i]["angle"] - std::atan2(v, u), 2 * pi), 0.0, 1e-6);
  }
}

TEST_F(Logmap, IsExactOnAPlaneWithoutNormalsInBothVariants) {
  const auto points = plane(25);
  write("plane.xyz", xyz(points));
  for (const std::string variant : {"adaptive", "localized"})
    for (const Row& row : table("logmap plane.xyz -s 0 --variant " + variant))
      EXPECT_NEAR(row["distance"], distance(row.position(), points[0]), 1e-9);
}

TEST_F(Logmap, MeasuresArcsOnASphere) {
  write("sphere.xyz", xyz(sphere(4000)));
  double worst = 0;
  for (const Row& row : table("logmap sphere.xyz --source 0")) {
    ASSERT_EQ(row.status, "ok");
    const double exact = std::acos(std::clamp(row["z"], -1.0, 1.0));
    if (exact < 2.0) worst = std::max(worst, std::abs(row["distance"] - exact));
  }
  EXPECT_LT(worst, 0.11);  // two spacings of 0.056
}

TEST_F(Logmap, StartsAtTheVertexNearestToAPosition) {
  write("plane.xyz", xyz(plane(15)));
  const Outcome outcome = run_ok("logmap plane.xyz --source=-5,0.5,0.25 -o map.csv --json map.json");
  EXPECT_TRUE(has(outcome.err, "nearest"));  // a warning: the source is far off the cloud
  const auto rows = read_csv("map.csv");
  const auto away = [](const Row& row) { return std::hypot(row["x"] + 5, row["y"] - 0.5); };
  const Row& source = rows.at(read_json("map.json").at("source").at("index"));
  EXPECT_EQ(away(source), away(*std::ranges::min_element(rows, {}, away)));
  EXPECT_LT(source["distance"], 1e-12);
}

TEST_F(Logmap, EndsAtTheRadius) {
  const auto points = plane(30);
  write("plane.xyz", xyz(points));
  for (const std::string local : {"", " --local"})
    for (const Row& row : table("logmap plane.xyz --source 0 --radius 0.3" + local)) {
      const double exact = distance(row.position(), points[0]);
      EXPECT_EQ(row.status, exact > 0.3 ? "beyond_radius" : "ok");
      EXPECT_EQ(std::isnan(row["u"]), exact > 0.3);
      EXPECT_TRUE(row.status != "ok" || std::abs(row["distance"] - exact) < 1e-10);
    }
}

TEST_F(Logmap, DoesNotDependOnTheSearch) {
  write("sphere.xyz", xyz(sphere(1500)));
  const auto expected = table("logmap sphere.xyz --source 0 --knn nanoflann");
  Words others;
#ifdef AHM_WITH_FLANN
  others.emplace_back("flann");
#endif
#ifdef AHM_WITH_PCL
  others.emplace_back("pcl");
#endif
  for (const std::string& knn : others) {
    const auto rows = table("logmap sphere.xyz --source 0 --knn " + knn);
    for (std::size_t i = 0; i < rows.size(); ++i) EXPECT_NEAR(rows[i]["distance"], expected.at(i)["distance"], 1e-6);
  }
}

TEST_F(Logmap, DoesNotDependOnTheFactorization) {
  write("sphere.xyz", xyz(sphere(1500)));
#ifdef AHM_WITH_CHOLMOD
  const auto expected = table("logmap sphere.xyz --source 0 --method heat --factor own");
  for (const std::string factor : {"cholmod", "cholmod-simplicial"}) {
    const auto json = summary("logmap sphere.xyz --source 0 -o map.csv --factor " + factor);
    expect_values(json, {{"/method", "heat"}, {"/strategy", "global"}, {"/factor/factorization", factor}});
    EXPECT_GT(number(json, "/factor/bytes"), 8 * number(json, "/factor/nonzeros_A"));
    const auto rows = read_csv("map.csv");
    ASSERT_EQ(rows.size(), expected.size());
    for (std::size_t i = 0; i < rows.size(); ++i)
      for (const char* column : {"u", "v"}) ASSERT_NEAR(rows[i][column], expected[i][column], 1e-11) << i;
  }
#else
  expect_refused("logmap sphere.xyz --source 0 -o map.csv",
                 {{"--factor cholmod", 1, {"this build has no CHOLMOD", "AHM_WITH_CHOLMOD=OFF", "--factor own"}}});
#endif
  expect_values(summary("logmap sphere.xyz --source 0 -o map.csv --method heat"), {{"/factor/factorization", "own"}});
}

TEST_F(Logmap, DoesNotDependOnThreads) {
  write("sphere.xyz", xyz(sphere(2000)));
  for (const std::string threads : {"1", "3"})
    run_ok("logmap sphere.xyz -s 9 -o " + threads + ".csv --threads " + threads);
  EXPECT_EQ(read_text("1.csv"), read_text("3.csv"));
}

TEST_F(Logmap, DoesNotDependOnTheStrategy) {
  write("sphere.xyz", xyz(sphere(4000)));
  const auto global = summary("logmap sphere.xyz -s 0 -o global.csv --strategy global");
  const auto march = summary("logmap sphere.xyz -s 0 -o march.csv --strategy march");
  EXPECT_EQ(global.at("strategy"), "global");
  EXPECT_GT(number(global, "/factor/nonzeros_A"), 0);
  EXPECT_EQ(march.at("strategy"), "march");
  EXPECT_GT(number(march, "/march/bands"), 0);
  EXPECT_FALSE(march.contains("factor"));
  const auto expected = read_csv("global.csv"), rows = read_csv("march.csv");
  for (std::size_t i = 0; i < rows.size(); ++i) ASSERT_NEAR(rows[i]["distance"], expected.at(i)["distance"], 1e-8);
}

using Frame = InFolder;

TEST_F(Frame, IsTurnedByTheUAxis) {
  write("sphere.xyz", xyz(sphere(1000), sphere(1000)));
  const auto json = summary("logmap sphere.xyz -s 0 -o map.csv --u-axis 0,2,5");
  // The normal of the source is (0, 0, 1): (0, 2, 5) projects to +y, and v completes a right-handed frame.
  for (const auto& [axis, expected] :
       std::map<std::string, Vec3>{{"u", {0, 1, 0}}, {"v", {-1, 0, 0}}, {"normal", {0, 0, 1}}})
    EXPECT_LT(distance(json.at("source").at("frame").at(axis), expected), 1e-12) << axis;
  for (const Row& row : read_csv("map.csv"))
    if (row["distance"] > 0.3 && row["distance"] < 1.5) {
      EXPECT_NEAR(std::remainder(row["angle"] - std::atan2(-row["x"], row["y"]), 2 * pi), 0, 0.05);
    }
}

TEST_F(Frame, AlongTheCurvatureRunsAroundACylinder) {
  Points points;
  const int around = 60;
  for (int j = 0; j < 40; ++j)
    for (int i = 0; i < around; ++i) {
      const double angle = 2 * pi * (i + 0.5 * j) / around;
      points.push_back({std::cos(angle), std::sin(angle), 0.09 * j});
    }
  write("cylinder.xyz", xyz(points));
  const Vec3 p = points[20 * around + 7];
  const Vec3 u = summary("logmap cylinder.xyz -s 1207 --u-axis curvature -o map.csv").at("source").at("frame").at("u");
  const double h = 2 * pi / around;
  EXPECT_LT(std::abs(u[2]), h);
  EXPECT_LT(std::abs(u[0] * p[0] + u[1] * p[1]), h);
  // Planes and spheres have no direction of largest curvature.
  write("plane.xyz", xyz(plane(20)));
  write("sphere.xyz", xyz(sphere(2000)));
  for (const char* input : {"plane.xyz", "sphere.xyz"})
    expect_refused("logmap -s 0 --u-axis curvature -o new.csv", {{input, 1, {"--u-axis curvature"}}});
}

TEST_F(Frame, OfNormalsIsOrientedAsRequested) {
  write("sphere.xyz", xyz(sphere(1000), sphere(1000)));
  for (const auto& [how, oriented] :
       std::map<std::string, bool>{{"auto", true}, {"oriented", true}, {"unoriented", false}, {"estimate", false}})
    expect_values(summary("logmap sphere.xyz -s 0 -o map.csv --normals " + how), {{"/pointcloud/oriented", oriented}});
}

TEST_F(Frame, HasGradientsThatPointAwayFromTheSource) {
  const auto points = plane(20);
  write("plane.xyz", xyz(points));
  for (const Row& p : table("logmap plane.xyz -s 0 --gradient")) {
    const double x = p["x"] - points[0][0], y = p["y"] - points[0][1], r = std::hypot(x, y);
    EXPECT_NEAR(p["gx"], r > 0 ? x / r : 0, 1e-9);
    EXPECT_NEAR(p["gy"], r > 0 ? y / r : 0, 1e-9);
    EXPECT_NEAR(p["gz"], 0, 1e-12);
  }
  write("sphere.xyz", xyz(sphere(2000)));
  const double h = std::sqrt(4 * pi / 2000);
  for (const Row& p : table("logmap sphere.xyz -s 0 --gradient")) {  // from the north pole
    if (std::abs(p["z"]) > 0.9) continue;
    const double r = std::hypot(p["x"], p["y"]);
    EXPECT_LT(distance({p["gx"], p["gy"], p["gz"]}, {p["z"] * p["x"] / r, p["z"] * p["y"] / r, -r}), 2 * h);
  }
}

class Report : public InFolder {
 protected:
  Report() { write("sphere.xyz", xyz(sphere(1000))); }
};

TEST_F(Report, HasTheMapAndItsCost) {
  const auto json = summary("logmap sphere.xyz --source 3 --method heat -o map.csv");
  expect_values(
      json, {{"/n", 1000},
             {"/backend", "pointcloud"},
             {"/variant", "adaptive"},
             {"/strategy", "global"},
             {"/status", {{"ok", 1000}, {"disconnected", 0}, {"beyond_radius", 0}, {"unreached", 0}, {"removed", 0}}},
             {"/source/index", 3},
             {"/pointcloud/components", 1}});
  EXPECT_GT(number(json, "/mean_edge_length"), 0);
  EXPECT_LT(number(json, "/mean_edge_length"), 0.5);
  EXPECT_TRUE(json.at("warnings").is_array());
  for (const char* stage : {"read", "graph", "factor", "solve", "write"})
    EXPECT_GE(json.at("seconds").at(stage).get<double>(), 0);
  EXPECT_GT(number(json, "/peak_rss_bytes"), 1000000);
  for (const char* library : {"ahm", "registers", "eigen"}) EXPECT_NE(json.at("versions").at(library), "");
  EXPECT_EQ(json.at("source").at("position").size(), 3U);
  for (const char* axis : {"u", "v", "normal"}) EXPECT_EQ(json.at("source").at("frame").at(axis).size(), 3U);
}

TEST_F(Report, HasTheOptions) {
  const std::map<std::string, Values> cases{{"--variant localized", {{"/variant", "localized"}}},
                                            {"--k 12", {{"/pointcloud/k", 12}}},
                                            {"--t-coef 4", {{"/t_coef", 4.0}}},
                                            {"--backend pointcloud", {{"/backend", "pointcloud"}}},
                                            {"--ordering nested-dissection", {{"/status/ok", 1000}}}};
  for (const auto& [option, values] : cases)
    expect_values(summary("logmap sphere.xyz -s 0 -o map.csv " + option), values);
}

TEST_F(Report, HasStagesIfVerbose) {
  for (const auto& [method, stage] : std::map<std::string, std::string>{{"heat", "factor"}, {"polar", "layout"}}) {
    const Outcome outcome = run_ok("logmap sphere.xyz --source 0 -o map.csv --json - --verbose --method " + method);
    EXPECT_EQ(nlohmann::json::parse(outcome.out).at("n"), 1000);
    EXPECT_TRUE(has(outcome.err, "1000 vertices", "read", "graph", stage, "solve", "write", "memory"));
  }
}

TEST_F(Report, IsShortIfThereIsNoWarning) {
  const Outcome outcome = run_ok("logmap sphere.xyz --source 0 -o map.csv");
  EXPECT_EQ(outcome.err, "");
  EXPECT_TRUE(has(outcome.out, "1000 ok", "map.csv"));
}

TEST_F(Report, IsAProgressBarOnATerminal) {
  if (!has_terminals()) GTEST_SKIP() << "this system has no pseudo-terminals";
  write("sphere.xyz", xyz(sphere(60000)));
  const auto outcome = finish(start("logmap sphere.xyz --source 0 -o map.csv", true), true);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(has(outcome.err, "[")) << "no bar in more than a second";
  EXPECT_TRUE(outcome.err.ends_with("\r\x1b[K"));
  EXPECT_FALSE(has(outcome.out, "\x1b"));
}

using Estimate = InFolder;

TEST_F(Estimate, RunsNothing) {
  write("sphere.xyz", xyz(sphere(500)));
  EXPECT_TRUE(has(run_ok("logmap sphere.xyz --estimate").out, "global", "march", "chosen", "machine"));
  EXPECT_EQ(files(), Words{"sphere.xyz"});
  expect_refused("logmap sphere.xyz", {{"", 2, {"--source"}}, {"--estimate --source 10000", 1, {"10000"}}});
}

TEST_F(Estimate, DependsOnTheSurroundingsOfTheSource) {
  // Two spheres of different size: a march from one does not reach the other.
  write("spheres.xyz", xyz(joined(sphere(9000), moved(sphere(300), {10, 0, 0}))));
  const auto march = [](const std::string& source) {
    return number(summary("logmap spheres.xyz --estimate --source " + source), "/march/peak_bytes");
  };
  EXPECT_LT(march("9100"), march("100") - 1e6);
  EXPECT_LT(march("100 --radius 0.2"), march("100") - 1e6);
}

// On small inputs the program itself uses most of the memory; a sanitizer would use more.
TEST_F(Estimate, IsRightForSmallInputs) {
#ifdef AHM_SANITIZED
  GTEST_SKIP() << "sanitizers use additional memory";
#endif
  for (const Index n : {1000, 10000}) {
    write("sphere.xyz", xyz(sphere(n)));
    for (const auto& [strategy, radius] : std::vector<std::pair<std::string, std::string>>{{"global", ""},
                                                                                           {"global", " --radius 0.4"},
                                                                                           {"global", " --radius 3"},
                                                                                           {"march", " --radius 0.4"},
                                                                                           {"march", " --radius 3"}}) {
      const std::string command = "logmap sphere.xyz --source 0 --strategy " + strategy + radius;
      const auto estimate = summary((radius.empty() ? "logmap sphere.xyz" : command) + " --estimate").at(strategy);
      const double used = number(summary(command + " -o map.csv"), "/peak_rss_bytes");
      EXPECT_LT(std::abs(number(estimate, "/peak_bytes") / used - 1), 1.0 / 3) << n << " points, " << command;
      EXPECT_EQ(estimate.contains("at_most"), strategy == "march");
    }
  }
}

class Threads : public InFolderWithImages {};

/// Number of threads of a process; 0 if it has ended.
int thread_count(pid_t pid) {
  std::ifstream status("/proc/" + std::to_string(pid) + "/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("State:") && line.find('Z') != std::string::npos)
      return 0;
    else if (line.starts_with("Threads:"))
      return std::stoi(line.substr(8));
  return 0;
}

TEST_F(Threads, OfPicturesAreAtMostAsManyAsRequested) {
  if (!std::filesystem::exists("/proc/self/status")) GTEST_SKIP() << "no /proc";
  write("sphere.xyz", xyz(sphere(300)));
  for (const int threads : {1, 4}) {         // A busy machine may end the run before the last thread starts.
    setenv("OPENBLAS_NUM_THREADS", "1", 1);  // CHOLMOD's BLAS would start a pool of threads
    const Running running =
        start("logmap sphere.xyz --source 0 -o map.csv --view map.png --size 1600x1200 --verbose --threads " +
              std::to_string(threads));
    unsetenv("OPENBLAS_NUM_THREADS");
    read_until(running, "solve ");
    int most = 0;
    for (int now = 1; (now = thread_count(running.pid)) > 0; std::this_thread::sleep_for(std::chrono::milliseconds(1)))
      most = std::max(most, now);
    EXPECT_EQ(finish(running).status, 0);
    EXPECT_LE(most, threads);
  }
}

/// Warnings of maps that are not reliable.
class Reliability : public InFolder {
 protected:
  /// Standard error of each subcommand that computes a map from a source, by name.
  static std::map<std::string, std::string> errors(const Points& points, const std::string& size) {
    write("points.xyz", xyz(points));
    std::map<std::string, std::string> commands{{"logmap", "--source 0 -o map.csv"},
                                                {"inverse", "--source 0 --at 0.01,0 -o points.csv"},
                                                {"coverage", "--source 0 --spacing 0.05 -o path.csv --radius " + size},
                                                {"stroke", "--curve '0 9' -o stroke.csv"}};
    if (io::has_images()) {
      io::write_png("image.png", Image(8, 8));
      commands["decal"] = "--source 0 --image image.png -o decal.ply --size " + size;
    }
    for (auto& [name, command] : commands) command = run_ok(name + " points.xyz " + command).err;
    return commands;
  }

  const std::string warning = "the map is not reliable at ";
};

TEST_F(Reliability, IsReportedByEverySubcommandIfAFifthOfTheMapLacksIt) {
  for (const auto& [name, err] : errors(torus(900).positions, "4")) EXPECT_TRUE(has(err, warning)) << name;
  for (const auto& [name, err] : errors(plane(20), "0.3")) EXPECT_FALSE(has(err, warning)) << name;
}

TEST_F(Reliability, OfACoverageIsMeasuredWithinItsRadius) {
  write("points.xyz", xyz(torus(4000).positions));
  EXPECT_FALSE(has(run_ok("coverage points.xyz --source 0 --radius 0.4 --spacing 0.1 -o path.csv").err, warning));
}

}  // namespace
}  // namespace ahm::test
