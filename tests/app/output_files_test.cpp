// Output files: which are written, and which existing files are kept.
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "program.hpp"
#include "shapes.hpp"

namespace ahm::test {
namespace {

class OutputFiles : public InFolder {
 protected:
  OutputFiles() {
    write("plane.xyz", xyz(plane(12)));
    write("sphere.xyz", xyz(sphere(300)));
  }

  /// The table of a run with one input and one source.
  static std::string alone(const std::string& arguments) {
    run_ok("logmap " + arguments + " -o alone.csv");
    return read_text("alone.csv");
  }
};

TEST_F(OutputFiles, OfSeveralInputsEqualThoseOfEachInput) {
  run_ok("logmap plane.xyz sphere.xyz --source 3 -o maps/");
  EXPECT_EQ(read_text("maps/plane_map.csv"), alone("plane.xyz -s 3"));
  EXPECT_EQ(read_text("maps/sphere_map.csv"), alone("sphere.xyz -s 3"));
  std::istringstream lines(run_ok("logmap plane.xyz sphere.xyz -s 3 -o maps/ --json -").out);
  Words outputs;  // one line each
  for (std::string line; std::getline(lines, line);) outputs.push_back(nlohmann::json::parse(line).at("output"));
  EXPECT_EQ(outputs, (Words{"maps/plane_map.csv", "maps/sphere_map.csv"}));
}

TEST_F(OutputFiles, OfSeveralSourcesEqualThoseOfEachSource) {
  run_ok("logmap sphere.xyz -s 3 --source 0,0,-1 -s 17 -o {}_uv.csv");
  const Words sources{"3", "0,0,-1", "17"};
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_EQ(read_text("sphere_" + std::to_string(k) + "_uv.csv"), alone("sphere.xyz -s " + sources[k]));
  run_ok("logmap sphere.xyz --sources '3 0,0,-1 17' -o {}_list.csv");
  EXPECT_EQ(read_text("sphere_1_list.csv"), read_text("sphere_1_uv.csv"));
  run_ok("logmap sphere.xyz -s 3 -s 17 --local --radius 0.8 -o maps/");  // a graph for each source
  EXPECT_EQ(read_text("maps/sphere_0_map.csv"), alone("sphere.xyz -s 3 --local --radius 0.8"));
  EXPECT_EQ(read_text("maps/sphere_1_map.csv"), alone("sphere.xyz -s 17 --local --radius 0.8"));
}

TEST_F(OutputFiles, AreWrittenThoughOtherMapsFail) {
  write("broken.xyz", "1 2 three\n");
  const auto outcome = run("logmap broken.xyz plane.xyz -s 3 -s 100000 -o maps/");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_TRUE(has(outcome.err, "broken.xyz", "100000", "3 of 4 maps failed"));
  EXPECT_EQ(read_text("maps/plane_0_map.csv"), alone("plane.xyz -s 3"));
  EXPECT_FALSE(std::filesystem::exists("maps/plane_1_map.csv"));
  // Of many failures the first ten are printed.
  std::string rows = "3\n";
  for (int k = 0; k < 50; ++k) rows += "100000\n";
  write("rows.txt", rows);
  const auto many = run("logmap plane.xyz --sources rows.txt -o many/ --quiet");
  EXPECT_EQ(many.status, 1);
  EXPECT_EQ(std::ranges::count(many.err, '\n'), 12) << many.err;
  EXPECT_TRUE(has(many.err, "more failed maps: 40", "50 of 51 maps failed"));
  EXPECT_TRUE(std::filesystem::exists("many/plane_0_map.csv"));
}

TEST_F(OutputFiles, NeverReplaceInputsOrEachOther) {
  for (const char* folder : {"other", "maps"}) std::filesystem::create_directory(folder);
  write("other/plane.xyz", xyz(plane(5)));
  write("table.csv", "x,y,z\n1,2,3\n");
  write("maps/plane_0_map.csv", "3\n9\n");
  write("scene.gltf", R"({"asset": {"version": "2.0"}, "buffers": [{"uri": "of%20it.csv", "byteLength": 3}]})");
  write("of it.csv", "abc");
  expect_refused("logmap plane.xyz",
                 {{"other/plane.xyz -s 0 -o {}.csv", 1, {"rename one"}},
                  {"sphere.xyz -s 0 -o map.csv", 1, {"one file for several maps"}},
                  {"sphere.xyz -s 0 -o -", 1, {"one file for several maps"}},
                  {"table.csv -s 0 -o {}.csv", 1, {"input file"}},
                  {"-s 0 -o table.csv --no-overwrite", 1, {"--no-overwrite"}},
                  {"-s 5 -o - --json -", 1, {"--output - and --json -"}},
                  {"--sources maps/plane_0_map.csv -o maps/plane_0_map.csv --quiet", 1, {"plane_0_map.csv"}},
                  {"--sources maps/plane_0_map.csv -o maps/ --quiet", 1, {"plane_0_map.csv"}}});
  expect_refused("cells plane.xyz",
                 {{"--sources maps/plane_0_map.csv -o maps/plane_0_map.csv", 1, {"a list that this command reads"}}});
  expect_refused("logmap scene.gltf", {{"--source 0 -o 'of it.csv'", 1, {"a file that belongs to it"}}});
  const Outcome piped = finish(start("logmap - -s 5 --input-format xyz --format csv -o plane.xyz", false, "plane.xyz"));
  EXPECT_EQ(piped.status, 1);
  EXPECT_TRUE(has(piped.err, "the input file"));
  EXPECT_EQ(read_text("plane.xyz"), xyz(plane(12)));
}

TEST_F(OutputFiles, AreAllWrittenOrNone) {
  for (const bool existing : {false, true}) {
    if (existing) write("map.csv", "old");
    expect_refused("logmap plane.xyz", {{"-s 0 -o map.csv --json /dev/full", 1, {"'/dev/full'"}}});
    expect_refused("cells plane.xyz", {{"--count 2 -o map.csv --json /dev/full", 1, {"'/dev/full'"}}});
  }
  write("bad.xyz", "0 0 0\n1 zero 0\n");
  expect_refused("logmap bad.xyz", {{"--source 0 -o map.csv", 1, {"line 2", "'zero'"}}});
  EXPECT_EQ(read_text("map.csv"), "old");
  EXPECT_EQ(alone("plane.xyz -s 0"), (run_ok("logmap plane.xyz -s 0 -o map.csv"), read_text("map.csv")));
}

// The work of an hour must not depend on a reader of the summary.
TEST_F(OutputFiles, AreWrittenThoughThePictureFails) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  const std::string map = alone("plane.xyz -s 3");
  std::filesystem::create_symlink("/dev/full", "full.png");
  const Outcome outcome = run("logmap plane.xyz -s 3 -o map.csv --view full.png --json map.json");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_TRUE(has(outcome.err, "--view full.png"));
  EXPECT_EQ(read_text("map.csv"), map);
  const auto summary = nlohmann::json::parse(read_text("map.json"));
  EXPECT_TRUE(summary.at("failed").contains("view"));
  EXPECT_FALSE(summary.contains("view"));
}

TEST_F(OutputFiles, AreWrittenThoughNobodyReadsTheSummary) {
  Running running = start("logmap plane.xyz -s 0 -o map.csv");
  ::close(running.out);
  running.out = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  finish(running);
  EXPECT_EQ(read_csv("map.csv").size(), 144U);
}

TEST_F(OutputFiles, HaveTheFormatOfTheirExtension) {
  for (const auto& [name, start] : std::map<std::string, std::string>{
           {"map.ply", "ply"}, {"map.CSV", "index,x,y,z,u,v,distance,angle,status,quality,spread"}, {"map.pcd", "#"}}) {
    run_ok("logmap sphere.xyz --source 0 -o " + name);
    EXPECT_TRUE(read_text(name).starts_with(start)) << name;
  }
  run_ok("logmap plane.xyz -s 0 -o maps/ --format jsonl");
  EXPECT_TRUE(std::filesystem::exists("maps/plane_map.jsonl"));
}

TEST_F(OutputFiles, AtStandardOutputHaveNothingElse) {
  const std::string rows = alone("plane.xyz -s 5");
  const auto outcome = run_ok("logmap plane.xyz -s 5 -o -");
  EXPECT_EQ(outcome.out, rows);
  EXPECT_TRUE(has(outcome.err, "vertices"));
  const auto quiet = run_ok("logmap plane.xyz -s 5 -o - --quiet");
  EXPECT_EQ(quiet.out, rows);
  EXPECT_EQ(quiet.err, "");
  EXPECT_TRUE(run_ok("logmap plane.xyz -s 5 -o /dev/stdout").out.starts_with(rows));
  const auto cells = run_ok("cells plane.xyz --sources '3 9' -o - --format jsonl --quiet");
  EXPECT_EQ(nlohmann::json::parse(cells.out.substr(0, cells.out.find('\n'))).at("index"), 0);
}

TEST_F(OutputFiles, MayBeAPictureOnly) {
  run_ok("logmap plane.xyz -s 3 --view plane.png");
  EXPECT_GT(std::filesystem::file_size("plane.png"), 1000u);
  const auto outcome = run("logmap plane.xyz -s 3");
  EXPECT_NE(outcome.status, 0);
  EXPECT_TRUE(has(outcome.err, "--output or --view"));
}

TEST_F(OutputFiles, IncludePicturesAndPages) {
  for (const std::string name : {"map.png", "map.html"}) {
    const auto outcome = run("logmap sphere.xyz --source 0 -o map.csv --view " + name);
    if (outcome.status != 0 && has(outcome.err, "this build of ahm cannot write")) continue;
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_GT(std::filesystem::file_size(name), 1000U);
    EXPECT_TRUE(name == "map.html" || read_text(name).starts_with("\x89PNG"));
  }
}

}  // namespace
}  // namespace ahm::test
