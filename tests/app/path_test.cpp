// Paths and lines over meshes, through the program.
#include <gtest/gtest.h>

#include <cmath>

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

TEST(PathCommand, SaysWhyThereIsNone) {
  Folder folder;
  const std::string input = folder.write("cube.off", cube_and_square);
  const auto refused = [&](const std::string& file, const std::string& to, const std::string& word) {
    const Outcome outcome = run({"path", file, "--from", "0", "--to", to, "-o", folder / "path.csv"});
    EXPECT_EQ(outcome.status, 1);
    EXPECT_NE(outcome.err.find(word), std::string::npos) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "path.csv"));
  };
  refused(input, "9", "does not connect");
  refused(input, "12", "--to 12");
  refused(folder.write("plane.xyz", xyz(plane(10))), "5", "faces");
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

TEST(TraceCommand, RefusesADirectionAlongTheNormal) {
  Folder folder;
  const Outcome outcome = run({"trace", folder.write("cube.off", cube_and_square), "--source", "3.25,.5,0",
                               "--direction", "0,0,1", "--length", "1", "-o", folder / "line.csv"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.err.find("--direction"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace ahm::test
