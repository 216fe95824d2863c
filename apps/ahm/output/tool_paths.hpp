/// \file
/// Files of tool paths over whole surfaces: tables, lines, programs for machine tools, messages for robots.
#pragma once

#include <string>
#include <vector>

#include "ahm/applications/tool_path_text.hpp"

namespace ahm::app {

/// Options of the files.
struct PathFileOptions {
  double feed = 0;  ///< 0: none
  GcodeOptions gcode = {};
  RosOptions ros = {};
  std::vector<std::string> named = {};  ///< those in the command line: "--feed"
};

/// Extensions of the files.
std::vector<std::string> path_endings();

/// @param format        extension; empty: that of the file name
/// @param path_options  options of the path; G-code may blend corners by their chord error
/// @throws InvalidArgument (a path without a G-code program: as `gcode`), IoError
void write_tool_path(const std::string& file, const std::string& format, const PathFileOptions& options,
                     const ToolPathOptions& path_options, const ToolPath& path);

}  // namespace ahm::app
