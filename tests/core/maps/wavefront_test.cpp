// Distances and directions by unfolding, and how fronts bend on curved surfaces.
#include "ahm/maps/wavefront.hpp"

#include <memory>

#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "ahm/util/vec.hpp"
#include "core/solved_graph.hpp"
#include "maps/front_geometry.hpp"

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

// A tube is flat: on either side of the line opposite to the source vectors are those of the plane.
TEST(Wavefront, OnATubeIsThatOfThePlaneOnBothSidesOfTheCutLocus) {
  const Index rings = 60, around = 14, source = 30 * around;
  const CsrGraph graph(tube(rings, around));
  const auto away = distances(graph, source_at(source)), found = vectors(graph, source_at(source));
  for (Index i = 0; i < graph.size(); ++i) {
    const Index along = i / around - 30, k = i % around, across = 2 * k < around ? k : k - around;
    ASSERT_NEAR(away[i], std::hypot(along, across), 1e-10) << along << ", " << across;
    if (i == source || 2 * k == around) continue;
    expect_near(std::span(found).subspan(2 * to_size(i), 2), Vec2{double(along), double(across)}, 1e-9);
  }
}

TEST(Wavefront, IsExactInSpace) {
  const FlatGraph flat = lattice3(9);
  const auto away = distances(CsrGraph(flat.data), source_at(100));
  for (Index i = 0; i < flat.size(); ++i) ASSERT_NEAR(away[i], length(flat.exact(100, i)), 1e-11);
}

TEST(Wavefront, HasDirectionsIfTheSourceIsTheOnlySeed) {
  const Index rings = 12, around = 14, source = 6 * around;
  const CsrGraph graph(tube(rings, around));
  Wavefront front(graph, nullptr, true);
  front.add(source_at(source));
  front.run();
  const Wavefront::Seed seed{.vertex = Vertex(source), .distance = 0, .direction = {NAN, NAN}, .arrival = {NAN, NAN}};
  front.restart(std::span(&seed, 1));
  front.run();
  const auto expected = vectors(graph, source_at(source));
  for (Index i = 0; i < graph.size(); ++i) {
    if (i == source || 2 * (i % around) == around) continue;
    const Vec2 found = front.distance(Vertex(i)) * front.direction(Vertex(i));
    expect_near(std::span(expected).subspan(2 * to_size(i), 2), found, 1e-9);
  }
}

bool is_near_rim(Index i, Index side) {
  const Index row = i / side, column = i % side;
  return std::min(row, column) < 2 || std::max(row, column) > side - 3;
}

// Away from the notches of the boundary the geodesic paths of a plane are straight.
TEST(Wavefront, HasTheDirectionsOfThePlane) {
  const Index side = 40, source = 20 * side + 20;
  const FlatGraph flat = planar_triangulation(side);
  const CsrGraph graph(flat.data);
  const auto found = vectors(graph, source_at(source)),
             turned = vectors(graph, Source::at_vertex(Vertex(source), Vec2{0.6, 0.8}));
  for (Index i = 0; i < flat.size(); ++i) {
    if (i == source || is_near_rim(i, side)) continue;
    const auto z = flat.exact(source, i);
    expect_near(std::span(found).subspan(2 * to_size(i), 2), z, 1e-9);
    expect_near(std::span(turned).subspan(2 * to_size(i), 2), Vec2{0.6 * z[0] + 0.8 * z[1], 0.6 * z[1] - 0.8 * z[0]},
                1e-9);
  }
}

TEST(Wavefront, HasTheSameDirectionsWithMirroredFrames) {
  const FlatGraph plain = planar_triangulation(20, TransportKind::block), mixed = mirrored_plane(20);
  const Index source = 210;  // the frame of this vertex is not mirrored
  const auto expected = vectors(CsrGraph(plain.data), source_at(source)),
             found = vectors(CsrGraph(mixed.data), source_at(source));
  for (Index i = 0; i < plain.size(); ++i) {
    if (i == source) continue;
    const auto p = plain.exact(source, i), q = mixed.exact(source, i);  // the same point in other axes
    const double squared = dot(p, p), c = dot(p, q) / squared, s = (p[0] * q[1] - p[1] * q[0]) / squared;
    const Vec2 e{expected[2 * i], expected[2 * i + 1]};
    expect_near(std::span(found).subspan(2 * to_size(i), 2), Vec2{c * e[0] - s * e[1], s * e[0] + c * e[1]}, 1e-9);
  }
}

// Two points in one face of a coarse surface, crossed by the midpoints of its edges: the distances and directions of each point alone.
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
    ASSERT_LT(norm(both.direction(v) - nearer.direction(v)), 0.02) << i;
  }
}

// More points near every vertex than a vertex stores.
TEST(Wavefront, FromManyPointsAtOnceOrInTurnIsThatFromTheNearest) {
  const Index side = 24;
  for (const FlatGraph& flat : {planar_triangulation(side), lattice3(8)}) {
    const CsrGraph graph(flat.data);
    Wavefront at_once(graph, nullptr, true), in_turn(graph, nullptr, true);
    std::vector<Index> points;
    for (Index k = 0; k < 80; ++k) {
      points.push_back(k * 97 % flat.size());
      at_once.add(source_at(points.back()));
      in_turn.add(source_at(points.back()));
      in_turn.run();
    }
    at_once.run();
    for (Index i = 0; i < flat.size(); ++i) {
      if (flat.dimension == 2 && is_near_rim(i, side)) continue;
      double least = INFINITY;
      for (const Index point : points) least = std::min(least, length(flat.exact(point, i)));
      for (const Wavefront* front : {&at_once, &in_turn}) {
        ASSERT_NEAR(front->distance(Vertex(i)), least, 1e-9) << "vertex " << i;
        const auto exact = flat.exact(points[front->nearest(Vertex(i))], i);
        ASSERT_NEAR(length(exact), least, 1e-9) << "vertex " << i;
        if (front->has_directions() && least > 0) expect_near(least * front->direction(Vertex(i)), exact, 1e-9);
      }
    }
  }
}

// More samples than a vertex stores, most of them on one vertex: those of other vertices replace its first one.
TEST(Wavefront, FromACrowdedCurveIsThatFromItsNearestSample) {
  const Index around = 9, crowded = 40;
  const CsrGraph graph(tube(12, around));
  for (Index crowd = 8; crowd < 20; ++crowd)
    for (Index aside = 0; aside < 16; ++aside) {
      Source curve(2);
      std::vector<Index> samples(to_size(crowd), crowded);
      for (Index k = 0; k < aside; ++k) {
        samples.insert(samples.begin(), crowded + k % 3);
        samples.push_back(k % 2 ? crowded + around : crowded - around);
      }
      for (std::size_t k = 0; k < samples.size(); ++k) {
        const Vec2 at{0.1 * static_cast<double>(k), 0.0};
        curve.add(Vertex(samples[k]), 1, at, {}, {static_cast<Index>(k), 0, at});
      }
      const auto away = distances(graph, curve);
      for (const Index sample : samples) ASSERT_EQ(away[sample], 0) << crowd << ", " << aside << ": " << sample;
    }
}

TEST(Wavefront, IsTheSameWithStoredStars) {
  const CsrGraph graph(sphere_graph(600));
  Wavefront stored(graph, Wavefront::one_rings(graph)), looked_up(graph);
  for (Wavefront* front : {&stored, &looked_up}) front->add(source_at(7)), front->run();
  for (Index i = 0; i < graph.size(); ++i) ASSERT_EQ(stored.distance(Vertex(i)), looked_up.distance(Vertex(i)));
}

TEST(Wavefront, StopsAtTheRadiusAndAtTheComponent) {
  const CsrGraph graph(doubled(tube(40, 12)));
  Wavefront front(graph);
  front.add(source_at(0));
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

TEST(Wavefront, IsAsNewAfterClear) {
  for (const CsrGraphData& data : {sphere_graph(800), planar_triangulation(20).data, lattice3(6).data}) {
    const CsrGraph graph(data);
    Wavefront used(graph, nullptr, true), fresh(graph, nullptr, true);
    for (const Index v : {0, 100, 7}) used.add(Source::at_vertex(Vertex(v)));
    used.run(8 * graph.mean_edge_length());
    used.clear();
    EXPECT_EQ(used.points(), 0);
    EXPECT_TRUE(used.reached().empty());
    for (Wavefront* front : {&used, &fresh}) {
      front->add(Source::at_vertex(Vertex(50)));
      front->run(4 * graph.mean_edge_length());
    }
    std::vector<Vertex> reached = used.reached();
    EXPECT_EQ(reached, fresh.reached());
    std::ranges::sort(reached);
    for (Vertex v(0); v.index < graph.size(); ++v.index) {
      EXPECT_EQ(used.distance(v), fresh.distance(v));
      EXPECT_EQ(std::ranges::binary_search(reached, v), std::isfinite(fresh.distance(v)));
      if (data.dimension == 2 && fresh.distance(v) > 0 && std::isfinite(fresh.distance(v)))
        EXPECT_EQ(used.direction(v), fresh.direction(v));
    }
  }
}

TEST(Wavefront, ScalesByPowersOfTwoToTheBit) {
  const auto a = distances(CsrGraph(tube(20, 9)), source_at(4)),
             b = distances(CsrGraph(scaled(tube(20, 9), 0x1p40)), source_at(4));
  for (std::size_t i = 0; i < a.size(); ++i) ASSERT_EQ(a[i] * 0x1p40, b[i]);
}

TEST(Wavefront, RefusesSourcesThatDoNotFit) {
  const CsrGraph graph(tube(3, 5));
  Wavefront front(graph);
  EXPECT_THROW(front.add(source_at(15)), InvalidArgument);
  EXPECT_THROW(front.add(Source(3)), InvalidArgument);
}

TEST(OneRings, AreComputedOncePerGraph) {
  const CsrGraph flat(planar_triangulation(12).data), copy(flat);
  const Mesh sphere = icosphere(4);
  const auto surface = trimesh::TriangleMeshSurface::build(sphere.positions, sphere.faces);
  EXPECT_EQ(Wavefront::one_rings(flat), Wavefront::one_rings(flat, 2));
  EXPECT_EQ(Wavefront::one_rings(flat, 1, false), Wavefront::one_rings(flat, 1, false));
  EXPECT_EQ(Wavefront::one_rings(surface.graph()), Wavefront::one_rings(surface.graph()));
  EXPECT_NE(Wavefront::one_rings(surface.graph(), 1, false), Wavefront::one_rings(surface.graph(), 1, true))
      << "midpoints";
  EXPECT_NE(Wavefront::one_rings(copy), Wavefront::one_rings(flat));
}

/// Focusing of a front at this distance, on a surface of constant curvature.
double focusing_at(double distance, double curvature, int steps) {
  double focusing = 0;
  for (int k = 0; k < steps; ++k)
    focusing = focusing_after(focusing, distance * k / steps, distance * (k + 1) / steps, curvature);
  return focusing;
}

// A front at distance r from a point of the unit sphere has the curvature cot r, on the hyperbolic plane coth r.
TEST(Focusing, IsThatOfThePlaneTheSphereAndTheHyperbolicPlane) {
  EXPECT_EQ(focusing_at(3, 0, 7), 0);
  EXPECT_EQ(curvature_correction(bend_along(0.3, 0, 2), 0.3, 0.4, 1), 0);
  for (double r : {0.1, 0.7, 1.5, 2.4}) {
    const double sphere = r - r * r / std::tan(r), hyperbolic = r - r * r / std::tanh(r);
    for (int steps : {50, 100, 200, 20000}) {
      SCOPED_TRACE(r);
      EXPECT_NEAR(focusing_at(r, 1, steps), sphere, 6.0 / steps * std::abs(sphere));
      EXPECT_NEAR(focusing_at(r, -1, steps), hyperbolic, 2.0 / steps * std::abs(hyperbolic));
    }
  }
}

// The height of an isosceles triangle with straight sides, on the unit sphere: cos r = cos h cos(s/2).
TEST(Focusing, GivesTheHeightOfASphericalTriangle) {
  for (double r : {0.3, 1.0, 2.0})
    for (double s : {0.02, 0.04}) {
      const double height = std::acos(std::cos(r) / std::cos(s / 2)), flat = std::sqrt(r * r - s * s / 4);
      const double focusing = r - r * r / std::tan(r);
      EXPECT_NEAR(curvature_correction(bend_along(s, focusing, r), s, 0.5, 1), height - flat,
                  0.01 * std::abs(height - flat))
          << r << ", " << s;
    }
}

TEST(Focusing, IsBoundedBehindAFocusAndByTheDistance) {
  double focusing = 0;
  for (int k = 0; k < 100; ++k) {
    focusing = focusing_after(focusing, 0.1 * k, 0.1 * (k + 1), 1);  // up to 10: behind three foci
    ASSERT_LE(std::abs(focusing), max_bend * 0.01 * (k + 1) * (k + 1) / 0.1 * (1 + 1e-12));
    ASSERT_LE(std::abs(curvature_correction(bend_along(0.1, focusing, 0.1 * (k + 1)), 0.1, 0.5, 1)),
              max_curvature_correction * 0.1);
  }
  for (double distance : {0.0, 1e-300, 1e-3, 1.0})
    for (double huge : {-1e9, 1e9})
      EXPECT_LE(std::abs(curvature_correction(bend_along(1, huge, distance), 1, 0.5, 1)),
                max_curvature_correction * distance);
}

TEST(Focusing, IsFiniteWhereSquaresOfLengthsAreNot) {
  EXPECT_EQ(focusing_after(0, 1e200, 2e200, 0), 0);
  EXPECT_TRUE(std::isfinite(focusing_after(1, 1e-200, 2e-200, 1e300)));
}

}  // namespace
}  // namespace ahm::test
