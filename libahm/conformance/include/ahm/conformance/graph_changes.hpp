/// \file
/// Graphs derived from other graphs, whose maps follow from those of the original.
#pragma once

#include <vector>

#include "ahm/graph/csr_graph.hpp"

namespace ahm::test {

/// A copy of any graph in flat arrays.
CsrGraphData stored(const TangentGraph& graph);

/// Two graphs of the same kind as one graph of two components.
CsrGraphData joined(const CsrGraphData& graph, const CsrGraphData& other);

/// Two copies of a graph as one graph of two components.
CsrGraphData doubled(const CsrGraphData& graph);

/// A graph with every frame turned at random: components in frame i are multiplied by Q_i. On `block` graphs every other
/// frame is mirrored as well.
struct TurnedGraph {
  CsrGraphData data;
  std::vector<double> turns;  ///< Q_i, n x d x d, row major
};
TurnedGraph with_frames_turned(const CsrGraphData& graph, unsigned seed = 1);

/// A graph with every 2 x 2 rotation stored as a block.
CsrGraphData as_blocks(const CsrGraphData& rotations);

/// A graph with its vertices renumbered: vertex i becomes order[i].
CsrGraphData relabeled(const CsrGraphData& graph, const std::vector<Index>& order);

/// A graph seen from the other side: every frame is mirrored in its x axis.
CsrGraphData mirrored(const CsrGraphData& graph);

/// A graph with lengths multiplied by `factor`, masses by factor^d and weights by factor^(d - 2).
CsrGraphData scaled(const CsrGraphData& graph, double factor);

}  // namespace ahm::test
