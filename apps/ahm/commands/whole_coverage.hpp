/// \file
/// 'ahm coverage --whole': tool paths over whole surfaces.
#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>
#include <vector>

#include "ahm/applications/tool_path.hpp"
#include "cli/options.hpp"
#include "cli/source_list.hpp"
#include "commands/tool_path_files.hpp"

namespace ahm::app {

/// Options of tool paths over whole surfaces.
struct WholeOptions {
  bool whole = false;
  bool from_boundary = false;
  std::vector<double> plane;                ///< point and normal: six numbers; empty: none
  std::vector<SourceSpec> curve;            ///< of the seed
  std::vector<SourceSpec> inside, outside;  ///< closed curves that limit the region
  bool closed = false;
  double feature_angle = 0;           ///< of the seed, radians; 0: none
  std::optional<SourceSpec> feature;  ///< a point near the feature edge
  std::optional<SourceSpec> line;
  std::optional<Direction> direction;
  bool zigzag = false;  ///< the default, for completeness
  std::string mask;
  std::optional<Vec3> facing;
  double max_angle = 0.785398163397448;  ///< radians
  ToolPathOptions path = {};
  PathFileOptions files = {};
  std::string rows;  ///< a file
};

/// Adds --whole and the options that need it.
void offer_whole(CLI::App& app, WholeOptions& o);

/// Covers the whole surface, or the disc around the source.
/// @param radius  0: no disc
void run_whole(const InputOptions& input, const OutputOptions& output, const WholeOptions& options,
               const std::optional<SourceSpec>& source, double radius);

}  // namespace ahm::app
