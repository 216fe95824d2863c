#include "ahm/applications/cells.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "ahm/error.hpp"
#include "ahm/fields/distance.hpp"
#include "ahm/util/memory.hpp"
#include "ahm/util/small_math.hpp"
#include "graph/shortest_paths.hpp"
#include "maps/inflow.hpp"

namespace ahm {
namespace {

constexpr Index nobody = -1;

void check_vertices(const TangentGraph& graph, std::span<const Vertex> vertices) {
  if (vertices.empty()) throw InvalidArgument("nearest_source: 'vertices' is empty");
  std::vector<bool> taken(static_cast<std::size_t>(graph.size()), false);
  for (const auto [vertex] : vertices) {
    if (vertex < 0 || vertex >= graph.size())
      throw InvalidArgument("nearest_source: vertex " + std::to_string(vertex) + " is outside [0, " +
                            std::to_string(graph.size()) + ")");
    if (taken[vertex]) throw InvalidArgument("nearest_source: vertex " + std::to_string(vertex) + " is given twice");
    taken[vertex] = true;
  }
}

/// Heat of those sources whose number has `bit` set (of all of them: bit < 0).
std::vector<double> heat_of(const LogMapSolver& solver, std::span<const Vertex> vertices, int bit, double b) {
  std::vector<double> heat(static_cast<std::size_t>(solver.graph().size()), 0.0);
  for (std::size_t k = 0; k < vertices.size(); ++k)
    if (bit < 0 || ((k >> bit) & 1U) != 0) heat[vertices[k].index] = b;
  solver.operators().solve_scalar(heat, 1);
  return heat;
}

/// The number that most of the heat spells, bit by bit; `nobody` where there is no heat or no such source.
std::vector<Index> spell(const LogMapSolver& solver, std::span<const Vertex> vertices) {
  const double b = source_heat(solver.graph(), solver.operators(), vertices);
  const std::vector<double> all = heat_of(solver, vertices, -1, b);
  std::vector<Index> label(all.size(), 0);
  for (int bit = 0; (vertices.size() - 1) >> bit != 0; ++bit) {
    const std::vector<double> heat = heat_of(solver, vertices, bit, b);
    for (std::size_t i = 0; i < label.size(); ++i)
      if (heat[i] > all[i] / 2) label[i] |= Index{1} << bit;
  }
  for (std::size_t i = 0; i < label.size(); ++i)
    if (!(all[i] >= std::numeric_limits<double>::min()) || label[i] >= static_cast<Index>(vertices.size()))
      label[i] = nobody;
  return label;
}

/// Cells that grow by edge lengths (shortest paths), each only over vertices spelled as its own or not at all.
class Growth {
 public:
  Growth(const TangentGraph& graph, std::span<const Vertex> vertices, std::vector<Index> spelled)
      : graph_(graph), spelled_(std::move(spelled)), label_(spelled_.size(), nobody), away_(spelled_.size(), unknown) {
    for (std::size_t k = 0; k < vertices.size(); ++k) {
      label_[vertices[k].index] = static_cast<Index>(k);
      away_[vertices[k].index] = 0;
    }
  }

  void run() {
    for (std::size_t i = 0; i < label_.size(); ++i)
      if (label_[i] != nobody) paths_.take_up(static_cast<Index>(i));
    paths_.run([&](Index i, double) { relax(i); });
  }

  /// Lets any cell take what has none yet; what has one keeps it.
  void open_the_rest() {
    for (std::size_t i = 0; i < label_.size(); ++i) spelled_[i] = label_[i];
  }

  std::vector<Index> take_labels() { return std::move(label_); }

 private:
  void relax(Index i) {
    const Index own = label_[i];
    const Star star = graph_.star(i);
    for (std::size_t e = 0; e < star.degree(); ++e) {
      const auto j = static_cast<std::size_t>(star.neighbors[e]);
      if (spelled_[j] != nobody && spelled_[j] != own) continue;
      if (paths_.offer(star.neighbors[e], away_[i] + length(star.log(e)))) label_[j] = own;
    }
  }

  static constexpr double unknown = std::numeric_limits<double>::infinity();
  const TangentGraph& graph_;
  std::vector<Index> spelled_, label_;
  std::vector<double> away_;
  ShortestPaths<double, std::vector<double>, unknown> paths_{away_};
};

}  // namespace

std::vector<Index> nearest_source(const LogMapSolver& solver, std::span<const Vertex> vertices) {
  return detail::with_memory_check("labelling by the nearest source", [&] {
    check_vertices(solver.graph(), vertices);
    Growth cells(solver.graph(), vertices, spell(solver, vertices));
    cells.run();
    cells.open_the_rest();
    cells.run();
    return cells.take_labels();
  });
}

namespace {

void check_labels(const TangentGraph& graph, std::span<const Vertex> vertices, std::span<const Index> labels) {
  check_vertices(graph, vertices);
  if (labels.size() != static_cast<std::size_t>(graph.size()))
    throw InvalidArgument("distance_in_cells: 'labels' has " + std::to_string(labels.size()) + " entries for " +
                          std::to_string(graph.size()) + " vertices");
  for (std::size_t i = 0; i < labels.size(); ++i)
    if (labels[i] < nobody || labels[i] >= static_cast<Index>(vertices.size()))
      throw InvalidArgument("distance_in_cells: 'labels' [" + std::to_string(i) + "] is " + std::to_string(labels[i]) +
                            ", there are " + std::to_string(vertices.size()) + " sources");
}

/// For every cell the cells it touches.
std::vector<std::vector<Index>> touching_cells(const TangentGraph& graph, std::span<const Index> labels,
                                               std::size_t count) {
  std::vector<std::vector<Index>> touching(count);
  for (Index i = 0; i < graph.size(); ++i) {
    const Index own = labels[i];
    if (own == nobody) continue;
    std::vector<Index>& others = touching[own];
    for (Index j : graph.star(i).neighbors) {
      const Index other = labels[j];
      if (other != own && other != nobody && std::find(others.begin(), others.end(), other) == others.end())
        others.push_back(other);
    }
  }
  return touching;
}

/// Groups such that cells that touch, or touch a common one, are in different ones.
std::vector<Index> groups_apart(const std::vector<std::vector<Index>>& touching) {
  std::vector<Index> group(touching.size(), nobody);
  std::vector<std::size_t> taken_by(touching.size(), touching.size());  // the last cell that cannot have this group
  for (std::size_t cell = 0; cell < touching.size(); ++cell) {
    const auto avoid = [&](Index other) {
      if (const Index g = group[other]; g != nobody) taken_by[g] = cell;
    };
    for (Index near : touching[cell]) {
      avoid(near);
      for (Index next : touching[near]) avoid(next);
    }
    Index free = 0;
    while (taken_by[free] == cell) ++free;
    group[cell] = free;
  }
  return group;
}

}  // namespace

VertexField distance_in_cells(const LogMapSolver& solver, std::span<const Vertex> vertices,
                              std::span<const Index> labels) {
  const TangentGraph& graph = solver.graph();
  check_labels(graph, vertices, labels);
  const std::vector<Index> group = groups_apart(touching_cells(graph, labels, vertices.size()));
  VertexField result{1, std::vector<double>(labels.size(), std::numeric_limits<double>::quiet_NaN()),
                     std::vector<Status>(labels.size(), Status::disconnected)};
  for (Index g = 0; g <= *std::max_element(group.begin(), group.end()); ++g) {
    std::vector<Vertex> sources;
    for (std::size_t k = 0; k < group.size(); ++k)
      if (group[k] == g) sources.push_back(vertices[k]);
    const DistanceField field = distance_and_gradient(solver, Source::at_vertices(sources));
    for (std::size_t i = 0; i < labels.size(); ++i) {
      if (labels[i] == nobody || group[labels[i]] != g) continue;
      result.values[i] = field.distance.values[i];
      result.status[i] = field.distance.status[i];
    }
  }
  return result;
}

std::vector<Vertex> farthest_points(const LogMapSolver& solver, Vertex first, Index count) {
  const Index n = solver.graph().size();
  if (first.index < 0 || first.index >= n)
    throw InvalidArgument("farthest_points: 'first' " + std::to_string(first.index) + " is outside [0, " +
                          std::to_string(n) + ")");
  if (count < 1 || count > n)
    throw InvalidArgument("farthest_points: 'count' " + std::to_string(count) + " must be in [1, " + std::to_string(n) +
                          "]");
  std::vector<Vertex> points{first};
  std::vector<double> away(static_cast<std::size_t>(n), std::numeric_limits<double>::infinity());
  while (points.size() < static_cast<std::size_t>(count)) {
    const LogMap map = solver.solve(Source::at_vertex(points.back()));
    for (Index i = 0; i < n; ++i)
      if (map.status(Vertex(i)) == Status::ok) {
        double& d = away[i];
        d = std::min(d, map.distance(Vertex(i)));
      }
    for (Vertex point : points) away[point.index] = -1;
    points.push_back(Vertex(static_cast<Index>(std::max_element(away.begin(), away.end()) - away.begin())));
  }
  return points;
}

}  // namespace ahm
