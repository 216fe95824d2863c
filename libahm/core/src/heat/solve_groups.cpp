#include "heat/solve_groups.hpp"

#include <algorithm>
#include <numeric>
#include <queue>
#include <tuple>
#include <utility>

namespace ahm {
namespace {

/// Smaller factors are read in less time than threads take to begin.
constexpr Offset least_numbers = 1 << 19;
/// More make the top, which one thread goes through, larger.
constexpr std::size_t groups = 4;

/// The elimination tree of the supernodes.
struct Tree {
  std::vector<Offset> parent;   ///< -1: of a root
  std::vector<Offset> first;    ///< the least descendant
  std::vector<Offset> numbers;  ///< of the factor, in the whole subtree
  bool is_postordered = true;
};

Tree tree_of(const SupernodalFactor& L) {
  const auto n = static_cast<Offset>(L.super.size()) - 1;
  std::vector<Offset> supernode_of(static_cast<std::size_t>(L.size));
  for (Offset s = 0; s < n; ++s) std::fill(supernode_of.begin() + L.super[s], supernode_of.begin() + L.super[s + 1], s);
  Tree tree;
  tree.parent.assign(static_cast<std::size_t>(n), -1);
  tree.first.resize(tree.parent.size());
  std::iota(tree.first.begin(), tree.first.end(), Offset{0});
  tree.numbers.resize(tree.parent.size());
  std::vector<Offset> descendants(tree.parent.size(), 1);
  for (Offset s = 0; s < n; ++s) {
    tree.numbers[s] += L.value_begin[s + 1] - L.value_begin[s];
    tree.is_postordered &= s - tree.first[s] + 1 == descendants[s];
    const Offset below = L.row_begin[s] + L.super[s + 1] - L.super[s];
    if (below == L.row_begin[s + 1]) continue;
    const Offset parent = supernode_of[L.indices[below]];
    tree.is_postordered &= parent > s;
    if (!tree.is_postordered) break;
    tree.parent[s] = parent;
    tree.first[parent] = std::min(tree.first[parent], tree.first[s]);
    tree.numbers[parent] += tree.numbers[s];
    descendants[parent] += descendants[s];
  }
  return tree;
}

/// The roots of the subtrees that are left when those larger than a group should be are taken apart, largest first.
std::vector<Offset> roots_below_top(const Tree& tree, std::vector<bool>& is_top) {
  const auto n = static_cast<Offset>(tree.parent.size());
  std::vector<std::vector<Offset>> children(tree.parent.size());
  std::priority_queue<std::pair<Offset, Offset>> waiting;  // numbers, supernode
  Offset all = 0;
  for (Offset s = 0; s < n; ++s) {
    if (tree.parent[s] >= 0)
      children[tree.parent[s]].push_back(s);
    else
      waiting.emplace(tree.numbers[s], s), all += tree.numbers[s];
  }
  while (!waiting.empty() && waiting.top().first > all / static_cast<Offset>(groups)) {
    const Offset root = waiting.top().second;
    waiting.pop();
    is_top[root] = true;
    for (const Offset child : children[root]) waiting.emplace(tree.numbers[child], child);
  }
  std::vector<Offset> roots;
  for (; !waiting.empty(); waiting.pop()) roots.push_back(waiting.top().second);
  return roots;
}

}  // namespace

std::unique_ptr<const SolveGroups> solve_groups(const SupernodalFactor& L) {
  if (L.value_begin.back() < least_numbers) return nullptr;
  const Tree tree = tree_of(L);
  if (!tree.is_postordered) return nullptr;
  std::vector<bool> is_top(tree.parent.size(), false);
  const std::vector<Offset> roots = roots_below_top(tree, is_top);

  std::vector<std::vector<Offset>> of_group(groups);
  std::vector<Offset> work(groups, 0);
  for (const Offset root : roots) {
    const auto least = std::min_element(work.begin(), work.end()) - work.begin();
    of_group[least].push_back(root);
    work[least] += tree.numbers[root];
  }
  auto result = std::make_unique<SolveGroups>();
  result->begin = {0};
  for (std::vector<Offset>& own : of_group) {
    std::sort(own.begin(), own.end());
    for (const Offset root : own) result->subtrees.push_back({tree.first[root], root + 1, L.super[root + 1]});
    result->begin.push_back(result->subtrees.size());
  }
  result->place.assign(static_cast<std::size_t>(L.size), -1);
  for (std::size_t s = 0; s < is_top.size(); ++s) {
    if (!is_top[s]) continue;
    result->top.push_back(static_cast<Offset>(s));
    for (Offset row = L.super[s]; row < L.super[s + 1]; ++row)
      result->place[row] = static_cast<std::int32_t>(result->top_rows++);
  }
  return result;
}

}  // namespace ahm
