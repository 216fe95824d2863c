/// \file
/// The function whose gradient is nearest to a vector field, over the edges of a graph: the last step of every heat method
/// for distances.
///
/// \code
/// const ahm::methods::EdgeIntegration integration(graph);           // factors the Laplacian
/// std::vector<double> f = integration.integrate(unit_field, source);  // f[source] is not yet zero
/// \endcode
#pragma once

#include <span>
#include <vector>

#include "ahm/graph/components.hpp"
#include "ahm/graph/tangent_graph.hpp"
#include "methods/sparse_cholesky.hpp"

namespace ahm::methods {

/// Minimizes sum_ij w_ij (f_j - f_i - <X, e_ij>)^2, where X on an edge is the mean over its ends. On a flat graph it is
/// exact for gradients of quadratic functions, for any weights.
class EdgeIntegration {
 public:
  /// @throws NotPositiveDefinite (a Laplacian that is not positive semi-definite)
  explicit EdgeIntegration(const TangentGraph& graph);

  /// @param field  n x d, in the frame of each vertex, without unit
  /// @param pole   a vertex whose vector is ignored: its edges use the vector of their other end; -1: none
  /// @return f in graph units, up to a constant per component
  std::vector<double> integrate(std::span<const double> field, Index pole = -1) const;

 private:
  const TangentGraph& graph_;
  Components components_;
  std::vector<Index> pinned_;  ///< first vertex of each component, where f = 0
  SparseCholesky laplacian_;
};

}  // namespace ahm::methods
