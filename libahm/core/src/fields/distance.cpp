#include "ahm/fields/distance.hpp"

#include <utility>

#include "ahm/util/small_math.hpp"

namespace ahm {

DistanceField distance_and_gradient(const LogMapSolver& solver, const Source& source, const MapOptions& options) {
  MapOptions wanted = options;
  wanted.variant = options.variant.value_or(Variant::localized);
  wanted.frames = true;
  wanted.spread = false;
  const LogMap map = solver.solve(source, wanted);
  const TangentGraph& graph = solver.graph();
  const double at_source = 1e-8 * graph.mean_edge_length() * graph.length_unit();  // what rounding leaves there
  const auto d = static_cast<std::size_t>(map.dimension());
  const std::vector<Status> status(map.status().begin(), map.status().end());
  DistanceField field{{1, {map.distances().begin(), map.distances().end()}, status},
                      {map.dimension(), std::vector<double>(status.size() * d), status}};
  for (std::size_t i = 0; i < status.size(); ++i) {
    const auto phi = map.coordinates(Vertex(i));
    const double away = length(phi), scale = away < at_source ? 0.0 : 1 / away;
    const auto U = map.frames().subspan(i * d * d, d * d);
    for (std::size_t c = 0; c < d; ++c) {
      double sum = 0;
      for (std::size_t a = 0; a < d; ++a) sum += U[c * d + a] * phi[a];
      field.gradient.values[i * d + c] = scale * sum;
    }
  }
  return field;
}

}  // namespace ahm
