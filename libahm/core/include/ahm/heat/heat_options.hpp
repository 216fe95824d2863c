/// \file
/// Options shared by all computations with the heat method.
///
/// \code
/// ahm::LogMapSolver solver(graph, {.t_coef = 2, .threads = 4});
/// ahm::LocalMaps maps = ahm::local_maps(graph, {.radius = 0.05, .heat = {.variant = ahm::Variant::localized}});
/// \endcode
#pragma once

#include <cstddef>

#include "ahm/cholesky/cholesky.hpp"
#include "ahm/heat/variant.hpp"
#include "ahm/progress.hpp"
#include "ahm/types.hpp"

namespace ahm {

/// How the linear systems are solved (docs/concepts/march.md).
enum class Strategy {
  automatic,  ///< chooses by the size of the graph, the number of maps and the memory
  global,     ///< one factorization of the whole graph for all sources; reaches about 700 edges
  march,      ///< solves band after band, outwards from the source: time and memory linear in n, any distance
};

/// Options of the factorization (`HeatOperators`).
struct FactorOptions {
  double t_coef = 1.0;  ///< tau = t_coef h^2; > 0
  Ordering ordering = Ordering::automatic;
  bool check_graph = true;  ///< run `validate(graph)` first: O(n)
  unsigned threads = 0;     ///< 0: one per core. No result depends on it
  Progress progress = {};
  SolverFactory solver = {};  ///< makes the solvers of both operators; empty: libahm's own `CholeskyFactor`
};

/// Options of the diffusion, for computations on parts of a graph (`local_maps`, `local_coordinates`).
struct DiffusionOptions {
  double t_coef = 1.0;  ///< tau = t_coef h^2; > 0
  Variant variant = Variant::adaptive;
  bool check_graph = true;  ///< run `validate(graph)` first: O(n)
  unsigned threads = 0;     ///< 0: one per core. No result depends on it
  Progress progress = {};

  FactorOptions factor() const {
    return {.t_coef = t_coef, .check_graph = check_graph, .threads = threads, .progress = progress};
  }
};

/// Options of the solver (`LogMapSolver`).
struct HeatOptions {
  double t_coef = 1.0;  ///< tau = t_coef h^2; > 0
  Variant variant = Variant::adaptive;

  Strategy strategy = Strategy::automatic;
  /// For `automatic`: the number of maps to compute; 0: many. A single map of a large graph is faster by `march`.
  Index expected_maps = 0;
  /// For `automatic`: bytes available for the factors; 0: half of the machine's memory. If they need more, the strategy is `march`.
  std::size_t memory = 0;
  /// For `march`: the largest relative difference to a global solve, in [1e-14, 0.1].
  double accuracy = 1e-9;

  Ordering ordering = Ordering::automatic;
  bool check_graph = true;  ///< run `validate(graph)` first: O(n)

  unsigned threads = 0;  ///< 0: one per core. No result depends on it
  Progress progress = {};

  /// Makes the solvers of the whole graph's operators, by another library (`cholmod_solver`); empty: libahm's own `CholeskyFactor`.
  /// With a solver `automatic` is `global`, `march` is an error, and `ordering` is ignored: the other library chooses its own.
  /// Maps that heat does not reach are still continued by a march, which uses libahm's own factors.
  SolverFactory solver = {};

  DiffusionOptions diffusion() const { return {t_coef, variant, check_graph, threads, progress}; }
  FactorOptions factor() const { return {t_coef, ordering, check_graph, threads, progress, solver}; }
};

}  // namespace ahm
