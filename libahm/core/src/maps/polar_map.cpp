#include "ahm/maps/polar_map.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "ahm/error.hpp"
#include "ahm/graph/components.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/text.hpp"
#include "ahm/util/vec.hpp"
#include "maps/source_vertices.hpp"

namespace ahm {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Half of what the longest edge of each vertex to a neighbor with coordinates has too much in the map, world units.
std::vector<double> jumps(const TangentGraph& graph, std::span<const double> coordinates,
                          std::span<const Status> status) {
  constexpr double rounding = 1e-9;
  const double unit = graph.length_unit();
  std::vector<double> jump(status.size(), nan);
  for (Index i = 0; i < graph.size(); ++i) {
    if (status[i] != Status::ok) continue;
    jump[i] = 0;
    const Star star = graph.star(i);
    for (std::size_t e = 0; e < star.degree(); ++e) {
      const Index j = star.neighbors[e];
      if (status[j] != Status::ok) continue;
      const double apart =
          std::hypot(coordinates[2 * j] - coordinates[2 * i], coordinates[2 * j + 1] - coordinates[2 * i + 1]);
      const double excess = (apart - unit * length(star.log(e))) / 2;
      if (excess > rounding * apart) jump[i] = std::max(jump[i], excess);
    }
  }
  return jump;
}

}  // namespace

LogMap polar_map(const UnfoldingFront& front, const Source& source, const PolarMapOptions& options) {
  if (!(options.radius > 0))
    throw InvalidArgument("radius is " + detail::number(options.radius) + "; it must be > 0 (infinity: the whole graph)");
  if (!front.has_directions()) throw InvalidArgument("polar_map: the front has no directions; make it with them");
  if (source.is_curve()) throw InvalidArgument("polar_map: the source is a curve; polar coordinates are from points");
  const TangentGraph& graph = front.graph();
  const auto n = static_cast<std::size_t>(graph.size());
  std::vector<double> coordinates(2 * n, nan);
  std::vector<Status> status(n);
  MapExtras extras;
  extras.method = Method::polar;
  extras.radius = options.radius;
  extras.distances.assign(n, nan);
  extras.error_estimate.assign(n, nan);
  for (std::size_t i = 0; i < n; ++i) {
    const double distance = front.distance(Vertex(i));
    status[i] = distance <= options.radius ? Status::ok : Status::beyond_radius;
    if (!std::isfinite(distance)) {
      status[i] = std::isfinite(options.radius) ? Status::beyond_radius : Status::disconnected;
      continue;
    }
    if (status[i] != Status::ok) continue;
    const Vec2 direction = front.direction(Vertex(i));
    extras.distances[i] = distance;
    extras.error_estimate[i] = distance * front.doubt(Vertex(i));
    coordinates[2 * i] = distance > 0 ? distance * direction[0] : 0;
    coordinates[2 * i + 1] = distance > 0 ? distance * direction[1] : 0;
  }
  for (const auto& [vertex, known] : SourceVertices(source, 2))
    if (!known.vector.empty() && status[vertex] == Status::ok)
      std::ranges::copy(known.vector, coordinates.begin() + 2 * static_cast<std::ptrdiff_t>(vertex));
  extras.spread = jumps(graph, coordinates, status);
  return LogMap(2, Variant::adaptive, Strategy::automatic, source, std::move(coordinates), std::move(status),
                std::move(extras));
}

}  // namespace ahm
