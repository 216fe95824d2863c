/// \file
/// From a vector field to the function whose gradient it is nearest to, over the edges of a graph: the last step of
/// every heat method for distance.
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

/// Minimizes sum_ij w_ij (f_j - f_i - <X, e_ij>)^2, where X along the edge is the mean of its two ends. Exact on a flat
/// graph for the gradients of quadratic functions, whatever the weights.
class EdgeIntegration {
 public:
  /// @throws NotPositiveDefinite when the Laplacian is not positive semi-definite
  explicit EdgeIntegration(const TangentGraph& graph);

  /// @param field  n x d, in the frame of each vertex, of no unit
  /// @param pole   a vertex whose vector is not used: its edges take the vector of their other end; -1: none
  /// @return f in graph units, up to a constant in every component
  std::vector<double> integrate(std::span<const double> field, Index pole = -1) const;

 private:
  const TangentGraph& graph_;
  Components components_;
  std::vector<Index> pinned_;  ///< first vertex of each component, where f = 0
  SparseCholesky laplacian_;
};

}  // namespace ahm::methods
