/// \file
/// The checks that stand before every solve.
#pragma once

#include "ahm/heat/heat_operators.hpp"

namespace ahm {

/// Checks the graph, if the options say so, and t_coef.
/// @throws InvalidGraph, InvalidArgument
void check_heat_options(const TangentGraph& graph, const HeatOptions& options);

}  // namespace ahm
