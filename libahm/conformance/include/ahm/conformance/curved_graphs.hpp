/// \file
/// Curved graphs for tests that compare two ways of solving the same problem.
#pragma once

#include "ahm/graph/csr_graph.hpp"

namespace ahm::test {

/// `n` points of the unit sphere, each joined to its nearest ones, random weights, frames turned at random. The
/// log map on it has no closed form; both sides of a comparison see the same graph.
CsrGraphData sphere_graph(Index n, unsigned seed = 1);

/// A jittered lattice in space with frames turned at random and transports bent a little: as if the space were curved.
CsrGraphData bent_lattice(Index side, unsigned seed = 1);

}  // namespace ahm::test
