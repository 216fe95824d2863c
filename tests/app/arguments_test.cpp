#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "program.hpp"

namespace ahm::test {
namespace {

using Words = std::vector<std::string>;

/// A small valid run, to be spoilt by more words.
class Arguments : public testing::Test {
 protected:
  Folder folder;
  std::string input = folder.write("cloud.xyz", xyz(sphere(200)));

  Outcome with(Words more, const std::string& source = "0") {
    Words words = {"logmap", input, "--source=" + source, "-o", folder / "map.csv"};
    words.insert(words.end(), more.begin(), more.end());
    return run(words);
  }

  void expect_refused(const Outcome& outcome, int status, const std::string& culprit) {
    EXPECT_EQ(outcome.status, status) << outcome.err;
    EXPECT_NE(outcome.err.find("ahm: error: "), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find(culprit), std::string::npos) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(folder.files(), Words{"cloud.xyz"});
  }
};

TEST_F(Arguments, NumbersAreCheckedAndTheOptionIsNamed) {
  const std::vector<Words> cases = {{"--k", "2"},          {"--k", "-5"},          {"--k", "3.5"},
                                    {"--k", "ten"},        {"--k", "99999999999"}, {"--k", ""},
                                    {"--t-coef", "0"},     {"--t-coef", "-1"},     {"--t-coef", "nan"},
                                    {"--t-coef", "inf"},   {"--t-coef", "1,5"},    {"--t-coef", "1e400"},
                                    {"--t-coef", "1x"},    {"--t-coef", "0x1p3"},  {"--radius", "0"},
                                    {"--radius", "-2"},    {"--radius", "nan"},    {"--radius", "inf"},
                                    {"--voxel", "0"},      {"--voxel", "-0.1"},    {"--voxel", "nan"},
                                    {"--threads", "-1"},   {"--threads", "two"},   {"--u-axis", "1,2"},
                                    {"--u-axis", "0,0,0"}, {"--u-axis", "1,nan,0"}};
  for (const Words& words : cases) expect_refused(with(words), 2, words[0]);
}

TEST_F(Arguments, NamesAreChecked) {
  for (const Words& words : std::vector<Words>{{"--variant", "fast"},
                                               {"--backend", "grid"},
                                               {"--knn", "annoy"},
                                               {"--normals", "up"},
                                               {"--ordering", "metis"}}) {
    const auto outcome = with(words);
    expect_refused(outcome, 2, words[0]);
    EXPECT_NE(outcome.err.find(words[1]), std::string::npos) << outcome.err;
  }
}

TEST_F(Arguments, SourcesAreParsedStrictly) {
  for (const std::string spec : {"", "abc", "-1", "1.5", "99999999999", "1,2", "1,2,3,4", "1,nan,3", "1,,3", "face:1",
                                 "face:x:1,0,0", "face:0:0.5,0.5,0.5", "face:0:-1,1,1", "face:0:1,0"})
    expect_refused(with({}, spec), 2, "--source");
}

TEST_F(Arguments, SourcesMustFitTheInput) {
  expect_refused(with({}, "200"), 1, "200");
  expect_refused(with({}, "face:0:1,0,0"), 1, "face:0");
}

TEST_F(Arguments, BackendsForMeshesNeedFaces) {
  for (const std::string backend : {"trimesh", "polymesh"}) expect_refused(with({"--backend", backend}), 1, backend);
}

TEST_F(Arguments, OptionsForMeshesAreNoneForClouds) {
  for (const Words& words :
       std::vector<Words>{{"--no-flips"}, {"--non-manifold", "split"}, {"--discretization", "polygons"}, {"--repair"}})
    expect_refused(with(words), 1, words[0]);
}

TEST_F(Arguments, UnknownOptionsAndMissingOnesAreUsageErrors) {
  expect_refused(with({"--frobnicate"}), 2, "--frobnicate");
  expect_refused(run({"logmap", input, "-o", folder / "map.csv"}), 2, "--source");
  expect_refused(run({"logmap", input, "--source", "0"}), 2, "--output");
  expect_refused(run({"logmap", "--source", "0", "-o", folder / "map.csv"}), 2, "INPUT");
  expect_refused(run({"frobnicate"}), 2, "frobnicate");
  expect_refused(run({}), 2, "subcommand");
}

TEST_F(Arguments, WrongValuesAreWrongCommandLines) {
  expect_refused(with({"--view", folder / "map.jpg"}), 2, "--view");
  expect_refused(with({"--local"}), 2, "--local: requires --radius");
  expect_refused(with({"--strategy", "global", "--accuracy", "1e-3"}), 2, "--accuracy");
  expect_refused(with({"--method", "exact", "--tolerance", "0.5"}), 2, "--tolerance");
  expect_refused(with({"--sources", "nowhere.txt"}), 2, "--sources: there is no file 'nowhere.txt'");
  const auto refused = [&](const std::string& command, const std::string& option, const std::string& text) {
    const Words words{command, input, option, text, "-o", folder / "lines.csv"};
    expect_refused(run(words), 2, option + ": there is no file '" + text + "'");
  };
  refused("path", "--pairs", "1 2");
  refused("trace", "--lines", "0 1,0,0");
}

TEST_F(Arguments, OnePointIsNoSurroundings) {
  expect_refused(with({"--radius", "1e-9", "--local"}), 1, "only 1 point lies within 1.5e-09 of the source 0");
}

TEST(UnknownFileType, MayBeNamed) {
  Folder folder;
  const Outcome outcome = run({"info", folder.write("cloud.dat", xyz(sphere(10)))});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.err.find("unknown file type '.dat'"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("--input-format"), std::string::npos) << outcome.err;
}

TEST_F(Arguments, OutputsAreCheckedBeforeTheWork) {
  const auto refused = [&](const Words& more, const std::string& culprit) {
    Words words = {"logmap", input, "--source", "0"};
    words.insert(words.end(), more.begin(), more.end());
    expect_refused(run(words), 1, culprit);
  };
  refused({"-o", folder / "map.stl"}, ".stl");
  refused({"-o", folder / "map"}, "map");
  refused({"-o", folder / "nowhere/map.csv"}, "nowhere");
  refused({"-o", folder / "nowhere/maps/"}, "nowhere");
  refused({"-o", input}, "cloud.xyz");
  refused({"-o", folder / "map.csv", "--json", input}, "--json");
  refused({"-o", folder / "map.csv", "--json", folder / "./map.csv"}, "same file");
  refused({"-o", folder / "map.csv", "--view", folder / "nowhere/map.png"}, "nowhere");
  EXPECT_EQ(read_text(input), xyz(sphere(200)));
}

TEST_F(Arguments, ALinkToTheInputIsTheInput) {
  std::filesystem::create_symlink(input, folder / "link.csv");
  const auto outcome = run({"logmap", input, "--source", "0", "-o", folder / "link.csv"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.err.find("input"), std::string::npos) << outcome.err;
  EXPECT_EQ(read_text(input), xyz(sphere(200)));
}

TEST_F(Arguments, ALinkToWhatIsNotThereYetIsThatFile) {
  std::filesystem::create_symlink("map.csv", folder / "link.csv");
  const auto outcome = run({"logmap", input, "--source", "0", "-o", folder / "map.csv", "--json", folder / "link.csv"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.err.find("the same file"), std::string::npos) << outcome.err;
}

TEST(FilesBesideTheInput, AreNotReplaced) {
  const Folder folder;
  const std::string scene = folder.write(
      "scene.gltf", R"({"asset": {"version": "2.0"}, "buffers": [{"uri": "of%20it.csv", "byteLength": 3}]})");
  const std::string buffer = folder.write("of it.csv", "abc");
  const auto outcome = run({"logmap", scene, "--source", "0", "-o", buffer});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.err.find("would overwrite the input file, or a file that belongs to it"), std::string::npos)
      << outcome.err;
  EXPECT_EQ(read_text(buffer), "abc");
}

TEST(Help, IsThereForStrangers) {
  const auto main_help = run({"--help"});
  EXPECT_EQ(main_help.status, 0);
  for (const char* word : {"logmap", "info", "Examples", "--version"})
    EXPECT_NE(main_help.out.find(word), std::string::npos) << word;
  const auto logmap_help = run({"logmap", "--help"});
  EXPECT_EQ(logmap_help.status, 0);
  for (const char* word : {"--source",   "--output",   "--variant", "--backend", "--t-coef", "--voxel",   "--outliers",
                           "--k",        "--knn",      "--radius",  "--json",    "--view",   "--verbose", "--normals",
                           "--drop-nan", "--ordering", "--threads", "--u-axis",  "Examples", "face:"})
    EXPECT_NE(logmap_help.out.find(word), std::string::npos) << word;
  EXPECT_EQ(run({"info", "--help"}).status, 0);
}

#ifdef AHM_WITH_PCL
TEST(Program, FindsItsModulesWhenItIsFoundThroughPath) {
  Folder folder;
  std::string cloud =
      "VERSION 0.7\nFIELDS x y z\nSIZE 8 8 8\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 64\nHEIGHT 1\nPOINTS 64\nDATA ascii\n";
  folder.write("cloud.pcd", cloud + xyz(plane(8)));
  const std::string programs = std::filesystem::path(AHM_PROGRAM).parent_path().string();
  const std::string command =
      "cd '" + (folder / "") + "' && PATH='" + programs + "':\"$PATH\" ahm info cloud.pcd > out.txt 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0) << read_text(folder / "out.txt");
}
#endif

TEST(Version, NamesTheLibraries) {
  const auto outcome = run({"--version"});
  EXPECT_EQ(outcome.status, 0);
  for (const char* word : {"ahm ", "CHOLMOD ", "BLAS "})
    EXPECT_NE(outcome.out.find(word), std::string::npos) << outcome.out;
}

}  // namespace
}  // namespace ahm::test
