// Clouds that --voxel thins: what is drawn, colored and named of them. Noisy ones, which are smoothed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "ahm/io/image.hpp"
#include "ahm/io/read.hpp"
#include "program.hpp"

namespace ahm::test {
namespace {

using Words = std::vector<std::string>;

Words joined(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

/// A command on a plane of 1600 points, of which the voxel grid keeps about one in four.
class ThinnedCloud : public testing::Test {
 protected:
  void SetUp() override {
#ifndef AHM_WITH_PCL
    GTEST_SKIP() << "this build has no PCL";
#endif
  }
  Outcome run_thinned(const std::string& command, const Words& more) {
    return run(joined({command, input, "--voxel", "0.05"}, more));
  }

  Folder folder;
  const std::vector<Vec3> points = plane(40);
  const std::string input = folder.write("plane.xyz", xyz(points));
};

/// Of what is drawn, the share without a color.
double gray_share(const Image& image) {
  std::size_t gray = 0, drawn = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const std::uint8_t* p = image.pixel(x, y);
      const auto [least, most] = std::minmax({p[0], p[1], p[2]});
      if (least == 255) continue;
      ++drawn;
      gray += most - least < 12;
    }
  return static_cast<double>(gray) / static_cast<double>(drawn);
}

TEST_F(ThinnedCloud, IsDrawnWithoutThePointsThatWereReplaced) {
  if (!io::has_images()) GTEST_SKIP() << "this build has no stb";
  const std::string view = folder / "view.png";
  const Words written{"-o", folder / "out.csv", "--view", view, "--size", "400x300"};
  const std::map<std::string, Words> commands{
      {"logmap", {"--source", "0"}}, {"stroke", {"--curve", "0.2,0.2,0 0.8,0.7,0"}}, {"cells", {"--count", "9"}}};
  for (const auto& [command, more] : commands) {
    const Outcome outcome = run_thinned(command, joined(more, written));
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_LT(gray_share(io::read_image(view)), 0.2) << command;
  }
}

TEST_F(ThinnedCloud, HasTheColorsOfADecalAtAllPoints) {
  if (!io::has_images()) GTEST_SKIP() << "this build has no stb";
  Image red(4, 4);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x) red.pixel(x, y)[0] = red.pixel(x, y)[3] = 255;
  io::write_png(folder / "red.png", red);
  const Outcome outcome = run_thinned("decal", {"--image", folder / "red.png", "--source", "0", "--u-axis", "1,0,0",
                                                "--size", "0.5", "-o", folder / "out.ply"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const io::Geometry out = io::read(folder / "out.ply");
  ASSERT_EQ(out.colors.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double away = std::max(std::abs(points[i][0] - points[0][0]), std::abs(points[i][1] - points[0][1]));
    if (std::abs(away - 0.25) < 0.05) continue;  // the nearest kept point may be on the other side of the border
    EXPECT_EQ(out.colors[i][1] == 0, away < 0.25) << i;
  }
}

TEST_F(ThinnedCloud, KeepsEveryRowThatACommandNames) {
  // Of neighbours in one voxel at most one would be kept.
  const Words all{"41", "42", "81", "82", "83", "905", "906"};
  std::string list, pairs, lines;
  for (const std::string& row : all) {
    list += row + " ";
    pairs += row + " 0\n";
    lines += row + " 1,0,0 0.1\n";
  }
  const std::string csv = folder / "out.csv";
  const std::map<std::string, std::vector<Words>> commands{
      {"path",
       {{"--from", "41", "--through", "42 81", "--to", "82 83 905 906", "-o", csv},
        {"--pairs", folder.write("pairs.txt", pairs), "-o", csv}}},
      {"trace", {{"--lines", folder.write("lines.txt", lines), "-o", csv}}},
      {"cells", {{"--sources", list, "-o", csv}, {"--count", "4", "--start", "82", "-o", csv}}},
      {"center", {{"--points", list, "--start", "42"}}},
      {"stroke", {{"--curve", list, "-o", csv}}}};
  for (const auto& [command, each] : commands)
    for (const Words& more : each) EXPECT_EQ(run_thinned(command, more).status, 0) << command << ' ' << more.front();
  // The named rows are found, and not others beside them.
  ASSERT_EQ(run_thinned("cells", {"--sources", list, "-o", csv}).status, 0);
  const auto cells = read_numbers(csv);
  for (std::size_t k = 0; k < all.size(); ++k) EXPECT_EQ(cells[std::stoul(all[k])].at("label"), static_cast<double>(k));
}

TEST_F(ThinnedCloud, KeepsTheSourcesOfCharts) {
  if (!io::has_images()) GTEST_SKIP() << "this build has no stb";
  EXPECT_EQ(run_thinned("atlas", {"--sources", "41 42 906", "-o", folder / "out.obj"}).status, 0);
}

TEST_F(ThinnedCloud, RefusesNamedRowsThatDoNotExist) {
  const Outcome outcome = run_thinned("path", {"--from", "0", "--to", "1600", "-o", folder / "out.csv"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.err.find("--to 1600"), std::string::npos) << outcome.err;
}

// Each point half of the spacing inside or outside of the unit sphere.
TEST(NoisyCloud, IsSmoothedWithAWordUnlessThatIsTurnedOff) {
  Folder folder;
  std::vector<Vec3> points = sphere(2000);
  for (std::size_t i = 0; i < points.size(); ++i)
    for (double& x : points[i]) x *= i * i % 7 < 3 ? 1.03 : 0.97;
  const std::string input = folder.write("noisy.xyz", xyz(points));
  const auto map = [&](const Words& more) {
    return run(joined({"logmap", input, "--source", "0", "-o", folder / "map.csv"}, more));
  };
  EXPECT_NE(map({}).err.find("points were smoothed"), std::string::npos) << map({}).err;
  EXPECT_NE(map({"--smooth", "0.3"}).err.find("2000 points were smoothed"), std::string::npos);
  EXPECT_EQ(map({"--smooth", "off"}).err.find("smoothed"), std::string::npos);
  const Outcome refused = map({"--smooth", "on"});
  EXPECT_EQ(refused.status, 2);
  EXPECT_NE(refused.err.find("'on' is not auto, off or a number > 0"), std::string::npos) << refused.err;
}

}  // namespace
}  // namespace ahm::test
