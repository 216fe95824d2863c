#include "ahm/applications/mean.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "ahm/error.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/text.hpp"
#include "flat_center.hpp"

namespace ahm {
namespace {

/// Weighted vertices, and what is to be least.
struct Problem {
  const MapMaker& maps;
  const char* name;  ///< of the function called, for messages
  std::vector<double> (*flat_center)(const FlatPoints&);
  std::vector<Vertex> vertices;
  std::vector<double> weights;  ///< > 0, the largest 1
};

void check_vertex(const Problem& problem, Vertex vertex, const std::string& what) {
  if (vertex.index < 0 || vertex.index >= problem.maps.graph().size())
    throw InvalidArgument(std::string(problem.name) + ": " + what + ", vertex " + std::to_string(vertex.index) +
                          ", is outside [0, " + std::to_string(problem.maps.graph().size()) + ")");
}

/// Keeps the points of positive weight.
void set_points(Problem& problem, std::span<const Vertex> vertices, std::span<const double> weights) {
  const std::string name = problem.name;
  if (vertices.empty()) throw InvalidArgument(name + ": 'vertices' is empty");
  if (!weights.empty() && weights.size() != vertices.size())
    throw InvalidArgument(name + ": 'weights' has " + std::to_string(weights.size()) + " entries, 'vertices' has " +
                          std::to_string(vertices.size()));
  double largest = 0;
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    check_vertex(problem, vertices[k], "point " + std::to_string(k));
    const double w = weights.empty() ? 1.0 : weights[k];
    if (!(w >= 0) || !std::isfinite(w))
      throw InvalidArgument(name + ": weight " + std::to_string(k) + ", " + detail::number(w) +
                            ", must be finite and >= 0");
    if (w == 0) continue;
    problem.vertices.push_back(vertices[k]);
    problem.weights.push_back(w);
    largest = std::max(largest, w);
  }
  if (problem.vertices.empty()) throw InvalidArgument(name + ": all 'weights' are 0");
  for (double& w : problem.weights) w /= largest;
}

/// The points seen from a vertex, and their center there; lengths in graph units.
struct View {
  LogMap map;
  FlatPoints points;
  std::vector<double> center;
};

View look(const Problem& problem, Vertex from, double radius) {
  const TangentGraph& graph = problem.maps.graph();
  View view{problem.maps.map(from, radius), {}, {}};
  view.points.dimension = static_cast<std::size_t>(graph.dimension());
  view.points.weights = problem.weights;
  for (Vertex vertex : problem.vertices) {
    if (const Status status = view.map.status(vertex); status != Status::ok) {
      const char* what = status == Status::disconnected    ? "' (take one center per component)"
                         : status == Status::beyond_radius ? "' (raise radius)"
                                                           : "' (let the solver march: Strategy::automatic)";
      throw InvalidArgument(std::string(problem.name) + ": seen from vertex " + std::to_string(from.index) +
                            ", the point at vertex " + std::to_string(vertex.index) + " has status '" +
                            std::string(to_string(status)) + what);
    }
    for (double z : view.map.coordinates(vertex)) view.points.coordinates.push_back(z / graph.length_unit());
  }
  view.center = problem.flat_center(view.points);
  return view;
}

/// exp of `share` times the center: the vertex of the nearest coordinates, found by going from neighbour to neighbour,
/// since coordinates as short occur beyond the cut locus as well.
Vertex follow(const TangentGraph& graph, const View& view, Vertex from, double share) {
  const auto away = [&](Index i) {
    const auto phi = view.map.coordinates(Vertex(i));
    double sum = 0;
    for (std::size_t a = 0; a < phi.size(); ++a) {
      const double difference = phi[a] / graph.length_unit() - share * view.center[a];
      sum += difference * difference;
    }
    return sum;
  };
  Index best = from.index;
  double least = away(best);
  for (Index at = -1; at != best;) {
    at = best;
    for (Index j : graph.star(at).neighbors)
      if (const double r = away(j); r < least) best = j, least = r;  // never so for NaN
  }
  return Vertex(best);
}

/// Weighted power mean of the distances from the center.
double spread(const View& view, double power) {
  const std::vector<double> away = distances(view.points, view.center);
  double sum = 0, total = 0;
  for (std::size_t k = 0; k < away.size(); ++k) {
    sum += view.points.weights[k] * std::pow(away[k], power);
    total += view.points.weights[k];
  }
  return std::pow(sum / total, 1 / power);
}

Center search(const Problem& problem, double power, const CenterOptions& options) {
  if (options.max_maps < 1)
    throw InvalidArgument(std::string(problem.name) + ": 'max_maps' " + std::to_string(options.max_maps) +
                          " must be at least 1");
  const TangentGraph& graph = problem.maps.graph();
  const auto heaviest = std::max_element(problem.weights.begin(), problem.weights.end()) - problem.weights.begin();
  Vertex x = options.start.value_or(problem.vertices[heaviest]);
  check_vertex(problem, x, "'start'");

  Center best;
  std::vector<Vertex> visited;
  double remaining = std::numeric_limits<double>::infinity(), share = 1;
  for (Index maps = 1; maps <= options.max_maps; ++maps) {
    const View here = look(problem, x, options.radius);
    visited.push_back(x);
    if (const double r = length(here.center); r < remaining) {
      remaining = r;
      best.vertex = x;
      best.offset = here.center;
      best.spread = spread(here, power) * graph.length_unit();
      for (double& z : best.offset) z *= graph.length_unit();
    }
    best.maps = maps;
    // A vertex seen before would close a cycle: then go half as far.
    Vertex next = follow(graph, here, x, share);
    while (next != x && std::find(visited.begin(), visited.end(), next) != visited.end()) {
      share /= 2;
      next = share > 1e-6 ? follow(graph, here, x, share) : x;
    }
    best.converged = next == x;
    if (best.converged) break;
    x = next;
  }
  return best;
}

}  // namespace

Center karcher_mean(const MapMaker& maps, std::span<const Vertex> vertices, std::span<const double> weights,
                    const CenterOptions& options) {
  Problem problem{maps, "karcher_mean", flat_mean, {}, {}};
  set_points(problem, vertices, weights);
  return search(problem, 2, options);
}

Center geometric_median(const MapMaker& maps, std::span<const Vertex> vertices, std::span<const double> weights,
                        const CenterOptions& options) {
  Problem problem{maps, "geometric_median", flat_median, {}, {}};
  set_points(problem, vertices, weights);
  return search(problem, 1, options);
}

Source source_at(const Center& center) {
  std::vector<double> back(center.offset);
  for (double& z : back) z = -z;
  return Source(static_cast<int>(back.size())).add(center.vertex, 1.0, back);
}

}  // namespace ahm
