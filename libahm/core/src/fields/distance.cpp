#include "ahm/fields/distance.hpp"

#include <utility>

#include "ahm/error.hpp"
#include "ahm/util/small_math.hpp"

namespace ahm {

VertexField distance_gradient(const TangentGraph& graph, const LogMap& map) {
  if (map.size() != graph.size() || map.frames().empty())
    throw InvalidArgument("distance_gradient: the map has no frames, or belongs to another graph");
  const double rounding_error = 1e-8 * graph.mean_edge_length() * graph.length_unit();  // rounding error of |phi| = 0
  const auto d = static_cast<std::size_t>(map.dimension());
  VertexField gradient{
      map.dimension(), std::vector<double>(map.coordinates().size()), {map.status().begin(), map.status().end()}};
  for (std::size_t i = 0; i < gradient.status.size(); ++i) {
    const auto phi = map.coordinates(Vertex(i));
    const auto U = map.frames().subspan(i * d * d, d * d);
    const double away = length(phi);
    if (away <= rounding_error) continue;
    for (std::size_t c = 0; c < d; ++c)
      for (std::size_t a = 0; a < d; ++a) gradient.values[i * d + c] += U[c * d + a] * (phi[a] / away);
  }
  return gradient;
}

DistanceField distance_and_gradient(const LogMapSolver& solver, const Source& source, const MapOptions& options) {
  MapOptions map_options = options;
  map_options.variant = options.variant.value_or(Variant::localized);
  map_options.frames = true;
  map_options.spread = false;
  const LogMap map = solver.solve(source, map_options);
  VertexField gradient = distance_gradient(solver.graph(), map);
  VertexField distance{1, {map.distances().begin(), map.distances().end()}, gradient.status};
  return {std::move(distance), std::move(gradient)};
}

}  // namespace ahm
