/// \file
/// Files of tool paths over whole surfaces: tables, lines, programs for machine tools, messages for robots.
#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

#include "ahm/applications/tool_path_text.hpp"
#include "cli/options.hpp"

namespace ahm::app {

/// Options of the files.
struct PathFileOptions {
  double feed = 0;  ///< 0: none
  GcodeOptions gcode = {};
  RosOptions ros = {};
};

/// Adds --feed, --axes, --units, --message and --frame, which need `whole`.
void offer_path_files(CLI::App& app, PathFileOptions& o, CLI::Option* whole);

/// Extensions of the files.
std::vector<std::string> path_endings();

/// Checks the options for a file before the work. @throws InvalidArgument
void check_path_file(const OutputOptions& output, const PathFileOptions& options);

/// Writes a path in the format of the file's extension.
/// @param path_options  options of the path; G-code may blend corners by their chord error
/// @throws InvalidArgument (a path without a G-code program: as `gcode`), IoError
void write_path_file(const OutputOptions& output, const PathFileOptions& options, const ToolPathOptions& path_options,
                     const ToolPath& path);

}  // namespace ahm::app
