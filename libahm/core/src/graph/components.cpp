#include "ahm/graph/components.hpp"

namespace ahm {

Components connected_components(const TangentGraph& graph) {
  const Index n = graph.size();
  Components result{std::vector<Index>(static_cast<std::size_t>(n), -1), 0};
  std::vector<Index> stack;
  for (Index seed = 0; seed < n; ++seed) {
    if (result.of_vertex[seed] >= 0) continue;
    const Index component = result.count++;
    auto visit = [&](Index vertex) {
      Index& mark = result.of_vertex[vertex];
      if (mark >= 0) return;
      mark = component;
      stack.push_back(vertex);
    };
    visit(seed);
    while (!stack.empty()) {
      const Index vertex = stack.back();
      stack.pop_back();
      const Star star = graph.star(vertex);
      for (std::size_t e = 0; e < star.degree(); ++e)
        if (star.weights[e] != 0) visit(star.neighbors[e]);
    }
  }
  return result;
}

}  // namespace ahm
