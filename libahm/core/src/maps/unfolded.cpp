#include "maps/unfolded.hpp"

#include <algorithm>

#include "maps/affine_heat.hpp"

namespace ahm {

Unfolded unfolded_from(const Source& source, const TangentGraph& graph,
                       const std::shared_ptr<const Wavefront::OneRings>& stars, bool directions, double radius,
                       const std::stop_token& stop) {
  if (!unfolds(graph, source)) return {};
  Wavefront front(graph, stars, directions && graph.is_delaunay());
  front.add(source);
  front.run(radius, stop);
  const auto n = static_cast<std::size_t>(graph.size());
  Unfolded found;
  found.distances.resize(n);
  found.directions.resize(front.has_directions() ? 2 * n : 0);
  found.direction_errors.reserve(front.has_directions() ? n : 0);
  found.nearest.resize(source.is_curve() ? n : 0);
  for (std::size_t i = 0; i < n; ++i) {
    found.distances[i] = front.distance(Vertex(i));
    if (!found.nearest.empty()) found.nearest[i] = front.nearest(Vertex(i));
    if (found.directions.empty()) continue;
    std::ranges::copy(front.direction(Vertex(i)), found.directions.begin() + 2 * i);
    found.direction_errors.push_back(front.direction_error(Vertex(i)));
  }
  return found;
}

}  // namespace ahm
