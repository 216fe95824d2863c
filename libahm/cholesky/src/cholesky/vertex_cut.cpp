#include "cholesky/vertex_cut.hpp"

#include <algorithm>

namespace ahm {
namespace {

/// Disjoint paths from the first end to the second. Each vertex v is split into an entry 2 v and an exit 2 v + 1, joined by an arc of
/// capacity 1. Other arcs have no limit.
class DisjointPaths {
 public:
  DisjointPaths(const Adjacency& graph, std::span<const End> ends)
      : graph_(graph),
        ends_(ends),
        level_(2 * ends.size()),
        next_arc_(2 * ends.size()),
        after_(ends.size(), none),
        before_(ends.size(), none),
        used_(ends.size(), false) {
    while (find_levels()) add_paths();
  }

  std::vector<Part> parts() const {
    std::vector<Part> result(ends_.size());
    for (std::int32_t v = 0; v < graph_.size(); ++v)
      result[v] = level_[exit(v)] != none ? Part::first : level_[entry(v)] != none ? Part::cut : Part::second;
    return result;
  }

 private:
  static constexpr std::int32_t none = -1, target = -2;  ///< `target`: beyond the second end
  static std::int32_t entry(std::int32_t v) { return 2 * v; }
  static std::int32_t exit(std::int32_t v) { return 2 * v + 1; }

  /// The k-th residual arc of a node, `none` if it is saturated.
  std::int32_t arc(std::int32_t node, std::int32_t k) const {
    const std::int32_t v = node / 2;
    if (node == entry(v)) {
      if (k == 0) return used_[v] ? none : exit(v);
      return before_[v] == none ? none : exit(before_[v]);  // cancels the path before v
    }
    if (k == 0) return used_[v] ? entry(v) : none;  // cancels the path through v
    if (k == 1) return ends_[v] == End::second ? target : none;
    const std::int32_t w = graph_.of(v)[k - 2];
    return w == after_[v] ? none : entry(w);
  }
  std::int32_t arcs(std::int32_t node) const {
    const std::int32_t v = node / 2;
    return node == entry(v) ? 2 : 2 + static_cast<std::int32_t>(graph_.of(v).size());
  }

  /// Number of arcs from the first end to each node, up to the length of the shortest path. Returns whether there is a path.
  bool find_levels() {
    std::ranges::fill(level_, none);
    length_ = none;
    Numbers queue;
    const auto reach = [&](std::int32_t node, std::int32_t level) {
      if (level_[node] == none) level_[node] = level, queue.push_back(node);
    };
    for (std::int32_t v = 0; v < graph_.size(); ++v)
      if (ends_[v] == End::first) reach(entry(v), 0);
    for (std::size_t q = 0; q < queue.size(); ++q) {
      const std::int32_t node = queue[q];
      if (length_ != none && level_[node] >= length_) break;
      for (std::int32_t k = 0; k < arcs(node); ++k) {
        const std::int32_t to = arc(node, k);
        if (to == target)
          length_ = level_[node];
        else if (to != none)
          reach(to, level_[node] + 1);
      }
    }
    return length_ != none;
  }

  /// Adds paths of the smallest length until none is left.
  void add_paths() {
    std::ranges::fill(next_arc_, 0);
    Numbers path;
    for (std::int32_t v = 0; v < graph_.size(); ++v) {
      if (ends_[v] != End::first) continue;
      path.assign(1, entry(v));
      while (!path.empty()) {
        const std::int32_t node = path.back();
        if (next_arc_[node] == arcs(node)) {
          path.pop_back();
          continue;
        }
        const std::int32_t to = arc(node, next_arc_[node]++);
        if (to == target && level_[node] == length_) {
          add(path);
          break;
        }
        if (to >= 0 && level_[to] == level_[node] + 1) path.push_back(to);
      }
    }
  }

  void add(const Numbers& path) {
    for (std::size_t k = 0; k < path.size(); ++k) {
      const std::int32_t from = path[k], to = k + 1 < path.size() ? path[k + 1] : target, v = from / 2, w = to / 2;
      if (to == target) {
        after_[v] = none;
      } else if (v == w) {
        used_[v] = from == entry(v);
      } else if (from == exit(v)) {
        after_[v] = w;
        before_[w] = v;
      } else {  // the path from w to v is cancelled; others may have replaced its ends
        if (after_[w] == v) after_[w] = none;
        if (before_[v] == w) before_[v] = none;
      }
    }
  }

  const Adjacency& graph_;
  std::span<const End> ends_;
  Numbers level_, next_arc_;
  Numbers after_, before_;  ///< next and previous vertex of the path through a vertex
  std::vector<bool> used_;  ///< whether a path goes through the vertex
  std::int32_t length_ = none;
};

}  // namespace

std::vector<Part> smallest_vertex_cut(const Adjacency& graph, std::span<const End> ends) {
  return DisjointPaths(graph, ends).parts();
}

}  // namespace ahm
