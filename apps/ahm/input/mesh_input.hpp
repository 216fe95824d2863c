/// \file
/// What the backends for meshes ask of the command line and the input.
#pragma once

#include <span>
#include <string>

#include "ahm/io/geometry.hpp"
#include "cli/options.hpp"

namespace ahm::app {

/// The cheap checks, before any work: there are faces, the source fits them, no option for clouds was given.
/// @throws InvalidArgument
void check_mesh_input(const std::string& backend, const io::Geometry& input, const InputOptions& options,
                      const std::optional<SourceSpec>& source);

/// The row nearest to a position among those that are vertices of a graph (`vertex_of_row` >= 0).
Index nearest_row(std::span<const Vec3> points, std::span<const Index> vertex_of_row, const Vec3& position);

/// Advice of the library in terms of the program's options.
std::string in_terms_of_the_program(std::string text);

}  // namespace ahm::app
