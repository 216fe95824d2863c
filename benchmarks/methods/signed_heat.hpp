/// \file
/// SHM, the signed heat method [FC24], on any graph.
///
/// \code
/// const ahm::methods::SignedHeat shm(graph);
/// std::vector<double> to_curve = shm.signed_distance(ahm::stroke_source(graph, path));  // > 0 left of the path
/// std::vector<double> to_point = shm.solve(42).distance;
/// \endcode
#pragma once

#include "ahm/heat/heat_operators.hpp"
#include "ahm/maps/source.hpp"
#include "methods/edge_integration.hpp"
#include "methods/method.hpp"

namespace ahm::methods {

/// Factors in its constructor. `solve` computes the unsigned distance to a vertex: a point has no sides.
class SignedHeat final : public Baseline {
 public:
  /// @throws as `HeatOperators`; NotPositiveDefinite (weights)
  explicit SignedHeat(const TangentGraph& graph, double t_coef = 1.0);

  std::string_view name() const noexcept override { return "SHM"; }
  Result solve(Index source) const override;

  /// Signed distance to a curve, d = 2.
  /// @param curve  samples with quadrature weights whose u axes point along the curve, as from `stroke_source`; several
  /// strokes added to one source are one broken curve
  /// @return n numbers, world units, > 0 on the side of the v axes; zero on average over the curve
  /// @throws InvalidArgument (a source that is not a curve in d = 2, or that does not match the graph)
  std::vector<double> signed_distance(const Source& curve) const;

 private:
  const TangentGraph& graph_;
  HeatOperators heat_;
  EdgeIntegration integration_;
};

}  // namespace ahm::methods
