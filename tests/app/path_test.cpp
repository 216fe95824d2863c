// Shortest paths and straight lines.
#include <cmath>
#include <numbers>

#include "ahm/io/read.hpp"
#include "program.hpp"
#include "shapes.hpp"

namespace ahm::test {
namespace {

double sum_of_steps(const std::vector<Row>& rows) {
  double sum = 0;
  for (std::size_t k = 1; k < rows.size(); ++k) sum += distance(rows[k].position(), rows[k - 1].position());
  return sum;
}

class Path : public InFolder {
 protected:
  Path() {
    write("cube.off", cube_and_square);
    write("plane.xyz", xyz(plane(20)));
  }
};

TEST_F(Path, UnfoldsACube) {
  const double length = number(summary("path cube.off --from 0 --to 7 -o path.csv"), "/length");
  const auto rows = read_csv("path.csv");
  for (const double l : {length, sum_of_steps(rows), rows.back()["arclength"]}) EXPECT_NEAR(l, std::sqrt(5.0), 1e-12);
  EXPECT_EQ(rows.front()["x"], 0);
  EXPECT_LT(distance(rows.back().position(), {1, 1, 1}), 1e-15);
}

// A position in other units, or rows separated by commas: every command that has positions warns.
TEST_F(Path, AndOtherCommandsWarnOfPositionsFarOffTheSurface) {
  for (const std::string command :
       {"path cube.off --from 0,200,300 --to 7 -o out.csv", "path cube.off --from 0 --to 0,200,300 -o out.csv",
        "trace cube.off --source 0,200,300 --direction 1,0,0 --length 1 -o out.csv",
        "cells cube.off --sources 0,200,300 -o out.csv", "center cube.off --points 0,200,300",
        "inverse cube.off --source 0,200,300 --at 0,0 -o out.csv", "logmap cube.off --source 0,200,300 -o out.csv"})
    EXPECT_TRUE(has(run_ok(command).err, "0,200,300: 3", "separate them by blanks")) << command;
  EXPECT_FALSE(has(run_ok("path cube.off --from 0.1,0.1,-0.5 --to 7 -o out.csv").err, "off the surface"));
}

TEST_F(Path, VisitsStopsAndReturns) {
  // From the middle of the front over those of the other three sides. The second stop is a position off the surface.
  for (const std::string file : {"loop.csv", "loop.ply", "loop.obj"}) {
    const auto json = summary(
        "path cube.off --from face:2:.25,.25,.25,.25 --to '1.3,.5,.5 face:3:.25,.25,.25,.25 face:4:.25,.25,.25,.25' "
        "--closed --view loop.png -o " +
        file);
    EXPECT_NEAR(number(json, "/length"), 4, 1e-12);
    for (const double length : json.at("lengths")) EXPECT_NEAR(length, 1, 1e-12);
    EXPECT_GT(std::filesystem::file_size("loop.png"), 1000U);
  }
  const auto rows = read_csv("loop.csv");
  EXPECT_NEAR(sum_of_steps(rows), 4, 1e-12);
  for (const char* file : {"loop.obj", "loop.ply"}) EXPECT_EQ(io::read(file).points.size(), rows.size());
  const auto length = [](const std::string& stops) {
    return number(summary("path cube.off --from face:2:.25,.25,.25,.25 -o path.csv " + stops), "/length");
  };
  const std::string right = "face:5:.25,.25,.25,.25", back = "face:3:.25,.25,.25,.25";
  EXPECT_NEAR(length("--through " + right + " --to " + back), 2, 1e-12);
  EXPECT_EQ(length("--through " + right + " --to " + back), length("--to '" + right + " " + back + "'"));
}

TEST_F(Path, IsFoundForEveryPairOfAFile) {
  write("pairs.txt", "# from to\n0 7\n0 3\n\n0 9\n3.5,0,0 3.5,1,0\n0 0 0  0 0 1\n");
  const double expected[] = {std::sqrt(5.0), std::sqrt(2.0), 0, 1, 1};
  for (const std::string how : {"", " --fast"}) {
    const Outcome outcome = run_ok("path cube.off --pairs pairs.txt -o paths.csv --view paths.png --json -" + how);
    EXPECT_TRUE(has(outcome.err, "different components of the surface: 1 of 5"));
    const auto paths = nlohmann::json::parse(outcome.out).at("paths");
    std::vector<double> last(5, 0);
    for (const Row& row : read_csv("paths.csv")) last[static_cast<std::size_t>(row["curve"])] = row["arclength"];
    for (std::size_t k = 0; k < 5; ++k) {
      EXPECT_EQ(paths[k].at("status"), k == 2 ? "disconnected" : "ok");
      EXPECT_NEAR(last[k], expected[k], 1e-12);
      if (k == 2)
        EXPECT_TRUE(paths[k].at("length").is_null());
      else
        EXPECT_NEAR(number(paths[k], "/length"), expected[k], 1e-12);
    }
  }
  for (const std::string file : {"paths.obj", "paths.ply"}) {
    run_ok("path cube.off --pairs pairs.txt -o " + file);
    EXPECT_EQ(io::read(file).points.size(), read_csv("paths.csv").size());
  }
  EXPECT_EQ(obj_lines("paths.obj", "l").size(), 4U);
}

// The shortest loops around the cube are straight, and as long as four sides.
TEST_F(Path, IsTightenedToALoop) {
  const std::string command =
      "path cube.off --from face:2:.3,.3,.2,.2 --to 'face:5:.2,.4,.2,.2 face:3:.25,.25,.25,.25 face:4:.3,.2,.2,.3' "
      "--closed -o loop.csv";
  const double loose = number(summary(command), "/length");
  const auto json = summary(command + " --tighten");
  EXPECT_NEAR(number(json, "/length"), 4, 1e-9);
  EXPECT_NEAR(number(json, "/length_through_stops"), loose, 1e-12);
  EXPECT_GT(loose, 4);
}

TEST_F(Path, IsStraightOnAFlatCloud) {
  const double length = number(summary("path plane.xyz --from 0 --to 0.9,0.8,0 -o path.csv"), "/length");
  const auto rows = read_csv("path.csv");
  ASSERT_GT(rows.size(), 5U);
  const Vec3 a = rows.front().position(), b = rows.back().position();
  EXPECT_NEAR(b[0], 0.9, 1e-12);
  for (const Row& row : rows) EXPECT_NEAR((row["x"] - a[0]) * (b[1] - a[1]), (row["y"] - a[1]) * (b[0] - a[0]), 1e-12);
  EXPECT_NEAR(length, distance(a, b), 1e-11);
}

using Trace = Path;

TEST_F(Trace, IsStraightOnAFlatCloudAndEndsAtItsRim) {
  const auto rows = table("trace plane.xyz --source 0 --direction 1,0.5,3 --length 0.3");
  EXPECT_NEAR(rows.back()["x"] - rows.front()["x"], 0.3 * 2 / std::sqrt(5.0), 1e-12);
  EXPECT_NEAR(rows.back()["y"] - rows.front()["y"], 0.3 / std::sqrt(5.0), 1e-12);
  const auto json = summary("trace plane.xyz --source 0 --direction 1,0,0 --length 9 -o line.csv");
  expect_values(json, {{"/end/at", "boundary"}});
  EXPECT_NEAR(number(json, "/length"), 0.5, 0.1);
}

TEST_F(Trace, ClosesAroundACubeAndEndsAtABoundary) {
  expect_values(summary("trace cube.off --source face:2:.2,.3,.3,.2 --direction 1,0,0 --length 4 -o line.csv"),
                {{"/end/at", "length"}});
  const auto rows = read_csv("line.csv");
  EXPECT_LT(distance(rows.back().position(), rows.front().position()), 1e-12);
  EXPECT_NEAR(sum_of_steps(rows), 4, 1e-12);
  const auto json = summary("trace cube.off --source 3.25,.5,0 --direction 1,0,7 --length 4 -o line.csv");
  expect_values(json, {{"/end/at", "boundary"}});
  EXPECT_NEAR(number(json, "/length"), 0.75, 1e-12);
  EXPECT_NEAR(read_csv("line.csv").back()["x"], 4, 1e-12);
}

// The line of length L at angle a ends where the map of the source has the coordinates L (cos a, sin a).
TEST_F(Trace, TakesAnAngleFromTheUAxis) {
  for (const std::string source :
       {"cube.off --source face:2:.2,.3,.3,.2", "cube.off --source face:6:.25,.25,.25,.25", "plane.xyz --source 0"})
    for (const double degrees : {0.0, 30.0, -117.5}) {
      const double a = degrees * std::numbers::pi / 180;
      const auto line = table("trace " + source + " --length 0.2 --direction=" + std::to_string(degrees)),
                 point = table("inverse " + source + " --at=" + std::to_string(0.2 * std::cos(a)) + "," +
                               std::to_string(0.2 * std::sin(a)));
      EXPECT_LT(distance(line.back().position(), point.front().position()), 4e-6) << source << " " << degrees;
    }
  write("lines.txt", "0 30 0.2\n");
  run_ok("trace plane.xyz --lines lines.txt -o lines.csv");
  const auto line = table("trace plane.xyz --source 0 --direction 30 --length 0.2");
  EXPECT_LT(distance(read_csv("lines.csv").back().position(), line.back().position()), 1e-12);
  expect_refused("trace cube.off --source 0 --length 1 -o line.csv", {{"--direction 30,5", 2, {"--direction"}}});
}

TEST_F(Trace, FollowsEveryLineOfAFile) {
  write("lines.txt", "face:2:.2,.3,.3,.2 1,0,0\n3.25,.5,0 1,0,7 9\n");
  const auto json = summary("trace cube.off --lines lines.txt --length 4 -o lines.csv --view lines.png");
  expect_values(json, {{"/lines/0/end", "length"}, {"/lines/1/end", "boundary"}});
  EXPECT_NEAR(number(json, "/lines/0/length"), 4, 1e-12);
  EXPECT_NEAR(number(json, "/lines/1/length"), 0.75, 1e-12);
  EXPECT_EQ(read_csv("lines.csv").back()["curve"], 1);
}

}  // namespace
}  // namespace ahm::test
