/// \file
/// The matrices c (M + tau L) and c (M + tau L^nabla) of a graph.
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
/// @param tau  of each vertex, the same at both ends of an edge
AssembledOperators assemble(const TangentGraph& graph, std::span<const double> tau, double scaling);

/// Checks the options, and the graph if they say so.
/// @throws InvalidGraph, InvalidArgument
void check_heat_options(const TangentGraph& graph, const HeatOptions& options);
/// Checks `t_coef`, and the graph if the options request it. @throws InvalidGraph, InvalidArgument
void check_diffusion(const TangentGraph& graph, const FactorOptions& options);

/// A and B, scaled by c, ready to solve with. Immutable: `solve_A` and `solve_B` may be called from many threads at once.
class HeatSystem {
 public:
  virtual ~HeatSystem() = default;

  /// X <- (c A)^-1 X, column major; the same bits on any number of threads.
  virtual void solve_A(std::span<double> X, Offset columns, unsigned threads = 1) const = 0;
  /// X <- (c B)^-1 X, column major; complex numbers as interleaved pairs.
  virtual void solve_B(std::span<double> X, Offset columns, unsigned threads = 1) const = 0;

  /// What was not checked when the system was made. @throws NotPositiveDefinite
  virtual void check() const {}

  /// Of each vertex.
  std::span<const double> tau() const noexcept { return tau_; }
  double scaling() const noexcept { return scaling_; }
  const FactorStatistics& statistics() const noexcept { return statistics_; }

 protected:
  HeatSystem(std::vector<double> tau, double scaling) : tau_(std::move(tau)), scaling_(scaling) {}

  std::vector<double> tau_;
  double scaling_;
  FactorStatistics statistics_;
};

/// The power of two that brings the mean mass to order one. A power of two, so that scaled models give the same bits.
/// @throws InvalidGraph
double mass_scaling(double mean_mass);

/// How far A^-1 m is from 1 at the first `own` vertices. Constants are in the kernel of L, so A 1 = m: it tells what
/// conditioning leaves of the digits.
double conservation_residual(const HeatSystem& system, const TangentGraph& graph, Index own);
/// @throws NotPositiveDefinite where that is too much
void check_conservation(double lost);

/// By Cholesky factors.
/// @param tau  of each vertex, the same at both ends of an edge
/// @throws as `HeatOperators`
std::unique_ptr<const HeatSystem> factored_system(const TangentGraph& graph, std::vector<double> tau,
                                                  const FactorOptions& options);

/// The same, but A's factor is checked, and B factored, when B is first solved with: whoever goes by what A tells and never solves
/// with B calls `check`. Its statistics are empty.
/// @throws as `HeatOperators`; and so does the first `solve_B`
std::unique_ptr<const HeatSystem> heat_first_system(const TangentGraph& graph, std::vector<double> tau,
                                                    const FactorOptions& options);

/// By conjugate gradients; block graphs only. Errors are relative to the largest value of a solution, which is enough for
/// the thin bands of a march.
/// @throws as `HeatOperators`
std::unique_ptr<const HeatSystem> iterative_system(const TangentGraph& graph, std::vector<double> tau,
                                                   const FactorOptions& options);

/// Makes operators that solve with a system: factors, conjugate gradients, or solvers of other libraries.
struct HeatOperatorsAccess {
  static HeatOperators make(std::unique_ptr<const HeatSystem> system, const TangentGraph& graph, Components components);
};

}  // namespace ahm
