// Maps from curves of vertices and points: in the plane, on circles and on any flat graph.
#include "ahm/applications/stroke.hpp"

#include "mapped_surfaces.hpp"

namespace ahm::test {
namespace {

Vec2 position_of(const FlatGraph& flat, Index i) {
  return {flat.positions[2 * to_size(i)], flat.positions[2 * to_size(i) + 1]};
}

/// Coordinates of vertex i.
Vec2 at(const LogMap& map, Index i) { return {map.coordinates(Vertex(i))[0], map.coordinates(Vertex(i))[1]}; }

std::vector<Vertex> consecutive(Index first, Index count) {
  std::vector<Vertex> path;
  for (Index i = first; i < first + count; ++i) path.emplace_back(i);
  return path;
}

/// The row of a `planar_triangulation` through its middle, from left to right.
std::vector<Vertex> middle_row(Index side) { return consecutive(side / 2 * side + 2, side - 4); }

/// Rings of `around` vertices at radii 1 + i * `spacing` about the origin.
FlatGraph rings(Index around, Index count, double spacing) {
  std::vector<double> positions;
  std::vector<Pair> edges;
  for (Index r = 0; r < count; ++r)
    for (Index a = 0; a < around; ++a) {
      const double angle = 2 * pi * a / around, radius = 1 + r * spacing;
      positions.insert(positions.end(), {radius * std::cos(angle), radius * std::sin(angle)});
      const Index here = r * around + a, next = r * around + (a + 1) % around;
      edges.push_back({here, next});
      if (r + 1 < count) edges.push_back({here, here + around}), edges.push_back({here, next + around});
    }
  return flat_graph(2, positions, edges, TransportKind::rotation2, false, 3);
}

TEST(Stroke, HasThePositionsOfAPlaneGivenThoseOfTheCurve) {
  for (const bool mirrored : {false, true}) {
    const FlatGraph flat =
        planar_triangulation(20, mirrored ? TransportKind::block : TransportKind::rotation2, mirrored);
    const CsrGraph graph(flat.data);
    const LogMapSolver solver(graph);
    const std::vector<Vertex> path = middle_row(20);
    for (Variant variant : all_variants) {
      // With mirrored frames the left side may be the right side: then the map is that of the mirrored plane.
      double error = INFINITY;
      for (const double sign : {1.0, mirrored ? -1.0 : 1.0}) {
        std::vector<Vec2> positions;
        for (const auto [i] : path) positions.push_back({position_of(flat, i)[0], sign * position_of(flat, i)[1]});
        const LogMap map = solver.solve(stroke_source(graph, path, positions), {.variant = variant});
        double worst = 0;
        for (Index i = 0; i < flat.size(); ++i) {
          const Vec2 exact = position_of(flat, i);
          worst = std::max(worst, length(at(map, i) - Vec2{exact[0], sign * exact[1]}));
        }
        error = std::min(error, worst);
      }
      EXPECT_LT(error, 1e-11);
    }
  }
}

TEST(Stroke, HasArclengthAndSignedDistanceForAStraightLine) {
  const FlatGraph flat = strip(30);
  const CsrGraph graph(flat.data);
  std::vector<Vertex> path;  // a straight row
  for (Index i = 0; i < flat.size(); ++i)
    if (position_of(flat, i)[1] == position_of(flat, 0)[1]) path.emplace_back(i);
  std::ranges::sort(path, {}, [&](Vertex v) { return position_of(flat, v.index)[0]; });
  const LogMap map = LogMapSolver(graph).solve(stroke_source(graph, path));
  for (Index i = 0; i < flat.size(); ++i) {
    const Vec2 exact = position_of(flat, i) - position_of(flat, path[0].index);
    for (int a : {0, 1}) EXPECT_NEAR(at(map, i)[a], exact[a], 1e-11 * flat.diameter());
  }
}

TEST(Stroke, OfShapeCircleHasThePositionsOfThePlane) {
  const Index around = 96, count = 12;
  const double spacing = 2 * pi / around;
  const FlatGraph flat = rings(around, count, spacing);
  const CsrGraph graph(flat.data);
  const LogMap map = LogMapSolver(graph).solve(
      stroke_source(graph, consecutive(count / 2 * around, around), {.closed = true, .shape = StrokeShape::circle}));
  // The circle has the length of the polygon: it is smaller than the circle through the corners by a share of pi^2 / 6 n^2.
  const double share = std::pow(pi / around, 2) / 6, radius = 1 + count / 2 * spacing;
  for (Index i = 0; i < flat.size(); ++i) EXPECT_LT(length(at(map, i) - position_of(flat, i)), 1.01 * share * radius);
}

/// Rings with the weights and masses of their nearly square cells, so that heat spreads evenly.
FlatGraph even_rings(Index around, Index count, double spacing) {
  FlatGraph flat = rings(around, count, spacing);
  CsrGraphData& g = flat.data;
  const auto radius = [&](Index i) { return 1 + i / around * spacing; };
  for (Index i = 0; i < flat.size(); ++i) {
    const double arc = 2 * pi / around * radius(i);
    g.masses[i] = arc * spacing;
    for (Offset e = g.row_begin[i]; e < g.row_begin[to_size(i) + 1]; ++e) {
      const Index j = g.neighbors[e];
      const double between = pi / around * (radius(i) + radius(j));
      g.weights[e] = i / around == j / around ? spacing / arc : i % around == j % around ? between / spacing : 0.0;
    }
  }
  return flat;
}

TEST(Stroke, HasArclengthAndSignedDistanceForACircle) {
  const Index count = 9;
  for (Index around : {64, 128, 256}) {
    const double spacing = 2 * pi / around, R = 1 + count / 2 * spacing;
    const CsrGraph graph(even_rings(around, count, spacing).data);
    const LogMap map =
        LogMapSolver(graph).solve(stroke_source(graph, consecutive(count / 2 * around, around), {.closed = true}));
    const double root_tau = edge_length(graph);
    for (Index r = 0; r < count; ++r)
      for (Index a = around / 4; a < 3 * around / 4; ++a) {  // away from the seam
        const double rho = 1 + r * spacing, s = 2 * pi * R * a / around, left = R - rho;
        // Heat comes from a piece of the circle of variance sqrt(tau) / (1/d - 1/R), from whose points the vertex is at
        // (s - rho sin(s/R), R - rho cos(s/R)): second order in the width of the piece. The discrete heat of a vertex on the curve comes
        // from its neighbors as well: d + sqrt(tau).
        const double d = std::abs(left) + root_tau, spread = root_tau / (1 / d - (left > 0 ? 1 : -1) / R);
        const double bias = rho * spread / (2 * R * R);
        EXPECT_LT(length(at(map, r * around + a) - Vec2{s, left}), 1.5 * bias)
            << around << " around, ring " << r << ", at " << a;
      }
  }
}

TEST(Stroke, AroundATubeHasTheDistanceOfRings) {
  const Index around = 24;
  const CsrGraph graph(tube(21, around));
  const LogMap map =
      LogMapSolver(graph).solve(stroke_source(graph, consecutive(10 * around, around), {.closed = true}));
  for (Index i = 0; i < map.size(); ++i) EXPECT_NEAR(std::abs(at(map, i)[1]), std::abs(i / around - 10), 1e-10);
}

TEST(Stroke, OfPointsBetweenVerticesIsExactInThePlane) {
  const FlatGraph flat = planar_triangulation(16);
  const CsrGraph graph(flat.data);
  Vec2 low = position_of(flat, 0), high = low;
  for (Index i = 0; i < flat.size(); ++i)
    for (int a : {0, 1})
      low[a] = std::min(low[a], position_of(flat, i)[a]), high[a] = std::max(high[a], position_of(flat, i)[a]);
  const Vec2 middle = 0.5 * (low + high);
  const double radius = (high[0] - low[0]) / 4;
  const int n = 80;  // points of a circle, each relative to the nearest vertex
  std::vector<Source> points;
  for (int k = 0; k < n; ++k) {
    const double c = std::cos(2 * pi * k / n), s = std::sin(2 * pi * k / n);
    const Vec2 p = middle + radius * Vec2{c, s};
    Index nearest = 0;
    for (Index i = 1; i < flat.size(); ++i)
      if (length(position_of(flat, i) - p) < length(position_of(flat, nearest) - p)) nearest = i;
    const double* F = &flat.frames[4 * to_size(nearest)];
    const double axes[] = {-F[0] * s + F[1] * c, -F[0] * c - F[1] * s, -F[2] * s + F[3] * c, -F[2] * c - F[3] * s};
    const Vec2 d = position_of(flat, nearest) - p;
    points.push_back(Source(2).add(Vertex(nearest), 1, Vec2{-s * d[0] + c * d[1], -c * d[0] - s * d[1]}, axes));
  }
  const std::vector<double> lengths(n, 2 * pi * radius / n);
  const LogMap map =
      LogMapSolver(graph).solve(stroke_source(points, lengths, {.closed = true, .shape = StrokeShape::circle}));
  for (Index i = 0; i < flat.size(); ++i)
    for (int a : {0, 1}) EXPECT_NEAR(at(map, i)[a], position_of(flat, i)[a] - middle[a], 1e-11 * flat.diameter());
}

TEST(Stroke, RefusesWhatIsNoCurve) {
  const CsrGraph graph(planar_triangulation(6).data);
  const std::array jump{Vertex{0}, Vertex{35}}, outside{Vertex{0}, Vertex{36}}, edge{Vertex{0}, Vertex{1}};
  const std::array back{Vertex{0}, Vertex{1}, Vertex{0}};
  for (const std::span<const Vertex> path : {std::span<const Vertex>(jump), {outside}, {back}, {jump.data(), 1}})
    EXPECT_THROW(stroke_source(graph, path), InvalidArgument);
  EXPECT_THROW(stroke_source(graph, edge, {.shape = StrokeShape::circle}), InvalidArgument);
  const std::vector<Source> points(3, Source::at_vertex(Vertex{0}, Vec2{1, 0}));
  const std::vector<Source> without_direction(3, Source::at_vertex(Vertex{0}));
  const std::array<double, 3> lengths{1, 1, 1}, with_zero{1, 0, 1};
  EXPECT_NO_THROW(stroke_source(points, lengths, {.closed = true}));
  EXPECT_THROW(stroke_source(points, lengths), InvalidArgument);
  EXPECT_THROW(stroke_source(points, with_zero, {.closed = true}), InvalidArgument);
  EXPECT_THROW(stroke_source(without_direction, lengths, {.closed = true}), InvalidArgument);
  EXPECT_THROW(stroke_source(points, std::span(lengths).first(2), {.shape = StrokeShape::circle}), InvalidArgument);
  EXPECT_THROW(stroke_source(std::span(points).first(1), std::span(lengths).first(0)), InvalidArgument);
}

}  // namespace
}  // namespace ahm::test
