/// \file
/// Which strategy suits a graph.
#pragma once

#include "ahm/log_map_solver.hpp"

namespace ahm {

/// `global` or `march`, never `automatic`.
Strategy choose_strategy(const TangentGraph& graph, const SolverOptions& options);

/// Checks the graph, if the options say so, and t_coef.
/// @return tau
/// @throws InvalidGraph, InvalidArgument
double check_operator_options(const TangentGraph& graph, const OperatorOptions& options);

/// Rough number of bytes that the factors of both operators and their making take at the peak.
double factor_bytes(const TangentGraph& graph);

}  // namespace ahm
