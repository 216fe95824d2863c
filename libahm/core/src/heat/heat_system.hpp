/// \file
/// Something that solves with A and B of one graph: by factors, or by iteration.
#pragma once

#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "ahm/heat/heat_operators.hpp"

namespace ahm {

/// A and B, scaled by c, ready to solve with. Immutable: `solve_A` and `solve_B` may be called from many threads at once.
class HeatSystem {
 public:
  virtual ~HeatSystem() = default;

  /// X <- (c A)^-1 X, column major.
  virtual void solve_A(std::span<double> X, Offset columns) const = 0;
  /// X <- (c B)^-1 X, column major; complex numbers as interleaved pairs.
  virtual void solve_B(std::span<double> X, Offset columns) const = 0;

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

/// By Cholesky factors.
/// @param tau  of each vertex, the same at both ends of an edge
/// @throws as `HeatOperators`
std::unique_ptr<const HeatSystem> factored_system(const TangentGraph& graph, std::vector<double> tau,
                                                  const HeatOptions& options);

/// By conjugate gradients; block graphs only. Errors are relative to the largest value of a solution, which is enough for
/// the thin bands of a march.
/// @throws as `HeatOperators`
std::unique_ptr<const HeatSystem> iterative_system(const TangentGraph& graph, std::vector<double> tau,
                                                   const HeatOptions& options);

}  // namespace ahm
