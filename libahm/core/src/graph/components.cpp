#include "ahm/graph/components.hpp"

#include "ahm/util/disjoint_sets.hpp"

namespace ahm {

Components connected_components(const TangentGraph& graph) {
  const Index n = graph.size();
  detail::DisjointSets sets(static_cast<std::size_t>(n));
  for (Index i = 0; i < n; ++i) {
    const Star star = graph.star(i);
    for (std::size_t e = 0; e < star.degree(); ++e)
      if (star.weights[e] != 0) sets.join(i, star.neighbors[e]);
  }
  Components result{std::vector<Index>(static_cast<std::size_t>(n)), 0};
  for (Index i = 0; i < n; ++i) {
    const Index root = sets.root(i);  // the smallest of the component
    result.of_vertex[i] = root == i ? result.count++ : result.of_vertex[root];
  }
  return result;
}

}  // namespace ahm
