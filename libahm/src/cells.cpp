#include "ahm/cells.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <queue>
#include <string>
#include <utility>

#include "ahm/detail/memory.hpp"
#include "ahm/error.hpp"
#include "inflow.hpp"
#include "small_math.hpp"

namespace ahm {
namespace {

constexpr Index nobody = -1;

void check_vertices(const TangentGraph& graph, std::span<const Index> vertices) {
  if (vertices.empty()) throw InvalidArgument("nearest_source: 'vertices' is empty");
  std::vector<bool> taken(static_cast<std::size_t>(graph.size()), false);
  for (Index vertex : vertices) {
    if (vertex < 0 || vertex >= graph.size())
      throw InvalidArgument("nearest_source: vertex " + std::to_string(vertex) + " is outside [0, " +
                            std::to_string(graph.size()) + ")");
    if (taken[static_cast<std::size_t>(vertex)])
      throw InvalidArgument("nearest_source: vertex " + std::to_string(vertex) + " is given twice");
    taken[static_cast<std::size_t>(vertex)] = true;
  }
}

/// Heat of those sources whose number has `bit` set (of all of them: bit < 0).
std::vector<double> heat_of(const LogMapSolver& solver, std::span<const Index> vertices, int bit, double b) {
  std::vector<double> heat(static_cast<std::size_t>(solver.graph().size()), 0.0);
  for (std::size_t k = 0; k < vertices.size(); ++k)
    if (bit < 0 || ((k >> bit) & 1U) != 0) heat[static_cast<std::size_t>(vertices[k])] = b;
  solver.operators().solve_scalar(heat, 1);
  return heat;
}

/// The number that most of the heat spells, bit by bit; `nobody` where there is no heat or no such source.
std::vector<Index> spell(const LogMapSolver& solver, std::span<const Index> vertices) {
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

/// Cells that grow by edge lengths (Dijkstra), each only over vertices spelled as its own or not at all.
class Growth {
 public:
  Growth(const TangentGraph& graph, std::span<const Index> vertices, std::vector<Index> spelled)
      : graph_(graph),
        spelled_(std::move(spelled)),
        label_(spelled_.size(), nobody),
        away_(spelled_.size(), std::numeric_limits<double>::infinity()) {
    for (std::size_t k = 0; k < vertices.size(); ++k) {
      label_[static_cast<std::size_t>(vertices[k])] = static_cast<Index>(k);
      away_[static_cast<std::size_t>(vertices[k])] = 0;
    }
  }

  void run() {
    for (std::size_t i = 0; i < label_.size(); ++i)
      if (label_[i] != nobody) queue_.emplace(away_[i], static_cast<Index>(i));
    while (!queue_.empty()) {
      const auto [d, i] = queue_.top();
      queue_.pop();
      if (d == away_[static_cast<std::size_t>(i)]) relax(i);
    }
  }

  /// Lets any cell take what has none yet; what has one keeps it.
  void open_the_rest() {
    for (std::size_t i = 0; i < label_.size(); ++i) spelled_[i] = label_[i];
  }

  std::vector<Index> take_labels() { return std::move(label_); }

 private:
  void relax(Index i) {
    const Index own = label_[static_cast<std::size_t>(i)];
    const Star star = graph_.star(i);
    for (std::size_t e = 0; e < star.degree(); ++e) {
      const auto j = static_cast<std::size_t>(star.neighbors[e]);
      if (spelled_[j] != nobody && spelled_[j] != own) continue;
      const double d = away_[static_cast<std::size_t>(i)] + length(star.log(e));
      if (!(d < away_[j])) continue;
      away_[j] = d;
      label_[j] = own;
      queue_.emplace(d, star.neighbors[e]);
    }
  }

  using Entry = std::pair<double, Index>;
  const TangentGraph& graph_;
  std::vector<Index> spelled_, label_;
  std::vector<double> away_;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
};

}  // namespace

std::vector<Index> nearest_source(const LogMapSolver& solver, std::span<const Index> vertices) {
  return detail::with_memory_check("labelling by the nearest source", [&] {
    check_vertices(solver.graph(), vertices);
    Growth cells(solver.graph(), vertices, spell(solver, vertices));
    cells.run();
    cells.open_the_rest();
    cells.run();
    return cells.take_labels();
  });
}

std::vector<Index> farthest_points(const LogMapSolver& solver, Index first, Index count, const MapOptions& options) {
  const Index n = solver.graph().size();
  if (first < 0 || first >= n)
    throw InvalidArgument("farthest_points: 'first' " + std::to_string(first) + " is outside [0, " + std::to_string(n) +
                          ")");
  if (count < 1 || count > n)
    throw InvalidArgument("farthest_points: 'count' " + std::to_string(count) + " must be in [1, " + std::to_string(n) +
                          "]");
  std::vector<Index> points{first};
  std::vector<double> away(static_cast<std::size_t>(n), std::numeric_limits<double>::infinity());
  while (points.size() < static_cast<std::size_t>(count)) {
    const LogMap map = solver.solve(Source::at_vertex(points.back()), options);
    for (Index i = 0; i < n; ++i)
      if (map.status(i) == Status::ok) {
        double& d = away[static_cast<std::size_t>(i)];
        d = std::min(d, map.distance(i));
      }
    for (Index point : points) away[static_cast<std::size_t>(point)] = -1;
    points.push_back(static_cast<Index>(std::max_element(away.begin(), away.end()) - away.begin()));
  }
  return points;
}

}  // namespace ahm
