/// \file
/// Statuses of the rows that --local left out.
#pragma once

#include "ahm/surface/row_log_map.hpp"
#include "input/open.hpp"

namespace ahm::app {

/// Corrects the statuses of rows that --local left out, or that only left-out faces connect to the source. Meshes get the same
/// statuses as without --local. Points of clouds get `beyond_radius` if their straight-line distance is larger than the radius.
void set_left_out_statuses(const Input& input, const SurfaceSource& source, double radius, RowLogMap& rows);

}  // namespace ahm::app
