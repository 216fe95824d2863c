#include "ahm/fields/distance.hpp"

#include <utility>

#include "ahm/util/small_math.hpp"

namespace ahm {

DistanceField distance_and_gradient(const LogMapSolver& solver, const Source& source, const MapOptions& options) {
  VertexField Y = radial_field(solver, source, options);
  const TangentGraph& graph = solver.graph();
  const double at_source = 1e-8 * graph.mean_edge_length() * graph.length_unit();  // what rounding leaves there
  VertexField distance{1, std::vector<double>(Y.status.size()), Y.status};
  const auto d = static_cast<std::size_t>(Y.width);
  for (std::size_t i = 0; i < Y.status.size(); ++i) {
    const std::span gradient = std::span(Y.values).subspan(i * d, d);
    const double r = distance.values[i] = length(gradient);
    for (double& component : gradient) component = r < at_source ? 0.0 : component / r;
  }
  return {std::move(distance), std::move(Y)};
}

}  // namespace ahm
