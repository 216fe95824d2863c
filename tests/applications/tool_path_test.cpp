// Tool paths over whole parts: the bars of coverage on generated parts, poses, links, regions and errors.
#include "ahm/applications/tool_path.hpp"

#include <cmath>
#include <numbers>
#include <set>

#include "ahm/conformance/parts.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "ahm/util/vec.hpp"
#include "support/expect_error.hpp"

namespace ahm::test {
namespace {

/// Two boxes that do not touch.
Mesh two_boxes() { return joined(box({4, 3, 1}), box({1, 1, 1}), {6, 1, 0}); }

trimesh::TriangleMeshSurface surface_of(const Mesh& mesh) {
  return trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces);
}

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
void expect_path(const Mesh& mesh, double spacing, const ToolPathSeed& seed = AutomaticSeed{}) {
  const auto surface = surface_of(mesh);
  const ToolPath path = tool_path(surface, {.spacing = spacing, .seed = seed});
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
    if (p.kind == ToolMotion::pass) EXPECT_LT(surface.closest_point(p.position).distance, 1e-9);
    if (k == 0) continue;
    const ToolPose& before = path.poses[k - 1];
    EXPECT_NEAR(p.arclength - before.arclength, norm(p.position - before.position), 1e-9 * p.arclength + 1e-12);
    if (p.kind == ToolMotion::pass && before.kind == ToolMotion::pass && p.pass == before.pass) {
      EXPECT_LE(norm(p.position - before.position), 0.25 * spacing * (1 + 1e-9));
      EXPECT_GT(dot(p.axis, before.axis), 0.5);  // smoothed over half a spacing, also at right-angled edges
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
       {ToolPathSeed{CurveSeed{{{0, 0.5, 0}, {6, 0.5, 0}}, false}}, ToolPathSeed{LineSeed{Row{335}, {1, 0, 0}}}}) {
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

TEST(ToolPath, MeasuresFindGapsAndDoublePasses) {
  // Passes at twice the spacing leave gaps; passes at a third of it cover twice.
  const auto surface = surface_of(flat_square(21));
  ToolPath path = tool_path(surface, {.spacing = 0.1});
  path.spacing = 0.05;
  EXPECT_LT(tool_path_measures(surface, path).covered, 0.7);
  path.spacing = 0.3;
  EXPECT_GT(tool_path_measures(surface, path).double_covered, 0.9);
}

TEST(ToolPath, RejectsWhatCannotBeCovered) {
  const auto surface = surface_of(icosphere(4));
  const auto refuses = [&](ToolPathOptions options, const std::string& text) {
    expect_error<InvalidArgument>([&] { tool_path(surface, options); }, text);
  };
  refuses({}, "spacing is 0");
  refuses({.spacing = 100}, "larger than the region");
  refuses({.spacing = 0.2, .seed = PlaneSeed{{0, 0, 5}, {0, 0, 1}}}, "does not cross the region");
  refuses({.spacing = 0.2, .seed = BoundarySeed{}}, "no boundary");
  refuses({.spacing = 0.2, .seed = CurveSeed{{{0, 0, 1}, {0, 0, 3}}, false}}, "point 1 of the seed curve");
  refuses({.spacing = 0.2, .region = {.rows = std::vector<bool>(162, false)}}, "no triangle lies in the region");
  refuses({.spacing = 0.2, .region = {.rows = std::vector<bool>(3, true)}}, "3 rows");
  refuses({.spacing = 0.2, .step = -1}, "step is -1");
}

}  // namespace
}  // namespace ahm::test
