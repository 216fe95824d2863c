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
#include "maps/affine_heat.hpp"
#include "maps/carried_axes.hpp"
#include "maps/vector_quality.hpp"

namespace ahm {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// The jump at each vertex, over neighbors with coordinates; world units.
std::vector<double> jumps(const TangentGraph& graph, std::span<const double> coordinates,
                          std::span<const Status> status) {
  std::vector<double> jump(status.size(), nan);
  for (Index i = 0; i < graph.size(); ++i)
    if (status[i] == Status::ok)
      jump[i] = jump_at(graph, i, [&](Index j) {
        return status[j] != Status::ok ? nan
                                       : length(Vec2{coordinates[2 * j] - coordinates[2 * i],
                                                     coordinates[2 * j + 1] - coordinates[2 * i + 1]});
      });
  return jump;
}

/// Axes of each vertex, row major: the source's axes at the source's vertices, the identity elsewhere.
std::vector<double> source_axes(const Source& source, std::size_t n) {
  std::vector<double> axes(4 * n, 0);
  for (std::size_t i = 0; i < n; ++i) axes[4 * i] = axes[4 * i + 3] = 1;
  for (std::size_t k = 0; k < source.vertices().size() && !source.axes().empty(); ++k)
    std::ranges::copy(source.axes().subspan(4 * k, 4), axes.begin() + 4 * std::ptrdiff_t{source.vertices()[k].index});
  return axes;
}

std::vector<Status> statuses(const Wavefront& front, const Source& source, double radius) {
  const TangentGraph& graph = front.graph();
  std::vector<Status> status(static_cast<std::size_t>(graph.size()), Status::disconnected);
  for (Index i = 0; i < graph.size(); ++i)
    if (const double distance = front.distance(Vertex(i)); std::isfinite(distance) && distance <= radius)
      status[i] = Status::ok;
  if (std::isinf(radius)) return status;  // the front has reached all connected vertices
  const Components components = connected_components(graph);
  const SourceComponents reached(source, components.of_vertex);
  for (Index i = 0; i < graph.size(); ++i)
    if (status[i] != Status::ok && reached.hold(i)) status[i] = Status::beyond_radius;
  return status;
}

void check(const Wavefront& front, const Source& source, const PolarMapOptions& options) {
  if (!(options.radius > 0))
    throw InvalidArgument("radius is " + detail::number(options.radius) +
                          "; it must be > 0 (infinity: the whole graph)");
  if (!front.has_directions())
    throw InvalidArgument("front_without_directions", "polar_map: the front has no directions",
                          "construct it with `directions`, on a graph of dimension 2");
  if (source.is_curve()) throw InvalidArgument("polar_map: the source is a curve; polar maps require points");
}

}  // namespace

LogMap polar_map(const Wavefront& front, const Source& source, const PolarMapOptions& options) {
  check(front, source, options);
  const TangentGraph& graph = front.graph();
  const auto n = static_cast<std::size_t>(graph.size());
  std::vector<double> coordinates(2 * n, nan);
  std::vector<Status> status = statuses(front, source, options.radius);
  MapExtras extras;
  extras.method = Method::polar;
  extras.radius = options.radius;
  extras.distances.assign(n, nan);
  extras.error_estimate.assign(n, nan);
  if (options.frames) extras.frames = source_axes(source, n);
  if (front.points() > 1) extras.nearest.assign(n, -1);
  for (std::size_t i = 0; i < n; ++i) {
    if (status[i] != Status::ok) continue;
    const Vertex vertex(static_cast<Index>(i));
    const double distance = extras.distances[i] = front.distance(vertex);
    if (!extras.nearest.empty()) extras.nearest[i] = front.nearest(vertex);
    const Vec2 direction = front.direction(vertex);
    extras.error_estimate[i] = distance * front.direction_error(vertex);
    coordinates[2 * i] = distance > 0 ? distance * direction[0] : 0;
    coordinates[2 * i + 1] = distance > 0 ? distance * direction[1] : 0;
    if (!options.frames) continue;
    const Vec2 arrival = front.arrival(vertex);
    if (!std::isnan(arrival[0]) && !std::isnan(direction[0]))
      std::ranges::copy(carried_axes(direction, arrival, front.is_mirrored(vertex)), extras.frames.data() + 4 * i);
  }
  extras.spread = jumps(graph, coordinates, status);
  return LogMap(2, Variant::adaptive, Strategy::automatic, source, std::move(coordinates), std::move(status),
                std::move(extras));
}

}  // namespace ahm
