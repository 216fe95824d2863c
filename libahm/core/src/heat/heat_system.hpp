/// \file
/// The matrices c (M + tau L) and c (M + tau L^nabla) of a graph, with the scalar Laplacian L and the connection Laplacian L^nabla.
#pragma once

#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "ahm/cholesky/cholesky.hpp"
#include "ahm/graph/tangent_graph.hpp"
#include "ahm/heat/heat_operators.hpp"

namespace ahm {

struct AssembledOperators {
  SparseUpper A;  ///< c (M + tau L), n x n real
  SparseUpper B;  ///< c (M + tau L^nabla): n x n complex Hermitian (rotation2) or nd x nd real (block)
};

/// Assembles both operators in one pass over the graph's stars; parallel edges are summed. Time and memory O(nnz).
/// @param tau      diffusion time of each vertex, equal at both ends of an edge
/// @param scaling  the constant c
AssembledOperators assemble(const TangentGraph& graph, std::span<const double> tau, double scaling);

/// Checks the options, and the graph if the options request it.
/// @throws InvalidGraph, InvalidArgument
void check_heat_options(const TangentGraph& graph, const HeatOptions& options);
/// Checks `t_coef`, and the graph if the options request it. @throws InvalidGraph, InvalidArgument
void check_diffusion(const TangentGraph& graph, const FactorOptions& options);

/// Solves with A and B, both scaled by c. Immutable: `solve_A` and `solve_B` may be called from many threads at once.
class HeatSystem {
 public:
  virtual ~HeatSystem() = default;

  /// X <- (c A)^-1 X, column major. The result has the same bits for any number of threads.
  virtual void solve_A(std::span<double> X, Offset columns, unsigned threads = 1) const = 0;
  /// X <- (c B)^-1 X, column major; complex numbers as interleaved pairs.
  virtual void solve_B(std::span<double> X, Offset columns, unsigned threads = 1) const = 0;

  /// Runs the checks that the constructor postponed. @throws NotPositiveDefinite
  virtual void check() const {}

  /// Diffusion time of each vertex, in squared graph units.
  std::span<const double> tau() const noexcept { return tau_; }
  /// The constant c.
  double scaling() const noexcept { return scaling_; }
  const FactorStatistics& statistics() const noexcept { return statistics_; }

 protected:
  HeatSystem(std::vector<double> tau, double scaling) : tau_(std::move(tau)), scaling_(scaling) {}

  std::vector<double> tau_;
  double scaling_;
  FactorStatistics statistics_;
};

/// The constant c: a power of two that brings the mean mass to order one. So scaled models give the same bits.
/// @throws InvalidGraph
double mass_scaling(double mean_mass);

/// Largest difference of A^-1 m from 1 at the first `own` vertices. Constants are in the kernel of L, so A 1 = m. The difference
/// measures how many digits are lost to conditioning.
double conservation_residual(const HeatSystem& system, const TangentGraph& graph, Index own);
/// Checks a `conservation_residual`. @throws NotPositiveDefinite (it is too large)
void check_conservation(double lost);

/// A system that solves by Cholesky factors, or by the solvers that `options.solver` makes.
/// @param tau  diffusion time of each vertex, equal at both ends of an edge
/// @throws as `HeatOperators`
std::unique_ptr<const HeatSystem> factored_system(const TangentGraph& graph, std::vector<double> tau,
                                                  const FactorOptions& options);

/// As `factored_system`, but the first `solve_B` checks the factor of A and factors B. If the caller never solves with B, it must call
/// `check` before it uses results of A. The statistics are empty. Ignores `options.solver`.
/// @throws as `HeatOperators`; the first `solve_B` throws the same errors
std::unique_ptr<const HeatSystem> deferred_system(const TangentGraph& graph, std::vector<double> tau,
                                                  const FactorOptions& options);

/// A system that solves by conjugate gradients, for block graphs only. Errors are relative to the largest value of a solution, which is
/// accurate enough for the thin bands of a march.
/// @throws as `HeatOperators`
std::unique_ptr<const HeatSystem> iterative_system(const TangentGraph& graph, std::vector<double> tau,
                                                   const FactorOptions& options);

/// Makes operators from a system: Cholesky factors, conjugate gradients, or solvers of other libraries.
struct HeatOperatorsAccess {
  static HeatOperators make(std::unique_ptr<const HeatSystem> system, const TangentGraph& graph, Components components);
};

}  // namespace ahm
