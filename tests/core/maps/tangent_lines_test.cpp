// Straight lines and shortest paths over tangent planes.
#include "ahm/maps/tangent_lines.hpp"

#include <random>

#include "core/solved_graph.hpp"

namespace ahm::test {
namespace {

/// Position in the plane of a point of a flat graph.
Vec2 flat_position(const FlatGraph& flat, const TangentPlanePoint& point) {
  const auto i = to_size(point.vertex.index);
  const double* F = flat.frames.data() + 4 * i;  // positions -> components
  const auto [x, y] = point.offset;
  return Vec2{flat.positions[2 * i], flat.positions[2 * i + 1]} + Vec2{F[0] * x + F[2] * y, F[1] * x + F[3] * y};
}

/// Components in the frame of a vertex.
Vec2 in_frame(const FlatGraph& flat, Vertex vertex, const Vec2& v) {
  const double* F = flat.frames.data() + 4 * to_size(vertex.index);
  return {F[0] * v[0] + F[1] * v[1], F[2] * v[0] + F[3] * v[1]};
}

double gap(const Vec2& a, const Vec2& b) { return norm(a - b); }

TEST(TangentLines, AreStraightOnPlanes) {
  for (const FlatGraph& flat : {planar_triangulation(20), mirrored_plane(20)}) {
    const CsrGraph graph(flat.data);
    const TangentPlanePoint from{Vertex(5 * 20 + 6), {0.004, -0.003}};
    const Vec2 start = flat_position(flat, from);
    for (double angle = 0.05; angle < 1.5; angle += 0.1) {
      const Vec2 direction{std::cos(angle), std::sin(angle)};
      const TangentLine line = trace_line(graph, from, in_frame(flat, from.vertex, 3 * direction), 0.6);
      ASSERT_TRUE(line.complete);
      ASSERT_NEAR(line.length, 0.6, 1e-13);
      double before = 0;
      for (const TangentPlanePoint& place : line.places) {
        const Vec2 off = flat_position(flat, place) - start;
        ASSERT_NEAR(cross(off, direction), 0, 1e-13);
        ASSERT_GE(dot(off, direction), before - 1e-13);
        before = dot(off, direction);
      }
      ASSERT_NEAR(before, 0.6, 1e-13);
      ASSERT_LT(gap(line.arrival, in_frame(flat, line.places.back().vertex, direction)), 1e-12);
    }
  }
}

TEST(TangentLines, EndAtTheBoundary) {
  const FlatGraph flat = planar_triangulation(20);
  const CsrGraph graph(flat.data);
  const TangentPlanePoint from{Vertex(10 * 20 + 9)};
  for (double angle = 0.1; angle < 6.2; angle += 0.3) {
    const Vec2 direction{std::cos(angle), std::sin(angle)};
    const TangentLine line = trace_line(graph, from, in_frame(flat, from.vertex, direction), 5);
    EXPECT_FALSE(line.complete);
    const Vec2 end = flat_position(flat, line.places.back());
    EXPECT_NEAR(line.length, gap(flat_position(flat, from), end), 1e-12);
    EXPECT_LT(std::abs(std::min({end[0], 1 - end[0], end[1], 1 - end[1]})), 1.0 / 19) << angle;
  }
}

TEST(ShortestLines, AreStraightOnPlanes) {
  for (const FlatGraph& flat : {planar_triangulation(20), mirrored_plane(20)}) {
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
      ASSERT_LT(gap(flat_position(flat, path.places.front()), a), 1e-13);
      ASSERT_LT(gap(flat_position(flat, path.places.back()), b), 1e-12);
      const auto is_on_rim = [](Index v) { return v % 20 == 0 || v % 20 == 19 || v / 20 == 0 || v / 20 == 19; };
      if (is_on_rim(from.vertex.index) || is_on_rim(to.vertex.index)) {  // a rim of jittered points is not convex
        ASSERT_LT(path.length, 1.05 * gap(a, b) + 0.02);
        continue;
      }
      ASSERT_NEAR(path.length, gap(a, b), 1e-11) << k;
      ASSERT_NEAR(shortest_line(graph, to, from).length, path.length, 1e-11);
    }
  }
}

TEST(ShortestLines, EndWhereTheTraceOfTheirDirectionDoes) {
  const FlatGraph flat = planar_triangulation(20);
  const CsrGraph graph(flat.data);
  const TangentPlanePoint from{Vertex(6 * 20 + 4)}, to{Vertex(13 * 20 + 15), {0.01, 0.005}};
  const TangentLine path = shortest_line(graph, from, to);
  const TangentLine traced = trace_line(graph, from, path.departure, path.length);
  EXPECT_LT(gap(flat_position(flat, traced.places.back()), flat_position(flat, to)), 1e-12);
}

TEST(ShortestLines, OfAPointToItselfHaveNoLength) {
  const CsrGraph graph(planar_triangulation(8).data);
  const TangentPlanePoint place{Vertex(20), {0.01, 0.02}};
  const TangentLine path = shortest_line(graph, place, place);
  EXPECT_EQ(path.length, 0);
  EXPECT_EQ(path.departure, Vec2{});
  EXPECT_EQ(trace_line(graph, place, {0, 1}, 0).length, 0);
}

TEST(ShortestLines, TakeTheShorterSideOfATube) {
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

TEST(TangentLines, RefuseInvalidArguments) {
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
