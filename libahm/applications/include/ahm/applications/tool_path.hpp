/// \file
/// Tool paths over whole surfaces: passes at equal geodesic distance, links between them, and poses of the tool.
///
/// \code
/// ahm::ToolPath path = ahm::tool_path(surface, {.spacing = 2});
/// for (const ahm::ToolPose& pose : path.poses) move_to(pose.position, pose.axis, pose.travel);
/// ahm::ToolPathMeasures measures = ahm::tool_path_measures(surface, path);       // area covered, gaps, double cover
/// \endcode
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "ahm/applications/stroke.hpp"
#include "ahm/progress.hpp"
#include "ahm/surface/surface.hpp"

namespace ahm {

/// The passes are parallel to the section of each component with a plane through its center. The plane contains the
/// longest direction of the component, and the direction in which it is thinnest.
struct AutomaticSeed {};
/// The passes are parallel to the section with a plane.
struct PlaneSeed {
  Vec3 point, normal;  ///< world units; the normal has any length > 0
};
/// The passes are parallel to the longest boundary loop of each component. The first pass is half a spacing from it.
struct BoundarySeed {};
/// The passes are parallel to a curve on the surface, joined as by `draw_curve`.
struct CurveSeed {
  std::vector<Vec3> points;  ///< at least 2, at most half a spacing from the surface, world units
  bool closed = false;
};
/// The passes are parallel to the geodesic line through a point, in both directions to the boundary. It ends where it comes
/// within half a spacing of itself, and after the length of the diagonal of the bounding box. From a point of the boundary it
/// runs to one side.
struct LineSeed {
  CurvePoint point;  ///< a position is at most half a spacing from the surface, world units
  Vec3 direction;    ///< in space; projected to the surface. At an angle: `Surface::direction`
};
/// The passes are parallel to a feature edge: sides of triangles at which the normal turns by an angle or more, joined where
/// exactly two of them meet.
struct FeatureSeed {
  double angle;  ///< radians, in (0, pi]
  /// The nearest feature edge to this point; none: the longest one of each component. A position is at most half a spacing from
  /// the surface, world units.
  std::optional<CurvePoint> near = {};
};
using ToolPathSeed = std::variant<AutomaticSeed, PlaneSeed, BoundarySeed, CurveSeed, LineSeed, FeatureSeed>;

/// The part of the surface to cover, which fulfills all conditions.
struct ToolPathRegion {
  std::vector<bool> rows;  ///< one per row: triangles and polygons whose corners are all true; empty: all rows
  /// Triangles that face a direction: (0, 0, 1) is the upper side of a part. What other parts hide is included.
  struct Facing {
    Vec3 direction;
    double angle;  ///< largest angle between the normal and the direction, radians, in [0, pi]
  };
  std::optional<Facing> facing;
  /// Triangles within this distance of a point, along the surface.
  struct Disc {
    CurvePoint center;  ///< a position is at most half a spacing from the surface, world units
    double radius;      ///< world units
  };
  std::optional<Disc> disc;
  /// One side of a curve that is joined as by `draw_curve` and closed. The curve divides its component. The largest part is
  /// the outside, the others are the inside. Other components are outside.
  struct Enclosure {
    std::vector<Vec3> points;  ///< at least 3, at most half a spacing from the surface, world units
    bool outside = false;
  };
  std::vector<Enclosure> enclosures;
};

struct ToolPathOptions {
  double spacing = 0;  ///< geodesic distance between neighboring passes, world units; > 0
  ToolPathSeed seed = AutomaticSeed{};
  ToolPathRegion region = {};
  /// Joins consecutive closed passes to spirals, which move by one spacing per turn. Where passes are open, or split, they
  /// remain separate.
  bool spiral = false;
  double step = 0;  ///< longest distance between poses of a pass, world units; 0: a quarter of the spacing
  /// Largest distance of a pass from the chords between its poses, world units; 0: a 200th of the spacing.
  double chord_error = 0;
  double tool_radius = 0;  ///< the tool axis is the mean normal within this radius, world units; 0: half of the spacing
  double lead = 0;  ///< angle by which the tool axis leans toward the travel; < 0: lag. Radians, within (-pi/2, pi/2)
  double tilt = 0;  ///< angle by which it leans to the left of the travel, radians, within (-pi/2, pi/2)
  /// Distance of the poses from the surface, world units: the path of the center of a ball of this radius. The axis points
  /// along the mean normal, but in concave places the ball does not enter farther than it fits: loops are removed.
  double offset = 0;
  double clearance = 0;  ///< height of lifted links over the surface, world units; 0: the spacing
  double max_link = 0;   ///< longest link on the surface; longer links are lifted. World units; 0: three spacings
  bool one_way =
      false;  ///< all passes run in the direction of the seed; false: directions alternate to shorten the links
  Progress progress = {};
  unsigned threads = 0;  ///< 0: one per core; the result does not depend on it
};

enum class ToolMotion {
  pass,      ///< along a pass
  link,      ///< from pass to pass, on the surface or lifted
  approach,  ///< down to the start of a pass, from the clearance or, on links around the part, from half of it
  retreat,   ///< from the end of a pass up to there
  missing,   ///< no link was found: the tool must get here by other means
};

/// A pose of the tool.
struct ToolPose {
  Vec3 position;  ///< at the offset from the surface, except for lifted links, approach and retreat; world units
  Vec3 contact;   ///< the point of the surface where the pose is; the position on lifted links, approach and retreat
  /// Unit vector away from the surface: the mean normal within the tool radius, with lead and tilt. With an offset, it points away
  /// from the faces at the contact by six degrees or more. Along a pass it turns by at most 20 degrees from pose to pose.
  Vec3 axis;
  Vec3 travel;  ///< unit vector perpendicular to the axis: direction of travel
  /// Rotation (w, x, y, z) that takes z to `axis` and x to `travel`. Signs are such that consecutive poses are close.
  std::array<double, 4> quaternion;
  Index pass;  ///< number of the pass; on links, that of the next pass
  ToolMotion kind;
  double arclength;  ///< length of the path up to this pose, without missing links, world units
};

/// A pose as a 4 x 4 matrix, row by row. It takes coordinates of the tool (x along the travel, z along the axis) to those of
/// the surface.
std::array<std::array<double, 4>, 4> pose_matrix(const ToolPose& pose);

/// Why a pass is where it is.
enum class PassOrigin {
  seed,       ///< the seed curve itself
  level,      ///< at a multiple of the spacing from the seed
  cut_locus,  ///< where fronts from two sides meet, and leave a gap or would cover twice
  boundary,   ///< along the boundary, to close a gap
  spiral,     ///< several closed passes as one
};

struct ToolPass {
  std::size_t begin, end;  ///< its poses
  bool closed;             ///< whether it ends where it begins
  PassOrigin origin;
  double distance;  ///< distance from the seed, world units; on cut loci, boundaries and spirals the mean
  double length;    ///< world units
};

struct ToolPath {
  std::vector<ToolPose> poses;  ///< in order of travel
  std::vector<ToolPass> passes;
  double spacing = 0;                       ///< of the options, world units
  double chord_error = 0;                   ///< of the options, or its default, world units
  double pass_length = 0, link_length = 0;  ///< links: with approach and retreat; world units
  Index surface_links = 0;                  ///< links on the surface
  Index lifted_links = 0;                   ///< links at the clearance, higher, or around the part
  /// Links that are missing: no path was found that does not cut the surface. The tool must move by other means to the poses of
  /// the kind `ToolMotion::missing`.
  Index missing_links = 0;
  Index uncovered_components = 0;  ///< components of the region without a seed
};

/// Covers a surface, or a region, with passes at equal geodesic distance.
///
/// Passes are the level sets of the exact distance from the seed curve, on flat faces. Where two fronts meet at an acute
/// angle to the cut locus, one pass along the cut locus replaces the pair that would cover twice, or fills the gap. The same
/// is done along boundaries. The first and the last turn of a spiral move by half a spacing, because they border on other
/// passes, or on the edge of the region. Passes are ordered by their nearest ends and improved by 2-opt exchanges.
/// @throws InvalidArgument (a value that is not finite or out of range; faults "spacing_too_large": larger than the
/// region, "seed_off_surface", "seed_along_normal": a line without a direction along the surface, "region_off_surface",
/// "region_not_enclosed": a curve that does not divide the surface, "curve_disconnected": points in different components,
/// "region_empty"; a surface without positions or triangles), InvalidGeometry (faces without area, needles: as
/// `exact::exact_map`), ResourceExhausted (more than 2^26 triangles, more than 2^24 poses), Cancelled
ToolPath tool_path(const Surface& surface, const ToolPathOptions& options);

/// Whether a tool path covers a row, and why not; from best to worst.
enum class RowCoverage : std::uint8_t {
  covered,         ///< within 0.6 spacings of a pass, along the surface
  gap,             ///< farther from the passes
  no_pass,         ///< in a component of the region without a pass: the seed does not reach it, or it is too small
  outside_region,  ///< in no triangle of the region
  no_triangle,     ///< in no triangle of the surface: isolated points of clouds
  removed,  ///< without a vertex: points removed from the cloud, for example outliers; vertices that no face uses
};

/// How well a tool path covers a surface.
struct ToolPathMeasures {
  double area = 0;     ///< area of the region, world units squared
  double covered = 0;  ///< share of the area within 0.6 spacings of a pass, along the surface
  /// Largest distance of a point of the region from the nearest pass, in spacings; 4: 4 or more, or not reached.
  double largest_gap = 0;
  /// Share of the pass length that is closer than 0.5 spacings, in space, to another pass, or to the same pass more than two
  /// spacings along it. Points of different components, and on opposite sides of a wall, are not compared.
  double double_covered = 0;
  std::vector<RowCoverage> rows;  ///< one per row of the surface
};

/// Measures a tool path independently of its construction. Distances are exact ones from the poses of the passes, and are
/// measured at points that are spread over the area, and at all vertices.
/// @param region   region of the options of the path
/// @param samples  number of points per square spacing
/// @throws as `tool_path`
ToolPathMeasures tool_path_measures(const Surface& surface, const ToolPath& path, const ToolPathRegion& region = {},
                                    double samples = 24);

}  // namespace ahm
