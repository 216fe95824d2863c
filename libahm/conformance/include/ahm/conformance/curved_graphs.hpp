/// \file
/// Curved graphs for tests that compare two solutions of the same problem.
#pragma once

#include "ahm/graph/csr_graph.hpp"

namespace ahm::test {

/// `n` points of the unit sphere, each joined to its nearest points, with random weights and frames turned at random. The
/// log map has no closed form on this graph.
CsrGraphData sphere_graph(Index n, unsigned seed = 1);

/// A jittered lattice in space with frames turned at random and small random rotations in the transports, as in a curved
/// space.
CsrGraphData bent_lattice(Index side, unsigned seed = 1);

}  // namespace ahm::test
