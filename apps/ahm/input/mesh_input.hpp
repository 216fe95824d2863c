/// \file
/// What the backends for meshes ask of the command line and the input.
#pragma once

#include <string>

#include "ahm/io/geometry.hpp"
#include "cli/options.hpp"

namespace ahm::app {

/// The cheap checks, before any work: there are faces, the source fits them, no option for clouds was given.
/// @throws InvalidArgument
void check_mesh_input(const std::string& backend, const io::Geometry& input, const InputOptions& options,
                      const std::optional<SourceSpec>& source);

}  // namespace ahm::app
