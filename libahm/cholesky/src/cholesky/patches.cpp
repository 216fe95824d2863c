#include "cholesky/patches.hpp"

#include <vector>

namespace ahm {
namespace {

/// Balls of up to `size` vertices, one after another. Each begins at the border of those before.
Patches balls(const Adjacency& graph, std::int32_t size) {
  Patches result{Numbers(static_cast<std::size_t>(graph.size()), -1)};
  Numbers border, ball;
  std::size_t next = 0;
  const auto grow = [&](std::int32_t seed) {
    if (result.of_vertex[seed] >= 0) return;
    ball.assign(1, seed);
    result.of_vertex[seed] = result.count;
    for (std::size_t k = 0; k < ball.size(); ++k)
      for (const std::int32_t w : graph.of(ball[k])) {
        if (result.of_vertex[w] >= 0) continue;
        if (static_cast<std::int32_t>(ball.size()) == size) {
          border.push_back(w);
        } else {
          result.of_vertex[w] = result.count;
          ball.push_back(w);
        }
      }
    ++result.count;
  };
  for (std::int32_t v = 0; v < graph.size(); ++v) {
    grow(v);
    for (; next < border.size(); ++next) grow(border[next]);
  }
  return result;
}

/// The vertex of each patch that is farthest from its border, and the number of vertices.
struct Centers {
  Numbers vertex, weight;
};

Centers centers_of(const Adjacency& graph, const Patches& patches) {
  Centers centers{Numbers(static_cast<std::size_t>(patches.count), -1),
                  Numbers(static_cast<std::size_t>(patches.count), 0)};
  Numbers queue;
  std::vector<bool> seen(patches.of_vertex.size(), false);
  for (std::int32_t v = 0; v < graph.size(); ++v) {
    const std::int32_t own = patches.of_vertex[v];
    centers.vertex[own] = v;  // for patches without a border
    ++centers.weight[own];
    for (const std::int32_t w : graph.of(v))
      if (patches.of_vertex[w] != own) {
        seen[v] = true;
        queue.push_back(v);
        break;
      }
  }
  for (std::size_t k = 0; k < queue.size(); ++k) {
    const std::int32_t own = patches.of_vertex[queue[k]];
    centers.vertex[own] = queue[k];
    for (const std::int32_t w : graph.of(queue[k]))
      if (!seen[w] && patches.of_vertex[w] == own) seen[w] = true, queue.push_back(w);
  }
  return centers;
}

/// Gives each vertex to the nearest center. Patches much smaller than `size` disappear unless they are a component.
Patches grown_again(const Adjacency& graph, const Patches& patches, std::int32_t size) {
  const Centers centers = centers_of(graph, patches);
  Patches result{Numbers(patches.of_vertex.size(), -1)};
  Numbers queue;
  const auto begin = [&](std::int32_t seed) {
    result.of_vertex[seed] = result.count++;
    queue.push_back(seed);
  };
  for (std::int32_t p = 0; p < patches.count; ++p)
    if (centers.weight[p] >= size / 4) begin(centers.vertex[p]);
  std::size_t next = 0;
  for (std::int32_t v = 0;; ++v) {
    for (; next < queue.size(); ++next)
      for (const std::int32_t w : graph.of(queue[next]))
        if (result.of_vertex[w] < 0) result.of_vertex[w] = result.of_vertex[queue[next]], queue.push_back(w);
    while (v < graph.size() && result.of_vertex[v] >= 0) ++v;
    if (v == graph.size()) return result;
    begin(v);
  }
}

}  // namespace

Patches patches_of(const Adjacency& graph, std::int32_t size) {
  Patches patches = balls(graph, size);
  for (int k = 0; k < 2; ++k) patches = grown_again(graph, patches, size);
  return patches;
}

}  // namespace ahm
