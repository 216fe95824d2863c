/// \file
/// Extracts a subgraph.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "ahm/graph/csr_graph.hpp"
#include "ahm/util/small_math.hpp"

namespace ahm {

/// The subgraph of some vertices, with the mean edge length of the whole graph. Edges to other vertices are dropped. This gives natural
/// boundary conditions, for which affine maps stay exact on flat geometry.
/// @param local_of    local_of(vertex): number of a vertex of `graph` in the subgraph; negative: outside
/// @param on_outside  on_outside(position in `vertices`, star, edge): called for each dropped edge of nonzero weight; returns the
///                    mass to add to the vertex
/// @param beyond      number of additional vertices, without out-edges and with mass 1. They are numbered from vertices.size() on;
///                    `local_of` may map vertices to them
template <class LocalOf, class OnOutside>
CsrGraph cut_out(const TangentGraph& graph, std::span<const Index> vertices, const LocalOf& local_of,
                 const OnOutside& on_outside, std::size_t beyond = 0) {
  const auto d = static_cast<std::size_t>(graph.dimension());
  const std::size_t r = graph.transport_layout().width();
  CsrGraphData patch;
  patch.dimension = graph.dimension();
  patch.kind = graph.transport_kind();
  patch.length_unit = graph.length_unit();
  patch.mean_edge_length = graph.mean_edge_length();
  patch.is_delaunay = graph.is_delaunay();
  patch.row_begin.reserve(vertices.size() + 1);
  patch.masses.reserve(vertices.size());
  const std::size_t expected =
      vertices.size() * static_cast<std::size_t>(graph.edge_count() / std::max<Index>(graph.size(), 1) + 1);
  patch.neighbors.reserve(expected);
  patch.weights.reserve(expected);
  patch.logs.reserve(expected * d);
  patch.transports.reserve(expected * r);
  patch.row_begin.push_back(0);
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    const Star star = graph.star(vertices[k]);
    double mass = graph.mass(vertices[k]);
    for (std::size_t e = 0; e < star.degree(); ++e) {
      const Index j = local_of(star.neighbors[e]);
      if (j < 0) {
        if (star.weights[e] != 0) mass += on_outside(k, star, e);
        continue;
      }
      patch.neighbors.push_back(j);
      patch.weights.push_back(star.weights[e]);
      patch.logs.insert(patch.logs.end(), star.logs.begin() + static_cast<std::ptrdiff_t>(e * d),
                        star.logs.begin() + static_cast<std::ptrdiff_t>((e + 1) * d));
      patch.transports.insert(patch.transports.end(), star.transports.begin() + static_cast<std::ptrdiff_t>(e * r),
                              star.transports.begin() + static_cast<std::ptrdiff_t>((e + 1) * r));
    }
    patch.masses.push_back(mass);
    patch.row_begin.push_back(static_cast<Offset>(patch.neighbors.size()));
  }
  patch.masses.resize(vertices.size() + beyond, 1.0);
  patch.row_begin.resize(patch.masses.size() + 1, patch.row_begin.back());
  return CsrGraph(std::move(patch));
}

}  // namespace ahm
