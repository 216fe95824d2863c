/// \file
/// The checks that stand before every solve.
#pragma once

#include "ahm/heat/heat_operators.hpp"

namespace ahm {

/// Checks the options, and the graph if they say so.
/// @throws InvalidGraph, InvalidArgument
void check_heat_options(const TangentGraph& graph, const HeatOptions& options);

}  // namespace ahm
