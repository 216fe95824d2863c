// Distances by unfolding.
#include "ahm/maps/wavefront.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "ahm/conformance/curved_graphs.hpp"
#include "ahm/conformance/flat_graphs.hpp"
#include "ahm/conformance/graph_changes.hpp"
#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/error.hpp"
#include "ahm/grid/grid_graph.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "ahm/util/small_math.hpp"

namespace ahm::test {
namespace {

std::vector<double> distances(const TangentGraph& graph, const Source& source) {
  Wavefront front(graph);
  front.add(source);
  front.run();
  std::vector<double> result;
  for (Index i = 0; i < graph.size(); ++i) result.push_back(front.distance(Vertex(i)));
  return result;
}

TEST(Wavefront, GoesRoundATubeTheShorterWay) {
  const Index rings = 60, around = 14;
  const CsrGraph graph(tube(rings, around));
  const auto away = distances(graph, Source::at_vertex(Vertex(30 * around)));
  for (Index r = 0; r < rings; ++r)
    for (Index k = 0; k < around; ++k)
      ASSERT_NEAR(away[r * around + k], std::hypot(r - 30, std::min(k, around - k)), 1e-10) << r << ", " << k;
}

TEST(Wavefront, IsExactInSpace) {
  const FlatGraph flat = lattice3(9);
  const CsrGraph graph(flat.data);
  const auto away = distances(graph, Source::at_vertex(Vertex{100}));
  for (Index i = 0; i < flat.size(); ++i) {
    const auto z = flat.exact(100, i);
    ASSERT_NEAR(away[i], std::hypot(z[0], z[1], z[2]), 1e-11);
  }
}

/// Distance times direction, n x 2.
std::vector<double> vectors(const TangentGraph& graph, const Source& source) {
  Wavefront front(graph, nullptr, true);
  front.add(source);
  front.run();
  std::vector<double> result;
  for (Index i = 0; i < graph.size(); ++i)
    for (double x : front.direction(Vertex(i))) result.push_back(front.distance(Vertex(i)) * x);
  return result;
}

// Away from the notches of its outline a plane is seen from inside by straight lines.
TEST(Wavefront, KnowsTheDirectionsOfThePlane) {
  const Index side = 40, source = 20 * side + 20;
  const FlatGraph flat = planar_triangulation(side);
  const CsrGraph graph(flat.data);
  const std::array turned{0.6, 0.8};
  const auto found = vectors(graph, Source::at_vertex(Vertex(source)));
  const auto found_turned = vectors(graph, Source::at_vertex(Vertex(source), turned));
  for (Index i = 0; i < flat.size(); ++i) {
    const Index row = i / side, column = i % side;
    if (i == source || std::min(row, column) < 2 || std::max(row, column) > side - 3) continue;
    const auto exact = flat.exact(source, i);
    ASSERT_NEAR(found[2 * i], exact[0], 1e-9) << "vertex " << i;
    ASSERT_NEAR(found[2 * i + 1], exact[1], 1e-9) << "vertex " << i;
    ASSERT_NEAR(found_turned[2 * i], 0.6 * exact[0] + 0.8 * exact[1], 1e-9) << "vertex " << i;
    ASSERT_NEAR(found_turned[2 * i + 1], 0.6 * exact[1] - 0.8 * exact[0], 1e-9) << "vertex " << i;
  }
}

TEST(Wavefront, KnowsTheSameDirectionsWhereFramesAreTurnedOver) {
  const FlatGraph plain = planar_triangulation(20, TransportKind::block),
                  mixed = planar_triangulation(20, TransportKind::block, true);
  const Index source = 210;  // its frame is not
  const CsrGraph a(plain.data), b(mixed.data);
  const auto expected = vectors(a, Source::at_vertex(Vertex(source))),
             found = vectors(b, Source::at_vertex(Vertex(source)));
  for (Index i = 0; i < plain.size(); ++i) {
    if (i == source) continue;
    const auto p = plain.exact(source, i), q = mixed.exact(source, i);  // the same plane, in axes of their own
    const double cosine = p[0] * q[0] + p[1] * q[1], sine = p[0] * q[1] - p[1] * q[0];
    const double squared = p[0] * p[0] + p[1] * p[1];
    ASSERT_NEAR(found[2 * i], (cosine * expected[2 * i] - sine * expected[2 * i + 1]) / squared, 1e-9)
        << "vertex " << i;
    ASSERT_NEAR(found[2 * i + 1], (sine * expected[2 * i] + cosine * expected[2 * i + 1]) / squared, 1e-9)
        << "vertex " << i;
  }
}

// A tube is flat: on either side of the line opposite to the source vectors are those of the plane.
TEST(Wavefront, KnowsTheDirectionsOnBothSidesOfACutLocus) {
  const Index rings = 60, around = 14;
  const CsrGraph graph(tube(rings, around));
  const auto found = vectors(graph, Source::at_vertex(Vertex(30 * around)));
  for (Index r = 0; r < rings; ++r)
    for (Index k = 0; k < around; ++k) {
      if ((r == 30 && k == 0) || 2 * k == around) continue;
      ASSERT_NEAR(found[2 * (r * around + k)], r - 30, 1e-9) << r << ", " << k;
      ASSERT_NEAR(found[2 * (r * around + k) + 1], 2 * k < around ? k : k - around, 1e-9) << r << ", " << k;
    }
}

// Two points in one face of a coarse surface, crossed by the midpoints of its edges: the distances and directions of each alone.
TEST(Wavefront, FromPointsInOneFaceIsThatFromEach) {
  const Mesh mesh = torus(4000);
  const auto surface = trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces);
  const TangentGraph& graph = surface.graph();
  Wavefront both(graph, nullptr, true);
  std::vector<std::unique_ptr<Wavefront>> alone;
  for (const std::vector<double>& weights : {std::vector{0.2, 0.25, 0.55}, std::vector{0.06, 0.75, 0.19}}) {
    const Source source = surface.source(FacePoint{1061, weights}, Vec3{0.3, 0.5, 0.8}).source;
    both.add(source);
    alone.push_back(std::make_unique<Wavefront>(graph, nullptr, true));
    alone.back()->add(source);
    alone.back()->run();
  }
  both.run();
  for (Index i = 0; i < graph.size(); ++i) {
    const Vertex v(i);
    const Wavefront& nearer = *alone[both.nearest(v)];
    ASSERT_LT(both.distance(v), 1.001 * std::min(alone[0]->distance(v), alone[1]->distance(v)) + 1e-12);
    const Vec2 is = both.direction(v), should = nearer.direction(v);
    ASSERT_LT(std::hypot(is[0] - should[0], is[1] - should[1]), 0.02) << i;
  }
}

TEST(Wavefront, TellsTheNearestOfManyAndGoesOnFromThere) {
  const CsrGraph graph(tube(40, 12));
  const std::array sources{Vertex{5}, Vertex{100}, Vertex{301}, Vertex{470}};
  Wavefront at_once(graph), in_turn(graph);
  for (Vertex source : sources) at_once.add(Source::at_vertex(source));
  at_once.run();
  for (Vertex source : sources) {
    in_turn.add(Source::at_vertex(source));
    in_turn.run();
  }
  std::vector<std::vector<double>> alone;
  for (Vertex source : sources) alone.push_back(distances(graph, Source::at_vertex(source)));
  for (Index i = 0; i < graph.size(); ++i) {
    double least = alone[0][i];
    for (const auto& one : alone) least = std::min(least, one[i]);
    for (const Wavefront* front : {&at_once, &in_turn}) {
      ASSERT_NEAR(front->distance(Vertex(i)), least, 1e-10) << "vertex " << i;
      ASSERT_NEAR(alone[front->nearest(Vertex(i))][i], least, 1e-10) << "vertex " << i;
    }
  }
}

// More of them near every vertex than it keeps.
TEST(Wavefront, FromManyPointsInTurnIsThatFromTheNearest) {
  const Index side = 24;
  const FlatGraph plane = planar_triangulation(side), space = lattice3(8);
  for (const FlatGraph* flat : {&plane, &space}) {
    const CsrGraph graph(flat->data);
    Wavefront front(graph, nullptr, true);
    std::vector<Index> points;
    for (Index k = 0; k < 80; ++k) {
      points.push_back(k * 97 % flat->size());
      front.add(Source::at_vertex(Vertex(points.back())));
      front.run();
    }
    for (Index i = 0; i < flat->size(); ++i) {
      const Index row = i / side, column = i % side;
      if (flat == &plane && (std::min(row, column) < 2 || std::max(row, column) > side - 3)) continue;
      double least = INFINITY;
      for (const Index point : points) least = std::min(least, length(flat->exact(point, i)));
      ASSERT_NEAR(front.distance(Vertex(i)), least, 1e-9) << "vertex " << i;
      const auto exact = flat->exact(points[front.nearest(Vertex(i))], i);
      ASSERT_NEAR(length(exact), least, 1e-9) << "vertex " << i;
      for (int a = 0; front.has_directions() && least > 0 && a < 2; ++a)
        ASSERT_NEAR(front.distance(Vertex(i)) * front.direction(Vertex(i))[a], exact[a], 1e-9) << "vertex " << i;
    }
  }
}

// More samples than a vertex keeps, most of them on one vertex: those of others take the place of its first one.
TEST(Wavefront, FromACurveThatCrowdsIsThatFromItsNearestSample) {
  const Index around = 9, crowded = 40;
  const CsrGraph graph(tube(12, around));
  for (Index crowd = 8; crowd < 20; ++crowd)
    for (Index aside = 0; aside < 16; ++aside) {
      Source curve(2);
      std::vector<Index> samples(static_cast<std::size_t>(crowd), crowded);
      for (Index k = 0; k < aside; ++k) {
        samples.insert(samples.begin(), crowded + k % 3);
        samples.push_back(k % 2 ? crowded + around : crowded - around);
      }
      for (std::size_t k = 0; k < samples.size(); ++k) {
        const std::array at{0.1 * static_cast<double>(k), 0.0};
        curve.add(Vertex(samples[k]), 1, at, {}, {static_cast<Index>(k), 0, at});
      }
      const auto away = distances(graph, curve);
      for (const Index sample : samples) ASSERT_EQ(away[sample], 0) << crowd << ", " << aside << ": " << sample;
    }
}

TEST(Wavefront, IsTheSameWithStarsThatAreKept) {
  const CsrGraph graph(sphere_graph(600));
  Wavefront kept(graph, Wavefront::one_rings(graph)), looked_up(graph);
  for (Wavefront* front : {&kept, &looked_up}) front->add(Source::at_vertex(Vertex(7))), front->run();
  for (Index i = 0; i < graph.size(); ++i) ASSERT_EQ(kept.distance(Vertex(i)), looked_up.distance(Vertex(i)));
}

TEST(Wavefront, StopsAtTheRadiusAndAtTheComponent) {
  const CsrGraph graph(doubled(tube(40, 12)));
  Wavefront front(graph);
  front.add(Source::at_vertex(Vertex{0}));
  front.run(7);
  for (Index i = 0; i < graph.size(); ++i) {
    const double exact = std::hypot(i / 12, std::min(i % 12, 12 - i % 12));
    if (i >= graph.size() / 2) {
      ASSERT_EQ(front.nearest(Vertex(i)), -1);
      ASSERT_TRUE(std::isinf(front.distance(Vertex(i))));
    } else if (exact <= 7) {
      ASSERT_NEAR(front.distance(Vertex(i)), exact, 1e-11);
    } else {
      ASSERT_GT(front.distance(Vertex(i)), 7);
    }
  }
}

TEST(Wavefront, ScalesByPowersOfTwoToTheBit) {
  const CsrGraph graph(tube(20, 9)), large(scaled(tube(20, 9), 0x1p40));
  const auto a = distances(graph, Source::at_vertex(Vertex{4})), b = distances(large, Source::at_vertex(Vertex{4}));
  for (std::size_t i = 0; i < a.size(); ++i) ASSERT_EQ(a[i] * 0x1p40, b[i]);
}

TEST(Wavefront, RefusesSourcesThatDoNotFit) {
  const CsrGraph graph(tube(3, 5));
  Wavefront front(graph);
  EXPECT_THROW(front.add(Source::at_vertex(Vertex{15})), InvalidArgument);
  EXPECT_THROW(front.add(Source(3)), InvalidArgument);
}

}  // namespace
}  // namespace ahm::test
