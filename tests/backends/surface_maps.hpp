/// \file
/// Maps of surfaces in one call, and comparisons that the tests of all backends use.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ahm/graph/csr_graph.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/surface/surface.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/vec.hpp"

namespace ahm::test {

inline RowLogMap map_of(const Surface& surface, const SurfacePoint& point, const std::optional<Vec3>& axis = {}) {
  return surface.to_rows(LogMapSolver(surface.graph()).solve(surface.source(point, axis).source));
}

/// Mean edge length in world units.
inline double mean_edge(const Surface& surface) {
  return surface.graph().mean_edge_length() * surface.graph().length_unit();
}

inline std::optional<Warning> find_warning(const Surface& surface, std::string_view id) {
  for (const Warning& warning : surface.warnings())
    if (warning.id == id) return warning;
  return {};
}

/// Largest difference of (u, v), infinite where one is NaN.
inline double largest_difference(const RowLogMap& a, const RowLogMap& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.u.size(); ++i) {
    const double difference = std::hypot(a.u[i] - b.u[i], a.v[i] - b.v[i]);
    largest = std::isnan(difference) ? INFINITY : std::max(largest, difference);
  }
  return largest;
}

/// Largest difference between (u, v) and the positions relative to `origin` along two axes. Infinite unless every row is mapped.
inline double flat_error(const RowLogMap& map, std::span<const Vec3> positions, const Vec3& origin, const Vec3& x,
                         const Vec3& y) {
  double worst = 0;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Vec3 offset = positions[i] - origin;
    const double error = std::hypot(map.u[i] - dot(x, offset), map.v[i] - dot(y, offset));
    worst = map.status[i] == Status::ok && !std::isnan(error) ? std::max(worst, error) : INFINITY;
  }
  return worst;
}

inline void expect_near(std::span<const double> found, std::span<const double> expected, double tolerance) {
  for (std::size_t i = 0; i < expected.size(); ++i) ASSERT_NEAR(found[i], expected[i], tolerance) << "row " << i;
}

/// Expects that row i of `a` has the status, coordinates and distance of row `row_of(i)` of `b`.
template <class RowOf>
void expect_same_rows(const RowLogMap& a, const RowLogMap& b, double tolerance, const RowOf& row_of) {
  for (std::size_t i = 0; i < a.u.size(); ++i) {
    const auto j = static_cast<std::size_t>(row_of(static_cast<Index>(i)));
    ASSERT_EQ(a.status[i], b.status[j]) << "row " << i;
    ASSERT_NEAR(a.u[i], b.u[j], tolerance) << "row " << i;
    ASSERT_NEAR(a.v[i], b.v[j], tolerance) << "row " << i;
    ASSERT_NEAR(a.distance[i], b.distance[j], tolerance) << "row " << i;
  }
}

/// The map of a surface that is `factor` times as large.
inline RowLogMap scaled(double factor, RowLogMap map) {
  for (auto* numbers : {&map.u, &map.v, &map.distance})
    for (double& x : *numbers) x *= factor;
  return map;
}

inline void expect_nan_exactly_where_not_ok(const RowLogMap& map) {
  for (std::size_t i = 0; i < map.status.size(); ++i)
    for (double x : {map.u[i], map.v[i], map.distance[i], map.angle[i]})
      ASSERT_EQ(std::isnan(x), map.status[i] != Status::ok) << "row " << i;
}

/// Expects that the first rows are mapped, at the distances of their positions in the plane.
inline void expect_plane_distances(const RowLogMap& map, const std::vector<Vec2>& plane, Index source,
                                   double tolerance) {
  for (std::size_t i = 0; i < plane.size(); ++i) {
    ASSERT_EQ(map.status[i], Status::ok) << "row " << i;
    ASSERT_NEAR(map.distance[i], length(plane[i] - plane[static_cast<std::size_t>(source)]), tolerance) << "row " << i;
  }
}

/// Expects that the graphs of two surfaces are the same bits.
template <class BuiltSurface>
void expect_same_bits(const BuiltSurface& one, const BuiltSurface& other) {
  const CsrGraphData &a = one.graph().data(), &b = other.graph().data();
  EXPECT_EQ(a.neighbors, b.neighbors);
  EXPECT_EQ(a.weights, b.weights);
  EXPECT_EQ(a.logs, b.logs);
  EXPECT_EQ(a.transports, b.transports);
  EXPECT_EQ(a.masses, b.masses);
}

inline double percentile95(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() * 95 / 100];
}

}  // namespace ahm::test
