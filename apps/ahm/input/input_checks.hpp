/// \file
/// What backends ask of the command line and the input: the cheap checks, before any work.
#pragma once

#include <string>

#include "ahm/io/geometry.hpp"
#include "cli/options.hpp"

namespace ahm::app {

/// There are faces, the source fits them, no option for clouds was given.
/// @throws InvalidArgument
void check_mesh_input(const std::string& backend, const io::Geometry& input, const InputOptions& options,
                      const std::optional<SourceSpec>& source);

/// The source is a point, no option for meshes was given.
/// @throws InvalidArgument
void check_cloud_input(const io::Geometry& input, const InputOptions& options, const std::optional<SourceSpec>& source);

}  // namespace ahm::app
