/// \file
/// What --local left out, in the results of all of the input.
#pragma once

#include "ahm/surface/row_log_map.hpp"
#include "input/open.hpp"

namespace ahm::app {

/// Statuses of rows that the surface lacks, or that hang together with the source by what it lacks alone: of meshes as without
/// --local, of clouds `beyond_radius` where they are farther than that in a straight line.
void settle_left_out(const Input& input, const SurfaceSource& source, double radius, RowLogMap& rows);

}  // namespace ahm::app
