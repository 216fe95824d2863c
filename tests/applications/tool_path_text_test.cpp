// Tool paths as texts: runs of motions, and G-code.
#include "ahm/applications/tool_path_text.hpp"

#include <gtest/gtest.h>

#include <cctype>
#include <cmath>
#include <map>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "ahm/applications/tool_path.hpp"
#include "ahm/util/vec.hpp"
#include "part_surface.hpp"
#include "support/expect_error.hpp"

namespace ahm::test {
namespace {

TEST(ToolPath, RunsFollowTheMotions) {
  const ToolPath path = tool_path(surface_of(two_boxes()), {.spacing = 0.5});
  std::size_t next = 0, passes = 0, on_surface = 0, lifted = 0;
  for (const ToolRun& run : tool_runs(path)) {
    EXPECT_EQ(run.begin, next);
    next = run.end;
    for (std::size_t k = run.begin; k < run.end; ++k) EXPECT_EQ(path.poses[k].kind, run.kind);
    EXPECT_EQ(run.from, run.kind == ToolMotion::pass || run.begin == 0 ? run.begin : run.begin - 1);
    passes += run.kind == ToolMotion::pass;
    if (run.kind == ToolMotion::link) (run.lifted ? lifted : on_surface) += 1;
  }
  EXPECT_EQ(next, path.poses.size());
  EXPECT_EQ(passes, path.passes.size());
  EXPECT_EQ(static_cast<Index>(on_surface), path.surface_links);
  EXPECT_EQ(static_cast<Index>(lifted), path.lifted_links);
  EXPECT_GT(lifted, 0U);
}

/// A line of G-code as its words.
using Block = std::map<char, double>;
std::vector<Block> blocks(const std::string& program) {
  std::vector<Block> result;
  std::istringstream lines(program);
  for (std::string line; std::getline(lines, line);) {
    EXPECT_LT(line.size(), 256U);
    if (line.starts_with('(')) {
      EXPECT_EQ(line.find(')'), line.size() - 1) << line;
      continue;
    }
    Block block;
    std::istringstream words(line);
    for (std::string word; words >> word;) {
      EXPECT_TRUE(std::isupper(static_cast<unsigned char>(word[0]))) << line;
      EXPECT_EQ(word.find_first_not_of("0123456789.-", 1), std::string::npos) << line;
      block[word[0]] = std::stod(word.substr(1));
    }
    result.push_back(block);
  }
  return result;
}

TEST(ToolPath, GcodeFollowsThePosesAndIsRapidOnlyAboveTheSurface) {
  const auto surface = surface_of(joined(box({4, 3, 1}), icosphere(4), {6, 1, 0}));
  const ToolPath path = tool_path(surface, {.spacing = 0.5, .lead = 0.1});
  const std::vector<Block> program = blocks(gcode(path, {.feed = 800, .axes = 5, .inches = true, .blend = 0.01}));
  EXPECT_EQ(program.back(), (Block{{'M', 2}}));
  EXPECT_EQ(program[1], (Block{{'G', 64}, {'P', 0.01}}));
  std::size_t k = 0, feeds = 0;
  Block before;
  for (std::size_t b = 2; b + 1 < program.size(); ++b, ++k) {
    const Block& block = program[b];
    const Vec3 position{block.at('X'), block.at('Y'), block.at('Z')};
    const double a = block.at('A') * std::numbers::pi / 180, c = block.at('C') * std::numbers::pi / 180;
    const Vec3 axis{std::sin(a) * std::sin(c), std::sin(a) * std::cos(c), std::cos(a)};
    const auto is_reached = [&] {
      return norm(path.poses[k].position - position) < 1e-6 && norm(path.poses[k].axis - axis) < 1e-6;
    };
    while (k < path.poses.size() && !is_reached()) ++k;  // poses that repeat the previous one have no line
    ASSERT_LT(k, path.poses.size()) << "line " << b;
    feeds += block.count('F');
    if (block.at('G') == 0) {
      EXPECT_NE(path.poses[k].kind, ToolMotion::pass);
      EXPECT_GT(surface.closest_point(position).distance, 0.1);
    }
    if (b > 2 && path.poses[k].kind == ToolMotion::pass) {  // the nearer of both pairs of angles
      EXPECT_LE(std::abs(block.at('C') - before['C']), 180) << "line " << b;
      EXPECT_LE(std::abs(block.at('A') - before['A']), 180) << "line " << b;
    }
    before = block;
  }
  EXPECT_EQ(k, path.poses.size());
  EXPECT_EQ(feeds, 1U);

  const ToolPathRegion top{.facing = ToolPathRegion::Facing{{0, 0, 1}, 0.5}};
  const std::string up = gcode(tool_path(surface_of(box({4, 3, 1})), {.spacing = 0.5, .region = top}), {.feed = 50});
  EXPECT_EQ(up.find('A'), std::string::npos);
  EXPECT_NE(up.find("G21 "), std::string::npos);
  const auto refuses = [](const ToolPath& of, const GcodeOptions& options, const std::string& text) {
    expect_error<InvalidArgument>([&] { gcode(of, options); }, text);
  };
  refuses(path, {.feed = 800}, "faces sideways or down");
  refuses(path, {.feed = 0}, "feed is 0");
  refuses(path, {.feed = 1, .axes = 4}, "3 or 5 axes");
  EXPECT_DOUBLE_EQ(path.chord_error, 0.5 / 200);
  EXPECT_NE(gcode(path, {.feed = 1, .axes = 5}).find("G64 P0.0025"), std::string::npos);
  EXPECT_NE(gcode(path, {.feed = 1, .axes = 5, .blend = 0}).find("G61\n"), std::string::npos);
  refuses(path, {.feed = 1, .axes = 5, .blend = -1}, "blend is -1");
}

TEST(ToolPath, HasNoTextWithMissingLinks) {
  ToolPath torn = tool_path(surface_of(icosphere(4)), {.spacing = 0.25});
  for (const std::size_t k : {20, 40}) torn.poses[k].kind = ToolMotion::missing;
  expect_error<InvalidArgument>([&] { gcode(torn, {.feed = 1, .axes = 5}); }, "2 missing links");
  expect_error<InvalidArgument>([&] { ros_yaml(torn); }, "2 missing links");
}

}  // namespace
}  // namespace ahm::test
