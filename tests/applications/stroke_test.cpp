// Stroke-aligned parameterization: what a curve in the plane, on a cylinder and on any flat graph must give.
#include "ahm/applications/stroke.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ahm/conformance/flat_graphs.hpp"
#include "ahm/error.hpp"
#include "ahm/maps/log_map_solver.hpp"

namespace ahm::test {
namespace {

Vec2 position(const FlatGraph& flat, Index i) {
  return {flat.positions[2 * static_cast<std::size_t>(i)], flat.positions[2 * static_cast<std::size_t>(i) + 1]};
}

/// The row of a `planar_triangulation` through its middle, from left to right.
std::vector<Vertex> middle_row(Index side) {
  std::vector<Vertex> path;
  for (Index x = 2; x < side - 2; ++x) path.emplace_back(side / 2 * side + x);
  return path;
}

/// Rings of `around` vertices at radii 1 + i * `spacing` about the origin.
FlatGraph rings(Index around, Index count, double spacing) {
  std::vector<double> positions;
  std::vector<Pair> edges;
  for (Index r = 0; r < count; ++r)
    for (Index a = 0; a < around; ++a) {
      const double angle = 2 * std::numbers::pi * a / around, radius = 1 + r * spacing;
      positions.insert(positions.end(), {radius * std::cos(angle), radius * std::sin(angle)});
      const Index here = r * around + a, next = r * around + (a + 1) % around;
      edges.push_back({here, next});
      if (r + 1 < count) edges.push_back({here, here + around}), edges.push_back({here, next + around});
    }
  return flat_graph(2, positions, edges, TransportKind::rotation2, false, 3);
}

TEST(Stroke, GivesThePlaneBackFromAnyCurveWithItsOwnPositions) {
  for (const bool mirrored : {false, true}) {
    const FlatGraph flat =
        planar_triangulation(20, mirrored ? TransportKind::block : TransportKind::rotation2, mirrored);
    const CsrGraph graph(flat.data);
    const LogMapSolver solver(graph);
    const std::vector<Vertex> path = middle_row(20);
    std::vector<Vec2> positions;
    for (const auto [i] : path) positions.push_back(position(flat, i));
    // On mirrored frames left may be right: then the map of the mirrored plane.
    const Source source = stroke_source(graph, path, positions);
    if (mirrored) {
      for (Vec2& z : positions) z[1] = -z[1];
    }
    const Source other = stroke_source(graph, path, positions);
    for (Variant variant : all_variants) {
      double worst[] = {0, 0};
      for (int which : {0, 1}) {
        const LogMap map = solver.solve(which == 0 ? source : other, {.variant = variant});
        for (Index i = 0; i < flat.size(); ++i) {
          const Vec2 exact = position(flat, i);
          const double v = which == 1 && mirrored ? -exact[1] : exact[1];
          worst[which] = std::max(
              worst[which], std::hypot(map.coordinates(Vertex(i))[0] - exact[0], map.coordinates(Vertex(i))[1] - v));
        }
      }
      EXPECT_LT(std::min(worst[0], worst[1]), 1e-11);
    }
  }
}

TEST(Stroke, AStraightLineGivesArclengthAndSignedDistance) {
  const FlatGraph flat = strip(30);
  const CsrGraph graph(flat.data);
  // A straight row: the vertices whose second coordinate is the first one's, by their first coordinate.
  std::vector<Vertex> path;
  for (Index i = 0; i < flat.size(); ++i)
    if (position(flat, i)[1] == position(flat, 0)[1]) path.emplace_back(i);
  std::sort(path.begin(), path.end(),
            [&](Vertex a, Vertex b) { return position(flat, a.index)[0] < position(flat, b.index)[0]; });
  const LogMap map = LogMapSolver(graph).solve(stroke_source(graph, path));
  const Vec2 start = position(flat, path[0].index);
  for (Index i = 0; i < flat.size(); ++i) {
    EXPECT_NEAR(map.coordinates(Vertex(i))[0], position(flat, i)[0] - start[0], 1e-11 * flat.diameter());
    EXPECT_NEAR(map.coordinates(Vertex(i))[1], position(flat, i)[1] - start[1], 1e-11 * flat.diameter());
  }
}

TEST(Stroke, ACircleInThePlaneGivesThePlane) {
  const Index around = 96, count = 12;
  const double spacing = 2 * std::numbers::pi / around;
  const FlatGraph flat = rings(around, count, spacing);
  const CsrGraph graph(flat.data);
  std::vector<Vertex> path;
  for (Index a = 0; a < around; ++a) path.emplace_back(count / 2 * around + a);
  const Source source = stroke_source(graph, path, {.closed = true, .shape = StrokeShape::circle});
  const LogMap map = LogMapSolver(graph).solve(source);
  // The circle has the length of the polygon: smaller than the circle through its corners by a share of pi^2 / 6 n^2.
  const double share = std::pow(std::numbers::pi / around, 2) / 6, radius = 1 + count / 2 * spacing;
  for (Index i = 0; i < flat.size(); ++i) {
    const Vec2 exact = position(flat, i);
    EXPECT_LT(std::hypot(map.coordinates(Vertex(i))[0] - exact[0], map.coordinates(Vertex(i))[1] - exact[1]),
              1.01 * share * radius);
  }
}

/// Rings with the weights and masses of their nearly square cells, so that heat spreads evenly.
FlatGraph even_rings(Index around, Index count, double spacing) {
  FlatGraph flat = rings(around, count, spacing);
  CsrGraphData& g = flat.data;
  const auto radius = [&](Index i) { return 1 + i / around * spacing; };
  for (Index i = 0; i < flat.size(); ++i) {
    const double arc = 2 * std::numbers::pi / around * radius(i);
    g.masses[i] = arc * spacing;
    for (Offset e = g.row_begin[i]; e < g.row_begin[static_cast<std::size_t>(i) + 1]; ++e) {
      const Index j = g.neighbors[e];
      const double between = std::numbers::pi / around * (radius(i) + radius(j));
      g.weights[e] = i / around == j / around ? spacing / arc : i % around == j % around ? between / spacing : 0.0;
    }
  }
  return flat;
}

TEST(Stroke, ACircleUnrolledGivesArclengthAndSignedDistance) {
  const Index count = 9;
  for (Index around : {64, 128, 256}) {
    const double spacing = 2 * std::numbers::pi / around;
    const FlatGraph flat = even_rings(around, count, spacing);
    const CsrGraph graph(flat.data);
    std::vector<Vertex> path;
    const double R = 1 + count / 2 * spacing;
    for (Index a = 0; a < around; ++a) path.emplace_back(count / 2 * around + a);
    const LogMap map = LogMapSolver(graph).solve(stroke_source(graph, path, {.closed = true}));
    const double root_tau = graph.mean_edge_length() * graph.length_unit();
    for (Index r = 0; r < count; ++r)
      for (Index a = around / 4; a < 3 * around / 4; ++a) {  // away from the seam
        const auto phi = map.coordinates(Vertex(r * around + a));
        const double rho = 1 + r * spacing, s = 2 * std::numbers::pi * R * a / around, left = R - rho;
        // Heat comes from a piece of the circle of variance sqrt(tau) / (1/d - 1/R), whose points see the vertex at
        // (s - rho sin(s/R), R - rho cos(s/R)): second order in the width of the piece. The discrete heat of a vertex on
        // the curve comes from its neighbours as well: d + sqrt(tau).
        const double d = std::abs(left) + root_tau, spread = root_tau / (1 / d - (left > 0 ? 1 : -1) / R);
        const double bias = rho * spread / (2 * R * R);
        EXPECT_LT(std::hypot(phi[0] - s, phi[1] - left), 1.5 * bias) << around << " around, ring " << r << ", at " << a;
      }
  }
}

TEST(Stroke, RingsOfATubeBecomeParallelLines) {
  const Index around = 24;
  const CsrGraph graph(tube(21, around));
  std::vector<Vertex> path;
  for (Index a = 0; a < around; ++a) path.emplace_back(10 * around + a);
  const LogMap map = LogMapSolver(graph).solve(stroke_source(graph, path, {.closed = true}));
  for (Index r = 0; r < 21; ++r)
    for (Index a = 0; a < around; ++a)
      EXPECT_NEAR(std::abs(map.coordinates(Vertex(r * around + a))[1]), std::abs(r - 10), 1e-10);
}

TEST(Stroke, OfPointsIsTheStrokeOfTheirVertices) {
  const FlatGraph flat = planar_triangulation(12);
  const CsrGraph graph(flat.data);
  const auto path = middle_row(12);
  const Source whole = stroke_source(graph, path);
  std::vector<StrokePoint> points;
  for (std::size_t k = 0; k < path.size(); ++k) {
    const auto U = whole.axes().subspan(4 * k, 4);
    const double direction[] = {U[0], U[2]};
    points.push_back({Source::at_vertex(path[k], direction),
                      whole.weights()[k],
                      {whole.offsets()[2 * k], whole.offsets()[2 * k + 1]},
                      0.0});
  }
  const LogMapSolver solver(graph);
  const LogMap a = solver.solve(whole), b = solver.solve(stroke_source(points));
  for (std::size_t i = 0; i < a.coordinates().size(); ++i) EXPECT_NEAR(a.coordinates()[i], b.coordinates()[i], 1e-12);
}

TEST(Stroke, OfPointsBesideVerticesIsExactInThePlane) {
  const FlatGraph flat = planar_triangulation(16);
  const CsrGraph graph(flat.data);
  Vec2 low = position(flat, 0), high = low;
  for (Index i = 0; i < flat.size(); ++i)
    for (int a : {0, 1})
      low[a] = std::min(low[a], position(flat, i)[a]), high[a] = std::max(high[a], position(flat, i)[a]);
  const Vec2 middle{(low[0] + high[0]) / 2, (low[1] + high[1]) / 2};
  const double radius = (high[0] - low[0]) / 4;
  // Points of a circle, each carried by the vertex nearest to it.
  const int n = 80;
  std::vector<Source> points;
  for (int k = 0; k < n; ++k) {
    const double angle = 2 * std::numbers::pi * k / n, c = std::cos(angle), s = std::sin(angle);
    const Vec2 p{middle[0] + radius * c, middle[1] + radius * s};
    Index nearest = 0;
    const auto away = [&](Index i) { return std::hypot(position(flat, i)[0] - p[0], position(flat, i)[1] - p[1]); };
    for (Index i = 1; i < flat.size(); ++i)
      if (away(i) < away(nearest)) nearest = i;
    const Vec2 a = position(flat, nearest);
    const double* F = &flat.frames[4 * static_cast<std::size_t>(nearest)];
    const double axes[] = {-F[0] * s + F[1] * c, -F[0] * c - F[1] * s, -F[2] * s + F[3] * c, -F[2] * c - F[3] * s};
    const Vec2 d{a[0] - p[0], a[1] - p[1]};
    const double offset[] = {-s * d[0] + c * d[1], -c * d[0] - s * d[1]};
    points.push_back(Source(2).add(Vertex(nearest), 1, offset, axes));
  }
  const std::vector<double> lengths(n, 2 * std::numbers::pi * radius / n);
  const LogMap map =
      LogMapSolver(graph).solve(stroke_source(points, lengths, {.closed = true, .shape = StrokeShape::circle}));
  for (Index i = 0; i < flat.size(); ++i)
    for (int a : {0, 1})
      EXPECT_NEAR(map.coordinates(Vertex(i))[a], position(flat, i)[a] - middle[a], 1e-11 * flat.diameter());
}

TEST(Stroke, RefusesWhatIsNoCurve) {
  const CsrGraph graph(planar_triangulation(6).data);
  const std::array jump{Vertex{0}, Vertex{35}}, outside{Vertex{0}, Vertex{36}};
  const std::array back{Vertex{0}, Vertex{1}, Vertex{0}};
  EXPECT_THROW(stroke_source(graph, jump), InvalidArgument);
  EXPECT_THROW(stroke_source(graph, outside), InvalidArgument);
  EXPECT_THROW(stroke_source(graph, back), InvalidArgument);
  EXPECT_THROW(stroke_source(graph, std::span(jump).first(1)), InvalidArgument);
  EXPECT_THROW(stroke_source(graph, std::array{Vertex{0}, Vertex{1}}, {.shape = StrokeShape::circle}), InvalidArgument);
  const double along[] = {1, 0};
  const std::vector<Source> points(3, Source::at_vertex(Vertex{0}, along));
  const std::vector<Source> unturned(3, Source::at_vertex(Vertex{0}));
  const std::array<double, 3> lengths{1, 1, 1}, still{1, 0, 1};
  EXPECT_NO_THROW(stroke_source(points, lengths, {.closed = true}));
  EXPECT_THROW(stroke_source(points, lengths), InvalidArgument);
  EXPECT_THROW(stroke_source(points, still, {.closed = true}), InvalidArgument);
  EXPECT_THROW(stroke_source(unturned, lengths, {.closed = true}), InvalidArgument);
  EXPECT_THROW(stroke_source(points, std::span(lengths).first(2), {.shape = StrokeShape::circle}), InvalidArgument);
  EXPECT_THROW(stroke_source(std::span(points).first(1), std::span(lengths).first(0)), InvalidArgument);
}

}  // namespace
}  // namespace ahm::test
