#include "ahm/maps/quality.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "ahm/error.hpp"
#include "ahm/util/parallel.hpp"
#include "ahm/util/small_math.hpp"
#include "heat/component_scales.hpp"

namespace ahm {

std::vector<double> map_quality(const TangentGraph& graph, const LogMap& map, unsigned threads) {
  if (map.size() != graph.size() || map.dimension() != graph.dimension())
    throw InvalidArgument("map_quality: the map has " + std::to_string(map.size()) + " vertices, the graph " +
                          std::to_string(graph.size()));
  if (map.source().is_curve())
    throw InvalidArgument("map_quality: coordinates from a curve are no vectors to it; a point has a quality");
  if (map.spread().empty()) throw InvalidArgument("map_quality: the map was made without MapOptions::spread");
  std::vector<double> quality(static_cast<std::size_t>(graph.size()), std::numeric_limits<double>::quiet_NaN());
  const ComponentScales scales(graph);
  detail::for_each_index(quality.size(), threads, [&](std::size_t i) {
    if (map.status()[i] != Status::ok) return;
    const double d = map.distances()[i], away = std::max(d, scales.h(static_cast<Index>(i)) * graph.length_unit());
    const double spread = map.spread()[i] / away;
    const double off = (length(map.coordinates(Vertex(i))) / away - d / away) * 3;
    const double doubt = std::hypot(spread, off) / 0.3;
    quality[i] = 1 / (1 + doubt * doubt);
  });
  return quality;
}

}  // namespace ahm
