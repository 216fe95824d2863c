#include "cholesky/bisection.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <queue>
#include <utility>

namespace ahm {
namespace {

using Sides = std::vector<std::uint8_t>;

constexpr std::int32_t far_away = std::numeric_limits<std::int32_t>::max();

/// Vertices to move, best gain first, then lowest number.
using Moves = std::priority_queue<std::pair<std::int32_t, std::int32_t>>;

class Bisection {
 public:
  explicit Bisection(const WeightedGraph& graph)
      : graph_(graph), total_(std::accumulate(graph.weights.begin(), graph.weights.end(), std::int64_t{0})) {}

  Sides best() const {
    constexpr int starts = 2;
    Numbers distance(static_cast<std::size_t>(graph_.size()), far_away);
    std::int32_t start = farthest(distance, 0);
    std::ranges::fill(distance, far_away);
    Sides best;
    std::int64_t least = std::numeric_limits<std::int64_t>::max();
    for (int k = 0; k < starts; ++k) {
      Sides sides = grown_from(start);
      if (const std::int64_t cut = refine(sides); cut < least) least = cut, best = std::move(sides);
      start = farthest(distance, start);
    }
    return best;
  }

 private:
  /// Reduces the distances to the numbers of edges from `start`, and returns the farthest vertex.
  std::int32_t farthest(Numbers& distance, std::int32_t start) const {
    Numbers queue{start};
    distance[start] = 0;
    for (std::size_t k = 0; k < queue.size(); ++k)
      for (const std::int32_t w : graph_.graph.of(queue[k]))
        if (distance[w] > distance[queue[k]] + 1) distance[w] = distance[queue[k]] + 1, queue.push_back(w);
    return static_cast<std::int32_t>(std::ranges::max_element(distance) - distance.begin());
  }

  template <class Visit>
  void for_each_edge(std::int32_t vertex, const Visit& visit) const {
    for (std::int32_t e = graph_.graph.begin[vertex]; e < graph_.graph.begin[vertex + 1]; ++e)
      visit(graph_.graph.neighbors[e], graph_.edge_weights[e]);
  }

  /// Decrease of the cut if the vertex changes sides.
  std::int32_t gain(const Sides& sides, std::int32_t vertex) const {
    std::int32_t sum = 0;
    for_each_edge(vertex,
                  [&](std::int32_t w, std::int32_t weight) { sum += sides[w] != sides[vertex] ? weight : -weight; });
    return sum;
  }

  /// Moves vertices to side 0, beginning with `start`, until it has half of the weight or one vertex is left. The next vertex is the
  /// neighbor with the best gain.
  Sides grown_from(std::int32_t start) const {
    Sides sides(static_cast<std::size_t>(graph_.size()), 1);
    Moves moves;
    std::int64_t weight = 0;
    std::int32_t unreached = 0, left = graph_.size();
    for (std::int32_t vertex = start;;) {
      sides[vertex] = 0;
      weight += graph_.weights[vertex];
      if (2 * weight >= total_ || --left == 1) return sides;
      for_each_edge(vertex, [&](std::int32_t w, std::int32_t) {
        if (sides[w] == 1) moves.emplace(gain(sides, w), -w);
      });
      while (!moves.empty() && sides[-moves.top().second] == 0) moves.pop();
      if (moves.empty()) {  // the next component
        while (sides[unreached] == 0) ++unreached;
        vertex = unreached;
      } else {
        vertex = -moves.top().second;
        moves.pop();
      }
    }
  }

  /// Moves vertices while this decreases the cut.
  /// @return weight of the edges in the cut
  std::int64_t refine(Sides& sides) const {
    std::int64_t cut = 0;
    std::array<std::int64_t, 2> weight{};
    for (std::int32_t v = 0; v < graph_.size(); ++v) {
      weight[sides[v]] += graph_.weights[v];
      for_each_edge(v, [&](std::int32_t w, std::int32_t of_edge) { cut += sides[v] < sides[w] ? of_edge : 0; });
    }
    for (;;) {
      const std::int64_t gained = pass(sides, weight);
      if (gained == 0) return cut;
      cut -= gained;
    }
  }

  /// Moves each vertex at most once, best gain first, even if the cut increases for a while. Keeps the moves up to the smallest cut.
  /// @return decrease of the cut
  std::int64_t pass(Sides& sides, std::array<std::int64_t, 2>& weight) const {
    constexpr std::size_t patience = 60;  // moves without a smaller cut
    const double lightest = smallest_side * static_cast<double>(total_);
    Moves moves;
    Numbers gains(static_cast<std::size_t>(graph_.size())), done;
    std::vector<bool> moved(gains.size(), false);
    for (std::int32_t v = 0; v < graph_.size(); ++v) {
      gains[v] = gain(sides, v);
      if (std::ranges::any_of(graph_.graph.of(v), [&](std::int32_t w) { return sides[w] != sides[v]; }))
        moves.emplace(gains[v], -v);
    }
    std::int64_t gained = 0, most = 0;
    std::size_t kept = 0;
    const auto change_side = [&](std::int32_t v) {
      weight[sides[v]] -= graph_.weights[v];
      sides[v] ^= 1;
      weight[sides[v]] += graph_.weights[v];
    };
    while (!moves.empty() && done.size() < kept + patience) {
      const auto [value, negative] = moves.top();
      const std::int32_t v = -negative;
      moves.pop();
      if (moved[v] || value != gains[v] || static_cast<double>(weight[sides[v]] - graph_.weights[v]) < lightest)
        continue;
      change_side(v);
      moved[v] = true;
      done.push_back(v);
      gained += value;
      for_each_edge(v, [&](std::int32_t w, std::int32_t of_edge) {
        gains[w] += sides[w] == sides[v] ? -2 * of_edge : 2 * of_edge;
        if (!moved[w]) moves.emplace(gains[w], -w);
      });
      if (gained > most) most = gained, kept = done.size();
    }
    for (; done.size() > kept; done.pop_back()) change_side(done.back());
    return most;
  }

  const WeightedGraph& graph_;
  std::int64_t total_;
};

}  // namespace

std::vector<std::uint8_t> bisect(const WeightedGraph& graph) { return Bisection(graph).best(); }

}  // namespace ahm
