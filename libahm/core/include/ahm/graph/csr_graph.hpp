/// \file
/// A tangent graph stored in arrays. Most backends build one; users can fill its arrays themselves.
///
/// \code
/// ahm::CsrGraphData g;                       // two vertices on a line, one apart (d = 1)
/// g.dimension = 1;
/// g.kind = ahm::TransportKind::block;
/// g.row_begin = {0, 1, 2};
/// g.neighbors = {1, 0};
/// g.weights = {1.0, 1.0};
/// g.logs = {+1.0, -1.0};
/// g.transports = {1.0, 1.0};
/// g.masses = {0.5, 0.5};
/// ahm::CsrGraph graph(std::move(g));
/// \endcode
#pragma once

#include <optional>
#include <vector>

#include "ahm/graph/graph_cache.hpp"
#include "ahm/graph/tangent_graph.hpp"

namespace ahm {

/// The arrays of a `CsrGraph`: compressed rows, one row of out-edges per vertex.
struct CsrGraphData {
  int dimension = 2;
  TransportKind kind = TransportKind::rotation2;
  std::vector<Offset> row_begin;           ///< n + 1 offsets into the edge arrays
  std::vector<Index> neighbors;            ///< one per directed edge
  std::vector<double> weights;             ///< one per directed edge
  std::vector<double> logs;                ///< d per directed edge
  std::vector<double> transports;          ///< 2 (rotation2) or d*d (block) per directed edge
  std::vector<double> masses;              ///< one per vertex
  std::vector<Frame> frames;               ///< one per vertex, or empty
  double length_unit = 1.0;                ///< power of two; see TangentGraph::length_unit
  std::optional<double> mean_edge_length;  ///< default: the mean of |e_ij| over all edges
  bool is_delaunay = false;                ///< see TangentGraph::is_delaunay
  /// one per vertex, or empty; see TangentGraph::component_edge_length
  std::vector<double> component_edge_lengths{};
};

/// A `TangentGraph` stored in flat arrays.
class CsrGraph final : public TangentGraph {
 public:
  /// Takes ownership of the arrays. Call `validate` to check the graph contract.
  /// @throws InvalidGraph (array lengths disagree, or a neighbor is out of range)
  explicit CsrGraph(CsrGraphData data);

  Index size() const noexcept override { return static_cast<Index>(data_.masses.size()); }
  int dimension() const noexcept override { return data_.dimension; }
  TransportKind transport_kind() const noexcept override { return data_.kind; }
  double mean_edge_length() const noexcept override { return *data_.mean_edge_length; }
  double component_edge_length(Index vertex) const override {
    return data_.component_edge_lengths.empty() ? 0 : data_.component_edge_lengths[vertex];
  }
  double mass(Index vertex) const override { return data_.masses[vertex]; }
  Star star(Index vertex) const override;
  Offset edge_count() const noexcept override { return static_cast<Offset>(data_.neighbors.size()); }
  double length_unit() const noexcept override { return data_.length_unit; }
  bool is_delaunay() const noexcept override { return data_.is_delaunay; }
  std::optional<Frame> frame(Index vertex) const override;
  const GraphCache* cache() const noexcept override { return &cache_; }

  const CsrGraphData& data() const noexcept { return data_; }

 private:
  CsrGraphData data_;
  GraphCache cache_;
};

}  // namespace ahm
