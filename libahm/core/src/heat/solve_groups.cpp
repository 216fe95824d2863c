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

/// Of every supernode's whole subtree.
struct Subtrees {
  std::vector<Offset> first;    ///< the least descendant
  std::vector<Offset> numbers;  ///< of the factor
};

Subtrees subtrees_of(const SupernodalFactor& L, const SupernodeTree& tree) {
  Subtrees subtrees;
  subtrees.first.resize(tree.parent.size());
  std::iota(subtrees.first.begin(), subtrees.first.end(), Offset{0});
  subtrees.numbers.resize(tree.parent.size());
  for (std::size_t s = 0; s < tree.parent.size(); ++s) {
    subtrees.numbers[s] += L.value_begin[s + 1] - L.value_begin[s];
    const Offset parent = tree.parent[s];
    if (parent < 0) continue;
    subtrees.first[parent] = std::min(subtrees.first[parent], subtrees.first[s]);
    subtrees.numbers[parent] += subtrees.numbers[s];
  }
  return subtrees;
}

/// The roots of the subtrees that are left when those larger than a group should be are taken apart, largest first.
std::vector<Offset> roots_below_top(const SupernodeTree& tree, const std::vector<Offset>& numbers,
                                    std::vector<bool>& is_top) {
  std::priority_queue<std::pair<Offset, Offset>> waiting;  // numbers, supernode
  Offset all = 0;
  for (std::size_t s = 0; s < tree.parent.size(); ++s)
    if (tree.parent[s] < 0) waiting.emplace(numbers[s], static_cast<Offset>(s)), all += numbers[s];
  while (!waiting.empty() && waiting.top().first > all / static_cast<Offset>(groups)) {
    const Offset root = waiting.top().second;
    waiting.pop();
    is_top[root] = true;
    for (const Offset child : tree.children_of(root)) waiting.emplace(numbers[child], child);
  }
  std::vector<Offset> roots;
  for (; !waiting.empty(); waiting.pop()) roots.push_back(waiting.top().second);
  return roots;
}

}  // namespace

void SupernodeTree::find_children() {
  child_begin.assign(parent.size() + 1, 0);
  for (const Offset p : parent)
    if (p >= 0) ++child_begin[p + 1];
  std::partial_sum(child_begin.begin(), child_begin.end(), child_begin.begin());
  children.resize(static_cast<std::size_t>(child_begin.back()));
  std::vector<Offset> next(child_begin.begin(), child_begin.end() - 1);
  for (std::size_t s = 0; s < parent.size(); ++s)
    if (parent[s] >= 0) children[next[parent[s]]++] = static_cast<Offset>(s);
}

std::unique_ptr<const SolveGroups> solve_groups(const SupernodalFactor& L, const SupernodeTree& tree) {
  if (L.value_begin.back() < least_numbers) return nullptr;
  const Subtrees subtrees = subtrees_of(L, tree);
  std::vector<bool> is_top(tree.parent.size(), false);
  const std::vector<Offset> roots = roots_below_top(tree, subtrees.numbers, is_top);

  std::vector<std::vector<Offset>> of_group(groups);
  std::vector<Offset> work(groups, 0);
  for (const Offset root : roots) {
    const auto least = std::min_element(work.begin(), work.end()) - work.begin();
    of_group[least].push_back(root);
    work[least] += subtrees.numbers[root];
  }
  auto result = std::make_unique<SolveGroups>();
  result->begin = {0};
  for (std::vector<Offset>& own : of_group) {
    std::sort(own.begin(), own.end());
    for (const Offset root : own) result->subtrees.push_back({subtrees.first[root], root + 1, L.super[root + 1]});
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
