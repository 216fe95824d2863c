/// \file
/// The second and third step of the heat method on a graph, shared by HM and SEM.
#pragma once

#include <vector>

#include "methods/edge_integration.hpp"
#include "methods/heat_fields.hpp"

namespace ahm::methods {

class StarHeat {
 public:
  explicit StarHeat(const TangentGraph& graph);

  /// Distances in world units from the heat of a vertex; NaN where no heat arrives.
  std::vector<double> from_heat(std::vector<double> lambda, Index source) const;

 private:
  const TangentGraph& graph_;
  EdgeIntegration integration_;
};

}  // namespace ahm::methods
