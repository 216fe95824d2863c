/// \file
/// The two operators of the affine heat method, factored once: A = M + tau L with the scalar Laplacian, and B = M + tau L^nabla with
/// the connection Laplacian. Both are symmetric positive definite if all weights are >= 0.
///
/// Most programs use `LogMapSolver` or the functions in vector_heat.hpp, which are built on this class.
///
/// \code
/// ahm::HeatOperators heat(graph, {.t_coef = 1.0});
/// std::vector<double> lambda(n, 0.0);
/// lambda[source] = 1.0;
/// heat.solve_scalar(lambda, 1);                // lambda = (c A)^-1 delta
/// \endcode
#pragma once

#include <memory>
#include <span>
#include <string>

#include "ahm/graph/components.hpp"
#include "ahm/graph/tangent_graph.hpp"
#include "ahm/heat/heat_options.hpp"

namespace ahm {

/// Time and memory of the factorization.
struct FactorStatistics {
  double assemble_seconds = 0;
  double analyze_seconds = 0;
  double factor_seconds = 0;
  Offset nonzeros_A = 0;  ///< entries of the triangular factor of A
  Offset nonzeros_B = 0;  ///< entries (complex, or real in the block path) of the factor of B
  std::size_t bytes = 0;  ///< memory of both factors
};

/// The factored operators A and B of one graph. Immutable: all member functions may be called from many threads at once.
class HeatOperators {
 public:
  /// Assembles and factors A and B, for one diffusion time.
  /// @throws InvalidGraph, InvalidArgument (t_coef), NotPositiveDefinite (an operator is not positive definite, or its residual is too
  ///         large), ResourceExhausted (memory), Cancelled
  HeatOperators(const TangentGraph& graph, const FactorOptions& options = {});
  ~HeatOperators();
  HeatOperators(HeatOperators&&) noexcept;
  HeatOperators& operator=(HeatOperators&&) noexcept;

  Index size() const noexcept;
  int dimension() const noexcept;
  TransportKind transport_kind() const noexcept;
  /// Diffusion time of each vertex, in squared graph units: t_coef h_c^2, with h_c the mean edge length of its component.
  std::span<const double> tau() const noexcept;
  const FactorStatistics& statistics() const noexcept;

  /// X <- (c A)^-1 X for `columns` right-hand sides, column major n x columns. The power of two c (`scaling`) brings the operators to
  /// order one. It is the same for A and B, and cancels in every quotient of solutions.
  /// @param threads  used for a large factor and a few columns (0: one per core); the result has the same bits for any number
  /// @throws InvalidArgument (the length of X is not n * columns)
  void solve_scalar(std::span<double> X, Index columns, unsigned threads = 1) const;
  /// X <- (c B)^-1 X for `columns` vector fields, column major: each column holds n vectors of d numbers.
  /// @throws InvalidArgument (the length of X is not n * d * columns)
  void solve_vector(std::span<double> X, Index columns, unsigned threads = 1) const;
  /// The constant c.
  double scaling() const noexcept;

  /// Connected component of each vertex, numbered from 0 in order of the first vertex.
  std::span<const Index> components() const noexcept;
  Index component_count() const noexcept;

 private:
  friend struct HeatOperatorsAccess;  // internal: makes operators that use another solver than Cholesky factors
  HeatOperators() = default;

  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ahm
