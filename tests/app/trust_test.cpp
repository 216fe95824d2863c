// What the program says of maps that are not to be trusted.
#include <gtest/gtest.h>

#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/io/image.hpp"
#include "program.hpp"

namespace ahm::test {
namespace {

/// Runs every subcommand that makes a map from a source, and calls `check` with its name and standard error.
template <class Check>
void for_each_map(const std::vector<Vec3>& points, const std::string& size, const Check& check) {
  Folder folder;
  const auto input = folder.write("points.xyz", xyz(points));
  std::vector<std::vector<std::string>> commands{
      {"logmap", input, "-o", folder / "map.csv"},
      {"inverse", input, "--at", "0.01,0", "-o", folder / "points.csv"},
      {"coverage", input, "--radius", size, "--spacing", "0.05", "-o", folder / "path.csv"},
      {"stroke", input, "--curve", "0 9", "-o", folder / "stroke.csv"}};
  if (io::has_images()) {
    io::write_png(folder / "image.png", Image(8, 8));
    commands.push_back({"decal", input, "--image", folder / "image.png", "--size", size, "-o", folder / "decal.ply"});
  }
  for (auto& words : commands) {
    if (words[0] != "stroke") words.insert(words.end(), {"--source", "0"});
    const auto outcome = run(words);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    check(words[0], outcome.err);
  }
}

constexpr const char* warning = "the map is not reliable at ";

TEST(Trust, MoreThanAFifthWithoutItIsAWarningOfEverySubcommandThatMaps) {
  for_each_map(torus(900).positions, "4", [](const std::string& name, const std::string& err) {
    EXPECT_NE(err.find(warning), std::string::npos) << name << ": " << err;
  });
}

TEST(Trust, IsNoWarningOnAPlane) {
  for_each_map(plane(20), "0.3", [](const std::string& name, const std::string& err) {
    EXPECT_EQ(err.find(warning), std::string::npos) << name << ": " << err;
  });
}

TEST(Trust, OfACoverageIsThatWithinTheRadius) {
  Folder folder;
  const auto input = folder.write("points.xyz", xyz(torus(4000).positions));
  const auto outcome =
      run({"coverage", input, "--source", "0", "--radius", "0.4", "--spacing", "0.1", "-o", folder / "path.csv"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err.find(warning), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace ahm::test
