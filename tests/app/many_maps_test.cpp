// Several files and several sources in one run: each map is what a run of its own makes.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "program.hpp"

namespace ahm::test {
namespace {

using Words = std::vector<std::string>;

class ManyMaps : public testing::Test {
 protected:
  Folder folder;
  std::string plane_file = folder.write("plane.xyz", xyz(plane(12)));
  std::string sphere_file = folder.write("sphere.xyz", xyz(sphere(300)));

  std::string alone(const std::string& input, const std::string& source, Words more = {}) {
    Words words{"logmap", input, "--source", source, "-o", folder / "alone.csv"};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = ahm::test::run(words);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return read_text(folder / "alone.csv");
  }
};

TEST_F(ManyMaps, OfFilesAreThoseOfEachFile) {
  const auto outcome = run({"logmap", plane_file, sphere_file, "--source", "3", "-o", folder / "maps/"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(read_text(folder / "maps/plane_map.csv"), alone(plane_file, "3"));
  EXPECT_EQ(read_text(folder / "maps/sphere_map.csv"), alone(sphere_file, "3"));
}

TEST_F(ManyMaps, OfSourcesAreThoseOfEachSource) {
  const auto outcome =
      run({"logmap", sphere_file, "-s", "3", "--source", "0,0,-1", "-s", "17", "-o", folder / "{}_uv.csv"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(read_text(folder / "sphere_0_uv.csv"), alone(sphere_file, "3"));
  EXPECT_EQ(read_text(folder / "sphere_1_uv.csv"), alone(sphere_file, "0,0,-1"));
  EXPECT_EQ(read_text(folder / "sphere_2_uv.csv"), alone(sphere_file, "17"));
  const auto listed = run({"logmap", sphere_file, "--sources", "3 0,0,-1 17", "-o", folder / "{}_list.csv"});
  ASSERT_EQ(listed.status, 0) << listed.err;
  EXPECT_EQ(read_text(folder / "sphere_1_list.csv"), read_text(folder / "sphere_1_uv.csv"));
}

TEST_F(ManyMaps, OnGraphsThatDependOnTheSourceAreThoseOfEachSource) {
  const Words local{"--local", "--radius", "0.8"};
  Words words{"logmap", sphere_file, "-s", "3", "-s", "17", "-o", folder / "maps/"};
  words.insert(words.end(), local.begin(), local.end());
  const auto outcome = run(words);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(read_text(folder / "maps/sphere_0_map.csv"), alone(sphere_file, "3", local));
  EXPECT_EQ(read_text(folder / "maps/sphere_1_map.csv"), alone(sphere_file, "17", local));
}

TEST_F(ManyMaps, AreMadeBesideThoseThatFail) {
  folder.write("broken.xyz", "1 2 three\n");
  const auto outcome =
      run({"logmap", folder / "broken.xyz", plane_file, "-s", "3", "-s", "100000", "-o", folder / "maps/"});
  EXPECT_EQ(outcome.status, 1);
  for (const char* part : {"broken.xyz", "100000", "3 of 4 maps failed"})
    EXPECT_NE(outcome.err.find(part), std::string::npos) << outcome.err;
  EXPECT_EQ(read_text(folder / "maps/plane_0_map.csv"), alone(plane_file, "3"));
  EXPECT_FALSE(std::filesystem::exists(folder / "maps/plane_1_map.csv"));
}

TEST_F(ManyMaps, OfManyThatFailTheFirstAreTold) {
  std::string rows = "3\n";
  for (int k = 0; k < 50; ++k) rows += "100000\n";
  const auto outcome =
      run({"logmap", plane_file, "--sources", folder.write("rows.txt", rows), "-o", folder / "maps/", "--quiet"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 12) << outcome.err;
  for (const char* part : {"more failed maps: 40", "50 of 51 maps failed"})
    EXPECT_NE(outcome.err.find(part), std::string::npos) << outcome.err;
  EXPECT_TRUE(std::filesystem::exists(folder / "maps/plane_0_map.csv"));
}

TEST_F(ManyMaps, TellOneLineEach) {
  const auto outcome = run({"logmap", plane_file, sphere_file, "-s", "3", "-o", folder / "maps/", "--json", "-"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  std::istringstream lines(outcome.out);
  Words outputs;
  for (std::string line; std::getline(lines, line);)
    outputs.push_back(nlohmann::json::parse(line).at("output").get<std::string>());
  EXPECT_EQ(outputs, (Words{folder / "maps/plane_map.csv", folder / "maps/sphere_map.csv"}));
}

TEST_F(ManyMaps, NeverGoToOneFileNorToAnInput) {
  const auto refused = [&](const Words& words, const std::string& part) {
    Words all{"logmap"};
    all.insert(all.end(), words.begin(), words.end());
    const auto outcome = run(all);
    EXPECT_EQ(outcome.status, 1) << outcome.err;
    EXPECT_NE(outcome.err.find(part), std::string::npos) << outcome.err;
  };
  std::filesystem::create_directory(folder / "other");
  folder.write("other/plane.xyz", xyz(plane(5)));
  refused({plane_file, folder / "other/plane.xyz", "-s", "0", "-o", folder / "{}.csv"}, "rename one");
  refused({plane_file, sphere_file, "-s", "0", "-o", folder / "map.csv"}, "one file for several maps");
  refused({plane_file, sphere_file, "-s", "0", "-o", "-"}, "one file for several maps");
  folder.write("sphere.csv", "x,y,z\n1,2,3\n");
  refused({plane_file, folder / "sphere.csv", "-s", "0", "-o", folder / "{}.csv"}, "input file");
  EXPECT_EQ(read_text(folder / "sphere.csv"), "x,y,z\n1,2,3\n");
  EXPECT_FALSE(std::filesystem::exists(folder / "plane_map.csv"));
}

TEST_F(ManyMaps, NeverReplaceAListThatIsRead) {
  std::filesystem::create_directory(folder / "maps");
  const std::string list = folder.write("maps/plane_0_map.csv", "3\n9\n");
  for (const std::string& output : {list, folder / "maps/"}) {
    const auto refused = run({"logmap", plane_file, "--sources", list, "-o", output, "--quiet"});
    EXPECT_EQ(refused.status, 1);
    EXPECT_NE(refused.err.find("plane_0_map.csv"), std::string::npos) << refused.err;
    EXPECT_EQ(read_text(list), "3\n9\n");
  }
  const auto cells = run({"cells", plane_file, "--sources", list, "-o", list});
  EXPECT_NE(cells.err.find("a list that this command reads"), std::string::npos) << cells.err;
}

TEST_F(ManyMaps, OneMapTakesAFolderToo) {
  ASSERT_EQ(run({"logmap", plane_file, "-s", "0", "-o", folder / "maps/", "--format", "jsonl"}).status, 0);
  EXPECT_TRUE(std::filesystem::exists(folder / "maps/plane_map.jsonl"));
}

TEST_F(ManyMaps, ReplaceFilesUnlessForbidden) {
  folder.write("map.csv", "mine");
  const auto refused = run({"logmap", plane_file, "-s", "0", "-o", folder / "map.csv", "--no-overwrite"});
  EXPECT_EQ(refused.status, 1);
  EXPECT_NE(refused.err.find("--no-overwrite"), std::string::npos) << refused.err;
  EXPECT_EQ(read_text(folder / "map.csv"), "mine");
  ASSERT_EQ(run({"logmap", plane_file, "-s", "0", "-o", folder / "map.csv"}).status, 0);
  EXPECT_EQ(read_text(folder / "map.csv"), alone(plane_file, "0"));
}

TEST_F(ManyMaps, StandardOutputHoldsTheRowsAndNothingElse) {
  const std::string wanted = alone(plane_file, "5");
  const auto outcome = run({"logmap", plane_file, "-s", "5", "-o", "-"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.out, wanted);
  EXPECT_NE(outcome.err.find("vertices"), std::string::npos);
  const auto quiet = run({"logmap", plane_file, "-s", "5", "-o", "-", "--quiet"});
  EXPECT_EQ(quiet.out, wanted);
  EXPECT_EQ(quiet.err, "");
  const auto both = run({"logmap", plane_file, "-s", "5", "-o", "-", "--json", "-"});
  EXPECT_EQ(both.status, 1);
  EXPECT_EQ(both.out, "");
  const auto cells = run({"cells", plane_file, "--sources", "3 9", "-o", "-", "--format", "jsonl", "--quiet"});
  ASSERT_EQ(cells.status, 0) << cells.err;
  EXPECT_EQ(nlohmann::json::parse(cells.out.substr(0, cells.out.find('\n'))).at("index"), 0);
}

TEST_F(ManyMaps, StandardInputIsAFileWithoutAName) {
  const std::string wanted = alone(plane_file, "5");
  const auto piped = [&](const Words& more) {
    Words words{"logmap", "-", "-s", "5", "-o", folder / "piped.csv"};
    words.insert(words.end(), more.begin(), more.end());
    return finish(start(words, false, plane_file));
  };
  const auto outcome = piped({"--input-format", "xyz"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(read_text(folder / "piped.csv"), wanted);
  const auto unknown = piped({});
  EXPECT_EQ(unknown.status, 1);
  EXPECT_NE(unknown.err.find("--input-format"), std::string::npos) << unknown.err;
}

TEST_F(ManyMaps, StandardInputIsAnInput) {
  const auto outcome = finish(start(
      {"logmap", "-", "-s", "5", "--input-format", "xyz", "--format", "csv", "-o", plane_file}, false, plane_file));
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.err.find("the input file"), std::string::npos) << outcome.err;
  EXPECT_EQ(read_text(plane_file), xyz(plane(12)));
}

}  // namespace
}  // namespace ahm::test
