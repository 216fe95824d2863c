#include "heat/solve_groups.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

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

Subtrees subtrees_of(const SupernodalFactor& L, std::span<const Offset> parents) {
  Subtrees subtrees;
  subtrees.first.resize(parents.size());
  std::iota(subtrees.first.begin(), subtrees.first.end(), Offset{0});
  subtrees.numbers.resize(parents.size());
  for (std::size_t s = 0; s < parents.size(); ++s) {
    subtrees.numbers[s] += L.value_begin[s + 1] - L.value_begin[s];
    const Offset parent = parents[s];
    if (parent < 0) continue;
    subtrees.first[parent] = std::min(subtrees.first[parent], subtrees.first[s]);
    subtrees.numbers[parent] += subtrees.numbers[s];
  }
  return subtrees;
}

}  // namespace

std::unique_ptr<const SolveGroups> solve_groups(const SupernodalFactor& L, std::span<const Offset> parent) {
  const Offset all = L.value_begin.back();
  if (all < least_numbers) return nullptr;
  const Subtrees subtrees = subtrees_of(L, parent);
  const auto is_top = [&](Offset s) { return subtrees.numbers[s] > all / static_cast<Offset>(groups); };
  const auto supernodes = static_cast<Offset>(parent.size());
  std::vector<Offset> roots;  // of the subtrees below the top, the largest first
  for (Offset s = supernodes; s-- > 0;)
    if (!is_top(s) && (parent[s] < 0 || is_top(parent[s]))) roots.push_back(s);
  std::stable_sort(roots.begin(), roots.end(),
                   [&](Offset a, Offset b) { return subtrees.numbers[a] > subtrees.numbers[b]; });

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
  for (Offset s = 0; s < supernodes; ++s) {
    if (!is_top(s)) continue;
    result->top.push_back(s);
    for (Offset row = L.super[s]; row < L.super[s + 1]; ++row)
      result->place[row] = static_cast<std::int32_t>(result->top_rows++);
  }
  return result;
}

}  // namespace ahm
