// Straight lines and shortest paths over tangent planes.
#include "ahm/maps/tangent_lines.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "ahm/conformance/flat_graphs.hpp"
#include "ahm/conformance/graph_changes.hpp"
#include "ahm/error.hpp"

namespace ahm::test {
namespace {

/// The plane's coordinates of a place of a flat graph.
Vec2 flat_position(const FlatGraph& flat, const TangentPlanePoint& place) {
  const auto i = static_cast<std::size_t>(place.vertex.index);
  const double* F = flat.frames.data() + 4 * i;  // positions -> components
  Vec2 p{flat.positions[2 * i], flat.positions[2 * i + 1]};
  for (std::size_t a = 0; a < 2; ++a) p[a] += F[a] * place.offset[0] + F[2 + a] * place.offset[1];
  return p;
}

/// Components in the frame of a vertex.
Vec2 in_frame(const FlatGraph& flat, Vertex vertex, const Vec2& v) {
  const double* F = flat.frames.data() + 4 * static_cast<std::size_t>(vertex.index);
  return {F[0] * v[0] + F[1] * v[1], F[2] * v[0] + F[3] * v[1]};
}

double apart(const Vec2& a, const Vec2& b) { return std::hypot(a[0] - b[0], a[1] - b[1]); }

std::vector<FlatGraph> planes() {
  std::vector<FlatGraph> result;
  result.push_back(planar_triangulation(20));
  result.push_back(planar_triangulation(20, TransportKind::block, true));
  return result;
}

TEST(TangentLines, AreStraightOnPlanes) {
  for (const FlatGraph& flat : planes()) {
    const CsrGraph graph(flat.data);
    const TangentPlanePoint from{Vertex(5 * 20 + 6), {0.004, -0.003}};
    const Vec2 start = flat_position(flat, from);
    for (double angle = 0.05; angle < 1.5; angle += 0.1) {
      const Vec2 direction{std::cos(angle), std::sin(angle)};
      const TangentLine line =
          trace_line(graph, from, in_frame(flat, from.vertex, {3 * direction[0], 3 * direction[1]}), 0.6);
      ASSERT_TRUE(line.complete);
      ASSERT_NEAR(line.length, 0.6, 1e-13);
      double before = 0;
      for (const TangentPlanePoint& place : line.places) {
        const Vec2 p = flat_position(flat, place), off{p[0] - start[0], p[1] - start[1]};
        ASSERT_NEAR(off[0] * direction[1] - off[1] * direction[0], 0, 1e-13);
        const double along = off[0] * direction[0] + off[1] * direction[1];
        ASSERT_GE(along, before - 1e-13);
        before = along;
      }
      ASSERT_NEAR(before, 0.6, 1e-13);
      ASSERT_LT(apart(line.arrival, in_frame(flat, line.places.back().vertex, direction)), 1e-12);
    }
  }
}

TEST(TangentLines, EndAtTheBoundary) {
  const FlatGraph flat = planar_triangulation(20);
  const CsrGraph graph(flat.data);
  for (double angle = 0.1; angle < 6.2; angle += 0.3) {
    const Vec2 direction{std::cos(angle), std::sin(angle)};
    const TangentPlanePoint from{Vertex(10 * 20 + 9)};
    const TangentLine line = trace_line(graph, from, in_frame(flat, from.vertex, direction), 5);
    EXPECT_FALSE(line.complete);
    const Vec2 end = flat_position(flat, line.places.back()), start = flat_position(flat, from);
    EXPECT_NEAR(line.length, apart(start, end), 1e-12);
    const double to_side = std::min(std::min(end[0], 1 - end[0]), std::min(end[1], 1 - end[1]));
    EXPECT_LT(std::abs(to_side), 1.0 / 19) << angle;
  }
}

TEST(ShortestLines, AreStraightOnPlanes) {
  for (const FlatGraph& flat : planes()) {
    const CsrGraph graph(flat.data);
    std::mt19937 random(3);
    std::uniform_int_distribution<Index> any(0, flat.size() - 1);
    std::uniform_real_distribution<double> near(-0.01, 0.01);
    for (int k = 0; k < 60; ++k) {
      const TangentPlanePoint from{Vertex(any(random)), {near(random), near(random)}},
          to{Vertex(any(random)), {near(random), near(random)}};
      const Vec2 a = flat_position(flat, from), b = flat_position(flat, to);
      const TangentLine path = shortest_line(graph, from, to);
      ASSERT_EQ(path.status, Status::ok);
      ASSERT_LT(apart(flat_position(flat, path.places.front()), a), 1e-13);
      ASSERT_LT(apart(flat_position(flat, path.places.back()), b), 1e-12);
      const auto is_on_rim = [](Index v) { return v % 20 == 0 || v % 20 == 19 || v / 20 == 0 || v / 20 == 19; };
      if (is_on_rim(from.vertex.index) || is_on_rim(to.vertex.index)) {  // a rim of jittered points is not convex
        ASSERT_LT(path.length, 1.05 * apart(a, b) + 0.02);
        continue;
      }
      ASSERT_NEAR(path.length, apart(a, b), 1e-11) << k;
      ASSERT_NEAR(shortest_line(graph, to, from).length, path.length, 1e-11);
    }
  }
}

TEST(ShortestLines, EndWhereTheTraceOfTheirDirectionDoes) {
  const FlatGraph flat = planar_triangulation(20);
  const CsrGraph graph(flat.data);
  const TangentPlanePoint from{Vertex(6 * 20 + 4)}, to{Vertex(13 * 20 + 15), {0.01, 0.005}};
  const TangentLine path = shortest_line(graph, from, to),
                    traced = trace_line(graph, from, path.departure, path.length);
  EXPECT_LT(apart(flat_position(flat, traced.places.back()), flat_position(flat, to)), 1e-12);
  EXPECT_LT(
      apart(in_frame(flat, path.places.back().vertex, {1, 0}), in_frame(flat, traced.places.back().vertex, {1, 0})),
      path.places.back().vertex == traced.places.back().vertex ? 1e-15 : 3.0);
}

TEST(ShortestLines, OfAPointToItselfHaveNoLength) {
  const FlatGraph flat = planar_triangulation(8);
  const CsrGraph graph(flat.data);
  const TangentPlanePoint place{Vertex(20), {0.01, 0.02}};
  const TangentLine path = shortest_line(graph, place, place);
  EXPECT_EQ(path.length, 0);
  EXPECT_EQ(path.departure, Vec2{});
  EXPECT_EQ(trace_line(graph, place, {0, 1}, 0).length, 0);
}

TEST(ShortestLines, GoRoundATubeTheShorterWay) {
  const Index rings = 60, around = 14;
  const CsrGraph graph(tube(rings, around));
  for (const Index turn : {2, 5, 9, 12}) {
    const TangentLine path = shortest_line(graph, {Vertex(20 * around)}, {Vertex(40 * around + turn)});
    EXPECT_NEAR(path.length, std::hypot(20.0, std::min(turn, around - turn)), 1e-10) << turn;
  }
}

TEST(ShortestLines, DoNotExistBetweenComponents) {
  const FlatGraph flat = planar_triangulation(6);
  const CsrGraph graph(doubled(flat.data));
  const TangentLine path = shortest_line(graph, {Vertex(3)}, {Vertex(flat.size() + 3)});
  EXPECT_EQ(path.status, Status::disconnected);
  EXPECT_TRUE(path.places.empty());
}

TEST(TangentLines, RefuseNonsense) {
  const CsrGraph graph(planar_triangulation(6).data), cube(lattice3(4).data);
  EXPECT_THROW(trace_line(cube, {Vertex(0)}, {1, 0}, 1), InvalidArgument);
  EXPECT_THROW(shortest_line(cube, {Vertex(0)}, {Vertex(1)}), InvalidArgument);
  EXPECT_THROW(trace_line(graph, {Vertex(-1)}, {1, 0}, 1), InvalidArgument);
  EXPECT_THROW(trace_line(graph, {Vertex(36)}, {1, 0}, 1), InvalidArgument);
  EXPECT_THROW(trace_line(graph, {Vertex(0), {NAN, 0}}, {1, 0}, 1), InvalidArgument);
  EXPECT_THROW(trace_line(graph, {Vertex(0)}, {0, 0}, 1), InvalidArgument);
  EXPECT_THROW(trace_line(graph, {Vertex(0)}, {1, 0}, -1), InvalidArgument);
  EXPECT_THROW(trace_line(graph, {Vertex(0)}, {1, 0}, INFINITY), InvalidArgument);
}

}  // namespace
}  // namespace ahm::test
