/// \file
/// Tool paths as programs for machine tools and messages for robots.
///
/// \code
/// std::ofstream("path.ngc") << ahm::gcode(path, {.feed = 800, .axes = 5});
/// std::ofstream("path.yaml") << ahm::ros_yaml(path);      // rostopic pub /path geometry_msgs/PoseArray -f path.yaml
/// \endcode
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ahm/applications/tool_path.hpp"

namespace ahm {

/// Consecutive motions of one kind. The poses `from` to `end` - 1 are a polyline.
struct ToolRun {
  std::size_t begin, end;  ///< its poses: those where its motions end
  /// The pose where its first motion begins: the last one of the previous run, or `begin` for passes, the first approach and
  /// `ToolMotion::missing`.
  std::size_t from;
  ToolMotion kind;
  Index pass;   ///< number of the pass; on links, that of the next pass
  bool lifted;  ///< whether the motion is above the surface; false for passes and for links on the surface
};

/// The runs of a path in order of travel. Every pose belongs to one run.
std::vector<ToolRun> tool_runs(const ToolPath& path);

struct GcodeOptions {
  double feed = 0;  ///< speed on passes, on links on the surface and on approaches, world units per minute; > 0
  /// 3: X, Y, Z, with the tool along z. 5: also A and C in degrees, such that the tool axis is
  /// (sin A sin C, sin A cos C, cos A): the kinematics `xyzac-trt` of LinuxCNC with the tool center point at X, Y, Z. On
  /// machines with the directions of ISO 841, A and C have the opposite signs.
  int axes = 3;
  bool inches = false;  ///< whether world units are inches (G20) or millimeters (G21)
  /// Largest deviation from the path by which the machine may blend corners, world units (G64 P). 0: none (G61); without a value:
  /// the chord error of the path.
  std::optional<double> blend = {};
};

/// A path as a program in RS-274/NGC, the dialect of LinuxCNC. Lifted motions are rapid ones (G0), which LinuxCNC runs in
/// straight lines. All others are G1. The program selects no tool and no spindle speed.
///
/// Angles change by the smallest amounts from pose to pose, and C can exceed one turn.
/// @throws InvalidArgument (values not finite or out of range; faults "missing_links": the path has missing links,
/// "axis_not_reachable": 3 axes, and the tool axis of a pass is horizontal or points down)
std::string gcode(const ToolPath& path, const GcodeOptions& options);

enum class RosMessage {
  pose_array,  ///< geometry_msgs/PoseArray
  path,        ///< nav_msgs/Path
};

struct RosOptions {
  RosMessage message = RosMessage::pose_array;
  std::string frame = "map";  ///< frame of the coordinates
  double feed = 0;  ///< speed for the time stamps of `RosMessage::path`, world units per minute; 0: all stamps are 0
};

/// A path as a message of ROS 1, in YAML as `rostopic pub -f` reads it. Orientations take z to the tool axis and x to the
/// direction of travel. ROS expects meters.
/// @throws InvalidArgument (a feed that is negative or not finite, a frame that is empty or contains control characters, fault
/// "missing_links": the path has missing links)
std::string ros_yaml(const ToolPath& path, const RosOptions& options = {});

}  // namespace ahm
