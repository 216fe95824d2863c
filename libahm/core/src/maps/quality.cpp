#include "ahm/maps/quality.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "ahm/error.hpp"
#include "ahm/maps/place_in_space.hpp"
#include "ahm/util/parallel.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/vec.hpp"
#include "heat/component_scales.hpp"

namespace ahm {

std::vector<double> map_quality(const TangentGraph& graph, const LogMap& map, unsigned threads) {
  if (map.size() != graph.size() || map.dimension() != graph.dimension())
    throw InvalidArgument("map_quality: the map has " + std::to_string(map.size()) + " vertices, the graph " +
                          std::to_string(graph.size()));
  if (map.source().is_curve())
    throw InvalidArgument("a map from a curve has no quality: its coordinates are no vectors to it");
  if (map.spread().empty())
    throw InvalidArgument("map_without_spread", "the map has no spread", "solve with MapOptions::spread");
  std::vector<double> quality(static_cast<std::size_t>(graph.size()), std::numeric_limits<double>::quiet_NaN());
  const ComponentScales scales(graph);
  // Unfolded distances are never below the straight line; those of heat may be.
  const bool may_be_short = map.method() == Method::heat && !graph.is_delaunay();
  const std::optional<Vec3> source = may_be_short ? place_in_space(graph, map.source()) : std::nullopt;
  detail::for_each_index(quality.size(), threads, [&](std::size_t i) {
    if (map.status()[i] != Status::ok) return;
    const auto vertex = static_cast<Index>(i);
    double d = map.distances()[i];
    if (const auto frame = source ? graph.frame(vertex) : std::nullopt)
      d = std::max(d, distance(frame->origin, *source));
    const double away = std::max(d, scales.h(vertex) * graph.length_unit());
    const double spread = map.spread()[i] / away;
    const double off = (length(map.coordinates(Vertex(i))) / away - d / away) * 3;
    const double doubt = std::hypot(spread, off) / 0.3;
    quality[i] = 1 / (1 + doubt * doubt);
  });
  return quality;
}

}  // namespace ahm
