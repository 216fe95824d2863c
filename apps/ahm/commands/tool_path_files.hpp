/// \file
/// Options of the files of tool paths over whole surfaces.
#pragma once

#include <CLI/App.hpp>

#include "cli/options.hpp"
#include "output/tool_paths.hpp"

namespace ahm::app {

/// Adds --feed, --axes, --units, --message and --frame, which need `whole`.
void offer_path_files(CLI::App& app, PathFileOptions& o, CLI::Option* whole);

/// Checks the options for a file before the work. @throws InvalidArgument (one is missing, or has no effect)
void check_path_file(const OutputOptions& output, const PathFileOptions& options);

}  // namespace ahm::app
