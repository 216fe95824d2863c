#include "ahm/applications/tool_path_text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include "ahm/error.hpp"
#include "ahm/util/text.hpp"
#include "ahm/util/vec.hpp"

namespace ahm {
namespace {

constexpr double degree = std::numbers::pi / 180;

/// The number with this many decimals.
std::string decimals(double value, int digits) {
  if (std::abs(value) < 0.5 * std::pow(10, -digits)) value = 0;  // not "-0.000"
  char text[512];
  return {text, std::to_chars(text, text + sizeof text, value, std::chars_format::fixed, digits).ptr};
}

/// The shortest decimals of the double, with a point: without one, PyYAML reads 1e-05 as a word.
std::string yaml_number(double value) {
  char text[32];
  std::string number(text, std::to_chars(text, text + sizeof text, value).ptr);
  if (number.find('.') == std::string::npos) number.insert(std::min(number.find('e'), number.size()), ".0");
  return number;
}

/// Angles of the tool axis on a machine with the axes A and C, in degrees.
struct Rotary {
  double a = 0, c = 0;

  /// Turns to an axis by the smallest change of angles.
  void turn_to(const Vec3& axis) {
    const double level = std::hypot(axis[0], axis[1]), tilt = std::atan2(level, axis[2]) / degree;
    constexpr double upright = 1e-9;
    if (level < upright) {
      a = axis[2] > 0 ? 0 : std::copysign(180, a);
      return;
    }
    const double heading = std::atan2(axis[0], axis[1]) / degree;
    double least = std::numeric_limits<double>::infinity();
    const Rotary before = *this;
    for (const bool flipped : {false, true}) {
      const double to_a = flipped ? -tilt : tilt,
                   to_c = before.c + std::remainder(heading + (flipped ? 180 : 0) - before.c, 360);
      const double change = std::abs(to_a - before.a) + std::abs(to_c - before.c);
      if (change < least) least = change, a = to_a, c = to_c;
    }
  }
};

void check_links(const ToolPath& path) {
  const auto missing =
      std::ranges::count_if(path.poses, [](const ToolPose& pose) { return pose.kind == ToolMotion::missing; });
  if (missing > 0)
    throw InvalidArgument(
        "missing_links",
        "the path has " + detail::counted(missing, "missing link") + ", which a machine would cross in a straight line",
        "change the clearance, or cover the parts one after the other");
}

void check(const ToolPath& path, const GcodeOptions& o) {
  if (!(o.feed > 0 && std::isfinite(o.feed)))
    throw InvalidArgument("feed is " + detail::number(o.feed) + "; it must be finite and > 0");
  if (o.blend && !(*o.blend >= 0 && std::isfinite(*o.blend)))
    throw InvalidArgument("blend is " + detail::number(*o.blend) + "; it must be finite and >= 0");
  if (o.axes != 3 && o.axes != 5)
    throw InvalidArgument("axes is " + std::to_string(o.axes) + "; machines have 3 or 5 axes");
  check_links(path);
  if (o.axes == 5) return;
  for (std::size_t k = 0; k < path.poses.size(); ++k)
    if (path.poses[k].kind == ToolMotion::pass && !(path.poses[k].axis[2] > 0))
      throw InvalidArgument("axis_not_reachable",
                            "pose " + std::to_string(k) + " faces sideways or down, which 3 axes do not reach",
                            "cover the part that faces up, or use 5 axes");
}

std::string position_words(const Vec3& p, int digits) {
  return " X" + decimals(p[0], digits) + " Y" + decimals(p[1], digits) + " Z" + decimals(p[2], digits);
}

std::string program_start(const GcodeOptions& o, double blend, int digits) {
  std::string text = "(tool path by libahm)\n";
  if (o.axes == 5)
    text += "(tool axis: sin A sin C, sin A cos C, cos A; as xyzac-trt, X Y Z is the tool center point)\n";
  text += std::string(o.inches ? "G20" : "G21") + " G17 G40 G80 G90 G94\n";
  text += blend > 0 ? "G64 P" + decimals(blend, digits) + "\n" : "G61\n";
  return text;
}

std::string pose(const ToolPose& p, const char* indent) {
  const auto& [w, x, y, z] = p.quaternion;
  const auto field = [](const char* name, double value) { return std::string(name) + ": " + yaml_number(value); };
  return std::string("position: {") + field("x", p.position[0]) + ", " + field("y", p.position[1]) + ", " +
         field("z", p.position[2]) + "}\n" + indent + "orientation: {" + field("x", x) + ", " + field("y", y) + ", " +
         field("z", z) + ", " + field("w", w) + "}\n";
}

/// Whether a text has characters that YAML does not permit, or reads as line breaks.
bool has_control_character(const std::string& text) {
  for (std::size_t k = 0; k < text.size(); ++k) {
    const auto byte = [&](std::size_t at) { return at < text.size() ? static_cast<unsigned char>(text[at]) : 0; };
    if (byte(k) < 0x20 || byte(k) == 0x7f) return true;
    if (byte(k) == 0xc2 && byte(k + 1) >= 0x80 && byte(k + 1) < 0xa0) return true;  // U+0080 to U+009F
    if (byte(k) == 0xe2 && byte(k + 1) == 0x80 && (byte(k + 2) == 0xa8 || byte(k + 2) == 0xa9))
      return true;  // U+2028, U+2029
  }
  return false;
}

std::string ros_header(const std::string& frame, std::size_t number, double seconds) {
  auto whole = static_cast<std::int64_t>(seconds);
  auto nano = static_cast<std::int64_t>(std::lround(1e9 * (seconds - static_cast<double>(whole))));
  if (nano == 1'000'000'000) ++whole, nano = 0;
  std::string quoted;
  for (const char c : frame) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return "header: {seq: " + std::to_string(number) + ", stamp: {secs: " + std::to_string(whole) +
         ", nsecs: " + std::to_string(nano) + "}, frame_id: \"" + quoted + "\"}\n";
}

}  // namespace

std::vector<ToolRun> tool_runs(const ToolPath& path) {
  std::vector<ToolRun> runs;
  const std::vector<ToolPose>& poses = path.poses;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    if (k > 0 && poses[k].kind == poses[k - 1].kind && poses[k].pass == poses[k - 1].pass) {
      runs.back().end = k + 1;
      continue;
    }
    const bool follows = k > 0 && poses[k].kind != ToolMotion::pass && poses[k].kind != ToolMotion::missing;
    const bool lifted = poses[k].kind == ToolMotion::retreat || poses[k].kind == ToolMotion::approach ||
                        (poses[k].kind == ToolMotion::link && !runs.empty() && runs.back().lifted);
    runs.push_back({k, k + 1, follows ? k - 1 : k, poses[k].kind, poses[k].pass, lifted});
  }
  return runs;
}

std::string gcode(const ToolPath& path, const GcodeOptions& options) {
  check(path, options);
  double largest = 0;
  for (const ToolPose& p : path.poses)
    for (const double x : p.position) largest = std::max(largest, std::abs(x));
  constexpr int significant = 8, angle_digits = 5;
  const int digits =
      largest > 0 ? std::clamp(significant - 1 - static_cast<int>(std::floor(std::log10(largest))), 0, 300) : 0;
  std::string text = program_start(options, options.blend.value_or(path.chord_error), digits);
  Rotary rotary;
  bool has_feed = false;
  std::string reached;
  const auto move = [&](const ToolPose& p, bool rapid) {
    std::string words = position_words(p.position, digits);
    if (options.axes == 5) {
      rotary.turn_to(p.axis);
      words += " A" + decimals(rotary.a, angle_digits) + " C" + decimals(rotary.c, angle_digits);
    }
    if (words == reached) return;  // passes begin where the link ends
    text += (rapid ? "G0" : "G1") + words;
    if (!rapid && !has_feed) text += " F" + decimals(options.feed, digits), has_feed = true;
    text += '\n';
    reached = std::move(words);
  };
  for (const ToolRun& run : tool_runs(path)) {
    if (run.kind == ToolMotion::pass) text += "(pass " + std::to_string(run.pass) + ")\n";
    for (std::size_t k = run.begin; k < run.end; ++k)
      move(path.poses[k], k == 0 || (run.lifted && run.kind != ToolMotion::approach));
  }
  return text + "M2\n";
}

std::string ros_yaml(const ToolPath& path, const RosOptions& options) {
  if (!(options.feed >= 0 && std::isfinite(options.feed)))
    throw InvalidArgument("feed is " + detail::number(options.feed) + "; it must be finite and >= 0");
  if (options.frame.empty()) throw InvalidArgument("the frame has no name");
  if (has_control_character(options.frame))
    throw InvalidArgument("the name of the frame contains a line break or another control character");
  check_links(path);
  const bool stamped = options.message == RosMessage::path;
  std::string text = ros_header(options.frame, 0, 0);
  text += path.poses.empty() ? "poses: []\n" : "poses:\n";
  for (std::size_t k = 0; k < path.poses.size(); ++k) {
    if (stamped) {
      const double seconds = options.feed > 0 ? 60 * path.poses[k].arclength / options.feed : 0;
      text += "- " + ros_header(options.frame, k, seconds) + "  pose:\n    " + pose(path.poses[k], "    ");
    } else {
      text += "- " + pose(path.poses[k], "  ");
    }
  }
  return text;
}

}  // namespace ahm
