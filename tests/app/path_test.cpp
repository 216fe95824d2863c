// Paths and lines over meshes, through the program.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "ahm/io/read.hpp"
#include "program.hpp"

namespace ahm::test {
namespace {

/// A unit cube of quads, corner k at the bits of k, and beside it a square.
const char* const cube_and_square =
    "OFF\n12 7 0\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 0 1\n1 0 1\n0 1 1\n1 1 1\n3 0 0\n4 0 0\n4 1 0\n3 1 0\n"
    "4 0 2 3 1\n4 4 5 7 6\n4 0 1 5 4\n4 2 6 7 3\n4 0 4 6 2\n4 1 3 7 5\n4 8 9 10 11\n";

double sum_of_steps(const std::vector<NumberRow>& rows) {
  double sum = 0;
  for (std::size_t k = 1; k < rows.size(); ++k)
    sum += std::hypot(rows[k].at("x") - rows[k - 1].at("x"), rows[k].at("y") - rows[k - 1].at("y"),
                      rows[k].at("z") - rows[k - 1].at("z"));
  return sum;
}

TEST(PathCommand, UnfoldsACube) {
  Folder folder;
  const std::string input = folder.write("cube.off", cube_and_square);
  const Outcome outcome =
      run({"path", input, "--from", "0", "--to", "7", "-o", folder / "path.csv", "--json", folder / "path.json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto rows = read_numbers(folder / "path.csv");
  EXPECT_NEAR(sum_of_steps(rows), std::sqrt(5.0), 1e-12);
  EXPECT_NEAR(rows.back().at("arclength"), std::sqrt(5.0), 1e-12);
  EXPECT_EQ(rows.front().at("x"), 0);
  for (const char* axis : {"x", "y", "z"}) EXPECT_NEAR(rows.back().at(axis), 1, 1e-15);
  EXPECT_NEAR(read_json(folder / "path.json").at("length").get<double>(), std::sqrt(5.0), 1e-12);
}

// In other units, or rows with commas between them: every command that takes positions says so.
TEST(PathCommand, SaysThatPositionsLieFarOffTheSurface) {
  Folder folder;
  const std::string input = folder.write("cube.off", cube_and_square), output = folder / "out.csv";
  const std::vector<std::vector<std::string>> commands{
      {"path", input, "--from", "0,200,300", "--to", "7"},
      {"path", input, "--from", "0", "--to", "0,200,300"},
      {"trace", input, "--source", "0,200,300", "--direction", "1,0,0", "--length", "1"},
      {"cells", input, "--sources", "0,200,300"},
      {"center", input, "--points", "0,200,300", "--json", output},
      {"inverse", input, "--source", "0,200,300", "--at", "0,0"},
      {"logmap", input, "--source", "0,200,300"}};
  for (std::vector<std::string> command : commands) {
    if (command[0] != "center") command.insert(command.end(), {"-o", output});
    const Outcome outcome = run(command);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_NE(outcome.err.find("0,200,300: 3"), std::string::npos) << command[0] << ": " << outcome.err;
    EXPECT_NE(outcome.err.find("separate them by blanks"), std::string::npos) << command[0] << ": " << outcome.err;
  }
  const Outcome near = run({"path", input, "--from", "0.1,0.1,-0.5", "--to", "7", "-o", output});
  EXPECT_EQ(near.err.find("off the surface"), std::string::npos) << near.err;
}

TEST(PathCommand, GoesThroughPointsAndBack) {
  Folder folder;
  const std::string input = folder.write("cube.off", cube_and_square);
  for (const std::string name : {"loop.csv", "loop.ply", "loop.obj"}) {
    // From the middle of the front over those of three further sides, the second one named by a position off it.
    const Outcome outcome = run({"path", input, "--from", "face:2:.25,.25,.25,.25", "--to",
                                 "1.3,.5,.5 face:3:.25,.25,.25,.25 face:4:.25,.25,.25,.25", "--closed", "-o",
                                 folder / name, "--json", folder / "loop.json", "--view", folder / "loop.png"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const auto json = read_json(folder / "loop.json");
    EXPECT_NEAR(json.at("length").get<double>(), 4, 1e-12);
    for (const auto& length : json.at("lengths")) EXPECT_NEAR(length.get<double>(), 1, 1e-12);
    EXPECT_GT(std::filesystem::file_size(folder / "loop.png"), 1000U);
  }
  EXPECT_NEAR(sum_of_steps(read_numbers(folder / "loop.csv")), 4, 1e-12);
  EXPECT_EQ(io::read(folder / "loop.obj").points.size(), read_numbers(folder / "loop.csv").size());
  EXPECT_EQ(io::read(folder / "loop.ply").points.size(), read_numbers(folder / "loop.csv").size());
}

TEST(PathCommand, NamesWhatItLeadsThrough) {
  Folder folder;
  const std::string input = folder.write("cube.off", cube_and_square);
  const auto length = [&](const std::vector<std::string>& words) {
    std::vector<std::string> all{
        "path", input, "--from", "face:2:.25,.25,.25,.25", "-o", folder / "path.csv", "--json", folder / "path.json"};
    all.insert(all.end(), words.begin(), words.end());
    const Outcome outcome = run(all);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return read_json(folder / "path.json").at("length").get<double>();
  };
  const std::string beside = "face:5:.25,.25,.25,.25", behind = "face:3:.25,.25,.25,.25";
  EXPECT_NEAR(length({"--through", beside, "--to", behind}), 2, 1e-12);
  EXPECT_EQ(length({"--through", beside, "--to", behind}), length({"--to", beside + " " + behind}));
}

TEST(PathCommand, FindsAPathForEveryPairOfAFile) {
  Folder folder;
  const std::string input = folder.write("cube.off", cube_and_square);
  const std::string pairs = folder.write("pairs.txt", "# from to\n0 7\n0 3\n\n0 9\n3.5,0,0 3.5,1,0\n0 0 0  0 0 1\n");
  for (const std::string how : {"", "--fast"}) {
    std::vector<std::string> words{"path",    input,
                                   "--pairs", pairs,
                                   "-o",      folder / "paths.csv",
                                   "--json",  folder / "paths.json",
                                   "--view",  folder / "paths.png"};
    if (!how.empty()) words.push_back(how);
    const Outcome outcome = run(words);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_NE(outcome.err.find("different components of the surface: 1 of 5"), std::string::npos) << outcome.err;
    const auto paths = read_json(folder / "paths.json").at("paths");
    const double expected[] = {std::sqrt(5.0), std::sqrt(2.0), 0, 1, 1};
    std::vector<double> walked(5, 0), last(5, 0);
    for (const NumberRow& row : read_numbers(folder / "paths.csv"))
      last[static_cast<std::size_t>(row.at("curve"))] = row.at("arclength");
    for (std::size_t k = 0; k < 5; ++k) {
      EXPECT_EQ(paths[k].at("status"), k == 2 ? "disconnected" : "ok");
      EXPECT_NEAR(last[k], expected[k], 1e-12);
      if (k == 2)
        EXPECT_TRUE(paths[k].at("length").is_null());
      else
        EXPECT_NEAR(paths[k].at("length").get<double>(), expected[k], 1e-12);
    }
  }
  for (const char* name : {"paths.obj", "paths.ply"}) {
    EXPECT_EQ(run({"path", input, "--pairs", pairs, "-o", folder / name}).status, 0);
    EXPECT_EQ(io::read(folder / name).points.size(), read_numbers(folder / "paths.csv").size());
  }
  const std::string curves = read_text(folder / "paths.obj");
  std::size_t lines = 0;
  for (std::size_t at = curves.find("\nl "); at != std::string::npos; at = curves.find("\nl ", at + 1)) ++lines;
  EXPECT_EQ(lines, 4U) << "one for each path";
}

TEST(PathCommand, NamesTheLineOfABadPair) {
  Folder folder;
  const std::string input = folder.write("cube.off", cube_and_square);
  const Outcome outcome =
      run({"path", input, "--pairs", folder.write("pairs.txt", "0 7\n0 1 2\n"), "-o", folder / "paths.csv"});
  EXPECT_NE(outcome.status, 0);
  EXPECT_NE(outcome.err.find("line 2"), std::string::npos) << outcome.err;
  EXPECT_NE(run({"path", input, "-o", folder / "paths.csv"}).err.find("--pairs"), std::string::npos);
}

TEST(PathCommand, TightensALoop) {
  Folder folder;
  const std::string input = folder.write("cube.off", cube_and_square);
  // Wavering about the cube: the shortest such loops are straight and as long as four sides.
  const std::vector<std::string> words{"path",
                                       input,
                                       "--from",
                                       "face:2:.3,.3,.2,.2",
                                       "--to",
                                       "face:5:.2,.4,.2,.2 face:3:.25,.25,.25,.25 face:4:.3,.2,.2,.3",
                                       "--closed",
                                       "-o",
                                       folder / "loop.csv",
                                       "--json",
                                       folder / "loop.json"};
  std::vector<std::string> tight = words;
  tight.push_back("--tighten");
  ASSERT_EQ(run(words).status, 0);
  const double loose = read_json(folder / "loop.json").at("length").get<double>();
  const Outcome outcome = run(tight);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto json = read_json(folder / "loop.json");
  EXPECT_NEAR(json.at("length").get<double>(), 4, 1e-9);
  EXPECT_NEAR(json.at("length_through_stops").get<double>(), loose, 1e-12);
  EXPECT_GT(loose, 4);
  // On a flat square a loop goes around nothing.
  const Outcome flat =
      run({"path", input, "--from", "8", "--to", "9 10", "--closed", "--tighten", "-o", folder / "flat.csv"});
  EXPECT_EQ(flat.status, 1);
  EXPECT_NE(flat.err.find("shrinks"), std::string::npos) << flat.err;
}

TEST(PathCommand, SaysWhyThereIsNone) {
  Folder folder;
  const std::string input = folder.write("cube.off", cube_and_square);
  const auto refused = [&](const std::string& file, const std::string& to, const std::string& word) {
    const Outcome outcome = run({"path", file, "--from", "0", "--to", to, "-o", folder / "path.csv"});
    EXPECT_EQ(outcome.status, 1);
    EXPECT_NE(outcome.err.find(word), std::string::npos) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "path.csv"));
  };
  refused(input, "9", "there is no path");
  refused(input, "12", "--to 12");
}

TEST(PathCommand, IsStraightOverAFlatCloud) {
  Folder folder;
  const std::string input = folder.write("plane.xyz", xyz(plane(20)));
  const Outcome outcome = run(
      {"path", input, "--from", "0", "--to", "0.9,0.8,0", "-o", folder / "path.csv", "--json", folder / "path.json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto rows = read_numbers(folder / "path.csv");
  ASSERT_GT(rows.size(), 5U);
  const double across = rows.back().at("x") - rows.front().at("x"), up = rows.back().at("y") - rows.front().at("y");
  EXPECT_NEAR(rows.back().at("x"), 0.9, 1e-12);
  for (const NumberRow& row : rows)
    EXPECT_NEAR((row.at("x") - rows.front().at("x")) * up, (row.at("y") - rows.front().at("y")) * across, 1e-12);
  EXPECT_NEAR(read_json(folder / "path.json").at("length").get<double>(), std::hypot(across, up), 1e-11);
  for (const char* option : {"--fast", "--tighten"}) {
    const Outcome refused =
        run({"path", input, "--from", "0", "--to", "5 90", "--closed", option, "-o", folder / "no.csv"});
    EXPECT_EQ(refused.status, 1);
    EXPECT_NE(refused.err.find("requires faces"), std::string::npos) << refused.err;
  }
}

TEST(TraceCommand, GoesStraightOverAFlatCloudToItsRim) {
  Folder folder;
  const std::string input = folder.write("plane.xyz", xyz(plane(20)));
  const Outcome outcome = run({"trace", input, "--source", "0", "--direction", "1,0.5,3", "--length", "0.3", "-o",
                               folder / "line.csv", "--json", folder / "line.json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto rows = read_numbers(folder / "line.csv");
  EXPECT_NEAR(rows.back().at("x") - rows.front().at("x"), 0.3 * 2 / std::sqrt(5.0), 1e-12);
  EXPECT_NEAR(rows.back().at("y") - rows.front().at("y"), 0.3 / std::sqrt(5.0), 1e-12);
  ASSERT_EQ(run({"trace", input, "--source", "0", "--direction", "1,0,0", "--length", "9", "-o", folder / "line.csv",
                 "--json", folder / "line.json"})
                .status,
            0);
  const auto json = read_json(folder / "line.json");
  EXPECT_EQ(json.at("end").at("at"), "boundary");
  EXPECT_NEAR(json.at("length").get<double>(), 0.5, 0.1);
}

/// The line of length L at angle a ends where the map of the source has the coordinates L (cos a, sin a).
TEST(TraceCommand, TakesAnAngleFromTheUAxis) {
  Folder folder;
  const std::string cube = folder.write("cube.off", cube_and_square), cloud = folder.write("plane.xyz", xyz(plane(20)));
  const std::vector<std::array<std::string, 2>> sources = {
      {cube, "face:2:.2,.3,.3,.2"}, {cube, "face:6:.25,.25,.25,.25"}, {cloud, "0"}};
  for (const auto& [input, source] : sources) {
    for (const double degrees : {0.0, 30.0, -117.5}) {
      const std::string angle = std::to_string(degrees),
                        lines = folder.write("lines.txt", source + " " + angle + " 0.2\n");
      const Outcome one = run(
          {"trace", input, "--source", source, "--direction=" + angle, "--length", "0.2", "-o", folder / "line.csv"});
      ASSERT_EQ(one.status, 0) << one.err;
      ASSERT_EQ(run({"trace", input, "--lines", lines, "-o", folder / "lines.csv"}).status, 0);
      const double a = degrees * std::numbers::pi / 180;
      const Outcome mapped = run({"inverse", input, "--source", source,
                                  "--at=" + std::to_string(0.2 * std::cos(a)) + "," + std::to_string(0.2 * std::sin(a)),
                                  "-o", folder / "point.csv"});
      ASSERT_EQ(mapped.status, 0) << mapped.err;
      const auto line = read_numbers(folder / "line.csv"), of_file = read_numbers(folder / "lines.csv"),
                 point = read_numbers(folder / "point.csv");
      for (const char* axis : {"x", "y", "z"}) {
        EXPECT_NEAR(line.back().at(axis), point.front().at(axis), 2e-6) << source << " " << degrees;
        EXPECT_NEAR(of_file.back().at(axis), line.back().at(axis), 1e-12);
      }
    }
  }
  const Outcome wrong =
      run({"trace", cube, "--source", "0", "--direction", "30,5", "--length", "1", "-o", folder / "line.csv"});
  EXPECT_NE(wrong.err.find("--direction"), std::string::npos) << wrong.err;
}

TEST(TraceCommand, GoesRoundACube) {
  Folder folder;
  const std::string input = folder.write("cube.off", cube_and_square);
  const Outcome outcome = run({"trace", input, "--source", "face:2:.2,.3,.3,.2", "--direction", "1,0,0", "--length",
                               "4", "-o", folder / "line.csv", "--json", folder / "line.json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto rows = read_numbers(folder / "line.csv");
  for (const char* axis : {"x", "y", "z"}) EXPECT_NEAR(rows.back().at(axis), rows.front().at(axis), 1e-12);
  EXPECT_NEAR(sum_of_steps(rows), 4, 1e-12);
  EXPECT_EQ(read_json(folder / "line.json").at("end").at("at"), "length");
}

TEST(TraceCommand, EndsAtTheBoundary) {
  Folder folder;
  const std::string input = folder.write("cube.off", cube_and_square);
  const Outcome outcome = run({"trace", input, "--source", "3.25,.5,0", "--direction", "1,0,7", "--length", "4", "-o",
                               folder / "line.csv", "--json", folder / "line.json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto json = read_json(folder / "line.json");
  EXPECT_EQ(json.at("end").at("at"), "boundary");
  EXPECT_NEAR(json.at("length").get<double>(), 0.75, 1e-12);
  EXPECT_NEAR(read_numbers(folder / "line.csv").back().at("x"), 4, 1e-12);
}

TEST(TraceCommand, GoesAlongEveryLineOfAFile) {
  Folder folder;
  const std::string input = folder.write("cube.off", cube_and_square);
  const std::string lines = folder.write("lines.txt", "face:2:.2,.3,.3,.2 1,0,0\n3.25,.5,0 1,0,7 9\n");
  const Outcome outcome = run({"trace", input, "--lines", lines, "--length", "4", "-o", folder / "lines.csv", "--json",
                               folder / "lines.json", "--view", folder / "lines.png"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto json = read_json(folder / "lines.json").at("lines");
  EXPECT_EQ(json[0].at("end"), "length");
  EXPECT_NEAR(json[0].at("length").get<double>(), 4, 1e-12);
  EXPECT_EQ(json[1].at("end"), "boundary");
  EXPECT_NEAR(json[1].at("length").get<double>(), 0.75, 1e-12);
  EXPECT_EQ(read_numbers(folder / "lines.csv").back().at("curve"), 1);
  const Outcome endless = run({"trace", input, "--lines", lines, "-o", folder / "lines.csv"});
  EXPECT_NE(endless.err.find("--length"), std::string::npos) << endless.err;
}

TEST(TraceCommand, RefusesADirectionAlongTheNormal) {
  Folder folder;
  const Outcome outcome = run({"trace", folder.write("cube.off", cube_and_square), "--source", "3.25,.5,0",
                               "--direction", "0,0,1", "--length", "1", "-o", folder / "line.csv"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.err.find("--direction"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace ahm::test
