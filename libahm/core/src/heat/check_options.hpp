/// \file
/// The checks that stand before every solve.
#pragma once

#include "ahm/heat/heat_operators.hpp"

namespace ahm {

/// Checks the graph, if the options say so, and t_coef.
/// @return tau
/// @throws InvalidGraph, InvalidArgument
double check_operator_options(const TangentGraph& graph, const OperatorOptions& options);

}  // namespace ahm
