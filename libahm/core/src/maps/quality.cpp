#include "ahm/maps/quality.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "ahm/error.hpp"
#include "ahm/util/parallel.hpp"
#include "ahm/util/small_math.hpp"

namespace ahm {
namespace {

/// g_i: how far the edges of vertex i are from the Gauss lemma. Edges to vertices without coordinates do not count.
double gauss_residual(const TangentGraph& graph, const LogMap& map, Index i) {
  const auto d = static_cast<std::size_t>(graph.dimension());
  const auto phi = map.coordinates(Vertex(i)), U = map.frames().subspan(static_cast<std::size_t>(i) * d * d, d * d);
  const double unit = graph.length_unit(), r = length(phi);
  const Star star = graph.star(i);
  double sum = 0;
  Index count = 0;
  for (std::size_t e = 0; e < star.degree(); ++e) {
    const Index j = star.neighbors[e];
    const double edge = length(star.log(e)) * unit;
    if (map.status(Vertex(j)) != Status::ok || !(edge > 0)) continue;
    double along = 0;  // e_ij . (U_i phi_i)
    for (std::size_t c = 0; c < d; ++c)
      for (std::size_t a = 0; a < d; ++a) along += star.logs[e * d + c] * unit * U[c * d + a] * phi[a];
    // In units of the larger length, so that nothing overflows.
    const double scale = std::max(r, edge), s = map.distance(Vertex(j));
    const double residual = ((s / scale - r / scale) * (s + r) / 2 - along / scale - edge * (edge / scale) / 2) / edge;
    sum += residual * residual;
    ++count;
  }
  return count > 0 ? std::sqrt(sum / count) : 0.0;
}

}  // namespace

std::vector<double> map_quality(const TangentGraph& graph, const LogMap& map, unsigned threads) {
  const auto n = static_cast<std::size_t>(graph.size()), d = static_cast<std::size_t>(graph.dimension());
  if (map.size() != graph.size() || map.dimension() != graph.dimension())
    throw InvalidArgument("map_quality: the map has " + std::to_string(map.size()) + " vertices, the graph " +
                          std::to_string(graph.size()));
  if (map.frames().size() != n * d * d)
    throw InvalidArgument("map_quality: the map has no frames; solve with MapOptions::frames = true");
  std::vector<double> quality(n, std::numeric_limits<double>::quiet_NaN());
  detail::for_each_index(n, threads, [&](std::size_t k) {
    const auto i = static_cast<Index>(k);
    if (map.status(Vertex(i)) != Status::ok) return;
    const double g = gauss_residual(graph, map, i) / 0.4;
    quality[k] = 1 / (1 + g * g);
  });
  return quality;
}

}  // namespace ahm
