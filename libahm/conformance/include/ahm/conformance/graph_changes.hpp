/// \file
/// Graphs made from other graphs, whose maps follow from those of the first.
#pragma once

#include <vector>

#include "ahm/graph/csr_graph.hpp"

namespace ahm::test {

/// A copy of any graph in flat arrays.
CsrGraphData stored(const TangentGraph& graph);

/// Two graphs of one kind side by side, not connected.
CsrGraphData joined(const CsrGraphData& graph, const CsrGraphData& other);

/// Two copies of a graph side by side, not connected.
CsrGraphData doubled(const CsrGraphData& graph);

/// The same graph with every frame turned at random: components in frame i become Q_i times them. On `block` graphs
/// every other frame is mirrored as well.
struct Turned {
  CsrGraphData data;
  std::vector<double> turns;  ///< Q_i, n x d x d, row major
};
Turned with_frames_turned(const CsrGraphData& graph, unsigned seed = 1);

/// The same graph with every 2 x 2 rotation written out as a block.
CsrGraphData as_blocks(const CsrGraphData& rotations);

/// The same graph with its vertices renumbered: vertex i becomes order[i].
CsrGraphData relabelled(const CsrGraphData& graph, const std::vector<Index>& order);

/// The same graph seen from the other side: every frame mirrored in its x axis.
CsrGraphData mirrored(const CsrGraphData& graph);

/// The same graph with lengths multiplied by `factor` (masses by its power d, weights by its power d - 2).
CsrGraphData scaled(const CsrGraphData& graph, double factor);

}  // namespace ahm::test
