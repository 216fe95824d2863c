/// \file
/// Graphs with their solvers, and comparisons of maps.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <span>
#include <utility>

#include "ahm/conformance/curved_graphs.hpp"
#include "ahm/conformance/flat_graphs.hpp"
#include "ahm/conformance/graph_changes.hpp"
#include "ahm/error.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/vec.hpp"

namespace ahm::test {

inline constexpr std::array strategies{Strategy::global, Strategy::march};
inline constexpr std::array identity{1.0, 0.0, 0.0, 1.0}, mirror{1.0, 0.0, 0.0, -1.0};
inline constexpr std::array zero{0.0, 0.0};

inline Source source_at(Index vertex) { return Source::at_vertex(Vertex(vertex)); }

/// A plane on which every other frame is mirrored.
inline FlatGraph mirrored_plane(Index side) { return planar_triangulation(side, TransportKind::block, true); }

struct SolvedGraph {
  explicit SolvedGraph(CsrGraphData data, const HeatOptions& options = {})
      : graph(std::move(data)), solver(graph, options) {}
  SolvedGraph(const SolvedGraph&) = delete;  // the solver refers to the graph

  LogMap map(const Source& source, const MapOptions& options = {}) const { return solver.solve(source, options); }
  LogMap map(Index vertex, const MapOptions& options = {}) const { return map(source_at(vertex), options); }

  CsrGraph graph;
  LogMapSolver solver;
};

inline bool same_bits(std::span<const double> a, std::span<const double> b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size_bytes()) == 0;
}

inline void expect_near(std::span<const double> found, std::span<const double> expected, double tolerance) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t k = 0; k < found.size(); ++k) ASSERT_NEAR(found[k], expected[k], tolerance) << "number " << k;
}

/// Expects the closed form from vertex p wherever the map is ok.
inline void expect_exact(const FlatGraph& flat, const LogMap& map, Index p) {
  for (Index i = 0; i < flat.size(); ++i) {
    if (map.status(Vertex(i)) != Status::ok) continue;
    SCOPED_TRACE("vertex " + std::to_string(i) + ", source " + std::to_string(p));
    ASSERT_NO_FATAL_FAILURE(expect_near(map.coordinates(Vertex(i)), flat.exact(p, i), 1e-11 * flat.diameter()));
  }
}

/// Largest difference of two maps, relative to the largest distance; infinite where their statuses differ.
inline double difference(const LogMap& a, const LogMap& b) {
  if (!std::ranges::equal(a.status(), b.status())) return INFINITY;
  double largest = 0, scale = 0;
  for (Index i = 0; i < a.size(); ++i) {
    if (a.status(Vertex(i)) != Status::ok) continue;
    scale = std::max(scale, a.distance(Vertex(i)));
    for (int c = 0; c < a.dimension(); ++c)
      largest = std::max(largest, std::abs(a.coordinates(Vertex(i))[c] - b.coordinates(Vertex(i))[c]));
  }
  return largest / scale;
}

}  // namespace ahm::test
