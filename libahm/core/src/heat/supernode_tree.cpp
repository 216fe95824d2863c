#include "heat/supernode_tree.hpp"

#include <algorithm>
#include <numeric>

namespace ahm {

SupernodeTree supernode_tree(const SupernodalFactor& L) {
  const auto n = static_cast<Offset>(L.super.size()) - 1;
  std::vector<Offset> supernode_of(static_cast<std::size_t>(L.size));
  for (Offset s = 0; s < n; ++s) std::fill(supernode_of.begin() + L.super[s], supernode_of.begin() + L.super[s + 1], s);
  SupernodeTree tree;
  tree.parent.assign(static_cast<std::size_t>(n), -1);
  tree.child_begin.assign(static_cast<std::size_t>(n) + 1, 0);
  for (Offset s = 0; s < n; ++s) {
    const Offset below = L.row_begin[s] + L.super[s + 1] - L.super[s];
    if (below == L.row_begin[s + 1]) continue;
    tree.parent[s] = supernode_of[L.indices[below]];
    ++tree.child_begin[tree.parent[s] + 1];
  }
  std::partial_sum(tree.child_begin.begin(), tree.child_begin.end(), tree.child_begin.begin());
  tree.children.resize(static_cast<std::size_t>(tree.child_begin.back()));
  std::vector<Offset> next(tree.child_begin.begin(), tree.child_begin.end() - 1);
  for (Offset s = 0; s < n; ++s)
    if (tree.parent[s] >= 0) tree.children[next[tree.parent[s]]++] = s;
  return tree;
}

}  // namespace ahm
