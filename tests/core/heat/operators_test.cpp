// The factored operators against their definition, factorizations that must be refused, and batches of solves: threads, progress,
// cancellation.
#include <atomic>
#include <numbers>
#include <thread>

#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "core/solved_graph.hpp"

namespace ahm::test {
namespace {

/// c (m_i x_i + tau sum_j w_ij (x_i - R_ji x_j)), with R = 1 for scalars: the operators as the paper writes them.
std::vector<double> apply(const CsrGraph& graph, const HeatOperators& heat, const std::vector<double>& x,
                          bool vectors) {
  std::vector<double> y(x.size());
  const std::size_t width = vectors ? 2 : 1;
  for (Index i = 0; i < graph.size(); ++i) {
    const Star star = graph.star(i);
    double sum[2] = {0, 0};
    for (std::size_t a = 0; a < width; ++a) sum[a] = graph.mass(i) * x[i * width + a];
    for (std::size_t e = 0; e < star.degree(); ++e) {
      const double w = heat.tau()[0] * star.weights[e];
      const double* other = x.data() + star.neighbors[e] * static_cast<Index>(width);
      const double c = star.transports[2 * e], s = star.transports[2 * e + 1];
      const double carried[2] = {vectors ? c * other[0] - s * other[1] : other[0],
                                 vectors ? s * other[0] + c * other[1] : 0.0};
      for (std::size_t a = 0; a < width; ++a) sum[a] += w * (x[i * width + a] - carried[a]);
    }
    for (std::size_t a = 0; a < width; ++a) y[i * width + a] = heat.scaling() * sum[a];
  }
  return y;
}

TEST(HeatOperators, InvertTheirDefinition) {
  const CsrGraph graph(sphere_graph(300));
  const HeatOperators heat(graph, {.t_coef = 3.0});
  EXPECT_DOUBLE_EQ(heat.tau()[0], 3.0 * graph.mean_edge_length() * graph.mean_edge_length());
  for (bool vectors : {false, true}) {
    std::vector<double> x(to_size(graph.size()) * (vectors ? 2 : 1));
    for (std::size_t k = 0; k < x.size(); ++k) x[k] = std::sin(1.0 + 3.7 * static_cast<double>(k));
    std::vector<double> solved = apply(graph, heat, x, vectors);
    vectors ? heat.solve_vector(solved, 1) : heat.solve_scalar(solved, 1);
    expect_near(solved, x, 1e-12);
  }
}

TEST(HeatOperators, SolveColumnsIndependently) {
  const CsrGraph graph(sphere_graph(100));
  const HeatOperators heat(graph);
  std::vector<double> both(200, 0.0), first(100, 0.0);
  both[3] = first[3] = 1.0;
  both[107] = 1.0;
  heat.solve_scalar(both, 2);
  heat.solve_scalar(first, 1);
  expect_near(std::span(both).first(100), first, 1e-15);
  EXPECT_NEAR(both[7], both[103], 1e-15);  // A is symmetric: heat from 3 at 7 is heat from 7 at 3
  EXPECT_THROW(heat.solve_scalar(first, 2), InvalidArgument);
  EXPECT_THROW(heat.solve_vector(first, 1), InvalidArgument);
  std::vector<double> none;
  EXPECT_NO_THROW(heat.solve_scalar(none, 0));
}

TEST(HeatOperators, RefuseInvalidGraphsAndTimesWithoutDigits) {
  CsrGraphData indefinite = sphere_graph(60), broken = indefinite;
  for (double& w : indefinite.weights) w = -w;
  EXPECT_THROW(HeatOperators{CsrGraph(indefinite)}, NotPositiveDefinite);
  broken.masses[17] = NAN;
  EXPECT_THROW(HeatOperators{CsrGraph(broken)}, InvalidGraph);                   // before the factorization
  EXPECT_THROW(HeatOperators(CsrGraph(broken), {.check_graph = false}), Error);  // by the factorization
  EXPECT_THROW(HeatOperators{CsrGraph(scaled(sphere_graph(60), 1e-170))}, InvalidGraph);
  const CsrGraph graph(sphere_graph(300));
  EXPECT_NO_THROW(HeatOperators(graph, {.t_coef = 1e4}));
  for (double t_coef : {1e12, 1e16, 1e25, 1e200})
    EXPECT_THROW(HeatOperators(graph, {.t_coef = t_coef}), Error) << t_coef;
}

// If the digits do not suffice, the pivots of B may fail as well; the error is about A.
TEST(HeatOperators, ReportLostHeatBeforeB) {
  for (const Index side : {20, 40, 60, 150}) {
    const CsrGraph graph(planar_triangulation(side).data);
    for (const double t_coef : {1e16, 1e17, 1e18, 1e19})
      for (const unsigned threads : {1u, 2u}) try {
          const HeatOperators heat(graph, {.t_coef = t_coef, .threads = threads});
          ADD_FAILURE() << side << ", " << t_coef;
        } catch (const NotPositiveDefinite& error) {
          EXPECT_TRUE(error.fault() == "heat_not_conserved" ||
                      std::string(error.what()).find(" A ") != std::string::npos)
              << error.what();
        }
  }
}

TEST(HeatOperators, SupportEdgesAThousandTimesAsLongAsOthersAtLongTimes) {
  // Around a tube 64 edges of 0.1, along it 39 of 100: rounding errors have the same sign everywhere.
  Mesh mesh;
  constexpr Index around = 64, along = 40;
  for (Index i = 0; i < along; ++i)
    for (Index j = 0; j < around; ++j) {
      const double turn = 2 * std::numbers::pi * j / around;
      mesh.positions.push_back({std::cos(turn), std::sin(turn), 100.0 * i});
      const Index a = i * around + j, b = i * around + (j + 1) % around;
      if (i + 1 < along) mesh.faces.insert(mesh.faces.end(), {{a, b, b + around}, {a, b + around, a + around}});
    }
  const auto surface = trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces);
  const auto map = LogMapSolver(surface.graph(), {.t_coef = 30}).solve(source_at(0));
  for (Index v = 3 * around; v < along * around; ++v)  // so far away that the distance around is negligible
    ASSERT_NEAR(length(map.coordinates(Vertex(v))), 100.0 * (v / around), 0.01 * 100 * (v / around));
}

class Batch : public testing::Test {
 protected:
  Batch() {
    for (Index p = 0; p < 37; ++p) sources.push_back(source_at(p * 16));
  }
  const SolvedGraph sphere{sphere_graph(600)};
  const LogMapSolver& solver = sphere.solver;
  std::vector<Source> sources;
};

TEST_F(Batch, SolvesFromManyThreadsAtOnce) {
  std::vector<LogMap> expected;
  for (const Source& source : sources) expected.push_back(solver.solve(source, {.threads = 1}));
  std::atomic<int> same{0}, calls{0};
  {
    std::vector<std::jthread> threads;
    for (int t = 0; t < 8; ++t)
      threads.emplace_back([&, t] {
        for (std::size_t s = t % 3; s < sources.size(); s += 3, ++calls) {
          const LogMap map = solver.solve(sources[s], {.threads = 1});
          same += same_bits(map.coordinates(), expected[s].coordinates()) &&
                  std::ranges::equal(map.status(), expected[s].status());
        }
      });
  }
  EXPECT_EQ(same, calls);
  EXPECT_TRUE(solver.solve(std::span<const Source>()).empty());
}

TEST_F(Batch, ReportsProgressUpToTheEnd) {
  double last = -1;
  MapOptions options{.progress = Progress{}};
  options.progress->report = [&](std::string_view stage, double fraction) {
    EXPECT_EQ(stage, "solve");
    EXPECT_GE(fraction, last);
    last = fraction;
  };
  solver.solve(sources, options);
  EXPECT_EQ(last, 1.0);
}

TEST_F(Batch, StopsBeforeTheStartAndInTheMiddle) {
  std::stop_source stop;
  MapOptions options{.threads = 1, .progress = Progress{{}, stop.get_token()}};
  options.progress->report = [&](std::string_view, double fraction) {
    if (fraction > 0) stop.request_stop();
  };
  EXPECT_THROW(solver.solve(sources, options), Cancelled);
  EXPECT_TRUE(stop.stop_requested());
  EXPECT_THROW(solver.solve(sources, {.progress = Progress{{}, stop.get_token()}}), Cancelled);
  EXPECT_THROW(LogMapSolver(sphere.graph, {.progress = Progress{{}, stop.get_token()}}), Cancelled);
}

TEST_F(Batch, ReportsTheStagesOfTheFactorization) {
  std::vector<std::string> stages;
  FactorOptions options;
  options.progress.report = [&](std::string_view stage, double) { stages.emplace_back(stage); };
  const HeatOperators heat(sphere.graph, options);
  EXPECT_EQ(stages, (std::vector<std::string>{"check", "assemble", "analyze", "factor", "factor"}));
  EXPECT_GT(heat.statistics().nonzeros_A, sphere.graph.size());
  EXPECT_GT(heat.statistics().bytes, 0u);
}

}  // namespace
}  // namespace ahm::test
