/// \file
/// Numbers by point that are neither positions, normals nor colors, and go through to the outputs.
#pragma once

#include <string>
#include <vector>

#include "ahm/io/geometry.hpp"

namespace ahm::io {

/// Adds a property, under a name that a column may have (letters, digits and _) and that no other one has.
void add_property(Geometry& g, const std::string& name, std::vector<double> values);

}  // namespace ahm::io
