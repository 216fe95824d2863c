#include "commands/tool_path_files.hpp"

#include <fmt/format.h>

#include "ahm/error.hpp"
#include "ahm/io/formats.hpp"
#include "cli/option_adders.hpp"

namespace ahm::app {

void offer_path_files(CLI::App& app, PathFileOptions& o, CLI::Option* whole) {
  const auto add = [&](const std::string& name, auto& value, const auto& parse, const char* type, const char* help) {
    const auto noted = [&o, name, parse](const std::string& text) {
      o.named.push_back(name);
      return parse(text);
    };
    return add_parsed(app, name, value, noted, type, help)->needs(whole);
  };
  add("--feed", o.feed, parse_positive, "F",
      "Speed of the tool, units of length per minute: a column 'time', stamps, and the feed rate of G-code");
  add("--axes", o.gcode.axes, choice_of<int>({{"3", 3}, {"5", 5}}), "N",
      ".ngc: 3 (default: X Y Z, tool along z) or 5 (also A and C, see below)");
  add("--units", o.gcode.inches, choice_of<bool>({{"mm", false}, {"inch", true}}), "NAME",
      ".ngc: unit of length, mm (default) or inch; numbers are not converted");
  add("--message", o.ros.message,
      choice_of<RosMessage>({{"PoseArray", RosMessage::pose_array}, {"Path", RosMessage::path}}), "NAME",
      ".yaml: geometry_msgs/PoseArray (default) or nav_msgs/Path");
  add("--frame", o.ros.frame, non_empty, "NAME", ".yaml: frame of the coordinates (default map)");
}

void check_path_file(const OutputOptions& output, const PathFileOptions& options) {
  const std::string extension = output.format.empty() ? io::lower_extension(output.output) : output.format;
  if (extension == ".ngc" && options.feed == 0)
    throw InvalidArgument(fmt::format("--output {}: G-code needs a feed rate; use --feed", output.output));
  const auto is_used = [&](const std::string& option) {
    if (option == "--axes" || option == "--units") return extension == ".ngc";
    if (option == "--message" || option == "--frame") return extension == ".yaml";
    return extension == ".yaml" ? options.ros.message == RosMessage::path : extension != ".obj";  // --feed
  };
  for (const std::string& option : options.named)
    if (!is_used(option))
      throw InvalidArgument(
          fmt::format("--output {}: {} has no effect on {}; leave it out", output.output, option,
                      extension == ".yaml" ? "a PoseArray, which has no times" : "a file of this format"));
}

}  // namespace ahm::app
