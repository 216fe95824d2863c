/// \file
/// A sparse symmetric positive definite matrix factored by CHOLMOD, for systems that are not in `HeatOperators`.
#pragma once

#include <Eigen/CholmodSupport>
#include <Eigen/Sparse>
#include <string>

#include "ahm/error.hpp"

namespace ahm::methods {

/// For one thread at a time: solves share the workspace of CHOLMOD.
class SparseCholesky {
 public:
  /// @param matrix  its lower triangle is used
  /// @param what    name of the matrix in messages
  /// @throws NotPositiveDefinite
  SparseCholesky(const Eigen::SparseMatrix<double>& matrix, const std::string& what) {
    factors_.cholmod().print = 0;
    factors_.compute(matrix);
    if (factors_.info() != Eigen::Success)
      throw NotPositiveDefinite(what + " is not positive definite; build the graph with weights >= 0");
  }

  Eigen::VectorXd solve(const Eigen::VectorXd& b) const { return factors_.solve(b); }

 private:
  Eigen::CholmodDecomposition<Eigen::SparseMatrix<double>> factors_;
};

}  // namespace ahm::methods
