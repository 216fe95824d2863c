// Tool paths at an offset: the center of a ball that touches the surface.
#include <algorithm>
#include <cmath>

#include "ahm/applications/tool_path.hpp"
#include "ahm/conformance/parts.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "ahm/util/vec.hpp"
#include "part_surface.hpp"
#include "support/expect_error.hpp"

namespace ahm::test {
namespace {

/// A floor z = 0 and a wall x = 0, of 4 x 4 each, with normals into the corner between them.
Mesh corner_of_two_walls() {
  return {{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {0, 0, 4}, {0, 4, 4}},
          {{0, 1, 2}, {0, 2, 3}, {0, 3, 5}, {0, 5, 4}}};
}

TEST(ToolPath, OffsetIsTheCenterOfABall) {
  const double offset = 0.5;
  const PlaneSeed across{{0, 2, 0}, {0, 1, 0}};
  const auto measure = [&](const auto& surface, const ToolPathSeed& seed) {
    const ToolPath path = tool_path(surface, {.spacing = 0.4, .seed = seed, .offset = offset});
    for (const ToolPose& p : path.poses) {
      if (p.kind == ToolMotion::pass) EXPECT_LT(surface.closest_point(p.contact).distance, 1e-9);
      EXPECT_GE(surface.closest_point(p.position).distance, 0.99 * offset);
      if (p.kind == ToolMotion::pass) EXPECT_LE(surface.closest_point(p.position).distance, 1.001 * offset);
    }
    for (std::size_t k = 1; k < path.poses.size(); ++k) {  // the chords are near the path of the center, at edges too
      const ToolPose &a = path.poses[k - 1], &b = path.poses[k];
      if (b.kind == ToolMotion::pass && a.kind == ToolMotion::pass)
        EXPECT_LE(norm(b.position - a.position), 0.1 + 1e-9);
      for (const double share : {0.25, 0.5, 0.75})
        EXPECT_GE(surface.closest_point((1 - share) * a.position + share * b.position).distance,
                  0.99 * offset - path.chord_error);
    }
    const ToolPathMeasures measures = tool_path_measures(surface, path),
                           without = tool_path_measures(surface, tool_path(surface, {.spacing = 0.4, .seed = seed}));
    EXPECT_GE(measures.covered, 0.99);
    EXPECT_LE(measures.largest_gap, 1.25);
    EXPECT_NEAR(measures.double_covered, without.double_covered, 0.005);
    return path;
  };
  measure(surface_of(box({4, 3, 2})), AutomaticSeed{});
  measure(surface_of(torus(500)), AutomaticSeed{});
  // In the corner, the ball follows the two lines that are half a unit from floor and wall: no loop.
  const auto corner = surface_of(corner_of_two_walls());
  const ToolPath path = measure(corner, across);
  for (const ToolPass& pass : path.passes) {
    double walked = 0;
    for (std::size_t k = pass.begin; k < pass.end; ++k) {
      const Vec3& p = path.poses[k].position;
      EXPECT_NEAR(std::min(p[0], p[2]), offset, 1e-4);
      if (k == pass.begin) continue;
      const Vec3 step = p - path.poses[k - 1].position;
      walked += std::abs(step[0]) + std::abs(step[2]);
    }
    EXPECT_NEAR(walked, 2 * (4 - offset), 1e-3);
  }
}

TEST(ToolPath, EndsWhereABallDoesNotFit) {
  // A ball of radius 0.5 does not fit into a slit of width 0.5 between two boxes: no pass jumps over it or into it.
  const auto surface = surface_of(joined(box({2, 2, 2}), box({2, 2, 2}), {2.5, 0, 0}));
  const ToolPath path = tool_path(surface, {.spacing = 0.5, .offset = 0.5});
  for (std::size_t k = 1; k < path.poses.size(); ++k) {
    const ToolPose &a = path.poses[k - 1], &b = path.poses[k];
    if (a.kind != ToolMotion::pass || b.kind != ToolMotion::pass || a.pass != b.pass) continue;
    EXPECT_GE(surface.closest_point(0.5 * (a.position + b.position)).distance, 0.4);
  }
}

TEST(ToolPath, ABallRollsAroundSharpEdges) {
  // A wedge of seven degrees: a ball fits everywhere, and no pass ends at the edge.
  const Mesh wedge{{{0, 0, 0}, {10, 0, 0}, {0, 1.2, 0}, {0, 0, 6}, {10, 0, 6}, {0, 1.2, 6}},
                   {{2, 1, 0}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}}};
  const auto surface = surface_of(wedge);
  const std::size_t passes = tool_path(surface, {.spacing = 0.3}).passes.size();
  for (const double offset : {0.02, 0.15}) {
    const ToolPath path = tool_path(surface, {.spacing = 0.3, .offset = offset});
    EXPECT_EQ(path.passes.size(), passes);
    for (std::size_t k = 1; k < path.poses.size(); ++k) {
      const ToolPose &a = path.poses[k - 1], &b = path.poses[k];
      if (b.kind != ToolMotion::pass || a.kind != ToolMotion::pass) continue;
      EXPECT_GT(dot(a.axis, b.axis), 0.938);
      for (const double share : {0.25, 0.5, 0.75})
        EXPECT_GE(surface.closest_point((1 - share) * a.position + share * b.position).distance,
                  0.999 * offset - path.chord_error);
    }
  }
}

TEST(ToolPath, ABallStaysOutOfAnAcuteGroove) {
  // A groove of width 2 and depth 4. Mean normals near its bottom can point into a wall.
  Mesh groove;
  for (const double z : {0.0, 6.0})
    for (const Vec2& p : {Vec2{0, 5}, {5, 5}, {6, 1}, {7, 5}, {12, 5}}) groove.positions.push_back({p[0], p[1], z});
  for (Index k = 0; k < 4; ++k) groove.faces.insert(groove.faces.end(), {{k, k + 5, k + 6}, {k, k + 6, k + 1}});
  const auto surface = surface_of(groove);
  for (const double offset : {0.7, 2.1}) {
    const ToolPath path =
        tool_path(surface, {.spacing = 0.7, .seed = PlaneSeed{{0, 0, 3}, {0, 0, 1}}, .offset = offset});
    for (const ToolPose& p : path.poses)
      EXPECT_GT(p.position[1], 5 - std::max(0.0, 4 * (1 - std::abs(p.position[0] - 6)))) << offset;
    EXPECT_GE(path.passes.size(), 10U);
    EXPECT_LE(path.passes.size(), 20U);
    EXPECT_GE(tool_path_measures(surface, path).covered, 0.99);
  }
}

TEST(ToolPath, OfABallThatIsTooLargeIsRefused) {
  Mesh inside = icosphere(4);
  for (Triangle& f : inside.faces) std::swap(f[0], f[1]);
  EXPECT_GE(tool_path(surface_of(inside), {.spacing = 0.4, .offset = 0.5}).passes.size(), 4U);
  expect_error<InvalidArgument>([&] { tool_path(surface_of(inside), {.spacing = 1, .offset = 1.1}); }, "fits nowhere");
}

}  // namespace
}  // namespace ahm::test
