// Fields of the two operators besides log maps: extension, transport, the radial field, and the distance with its gradient.
#include <numbers>

#include "ahm/conformance/vectors.hpp"
#include "ahm/fields/distance.hpp"
#include "ahm/fields/vector_heat.hpp"
#include "ahm/grid/grid_graph.hpp"
#include "core/solved_graph.hpp"
#include "support/solved_mesh.hpp"

namespace ahm::test {
namespace {

class VectorHeat : public testing::TestWithParam<TransportKind> {
 protected:
  const FlatGraph flat = GetParam() == TransportKind::block ? mirrored_plane(14) : planar_triangulation(14);
  const SolvedGraph plane{flat.data};
  const LogMapSolver& solver = plane.solver;
  const std::vector<double> vector{2.0, -1.5};

  void expect_carried(const VertexField& field, double tolerance) const {
    for (Index i = 0; i < flat.size(); ++i)
      expect_near(std::span(field.values).subspan(2 * to_size(i), 2), flat.carried(20, i, vector), tolerance);
  }
};

TEST_P(VectorHeat, ExtendsAConstantAsTheConstant) {
  for (double value : {-3.0, 0.0, 1e-30, 7e200}) {
    const auto field =
        extend_scalar(solver, std::array{Vertex{3}, Vertex{50}, Vertex{120}}, std::array{value, value, value});
    for (double v : field.values) ASSERT_NEAR(v, value, 1e-12 * std::abs(value));
  }
}

TEST_P(VectorHeat, ExtendsByTheShareOfEachSourceInTheHeat) {
  const auto field = extend_scalar(solver, std::array{Vertex{0}, Vertex{195}}, std::array{-1.0, 1.0});
  std::vector<double> heat(2 * to_size(flat.size()), 0.0);  // of one source, then of the other
  heat.front() = heat.back() = 1.0;
  solver.operators().solve_scalar(heat, 2);
  for (Index i = 0; i < flat.size(); ++i) {
    const double first = heat[i], second = heat[i + flat.size()];
    ASSERT_NEAR(field.values[i], (second - first) / (second + first), 1e-12) << "vertex " << i;
  }
  EXPECT_LT(field.values[0], field.values[195]);
}

TEST_P(VectorHeat, CarriesVectorsWithoutChangeOnThePlane) {
  expect_carried(transport_vectors(solver, std::array{Vertex{20}}, vector), 1e-11);
}

TEST_P(VectorHeat, CarriesVectorsFromPointsBetweenVertices) {
  // A point at z in the frame of a vertex, as a source on the vertex and its neighbors.
  const auto near_vertex = [&](Index vertex, const Vec2& z) {
    Source source(2);
    const auto add = [&](Index i, double weight) {
      const auto at = flat.exact(vertex, i), u = flat.carried(vertex, i, {1, 0}), v = flat.carried(vertex, i, {0, 1});
      source.add(Vertex{i}, weight, Vec2{at[0] - z[0], at[1] - z[1]}, std::array{u[0], v[0], u[1], v[1]});
    };
    const auto neighbors = plane.graph.star(vertex).neighbors;
    add(vertex, 0.4);
    for (Index i : neighbors) add(i, 0.6 / static_cast<double>(neighbors.size()));
    return source;
  };
  const std::array points{near_vertex(20, {0.02, 0.01}), near_vertex(100, {-0.01, 0.03})};
  std::vector<double> vectors = vector;
  for (double x : flat.carried(20, 100, vector)) vectors.push_back(x);
  expect_carried(transport_vectors(solver, points, vectors), 1e-10);
  for (double v : extend_scalar(solver, points, std::array{4.0, 4.0}).values) ASSERT_NEAR(v, 4.0, 1e-11);
}

TEST_P(VectorHeat, TakesVerticesAsPoints) {
  const std::array vertices{Vertex{3}, Vertex{50}};
  const std::array points{source_at(3), source_at(50)};
  const std::array values{1.0, 3.0};
  const std::array vectors{1.0, 2.0, -0.5, 0.25};
  EXPECT_EQ(extend_scalar(solver, points, values).values, extend_scalar(solver, vertices, values).values);
  EXPECT_EQ(transport_vectors(solver, points, vectors).values, transport_vectors(solver, vertices, vectors).values);
}

TEST_P(VectorHeat, HasTheParallelFrameAndTheRadialFieldOfThePlane) {
  const auto axes = parallel_transport(solver, source_at(20)), radial = radial_field(solver, source_at(20));
  for (Index i = 0; i < flat.size(); ++i) {
    const auto u = flat.carried(20, i, {1, 0}), v = flat.carried(20, i, {0, 1}), back = flat.exact(i, 20);
    expect_near(std::span(axes.values).subspan(4 * to_size(i), 4), std::array{u[0], v[0], u[1], v[1]}, 1e-11);
    expect_near(std::span(radial.values).subspan(2 * to_size(i), 2), Vec2{-back[0], -back[1]}, 1e-11);
  }
}

TEST_P(VectorHeat, MasksOtherComponents) {
  const SolvedGraph two(doubled(flat.data));
  const auto field = extend_scalar(two.solver, std::array{Vertex{0}}, std::array{1.0});
  EXPECT_EQ(field.status[flat.size()], Status::disconnected);
  EXPECT_TRUE(std::isnan(field.values[flat.size()]));
}

TEST_P(VectorHeat, RefusesInvalidArguments) {
  EXPECT_THROW(extend_scalar(solver, std::array{Vertex{0}}, std::array<double, 1>{NAN}), InvalidArgument);
  EXPECT_THROW(extend_scalar(solver, std::array{Vertex{0}}, std::array{1.0, 2.0}), InvalidArgument);
  EXPECT_THROW(extend_scalar(solver, std::array{Vertex{-5}}, std::array{1.0}), InvalidArgument);
  EXPECT_THROW(extend_scalar(solver, std::span<const Vertex>(), std::span<const double>()), InvalidArgument);
  EXPECT_THROW(transport_vectors(solver, std::array{Vertex{0}}, std::array{1.0}), InvalidArgument);
}

INSTANTIATE_TEST_SUITE_P(Kinds, VectorHeat, testing::Values(TransportKind::rotation2, TransportKind::block),
                         [](const auto& info) { return info.param == TransportKind::block ? "block" : "rotation2"; });

TEST(DistanceGradient, IsExactOnFlatGraphsOfAnyDimension) {
  for (const FlatGraph& flat : {planar_triangulation(14), mirrored_plane(14), lattice3(6), line_graph(40)}) {
    const Index p = flat.size() / 2;
    const SolvedGraph solved(flat.data);
    const DistanceField field = distance_and_gradient(solved.solver, source_at(p));
    const int d = flat.dimension;
    for (Index i = 0; i < flat.size(); ++i) {
      const auto back = flat.exact(i, p);
      const double r = length(back);
      EXPECT_NEAR(field.distance.values[i], r, 1e-11 * flat.diameter());
      for (int a = 0; a < d; ++a)
        EXPECT_NEAR(field.gradient.values[i * d + a], i == p ? 0 : -back[a] / r,
                    i == p ? 0 : 1e-11 * flat.diameter() / r);
    }
  }
}

TEST(DistanceGradient, OnTheSphereIsThatOfTheAngle) {
  for (Index parts : {10, 20, 40}) {
    const SolvedMesh sphere(icosphere(parts));
    const CsrGraph& graph = sphere.surface.graph();
    const double h = sphere.surface.details().longest_edge;
    for (Index p : {0, graph.size() / 3}) {
      SCOPED_TRACE(std::to_string(parts) + " parts, source " + std::to_string(p));
      const DistanceField field = distance_and_gradient(sphere.solver, source_at(p));
      const Vec3 source = graph.frame(p)->origin;
      double largest_error = 0, largest_step_error = 0;
      for (Index i = 0; i < graph.size(); ++i) {
        const Frame frame = *graph.frame(i);
        const double cosine = dot(frame.origin, source), sine = std::sqrt(1 - cosine * cosine);
        const double* g = &field.gradient.values[2 * i];
        if (i != p && cosine >= -0.7) {  // the exact gradient is (cos d q - p) / sin d
          const Vec3 exact = 1 / sine * (cosine * frame.origin - source);
          largest_error = std::max(largest_error, distance(g[0] * frame.x + g[1] * frame.y, exact));
        }
        if (cosine > std::cos(0.4) || cosine < 0) continue;
        EXPECT_NEAR(std::hypot(g[0], g[1]), 1, 1e-14);
        const Star star = graph.star(i);
        for (std::size_t e = 0; e < star.degree(); ++e) {
          const double along = (star.log(e)[0] * g[0] + star.log(e)[1] * g[1]) * graph.length_unit();
          const double step = field.distance.values[star.neighbors[e]] - field.distance.values[i];
          largest_step_error = std::max(largest_step_error, std::abs(step - along));
        }
      }
      if (p == 0) EXPECT_LT(largest_error, 0.2 * graph.mean_edge_length() * graph.length_unit());
      // The Hessian of the distance is cot(d) across: at most h^2 / 2 cot(0.4) along an edge.
      EXPECT_LT(largest_step_error, 1.5 * h * h / 2 / std::tan(0.4));
    }
  }
}

TEST(DistanceGradient, OfASetIsThatOfItsNearestPoint) {
  const grid::GridGraph plane({.shape = {61, 31}, .spacing = {0.1, 0.1}});
  const std::array points{plane.vertex(std::array{8, 15}), plane.vertex(std::array{50, 11})};
  Source set(2);
  for (Vertex i : points) set.add(i, 1.0, zero, identity);
  const DistanceField field = distance_and_gradient(LogMapSolver(plane), set);
  for (Index i = 0; i < plane.size(); ++i) {
    const Vec3 q = plane.position(Vertex(i));
    const Vec3 away[] = {q - plane.position(points[0]), q - plane.position(points[1])};
    const double r[] = {norm(away[0]), norm(away[1])};
    if (std::abs(r[0] - r[1]) < 2) continue;  // the heat of the farther point is above exp(-0.8 * 20)
    const int k = r[0] < r[1] ? 0 : 1;
    EXPECT_NEAR(field.distance.values[i], r[k], 1e-5);
    if (r[k] > 0)
      for (int a : {0, 1}) EXPECT_NEAR(field.gradient.values[2 * i + a], away[k][a] / r[k], 1e-4);
  }
}

TEST(DistanceGradient, IsMaskedWhereDistanceIs) {
  const FlatGraph flat = planar_triangulation(6);
  const SolvedGraph two(doubled(flat.data));
  const DistanceField field = distance_and_gradient(two.solver, source_at(0));
  for (Index i = 0; i < two.graph.size(); ++i) {
    const bool is_connected = i < flat.size();
    EXPECT_EQ(field.distance.status[i], is_connected ? Status::ok : Status::disconnected);
    EXPECT_EQ(field.gradient.status[i], field.distance.status[i]);
    EXPECT_EQ(std::isnan(field.distance.values[i]), !is_connected);
    EXPECT_EQ(std::isnan(field.gradient.values[2 * i]), !is_connected);
  }
  EXPECT_THROW(distance_and_gradient(two.solver, source_at(72)), InvalidArgument);
}

}  // namespace
}  // namespace ahm::test
