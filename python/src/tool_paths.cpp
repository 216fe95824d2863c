// Isolines and tool paths over whole surfaces.
#include "ahm/applications/isolines.hpp"
#include "ahm/applications/tool_path.hpp"
#include "ahm/applications/tool_path_text.hpp"
#include "ahm/error.hpp"
#include "compute.hpp"
#include "errors.hpp"
#include "map.hpp"
#include "options.hpp"
#include "parts.hpp"

namespace ahm::python {
namespace {

/// @param values  one per row
/// @param step    levels are its multiples; 0: `levels`
/// @return a list of (level, points, closed, length)
py::list isolines_of(const BodyPtr& body, const Doubles& values, const Doubles& levels, double step,
                     const py::object& report) {
  const std::span<const double> given = numbers(values), wanted = numbers(levels);
  std::vector<Isoline> lines = compute(report, py::make_tuple(values, levels), [=](const Progress& progress) {
    return in_one_step(progress, "isolines", [&] {
      const Surface& surface = body->surface_for("isolines");
      return step > 0 ? isolines(surface, given, level_multiples(given, step)) : isolines(surface, given, wanted);
    });
  });
  py::list result;
  for (Isoline& line : lines)
    result.append(py::make_tuple(line.level, owned(std::move(line.points)), line.closed, line.length));
  return result;
}

ToolPathSeed seed_of(const std::string& kind, const Doubles& numbers_of_seed, bool closed) {
  if (kind == "boundary") return BoundarySeed{};
  const std::span<const Vec3> points = vectors(numbers_of_seed);
  if (kind == "plane") return PlaneSeed{points[0], points[1]};
  if (kind == "curve") return CurveSeed{{points.begin(), points.end()}, closed};
  return AutomaticSeed{};
}

/// The seed line through a point. @param direction  (1, 3) a vector in space, or empty
/// @param angle  from the u axis, if there is no vector
LineSeed line_of(const Body& body, const py::tuple& start, const Doubles& direction, double angle) {
  const Places at = places(start);
  return naming(at.where(0), [&]() -> LineSeed {
    const SurfacePoint point = body.point(at.places[0]);
    const std::span<const Vec3> vector = vectors(direction);
    return {at.places[0], vector.empty() ? body.surface_for("a tool path").direction(point, angle) : vector[0]};
  });
}

/// @param seed    auto, boundary, plane, curve, line or feature
/// @param points  (n, 3): point and normal of the plane, points of the curve, direction of the line
/// @param start   point of the line or near the feature edge, or None
/// @param angle   of the line, if `points` is empty, or of the feature edge
/// @param mask    empty, or one byte per row
/// @param facing  empty, or a direction
/// @param center  of the disc with the radius in the options, or None
/// @param inside, outside  empty, or the points of closed curves
/// @return position, contact, axis, travel, quaternion, pass, kind, arclength of the poses; begin, end, closed, kind, distance,
/// length of the passes; measures and links; coverage of the rows; the chord error
py::tuple tool_path_of(const BodyPtr& body, double spacing, const std::string& seed, const Doubles& points, bool closed,
                       const py::object& start, double angle, const Bytes& mask, const Doubles& facing,
                       double max_angle, const Doubles& inside, const Doubles& outside, const py::object& center,
                       const py::dict& options, const py::object& report) {
  ToolPathOptions o{.spacing = spacing, .seed = seed_of(seed, points, closed)};
  if (seed == "line") o.seed = line_of(*body, start.cast<py::tuple>(), points, angle);
  if (seed == "feature") {
    FeatureSeed feature{angle};
    if (!start.is_none()) feature.near = places(start.cast<py::tuple>()).places[0];
    o.seed = feature;
  }
  if (!center.is_none()) {
    o.region.disc = {places(center.cast<py::tuple>()).places[0], 0};
    read(options, "radius", o.region.disc->radius);
  }
  for (const std::uint8_t row : numbers(mask)) o.region.rows.push_back(row != 0);
  if (const std::span<const double> d = numbers(facing); !d.empty())
    o.region.facing = ToolPathRegion::Facing{{d[0], d[1], d[2]}, max_angle};
  for (const bool is_outside : {false, true})
    if (const std::span<const Vec3> curve = vectors(is_outside ? outside : inside); !curve.empty())
      o.region.enclosures.push_back({{curve.begin(), curve.end()}, is_outside});
  read(options, "step", o.step);
  read(options, "chord_error", o.chord_error);
  read(options, "tool_radius", o.tool_radius);
  read(options, "clearance", o.clearance);
  read(options, "max_link", o.max_link);
  read(options, "lead", o.lead);
  read(options, "tilt", o.tilt);
  read(options, "offset", o.offset);
  read(options, "one_way", o.one_way);
  read(options, "spiral", o.spiral);
  read(options, "threads", o.threads);
  auto [path, measures] = compute(report, py::none(), [=](const Progress& progress) mutable {
    o.progress = progress;
    const Surface& surface = body->surface_for("a tool path");
    ToolPath made = tool_path(surface, o);
    const ToolPathMeasures measured = tool_path_measures(surface, made, o.region);
    return std::pair(std::move(made), measured);
  });
  std::vector<Vec3> position, contact, axis, travel;
  std::vector<std::array<double, 4>> quaternion;
  std::vector<Index> pass;
  std::vector<std::uint8_t> kind;
  std::vector<double> arclength;
  for (const ToolPose& pose : path.poses) {
    position.push_back(pose.position), contact.push_back(pose.contact), axis.push_back(pose.axis),
        travel.push_back(pose.travel);
    quaternion.push_back(pose.quaternion), pass.push_back(pose.pass), arclength.push_back(pose.arclength);
    kind.push_back(static_cast<std::uint8_t>(pose.kind));
  }
  using namespace py::literals;
  py::list passes;
  for (const ToolPass& p : path.passes)
    passes.append(py::make_tuple(p.begin, p.end, p.closed, static_cast<int>(p.origin), p.distance, p.length));
  std::vector<std::uint8_t> rows;
  for (const RowCoverage row : measures.rows) rows.push_back(static_cast<std::uint8_t>(row));
  const py::ssize_t n = length(quaternion);
  return py::make_tuple(
      owned(std::move(position)), owned(std::move(contact)), owned(std::move(axis)), owned(std::move(travel)),
      owned<std::array<double, 4>, double>(std::move(quaternion), {n, 4}), owned(std::move(pass)),
      owned(std::move(kind)), owned(std::move(arclength)), passes,
      py::dict("area"_a = measures.area, "covered"_a = measures.covered, "largest_gap"_a = measures.largest_gap,
               "double_covered"_a = measures.double_covered, "pass_length"_a = path.pass_length,
               "link_length"_a = path.link_length, "surface_links"_a = path.surface_links,
               "lifted_links"_a = path.lifted_links, "missing_links"_a = path.missing_links,
               "uncovered_components"_a = path.uncovered_components),
      owned(std::move(rows)), path.chord_error);
}

/// The arrays of a path as poses.
ToolPath path_of(const Doubles& positions, const Doubles& axes, const Doubles& quaternions, const Indices& passes,
                 const Bytes& kinds, const Doubles& arclengths) {
  const std::span<const Vec3> position = vectors(positions), axis = vectors(axes);
  const std::span<const double> q = numbers(quaternions), arclength = numbers(arclengths);
  const std::span<const Index> pass = numbers(passes);
  const std::span<const std::uint8_t> kind = numbers(kinds);
  ToolPath path;
  for (std::size_t k = 0; k < position.size(); ++k)
    path.poses.push_back({.position = position[k],
                          .contact = {},
                          .axis = axis[k],
                          .travel = {},
                          .quaternion = {q[4 * k], q[4 * k + 1], q[4 * k + 2], q[4 * k + 3]},
                          .pass = pass[k],
                          .kind = static_cast<ToolMotion>(kind[k]),
                          .arclength = arclength[k]});
  return path;
}

std::string gcode_of(const Doubles& positions, const Doubles& axes, const Doubles& quaternions, const Indices& passes,
                     const Bytes& kinds, const Doubles& arclengths, double feed, int machine_axes, bool inches,
                     double blend) {
  return gcode(path_of(positions, axes, quaternions, passes, kinds, arclengths),
               {.feed = feed, .axes = machine_axes, .inches = inches, .blend = blend});
}

std::string ros_yaml_of(const Doubles& positions, const Doubles& axes, const Doubles& quaternions,
                        const Indices& passes, const Bytes& kinds, const Doubles& arclengths, bool stamped,
                        const std::string& frame, double feed) {
  return ros_yaml(path_of(positions, axes, quaternions, passes, kinds, arclengths),
                  {.message = stamped ? RosMessage::path : RosMessage::pose_array, .frame = frame, .feed = feed});
}

}  // namespace

void add_tool_paths(py::module_& module) {
  module.def("isolines", &isolines_of);
  module.def("tool_path", &tool_path_of);
  module.def("gcode", &gcode_of);
  module.def("ros_yaml", &ros_yaml_of);
}

}  // namespace ahm::python
