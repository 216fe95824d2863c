// Factorizations of other libraries behind `HeatOptions::solver`: they are called for both operators, checked as libahm's own, and give
// the same maps.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "ahm/cholesky/cholesky.hpp"
#include "ahm/cholmod/cholmod_solver.hpp"
#include "ahm/conformance/clouds.hpp"
#include "ahm/error.hpp"
#include "ahm/graph/csr_graph.hpp"
#include "ahm/heat/heat_operators.hpp"
#include "ahm/maps/cost.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "ahm/util/small_math.hpp"
#include "support/expect_error.hpp"
#include "surface/surfaces.hpp"
#ifdef AHM_WITH_CHOLMOD
#include <SuiteSparse_config.h>
#endif

namespace ahm::test {
namespace {

using Call = std::pair<std::string, bool>;  // name of the matrix, and whether it is complex

/// A factory that counts its calls, and makes libahm's own factors.
SolverFactory counted_own_factors(std::vector<Call>& calls) {
  return [&calls](const SparseUpper& K, const char* name, unsigned threads) {
    calls.emplace_back(name, K.is_complex);
    return std::make_unique<const CholeskyFactor>(K, SymbolicCholesky(K), name, threads);
  };
}

/// Solves with a matrix that is 1 % larger.
class WrongSolver final : public LinearSolver {
 public:
  WrongSolver(const SparseUpper& K, const char* name) : factor_(K, SymbolicCholesky(K), name) {}
  void solve(std::span<double> X, Offset columns, unsigned threads) const override {
    factor_.solve(X, columns, threads);
    for (double& x : X) x /= 1.01;
  }
  Offset nonzeros() const noexcept override { return 0; }
  std::size_t bytes() const noexcept override { return 0; }

 private:
  CholeskyFactor factor_;
};

TEST(OtherSolver, IsMadeForBothOperators) {
  for (const auto& [mesh, complex_B] : {std::pair(icosphere(8), true), std::pair(moebius_mesh(40, 6), false)}) {
    const auto surface = surface_of(mesh);
    std::vector<Call> calls;
    const LogMapSolver solver(surface.graph(), {.solver = counted_own_factors(calls)}), own(surface.graph());
    ASSERT_EQ(calls.size(), 2U);
    EXPECT_EQ(calls[0], Call("A = M + tau L", false));
    EXPECT_EQ(calls[1], Call("B = M + tau L^nabla", complex_B));
    const FactorStatistics &other = solver.operators().statistics(), &expected = own.operators().statistics();
    EXPECT_EQ(other.nonzeros_A, expected.nonzeros_A);
    EXPECT_GT(other.bytes, 0U);
    const Source source = Source::at_vertex(Vertex(3));
    const LogMap map = solver.solve(source), own_map = own.solve(source);
    EXPECT_EQ(calls.size(), 2U);
    for (Index i = 0; i < map.size(); ++i)
      for (int c = 0; c < 2; ++c)
        ASSERT_NEAR(map.coordinates(Vertex(i))[c], own_map.coordinates(Vertex(i))[c], 1e-12) << "vertex " << i;
  }
}

TEST(OtherSolver, IsForFactorsOfTheWholeGraph) {
  const auto surface = surface_of(icosphere(4));
  std::vector<Call> calls;
  const HeatOptions options{.expected_maps = 1, .memory = 1, .solver = counted_own_factors(calls)};
  EXPECT_EQ(choose_strategy({.vertices = 10'000'000}, options), Strategy::global);
  EXPECT_EQ(LogMapSolver(surface.graph(), options).strategy(), Strategy::global);
  HeatOptions march = options;
  march.strategy = Strategy::march;
  expect_error<InvalidArgument>([&] { LogMapSolver(surface.graph(), march); }, "leave out 'solver'");
}

TEST(OtherSolver, IsCheckedAsOwnFactors) {
  const auto surface = surface_of(icosphere(4));
  FactorOptions options;
  options.solver = [](const SparseUpper& K, const char* name, unsigned) {
    return std::make_unique<const WrongSolver>(K, name);
  };
  expect_error<NotPositiveDefinite>([&] { HeatOperators(surface.graph(), options); }, "A = M + tau L: ");
  options.solver = [](const SparseUpper& K, const char* name, unsigned) -> std::unique_ptr<const LinearSolver> {
    if (name[0] == 'B') return std::make_unique<const WrongSolver>(K, name);
    return std::make_unique<const CholeskyFactor>(K, SymbolicCholesky(K), name);
  };
  expect_error<NotPositiveDefinite>([&] { HeatOperators(surface.graph(), options); }, "B = M + tau L^nabla: ");
  options.solver = [](const SparseUpper&, const char*, unsigned) { return std::unique_ptr<const LinearSolver>(); };
  expect_error<InvalidArgument>([&] { HeatOperators(surface.graph(), options); }, "'solver' returned no solver");
}

#ifndef AHM_WITH_CHOLMOD
TEST(Cholmod, IsMissing) {
  expect_error<InvalidArgument>([] { cholmod_solver(); }, "AHM_WITH_CHOLMOD=OFF");
}
#else

constexpr std::array factorizations{CholmodFactorization::automatic, CholmodFactorization::simplicial};

/// Expects that CHOLMOD gives the maps of libahm's own factors, to 1e-12 of the largest distance.
void expect_own_maps(const Surface& surface) {
  const TangentGraph& graph = surface.graph();
  const std::array sources{Source::at_vertex(Vertex(0)), Source::at_vertex(Vertex(graph.size() / 2))};
  const auto expected = LogMapSolver(graph, {.strategy = Strategy::global}).solve(sources);
  for (const CholmodFactorization factorization : factorizations) {
    const LogMapSolver solver(graph, {.solver = cholmod_solver(factorization)});
    EXPECT_GT(solver.operators().statistics().nonzeros_A, graph.size());
    EXPECT_GT(solver.operators().statistics().bytes,
              8 * static_cast<std::size_t>(solver.operators().statistics().nonzeros_A));
    const auto maps = solver.solve(sources);
    for (std::size_t s = 0; s < maps.size(); ++s) {
      double largest = 0;
      for (Index i = 0; i < graph.size(); ++i) largest = std::max(largest, expected[s].distance(Vertex(i)));
      for (Index i = 0; i < graph.size(); ++i) {
        ASSERT_EQ(maps[s].status(Vertex(i)), expected[s].status(Vertex(i)));
        for (int c = 0; c < 2; ++c)
          ASSERT_NEAR(maps[s].coordinates(Vertex(i))[c], expected[s].coordinates(Vertex(i))[c], 1e-12 * largest)
              << "vertex " << i;
      }
    }
  }
}

TEST(Cholmod, GivesTheOwnMapsOfASphere) { expect_own_maps(surface_of(icosphere(20))); }
TEST(Cholmod, GivesTheOwnMapsOfAMoebiusBand) { expect_own_maps(surface_of(moebius_mesh(80, 10))); }
TEST(Cholmod, GivesTheOwnMapsOfACloud) {
  const Cloud cloud = even_sphere(2000);
  expect_own_maps(pointcloud::PointCloudSurface::build(cloud.points, cloud.normals));
}

/// The Laplacian of a grid of `side` x `side` vertices, plus the identity.
SparseUpper grid_matrix(Offset side, bool is_complex) {
  SparseUpper K;
  K.is_complex = is_complex;
  K.column_begin = {0};
  const auto add = [&](Offset row, double real, double imaginary) {
    K.rows.push_back(row);
    K.values.push_back(real);
    if (is_complex) K.values.push_back(imaginary);
  };
  for (Offset j = 0; j < side * side; ++j) {
    if (j >= side) add(j - side, -0.6, 0.8);
    if (j % side != 0) add(j - 1, -0.8, -0.6);
    add(j, 5, 0);
    K.column_begin.push_back(static_cast<Offset>(K.rows.size()));
  }
  return K;
}

std::vector<double> right_hand_sides(std::size_t count) {
  std::vector<double> b(count);
  for (std::size_t k = 0; k < b.size(); ++k) b[k] = std::sin(1.0 + 3.7 * static_cast<double>(k));
  return b;
}

TEST(Cholmod, IsSupernodalForLargeFactorsIfAutomatic) {
  for (const Offset side : {3, 120}) {
    const SparseUpper K = grid_matrix(side, false);
    const Offset automatic = cholmod_solver()(K, "K", 1)->nonzeros(),
                 simplicial = cholmod_solver(CholmodFactorization::simplicial)(K, "K", 1)->nonzeros();
    EXPECT_EQ(automatic > simplicial, side == 120);  // supernodes store zeros
  }
}

TEST(Cholmod, GivesTheSameBitsOnManyThreads) {
  for (const CholmodFactorization factorization : factorizations)
    for (const bool is_complex : {false, true}) {
      const SparseUpper K = grid_matrix(120, is_complex);  // large enough for supernodes
      const auto solver = cholmod_solver(factorization)(K, "K", 1);
      check_residual(*solver, K, "K");
      constexpr Offset columns = 5;
      std::vector<double> expected = right_hand_sides(to_size(K.size()) * (is_complex ? 2 : 1) * columns);
      const std::vector<double> b = expected;
      solver->solve(expected, columns);
      std::vector found(8, b);
      std::vector<std::thread> threads;
      for (auto& X : found) threads.emplace_back([&solver, &X] { solver->solve(X, columns, 2); });
      for (std::thread& thread : threads) thread.join();
      for (const auto& X : found)
        EXPECT_EQ(std::memcmp(X.data(), expected.data(), X.size() * sizeof(double)), 0) << is_complex;
      const auto on_four = cholmod_solver(factorization)(K, "K", 4);
      std::vector<double> X = b;
      on_four->solve(X, columns, 4);
      EXPECT_EQ(std::memcmp(X.data(), expected.data(), X.size() * sizeof(double)), 0) << is_complex;
    }
}

TEST(Cholmod, RefusesIndefiniteMatrices) {
  for (const CholmodFactorization factorization : factorizations)
    for (const bool is_complex : {false, true})
      for (const Offset side : {3, 120}) {
        SparseUpper K = grid_matrix(side, is_complex);
        const auto last = static_cast<std::size_t>(K.column_begin[side * side / 2 + 1] - 1);
        K.values[last * (is_complex ? 2 : 1)] = -1;  // on the diagonal
        try {
          cholmod_solver(factorization)(K, "K", 1);
          ADD_FAILURE() << "no error";
        } catch (const NotPositiveDefinite& error) {
          EXPECT_EQ(error.fault(), "not_positive_definite");
          EXPECT_NE(std::string(error.what()).find("operator K is not positive definite (column "), std::string::npos);
        }
      }
}

/// Counts CHOLMOD's allocations, and lets one of them fail.
struct Allocations {
  inline static int until_failure = -1, alive = 0;

  static bool fails() { return until_failure >= 0 && until_failure-- == 0; }
  static void* count(void* memory) {
    alive += memory != nullptr;
    return memory;
  }
  static void* allocate(std::size_t bytes) { return fails() ? nullptr : count(std::malloc(bytes)); }
  static void* allocate_zeros(std::size_t number, std::size_t bytes) {
    return fails() ? nullptr : count(std::calloc(number, bytes));
  }
  static void* reallocate(void* memory, std::size_t bytes) {
    if (fails()) return nullptr;
    return memory == nullptr ? count(std::malloc(bytes)) : std::realloc(memory, bytes);
  }
  static void release(void* memory) {
    alive -= memory != nullptr;
    std::free(memory);
  }
};

TEST(Cholmod, ReportsMissingMemoryAndLeaksNone) {
  const SuiteSparse_config_struct before = SuiteSparse_config;
  SuiteSparse_config.malloc_func = Allocations::allocate;
  SuiteSparse_config.calloc_func = Allocations::allocate_zeros;
  SuiteSparse_config.realloc_func = Allocations::reallocate;
  SuiteSparse_config.free_func = Allocations::release;
  for (const CholmodFactorization factorization : factorizations)
    for (const bool is_complex : {false, true}) {
      const SparseUpper K = grid_matrix(60, is_complex);
      bool succeeds = false;
      int failed = 0;
      for (; !succeeds && failed < 1000; ++failed) {
        Allocations::until_failure = failed;
        try {
          const auto solver = cholmod_solver(factorization)(K, "K", 1);
          std::vector<double> x = right_hand_sides(to_size(K.size()) * (is_complex ? 2 : 1));
          solver->solve(x, 1);
          succeeds = Allocations::until_failure >= 0;  // fewer allocations than the number that may succeed
        } catch (const ResourceExhausted& error) {
          EXPECT_NE(std::string(error.what()).find("operator K: CHOLMOD is out of memory"), std::string::npos);
        }
        Allocations::until_failure = -1;
        ASSERT_EQ(Allocations::alive, 0) << "allocation " << failed;
      }
      EXPECT_TRUE(succeeds);
      EXPECT_GT(failed, 10);
    }
  SuiteSparse_config = before;
}

#endif

}  // namespace
}  // namespace ahm::test
