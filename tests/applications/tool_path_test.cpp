// Tool paths over whole parts: the bars of coverage on generated parts, poses, links, regions and errors.
#include "ahm/applications/tool_path.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <set>

#include "ahm/applications/tool_path_text.hpp"
#include "ahm/conformance/parts.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/vec.hpp"
#include "part_surface.hpp"
#include "support/expect_error.hpp"

namespace ahm::test {
namespace {

/// Whether a segment crosses a triangle, away from its ends by `margin` of its length.
bool crosses(const Vec3& from, const Vec3& to, const Vec3& a, const Vec3& b, const Vec3& c, double margin) {
  const Vec3 normal = cross(b - a, c - a);
  const double s = dot(from - a, normal), e = dot(to - a, normal);
  if (s * e >= 0) return false;
  const double t = s / (s - e);
  if (t < margin || t > 1 - margin) return false;
  const Vec3 p = from + t * (to - from);
  return dot(cross(b - a, p - a), normal) >= 0 && dot(cross(c - b, p - b), normal) >= 0 &&
         dot(cross(a - c, p - c), normal) >= 0;
}

/// Expects the laws of every path: coverage, poses on the surface, rotations, continuous axes, links outside of the part.
void expect_path(const Mesh& mesh, double spacing, const ToolPathSeed& seed = AutomaticSeed{}, bool spiral = false) {
  const auto surface = surface_of(mesh);
  const ToolPath path = tool_path(surface, {.spacing = spacing, .seed = seed, .spiral = spiral});
  const ToolPathMeasures measures = tool_path_measures(surface, path);
  EXPECT_GE(measures.covered, 0.99);
  EXPECT_LE(measures.largest_gap, 1.25);
  EXPECT_LE(measures.double_covered, 0.03);
  EXPECT_EQ(path.missing_links, 0);
  EXPECT_EQ(path.uncovered_components, 0);
  EXPECT_EQ(path.surface_links + path.lifted_links, std::ssize(path.passes) - 1);
  // A pass covers the strip of half a spacing on both sides.
  EXPECT_GE(path.pass_length * spacing, 0.8 * measures.area);
  EXPECT_LE(path.pass_length * spacing, 1.3 * measures.area);
  for (std::size_t k = 0; k < path.poses.size(); ++k) {
    const ToolPose& p = path.poses[k];
    EXPECT_NEAR(norm(p.axis), 1, 1e-9);
    EXPECT_NEAR(norm(p.travel), 1, 1e-9);
    EXPECT_NEAR(dot(p.axis, p.travel), 0, 1e-9);
    const auto [w, x, y, z] = p.quaternion;
    const Vec3 z_axis{2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)},
        x_axis{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)};
    EXPECT_LT(norm(z_axis - p.axis), 1e-9);
    EXPECT_LT(norm(x_axis - p.travel), 1e-9);
    const auto matrix = pose_matrix(p);
    const Vec3 y_axis{2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)};
    for (std::size_t r = 0; r < 3; ++r) {
      EXPECT_EQ(matrix[r][0], p.travel[r]);
      EXPECT_NEAR(matrix[r][1], y_axis[r], 1e-9);
      EXPECT_EQ(matrix[r][2], p.axis[r]);
      EXPECT_EQ(matrix[r][3], p.position[r]);
    }
    EXPECT_EQ(matrix[3], (std::array<double, 4>{0, 0, 0, 1}));
    if (p.kind == ToolMotion::pass) EXPECT_LT(surface.closest_point(p.position).distance, 1e-9);
    if (k == 0) continue;
    const ToolPose& before = path.poses[k - 1];
    if (before.kind == ToolMotion::approach) EXPECT_GT(dot(before.travel, p.travel), 1 - 1e-9);
    EXPECT_NEAR(p.arclength - before.arclength, norm(p.position - before.position), 1e-9 * p.arclength + 1e-12);
    if (p.kind == ToolMotion::pass && before.kind == ToolMotion::pass && p.pass == before.pass) {
      EXPECT_LE(norm(p.position - before.position), 0.25 * spacing * (1 + 1e-9));
      EXPECT_GT(dot(p.axis, before.axis), 0.938);  // 20 degrees, at edges too
      continue;
    }
    if (p.kind == ToolMotion::pass) continue;
    const auto height = [&](const Vec3& position) { return surface.closest_point(position).distance; };
    if (p.kind == ToolMotion::link && height(p.position) < 1e-9 && height(before.position) < 1e-9) {
      EXPECT_LT(height(0.5 * (before.position + p.position)), 1e-9);
      continue;
    }
    for (const Triangle& f : mesh.faces)
      EXPECT_FALSE(
          crosses(before.position, p.position, mesh.positions[f[0]], mesh.positions[f[1]], mesh.positions[f[2]], 1e-3))
          << "pose " << k << " of kind " << static_cast<int>(p.kind);
  }
}

TEST(ToolPath, CoversASphere) { expect_path(icosphere(8), 0.2); }
TEST(ToolPath, CoversAnOpenCylinder) { expect_path(cylinder(3, false), 0.3); }
TEST(ToolPath, CoversAClosedCylinder) { expect_path(cylinder(3, true), 0.3); }
TEST(ToolPath, CoversABox) { expect_path(box({4, 3, 2}), 0.3); }
TEST(ToolPath, CoversATorus) { expect_path(torus(1000), 0.2); }
TEST(ToolPath, CoversAPlateWithHoles) { expect_path(holed_plate(), 0.25); }
TEST(ToolPath, CoversAPlateFromItsBoundary) { expect_path(holed_plate(), 0.25, BoundarySeed{}); }
TEST(ToolPath, CoversSeveralComponents) { expect_path(two_boxes(), 0.25); }
/// Eight spheres on a cubic lattice, 0.4 apart, with a ninth between them that touches none.
Mesh cluster() {
  const Mesh ball = icosphere(3);
  Mesh result = ball;
  for (int k = 1; k < 8; ++k) result = joined(result, ball, {2.4 * (k & 1), 1.2 * (k & 2), 0.6 * (k & 4)});
  Mesh small = ball;
  for (Vec3& p : small.positions) p = 0.5 * p;
  return joined(result, small, {1.2, 1.2, 1.2});
}

TEST(ToolPath, LinksComponentsAroundEachOther) {
  expect_path(cluster(), 0.4);
  // A sphere between two walls.
  const Mesh walls = joined(box({8, 0.6, 8}), box({8, 0.6, 8}), {0, 4.2, 0});
  expect_path(joined(walls, icosphere(4), {4, 2.4, 4}), 0.4);
}

TEST(ToolPath, CountsLinksThatAreMissing) {
  // No path leads to a sphere in a sphere.
  Mesh inner = icosphere(4);
  for (Vec3& p : inner.positions) p = 0.5 * p;
  const Mesh nested = joined(icosphere(4), inner);
  const auto surface = surface_of(nested);
  const ToolPath path = tool_path(surface, {.spacing = 0.2});
  EXPECT_EQ(path.missing_links, 1);
  EXPECT_EQ(path.surface_links + path.lifted_links + path.missing_links, std::ssize(path.passes) - 1);
  EXPECT_GE(tool_path_measures(surface, path).covered, 0.99);
  // One pose marks it. The length of the path does not include the jump, and no run joins the two ends.
  double length = 0;
  for (std::size_t k = 1; k < path.poses.size(); ++k) {
    const bool is_missing = path.poses[k].kind == ToolMotion::missing;
    if (!is_missing) length += norm(path.poses[k].position - path.poses[k - 1].position);
    EXPECT_NEAR(path.poses[k].arclength, length, 1e-9 * length);
    if (is_missing) EXPECT_EQ(path.poses[k - 1].kind, ToolMotion::retreat);
    if (is_missing) EXPECT_EQ(path.poses[k + 1].kind, ToolMotion::approach);
  }
  EXPECT_EQ(std::ranges::count(path.poses, ToolMotion::missing, &ToolPose::kind), 1);
  EXPECT_NEAR(path.pass_length + path.link_length, length, 1e-9 * length);
  for (const ToolRun& run : tool_runs(path))
    if (run.kind == ToolMotion::missing) EXPECT_EQ(run.from, run.begin);
}

TEST(ToolPath, RisesOnlyWhereThereIsRoom) {
  // Above the lower plate, at a third of the clearance, lies the upper one. Both face up.
  const Mesh plate = holed_plate();
  const Mesh two = joined(plate, plate, {0, 0, 0.36});
  const auto surface = surface_of(two);
  const ToolPath path = tool_path(surface, {.spacing = 0.5, .clearance = 1});
  for (std::size_t k = 1; k < path.poses.size(); ++k) {
    const ToolPose &a = path.poses[k - 1], &b = path.poses[k];
    if (b.kind == ToolMotion::missing || b.kind == ToolMotion::pass) continue;
    for (const Triangle& f : two.faces)
      EXPECT_FALSE(crosses(a.position, b.position, two.positions[f[0]], two.positions[f[1]], two.positions[f[2]], 1e-3))
          << "pose " << k << " of kind " << static_cast<int>(b.kind);
  }
}

TEST(ToolPath, CoversABoxFromASectionWithAPlane) { expect_path(box({4, 3, 2}), 0.3, PlaneSeed{{1, 1, 1}, {1, 2, 3}}); }

TEST(ToolPath, PassesOnACylinderAreEquallySpaced) {
  // The section along the axis leaves passes at multiples of the spacing around the prism, which unrolls.
  const auto surface = surface_of(cylinder(3, false));
  const double spacing = 0.25;
  const ToolPath path = tool_path(surface, {.spacing = spacing});
  constexpr double side = 2 * std::numbers::pi / 48, chord = 0.13080625846028612;  // 2 sin(pi / 48)
  const auto unrolled = [&](const Vec3& p) {
    double angle = std::atan2(p[1], p[0]);
    if (angle < 0) angle += 2 * std::numbers::pi;
    const double k = std::floor(angle / side), within = angle - k * side;
    // From an angle within a side to a length along the chord.
    return chord * (k + 0.5 + std::tan(within - side / 2) / (2 * std::tan(side / 2)));
  };
  std::set<Index> levels;
  for (const ToolPass& pass : path.passes) {
    if (pass.origin == PassOrigin::cut_locus) continue;
    levels.insert(static_cast<Index>(std::lround(pass.distance / spacing)));
    const double first = unrolled(path.poses[pass.begin].position);
    for (std::size_t k = pass.begin; k < pass.end; ++k)
      EXPECT_NEAR(std::remainder(unrolled(path.poses[k].position) - first, 48 * chord), 0, 0.01 * spacing);
  }
  EXPECT_EQ(levels.size(), 1 + static_cast<std::size_t>(48 * chord / 4 / spacing));
}

/// A surface of revolution around the z axis. @param profile  radius and height of the rings from the edge to the apex, which
/// has radius 0
Mesh revolved(const std::vector<Vec2>& profile) {
  constexpr Index n = 64;
  Mesh mesh;
  const auto rings = static_cast<Index>(profile.size()) - 1;
  for (Index k = 0; k < rings; ++k)
    for (Index i = 0; i < n; ++i) {
      const double angle = 2 * std::numbers::pi * i / n;
      mesh.positions.push_back({profile[k][0] * std::cos(angle), profile[k][0] * std::sin(angle), profile[k][1]});
    }
  mesh.positions.push_back({0, 0, profile.back()[1]});
  for (Index k = 0; k < rings; ++k)
    for (Index i = 0; i < n; ++i) {
      const Index a = n * k + i, b = n * k + (i + 1) % n;
      if (k + 1 == rings) {
        mesh.faces.push_back({a, b, n * rings});
        continue;
      }
      mesh.faces.push_back({a, b, b + n});
      mesh.faces.push_back({a, b + n, a + n});
    }
  return mesh;
}

/// Expects one pass from the edge around the z axis, whose turns are equally spaced, except for the first and the last one.
/// @param distance_of  distance of a point from the edge
void expect_spiral(const Mesh& mesh, double spacing, const std::function<double(const Vec3&)>& distance_of) {
  const auto surface = surface_of(mesh);
  const ToolPath path = tool_path(surface, {.spacing = spacing, .seed = BoundarySeed{}, .spiral = true}),
                 rings = tool_path(surface, {.spacing = spacing, .seed = BoundarySeed{}});
  ASSERT_EQ(path.passes.size(), 1U);
  EXPECT_EQ(path.passes[0].origin, PassOrigin::spiral);
  EXPECT_GT(rings.passes.size(), 8U);
  EXPECT_EQ(path.surface_links + path.lifted_links, 0);
  const ToolPathMeasures measures = tool_path_measures(surface, path), of_rings = tool_path_measures(surface, rings);
  EXPECT_GE(measures.covered, std::min(0.99, of_rings.covered));
  EXPECT_LE(measures.largest_gap, std::max(0.75, of_rings.largest_gap));
  EXPECT_LE(measures.double_covered, 0.01);
  std::vector<Vec3> at;
  std::vector<double> turned, away;  // along the path: angle around the axis, distance from the edge in spacings
  for (const ToolPose& pose : path.poses) {
    if (pose.kind != ToolMotion::pass) continue;
    const double angle = std::atan2(pose.position[1], pose.position[0]),
                 before = turned.empty() ? angle : turned.back();
    turned.push_back(before + std::remainder(angle - before, 2 * std::numbers::pi));
    away.push_back(distance_of(pose.position) / spacing);
    at.push_back(pose.position);
  }
  if (away.front() > away.back()) {
    std::reverse(at.begin(), at.end());
    std::reverse(turned.begin(), turned.end());
    std::reverse(away.begin(), away.end());
  }
  const double direction = turned.back() > turned.front() ? 1 : -1;
  std::size_t turn = 0, compared = 0;
  double sum = 0;
  for (std::size_t k = 0; k < turned.size(); ++k) {
    if (k > 0)  // around a vertex, the path may move back a little
      EXPECT_GT(direction * (turned[k] - turned[k - 1]) * std::hypot(at[k][0], at[k][1]), -0.01 * spacing);
    while (turn < k && direction * (turned[k] - turned[turn + 1]) >= 2 * std::numbers::pi) ++turn;
    if (direction * (turned[k] - turned[turn]) < 2 * std::numbers::pi) continue;
    const double t = (direction * (turned[k] - turned[turn]) - 2 * std::numbers::pi) /
                     (direction * (turned[turn + 1] - turned[turn]));
    const double apart = away[k] - ((1 - t) * away[turn] + t * away[turn + 1]);
    EXPECT_GT(apart, 0.49);
    if (away[turn] < away.front() + 0.51 || away[k] > away.back() - 0.51) continue;
    // The path may rise by one face in one step.
    const double turn_length = 2 * std::numbers::pi * std::hypot(at[k][0], at[k][1]) / spacing;
    EXPECT_NEAR(apart, 1, 0.03 + 0.4 / turn_length);
    sum += apart;
    ++compared;
  }
  ASSERT_GT(compared, 100U);
  EXPECT_NEAR(sum / static_cast<double>(compared), 1, 0.01);
}

TEST(ToolPath, IsASpiralOnACylinder) {
  const Mesh mesh = cylinder(3, false);
  const ToolPath path = tool_path(surface_of(mesh), {.spacing = 0.25, .seed = BoundarySeed{}});
  const bool is_upward = path.passes[0].distance > path.passes.back().distance
                             ? path.poses[path.passes[0].begin].position[2] > 1.5
                             : path.poses[path.passes[0].begin].position[2] < 1.5;
  expect_spiral(mesh, 0.25, [&](const Vec3& p) { return is_upward ? p[2] : 3 - p[2]; });
}

TEST(ToolPath, IsASpiralOnACone) {
  std::vector<Vec2> profile;
  for (int k = 0; k <= 16; ++k) profile.push_back({1.5 * (1 - k / 16.0), 2.0 * k / 16});
  const double side = std::hypot(std::cos(std::numbers::pi / 64) * 1.5, 2);  // of the edge from the apex, in a face
  expect_spiral(revolved(profile), 0.2, [&](const Vec3& p) { return (1 - (2 - p[2]) / 2) * side; });
}

TEST(ToolPath, IsASpiralOnASphericalCap) {
  std::vector<Vec2> profile;
  for (int k = 0; k <= 24; ++k) {
    const double angle = 2 * (1 - k / 24.0);
    profile.push_back({std::sin(angle), std::cos(angle)});
  }
  for (const double spacing : {0.15, 2 / 12.87})  // with the second one, the pole is just below the end of the spiral
    expect_spiral(revolved(profile), spacing,
                  [](const Vec3& p) { return 2 - std::acos(std::clamp(p[2] / norm(p), -1.0, 1.0)); });
}

TEST(ToolPath, SpiralsCoverAsSeparatePassesDo) {
  expect_path(icosphere(8), 0.1, AutomaticSeed{}, true);
  expect_path(torus(1000), 0.1, PlaneSeed{{0, 0, 0}, {0, 1, 0}}, true);
  expect_path(holed_plate(), 0.15, BoundarySeed{}, true);
  expect_path(cylinder(3, true), 0.15, PlaneSeed{{0, 0, 1.5}, {0, 0, 1}}, true);
  // Around the holes of the plate, the passes are open: they remain as they are.
  const auto plate = surface_of(holed_plate());
  const ToolPath path = tool_path(plate, {.spacing = 0.25, .spiral = true});
  for (const ToolPass& pass : path.passes) EXPECT_NE(pass.origin, PassOrigin::spiral);
}

TEST(ToolPath, OneWayPassesRunInOneDirection) {
  const auto surface = surface_of(flat_square(21));
  const ToolPath path = tool_path(surface, {.spacing = 0.1, .one_way = true});
  const Vec3 first = path.poses[path.passes[0].begin].travel;
  for (const ToolPass& pass : path.passes)
    for (std::size_t k = pass.begin; k < pass.end; ++k) EXPECT_GT(dot(path.poses[k].travel, first), 0);
}

TEST(ToolPath, IsParallelToADrawnCurveAndToALine) {
  const Mesh mesh = holed_plate();
  const auto surface = surface_of(mesh);
  for (const ToolPathSeed& seed :
       {ToolPathSeed{CurveSeed{{{0, 0.5, 0}, {6, 0.5, 0}}, false}}, ToolPathSeed{LineSeed{Row{335}, {1, 0, 0}}},
        ToolPathSeed{LineSeed{Row{305}, {1, 0, 0}}}}) {
    const ToolPath path = tool_path(surface, {.spacing = 0.25, .seed = seed});
    std::size_t seeds = 0;
    for (const ToolPass& pass : path.passes) {
      if (pass.origin != PassOrigin::seed) continue;
      ++seeds;
      EXPECT_NEAR(pass.length, 6, 1e-9);
      for (std::size_t k = pass.begin; k < pass.end; ++k) EXPECT_NEAR(path.poses[k].position[1], 0.5, 1e-9);
    }
    EXPECT_EQ(seeds, 1U);
    EXPECT_GE(tool_path_measures(surface, path).covered, 0.99);
  }
}

TEST(ToolPath, IsParallelToAFeatureEdge) {
  // The edges of a box meet at corners, the rims of a cylinder are closed.
  const auto on_box = surface_of(box({4, 3, 2}));
  const auto first = [](const ToolPath& path) {
    return *std::ranges::find(path.passes, PassOrigin::seed, &ToolPass::origin);
  };
  for (const auto& near : {std::optional<CurvePoint>(), std::optional<CurvePoint>(Vec3{2, 1.5, 2}),
                           std::optional<CurvePoint>(Vec3{4, 1.5, 1.9})}) {
    const ToolPath path = tool_path(on_box, {.spacing = 0.3, .seed = FeatureSeed{1.5, near}});
    const ToolPass edge = first(path);
    EXPECT_NEAR(edge.length, near && (*std::get_if<Vec3>(&*near))[0] == 4 ? 3 : 4, 1e-9);
    EXPECT_FALSE(edge.closed);
    const ToolPathMeasures measures = tool_path_measures(on_box, path);
    EXPECT_GE(measures.covered, 0.99);
    EXPECT_LE(measures.largest_gap, 1.25);
    EXPECT_LE(measures.double_covered, 0.03);
  }
  const auto on_cylinder = surface_of(cylinder(3, true));
  for (const double side : {0.0, 3.0}) {
    const ToolPass rim = first(tool_path(on_cylinder, {.spacing = 0.3, .seed = FeatureSeed{1.5, Vec3{1, 0, side}}}));
    EXPECT_TRUE(rim.closed);
    EXPECT_NEAR(rim.length, 2 * std::numbers::pi, 0.01);
  }
  // At the sides of the prism, normals turn by 7.5 degrees.
  EXPECT_FALSE(first(tool_path(on_cylinder, {.spacing = 0.3, .seed = FeatureSeed{0.13}})).closed);
  for (const double angle : {0.0, 3.2, std::nan("")})
    expect_error<InvalidArgument>([&] { tool_path(on_box, {.spacing = 0.3, .seed = FeatureSeed{angle}}); },
                                  "in (0, 180]");
  expect_error<InvalidArgument>([&] { tool_path(on_box, {.spacing = 0.3, .seed = FeatureSeed{1.6}}); },
                                "nowhere by 91.67");
}

TEST(ToolPath, ALineEndsWhereItReturns) {
  // Around a cylinder, a line meets its own beginning, or runs along it.
  const auto surface = surface_of(cylinder(3, true));
  const SurfacePoint start = surface.closest_point({1, 0, 1.5}).point;
  for (const Vec3& direction : {Vec3{0, 1, 0}, Vec3{0, 1, 0.01}}) {
    const ToolPath path = tool_path(surface, {.spacing = 0.25, .seed = LineSeed{start, direction}});
    const ToolPathMeasures measures = tool_path_measures(surface, path);
    EXPECT_GE(measures.covered, 0.99);
    EXPECT_LE(measures.largest_gap, 1.25);
    EXPECT_LE(measures.double_covered, 0.005);
  }
}

TEST(ToolPath, CoversARegionOnly) {
  const auto surface = surface_of(box({4, 3, 2}));
  ToolPathRegion top{.facing = ToolPathRegion::Facing{{0, 0, 1}, 0.5}};
  const ToolPath path = tool_path(surface, {.spacing = 0.25, .region = top});
  const ToolPathMeasures measures = tool_path_measures(surface, path, top);
  EXPECT_NEAR(measures.area, 12, 1e-9);
  EXPECT_GE(measures.covered, 0.99);
  for (const ToolPose& pose : path.poses)
    if (pose.kind == ToolMotion::pass) EXPECT_NEAR(pose.position[2], 2, 1e-9);

  const Mesh plate = holed_plate();
  const auto flat = surface_of(plate);
  const ToolPathRegion disc{.disc = ToolPathRegion::Disc{Row{20 * 61 + 30}, 0.9}};
  for (const ToolPose& pose : tool_path(flat, {.spacing = 0.2, .region = disc}).poses)
    if (pose.kind == ToolMotion::pass) EXPECT_LE(norm(pose.position - Vec3{3, 2, 0}), 0.9 + 1e-9);

  std::vector<bool> left;
  for (const Vec3& p : plate.positions) left.push_back(p[0] < 3.05);
  for (const ToolPose& pose : tool_path(flat, {.spacing = 0.2, .region = {.rows = left}}).poses)
    if (pose.kind == ToolMotion::pass) EXPECT_LE(pose.position[0], 3 + 1e-9);
}

/// Expects that the passes inside and outside of a curve cover their parts of the surface.
void expect_enclosed(const Mesh& mesh, const std::vector<Vec3>& curve, double spacing, double inside, double outside,
                     double tolerance) {
  const auto surface = surface_of(mesh);
  for (const bool is_outside : {false, true}) {
    ToolPathRegion region;
    region.enclosures.push_back({curve, is_outside});
    const ToolPath path = tool_path(surface, {.spacing = spacing, .region = region});
    const ToolPathMeasures measures = tool_path_measures(surface, path, region);
    EXPECT_NEAR(measures.area, is_outside ? outside : inside, tolerance);
    EXPECT_GE(measures.covered, 0.99);
    EXPECT_LE(measures.largest_gap, 1.25);
    EXPECT_LE(measures.double_covered, 0.03);
  }
}

TEST(ToolPath, CoversTheInsideOfAClosedCurve) {
  // Along the sides of the mesh, and across them.
  const Mesh square = flat_square(21, 0);
  expect_enclosed(square, {{0.2, 0.2, 0}, {0.7, 0.2, 0}, {0.7, 0.7, 0}, {0.2, 0.7, 0}}, 0.05, 0.25, 0.75, 1e-9);
  expect_enclosed(square, {{0.52, 0.13, 0}, {0.83, 0.47, 0}, {0.49, 0.78, 0}, {0.18, 0.44, 0}}, 0.05, 0.2117, 0.7883,
                  1e-3);
  std::vector<Vec3> circle;
  for (int k = 0; k < 40; ++k) {
    const double angle = k * std::numbers::pi / 20;
    circle.push_back({std::sqrt(0.75) * std::cos(angle), std::sqrt(0.75) * std::sin(angle), 0.5});
  }
  expect_enclosed(icosphere(12), circle, 0.1, std::numbers::pi, 3 * std::numbers::pi, 0.05);
}

TEST(ToolPath, CoversACloud) {
  const auto surface = pointcloud::PointCloudSurface::build(icosphere(12).positions);
  const ToolPath path = tool_path(surface, {.spacing = 0.2});
  const ToolPathMeasures measures = tool_path_measures(surface, path);
  EXPECT_GE(measures.covered, 0.99);
  EXPECT_LE(measures.largest_gap, 1.25);
  EXPECT_LE(measures.double_covered, 0.03);
}

TEST(ToolPath, DoesNotDependOnTheNumberOfThreads) {
  const auto surface = surface_of(torus(500));
  const ToolPath one = tool_path(surface, {.spacing = 0.3, .threads = 1}),
                 two = tool_path(surface, {.spacing = 0.3, .threads = 2});
  ASSERT_EQ(one.poses.size(), two.poses.size());
  for (std::size_t k = 0; k < one.poses.size(); ++k) {
    EXPECT_EQ(one.poses[k].position, two.poses[k].position);
    EXPECT_EQ(one.poses[k].quaternion, two.poses[k].quaternion);
  }
}

TEST(ToolPath, LeadAndTiltLeanTheAxisOnly) {
  const auto surface = surface_of(torus(500));
  const double lead = 0.3, tilt = -0.2;
  const ToolPath upright = tool_path(surface, {.spacing = 0.3}),
                 leaning = tool_path(surface, {.spacing = 0.3, .lead = lead, .tilt = tilt});
  ASSERT_EQ(upright.poses.size(), leaning.poses.size());
  for (std::size_t k = 0; k < upright.poses.size(); ++k) {
    const ToolPose &p = upright.poses[k], &q = leaning.poses[k];
    EXPECT_EQ(p.position, q.position);
    EXPECT_NEAR(dot(q.axis, cross(p.axis, p.travel)), std::sin(tilt), 1e-12);
    EXPECT_NEAR(std::atan2(dot(q.axis, p.travel), dot(q.axis, p.axis)), lead, 1e-12);
    EXPECT_NEAR(norm(q.axis), 1, 1e-12);
    EXPECT_NEAR(norm(q.travel), 1, 1e-12);
    EXPECT_NEAR(dot(q.axis, q.travel), 0, 1e-12);
    EXPECT_NEAR(dot(q.travel, cross(p.axis, p.travel)), 0, 1e-12);
  }
}

TEST(ToolPath, MeasuresFindGapsAndDoublePasses) {
  // Passes at twice the spacing leave gaps; passes at a third of it cover twice.
  const auto surface = surface_of(flat_square(21));
  ToolPath path = tool_path(surface, {.spacing = 0.1});
  path.spacing = 0.05;
  EXPECT_LT(tool_path_measures(surface, path).covered, 0.7);
  path.spacing = 0.3;
  EXPECT_GT(tool_path_measures(surface, path).double_covered, 0.9);
}

TEST(ToolPath, MeasuresGiveTheReasonOfEveryRow) {
  // A square, a triangle that the seed does not reach, a vertex without faces.
  Mesh mesh = flat_square(21, 0);
  const auto square = static_cast<std::size_t>(mesh.vertices());
  mesh.faces.push_back({mesh.vertices(), mesh.vertices() + 1, mesh.vertices() + 2});
  for (const Vec3& p : {Vec3{3, 0, 0}, {3.01, 0, 0}, {3, 0.01, 0}, {5, 0, 0}}) mesh.positions.push_back(p);
  const auto surface = surface_of(mesh);
  const auto reasons = [&](double spacing, const ToolPathRegion& region) {
    const PlaneSeed middle{{0.5, 0.5, 0}, {0, 1, 0}};
    const ToolPath path = tool_path(surface, {.spacing = spacing, .seed = middle, .region = region});
    ToolPathMeasures measures = tool_path_measures(surface, path, region);
    EXPECT_EQ(measures.rows.size(), mesh.positions.size());
    return measures.rows;
  };
  for (const bool is_part : {false, true}) {
    const ToolPathRegion region{.facing = is_part ? std::optional(ToolPathRegion::Facing{{0, 0, 1}, 1}) : std::nullopt};
    const std::vector<RowCoverage> rows = reasons(0.1, region);
    for (std::size_t r = 0; r < square; ++r) EXPECT_EQ(rows[r], RowCoverage::covered);
    for (std::size_t r = square; r < square + 3; ++r) EXPECT_EQ(rows[r], RowCoverage::no_pass);
    EXPECT_EQ(rows.back(), RowCoverage::removed);
  }
  std::vector<bool> left;
  for (const Vec3& p : mesh.positions) left.push_back(p[0] < 0.51);
  const std::vector<RowCoverage> half = reasons(0.1, {.rows = left});
  for (std::size_t r = 0; r < square + 3; ++r)
    EXPECT_EQ(half[r], left[r] ? RowCoverage::covered : RowCoverage::outside_region);
  // Passes at twice the spacing leave gaps.
  ToolPath path = tool_path(surface, {.spacing = 0.1});
  path.spacing = 0.05;
  const std::vector<RowCoverage> rows = tool_path_measures(surface, path).rows;
  EXPECT_GT(std::ranges::count(rows, RowCoverage::gap), 20);
}

TEST(ToolPath, CornersThatCoincideAreNoTriangles) {
  // A square whose middle is two points at one place, joined by two triangles without area.
  Mesh mesh = flat_square(3, 0);
  const auto middle = static_cast<Index>(std::ranges::min_element(mesh.positions, {},
                                                                  [](const Vec3& p) {
                                                                    return norm(p - Vec3{0.5, 0.5, 0});
                                                                  }) -
                                         mesh.positions.begin());
  std::vector<Triangle> upper;
  std::vector<Index> ends;
  mesh.positions.push_back(mesh.positions[static_cast<std::size_t>(middle)]);
  const Index copy = mesh.vertices() - 1;
  const auto is_upper = [&](const Triangle& f) {
    Vec3 sum{};
    for (const Index p : f) sum = sum + mesh.positions[static_cast<std::size_t>(p)];
    return sum[1] / 3 > 0.5;
  };
  for (Triangle& f : mesh.faces) {
    const bool above = is_upper(f);
    for (Index& p : f)
      if (p == middle && above) p = copy;
  }
  for (std::size_t p = 0; p + 1 < mesh.positions.size(); ++p) {
    const Vec3& at = mesh.positions[p];
    if (std::abs(at[1] - 0.5) > 1e-9 || static_cast<Index>(p) == middle) continue;
    mesh.faces.push_back(at[0] < 0.5 ? Triangle{static_cast<Index>(p), middle, copy}
                                     : Triangle{static_cast<Index>(p), copy, middle});
  }
  const auto surface = surface_of(mesh);
  const ToolPath path = tool_path(surface, {.spacing = 0.1});
  const ToolPathMeasures measures = tool_path_measures(surface, path);
  EXPECT_NEAR(measures.area, 1, 1e-9);
  EXPECT_GE(measures.covered, 0.99);
  EXPECT_EQ(path.uncovered_components, 0);
}

TEST(ToolPath, FacingIncludesBothEndsOfItsRange) {
  // A tilted rectangle: the angle to its normal is 0 or pi, up to rounding, for directions of any length.
  for (const Vec3& normal : {Vec3{0.9, 2.1, -3}, Vec3{0.33, 0.77, -1.1}, Vec3{-0.3, -0.7, 1}}) {
    const Vec3 x = normalized(ahm::cross(normal, {0, 0, 1})), y = normalized(ahm::cross(normal, x));
    Mesh mesh = holed_plate();
    for (Vec3& p : mesh.positions) p = p[0] * x + p[1] * y;
    const auto surface = surface_of(mesh);
    const double area = tool_path_measures(surface, tool_path(surface, {.spacing = 0.5})).area;
    for (const double side : {1.0, -1.0})
      for (const double angle : {side > 0 ? 0.0 : std::numbers::pi, std::numbers::pi}) {
        const ToolPathRegion region{.facing = ToolPathRegion::Facing{side * normal, angle}};
        const ToolPath path = tool_path(surface, {.spacing = 0.5, .region = region});
        EXPECT_NEAR(tool_path_measures(surface, path, region).area, area, 1e-9);
      }
  }
}

TEST(ToolPath, OfALineEndsAtAGapOfTheRegion) {
  const auto surface = surface_of(holed_plate());
  ToolPathRegion region{.rows = std::vector<bool>(to_size(surface.rows().row_count()), true)};
  for (std::size_t r = 0; r < region.rows.size(); ++r) {
    const double x = surface.positions()[r][0];
    region.rows[r] = x < 2.95 || x > 3.25;
  }
  const ToolPath path =
      tool_path(surface, {.spacing = 0.3, .seed = LineSeed{Vec3{0.5, 0.3, 0}, {1, 0, 0}}, .region = region});
  EXPECT_EQ(path.uncovered_components, 1);
  for (const ToolPose& pose : path.poses) EXPECT_LT(pose.position[0], 2.95);
}

TEST(ToolPath, OfASmallDiscNeedsNothingElseOfTheSurface) {
  const auto surface = surface_of(split_icosphere(40962));
  expect_error<ResourceExhausted>([&] { tool_path(surface, {.spacing = 3e-4}); }, "more than 2^26 triangles");
  const ToolPathRegion region{.disc = ToolPathRegion::Disc{Row{0}, 0.003}};
  const ToolPath path = tool_path(surface, {.spacing = 3e-4, .region = region});
  EXPECT_NEAR(tool_path_measures(surface, path, region).area, std::numbers::pi * 9e-6, 2e-6);
}

TEST(ToolPath, RejectsWhatCannotBeCovered) {
  const auto surface = surface_of(icosphere(4));
  const auto refuses = [&](ToolPathOptions options, const std::string& text) {
    expect_error<InvalidArgument>([&] { tool_path(surface, options); }, text);
  };
  refuses({}, "spacing is 0");
  for (const double large : {100.0, 1e308}) refuses({.spacing = large}, "larger than the region");
  expect_error<ResourceExhausted>([&] { tool_path(surface, {.spacing = 1e-300}); }, "more than 2^26 triangles");
  expect_error<ResourceExhausted>([&] { tool_path(surface, {.spacing = 1e-308}); }, "too small for double precision");
  ToolPathRegion below{.facing = ToolPathRegion::Facing{{0, 0, -1}, 0.5}};
  refuses({.spacing = 0.2, .seed = LineSeed{Vec3{0, 0, 1}, {1, 0, 0}}, .region = below}, "in the part that is covered");
  refuses({.spacing = 0.2, .seed = PlaneSeed{{0, 0, 5}, {0, 0, 1}}}, "does not cross the region");
  refuses({.spacing = 0.2, .seed = BoundarySeed{}}, "no boundary");
  refuses({.spacing = 0.2, .seed = LineSeed{Row{3}, {0, 0, 0}}}, "the seed line has no length");
  for (const Vec3& across : {surface.positions()[3], (-1) * surface.positions()[3]})
    refuses({.spacing = 0.2, .seed = LineSeed{Row{3}, across}}, "perpendicular to the surface");
  refuses({.spacing = 0.2, .seed = CurveSeed{{{0, 0, 1}, {0, 0, 3}}, false}}, "point 1 of the seed curve");
  refuses({.spacing = 0.2, .region = {.rows = std::vector<bool>(162, false)}}, "no triangle lies in the region");
  refuses({.spacing = 0.2, .region = {.rows = std::vector<bool>(3, true)}}, "3 rows");
  refuses({.spacing = 0.2, .region = {.facing = ToolPathRegion::Facing{{0, 0, 1}, -0.1}}},
          "angle of the region is -5.7");
  refuses({.spacing = 0.2, .region = {.facing = ToolPathRegion::Facing{{0, 0, 1}, 3.2}}}, "in [0, 180]");
  refuses({.spacing = 0.2, .region = {.facing = ToolPathRegion::Facing{{0, 0, 1}, 0}}}, "reverse the direction");
  refuses({.spacing = 0.4, .region = {.disc = ToolPathRegion::Disc{Row{3}, 0.15}}}, "larger than the region");
  refuses({.spacing = 0.4, .region = {.disc = ToolPathRegion::Disc{Row{3}, 0.01}}}, "enlarge the radius");
  refuses({.spacing = 0.2, .step = -1}, "step is -1");
  refuses({.spacing = 0.2, .tool_radius = 5}, "tool_radius is 5");
  expect_error<ResourceExhausted>([&] { tool_path(surface, {.spacing = 0.2, .step = 1e-7}); }, "more than 2^24 poses");
  refuses({.spacing = 0.2, .lead = 2}, "lead is 2");
  const auto enclosed = [](const std::vector<Vec3>& points) {
    ToolPathRegion region;
    region.enclosures.push_back({points});
    return region;
  };
  refuses({.spacing = 0.2, .region = enclosed({{1, 0, 0}, {0, 1, 0}, {0, 0, 2}})}, "point 2 of the region curve");
  refuses({.spacing = 0.2, .region = enclosed({{0.99, 0.07, 0}, {0.99, -0.07, 0}, {0.99, 0, 0.1}})},
          "larger than the region");
  // Faces are named before they are refined.
  const std::vector<Vec3> corners{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}};
  const std::vector<Triangle> flat{{0, 1, 2}, {0, 3, 1}};
  const auto collinear = trimesh::TriangleMeshSurface::build(corners, flat);
  expect_error<InvalidGeometry>([&] { tool_path(collinear, {.spacing = 0.2}); }, "the face around 1, 0, 0 has no area");
  // Curves that join two components.
  const auto boxes = surface_of(two_boxes());
  ToolPathRegion both;
  both.enclosures.push_back({{{1, 1, 1}, {6.5, 1.5, 1}, {1, 2, 1}}});
  for (const ToolPathOptions& options :
       {ToolPathOptions{.spacing = 0.2, .seed = CurveSeed{{{1, 1, 1}, {6.5, 1.5, 1}}, false}},
        ToolPathOptions{.spacing = 0.2, .region = both}})
    expect_error<InvalidArgument>([&] { tool_path(boxes, options); }, "does not connect the points of the");
  const double tube = 1.4;  // around the tube of a torus, which does not divide it
  const auto ring = surface_of(torus(500));
  expect_error<InvalidArgument>(
      [&] {
        tool_path(ring, {.spacing = 0.2, .region = enclosed({{tube, 0, 0}, {1, 0, 0.4}, {0.6, 0, 0}, {1, 0, -0.4}})});
      },
      "does not divide the surface");
}

}  // namespace
}  // namespace ahm::test
