#include "cholesky/supernodal_pattern.hpp"

#include <numeric>
#include <utility>

#include "ahm/util/buckets.hpp"

namespace ahm {
namespace {

/// Smaller factors have no groups: starting threads takes longer than reading the factor.
constexpr Offset min_entries = 1 << 19;
/// Number of groups. More groups make the top larger, whose supernodes are processed one after another.
constexpr std::size_t groups = 4;

/// The subtree of each supernode in the elimination tree.
struct Subtrees {
  std::vector<Offset> first;    ///< smallest supernode of the subtree
  std::vector<Offset> numbers;  ///< entries of the factor in the subtree
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
  if (all < min_entries) return nullptr;
  const Subtrees subtrees = subtrees_of(L, parent);
  const auto is_top = [&](Offset s) { return subtrees.numbers[s] > all / static_cast<Offset>(groups); };
  const auto supernodes = static_cast<Offset>(parent.size());
  std::vector<Offset> roots;  // roots of the subtrees below the top, largest first
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

namespace {

Numbers inverse(const Numbers& order) {
  Numbers place(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) place[order[k]] = static_cast<std::int32_t>(k);
  return place;
}

/// Groups the entries of a matrix by the position of their row or column in elimination order.
/// @param place   position of each row in elimination order
/// @param key     key(i, j): group of the entry with row position i and column position j
/// @param member  member(i, j, p): what to store for entry p of the matrix
template <class Member, class Key, class MemberOf>
EntriesBy<Member> entries_by(const SparseUpper& matrix, const Numbers& place, const Key& key, const MemberOf& member) {
  const auto for_each_entry = [&](const auto& visit) {
    for (Offset j = 0; j < matrix.size(); ++j)
      for (Offset p = matrix.column_begin[j]; p < matrix.column_begin[j + 1]; ++p)
        visit(place[matrix.rows[p]], place[j], p);
  };
  EntriesBy<Member> result;
  result.begin.assign(static_cast<std::size_t>(matrix.size()) + 1, 0);
  for_each_entry([&](std::int32_t i, std::int32_t j, Offset) { ++result.begin[key(i, j) + 1]; });
  result.begin = detail::begin_of_groups(std::move(result.begin));
  result.members.resize(matrix.rows.size());
  std::vector<Offset> next(result.begin.begin(), result.begin.end() - 1);
  for_each_entry(
      [&](std::int32_t i, std::int32_t j, Offset p) { result.members[next[key(i, j)]++] = member(i, j, p); });
  return result;
}

/// Columns of each row of the matrix up to the diagonal, in elimination order.
using EarlierColumns = EntriesBy<std::int32_t>;

EarlierColumns earlier_columns(const SparseUpper& matrix, const Numbers& place) {
  const auto later = [](std::int32_t i, std::int32_t j) { return std::max(i, j); };
  return entries_by<std::int32_t>(matrix, place, later,
                                  [](std::int32_t i, std::int32_t j, Offset) { return std::min(i, j); });
}

FactorEntries factor_entries(const SparseUpper& matrix, const Numbers& place) {
  const auto earlier = [](std::int32_t i, std::int32_t j) { return std::min(i, j); };
  return entries_by<FactorEntry>(matrix, place, earlier, [](std::int32_t i, std::int32_t j, Offset p) {
    return FactorEntry{std::max(i, j), i < j ? ~p : p};
  });
}

/// Parent of each column in the elimination tree [Liu90]; -1: root.
Numbers elimination_tree(const EarlierColumns& before, std::int32_t n) {
  Numbers parent(static_cast<std::size_t>(n), -1), ancestor(parent);
  for (std::int32_t row = 0; row < n; ++row)
    for (std::int32_t column : before.of(row))
      while (column != -1 && column != row) {
        const std::int32_t next = ancestor[column];
        ancestor[column] = row;
        if (next == -1) parent[column] = row;
        column = next;
      }
  return parent;
}

/// Columns in postorder: children before parents, subtrees contiguous.
Numbers postorder(const Numbers& parent) {
  const auto n = static_cast<std::int32_t>(parent.size());
  Numbers first_child(parent.size(), -1), next_sibling(parent.size(), -1), order, waiting;
  for (std::int32_t k = n; k-- > 0;)
    if (parent[k] >= 0) next_sibling[k] = std::exchange(first_child[parent[k]], k);
  order.reserve(parent.size());
  for (std::int32_t root = 0; root < n; ++root) {
    if (parent[root] >= 0) continue;
    waiting.push_back(root);
    while (!waiting.empty()) {
      const std::int32_t k = waiting.back();
      if (const std::int32_t child = first_child[k]; child >= 0) {
        first_child[k] = next_sibling[child];
        waiting.push_back(child);
      } else {
        order.push_back(k);
        waiting.pop_back();
      }
    }
  }
  return order;
}

/// Number of rows of each column of the factor, including the diagonal [GNP94]. Columns must be in postorder.
class ColumnCounts {
 public:
  ColumnCounts(const FactorEntries& entries, const Numbers& parent)
      : first_(parent.size(), -1), most_(parent.size(), -1), last_leaf_(parent.size(), -1), ancestor_(parent.size()) {
    const auto n = static_cast<std::int32_t>(parent.size());
    std::iota(ancestor_.begin(), ancestor_.end(), 0);
    counts.resize(parent.size());
    for (std::int32_t j = 0; j < n; ++j) {
      counts[j] = first_[j] == -1 ? 1 : 0;
      for (std::int32_t k = j; k != -1 && first_[k] == -1; k = parent[k]) first_[k] = j;
    }
    for (std::int32_t j = 0; j < n; ++j) {
      if (parent[j] != -1) --counts[parent[j]];
      for (const auto& entry : entries.of(j)) add_leaf(entry.row, j);
      if (parent[j] != -1) ancestor_[j] = parent[j];
    }
    for (std::int32_t j = 0; j < n; ++j)
      if (parent[j] != -1) counts[parent[j]] += counts[j];
  }
  Numbers counts;

 private:
  /// Adds entry (i, j) of the matrix. If column j is a leaf of row i's subtree, its count increases by one. For all leaves except the
  /// first, the count of the lowest common ancestor with the previous leaf decreases by one.
  void add_leaf(std::int32_t i, std::int32_t j) {
    if (i <= j || first_[j] <= most_[i]) return;
    most_[i] = first_[j];
    ++counts[j];
    const std::int32_t before = std::exchange(last_leaf_[i], j);
    if (before == -1) return;
    std::int32_t common = before;
    while (common != ancestor_[common]) common = ancestor_[common];
    for (std::int32_t k = before; k != common;) k = std::exchange(ancestor_[k], common);
    --counts[common];
  }

  Numbers first_, most_, last_leaf_, ancestor_;
};

/// Consecutive columns that form a chain of the elimination tree: a supernode. Each column is the only child of the next one, and has
/// the same rows and one more.
struct Run {
  std::int32_t first, columns, rows;
  double zeros = 0;  ///< explicit zeros added by merging

  /// Merges the preceding run, whose last column is a child of this run's first column, if this adds few explicit zeros.
  /// @return whether the runs were merged
  bool join(const Run& child) {
    const double more = static_cast<double>(child.columns) * (child.columns + rows - child.rows), all = zeros + more;
    const double width = child.columns + columns, size = width * (width + 1) / 2 + width * (rows - columns);
    const double share = all / size;
    if (width > 4 && more > 0 && !(width <= 16 && share < 0.8) && !(width <= 48 && share < 0.1) && !(share < 0.05))
      return false;
    *this = {child.first, child.columns + columns, child.columns + rows, all};
    return true;
  }
};

std::vector<Run> runs_of(const Numbers& parent, const Numbers& counts) {
  const auto n = static_cast<std::int32_t>(parent.size());
  Numbers children(parent.size(), 0);
  for (const std::int32_t p : parent)
    if (p >= 0) ++children[p];
  std::vector<Run> runs;
  for (std::int32_t j = 0; j < n; ++j) {
    if (j > 0 && parent[j - 1] == j && counts[j - 1] == counts[j] + 1 && children[j] == 1)
      ++runs.back().columns;
    else
      runs.push_back({j, 1, counts[j]});
  }
  std::vector<Run> joined;  // in reverse order
  for (auto run = runs.rbegin(); run != runs.rend(); ++run)
    if (joined.empty() || parent[run->first + run->columns - 1] != joined.back().first || !joined.back().join(*run))
      joined.push_back(*run);
  std::reverse(joined.begin(), joined.end());
  return joined;
}

/// Computes the rows of each supernode. Rows are appended in ascending order. Each row belongs to all supernodes on the tree paths
/// from the supernodes of its columns to its own.
/// @param post   columns in postorder
/// @param place  position of each column in `post`
void find_indices(SupernodalPattern& pattern, const Numbers& supernode_of, const EarlierColumns& before,
                  const Numbers& post, const Numbers& place) {
  const auto n = static_cast<std::int32_t>(supernode_of.size());
  pattern.indices.resize(static_cast<std::size_t>(pattern.row_begin.back()));
  std::vector<Offset> next(pattern.row_begin.begin(), pattern.row_begin.end() - 1);
  Numbers seen(next.size(), -1);
  for (std::size_t s = 0; s < next.size(); ++s)
    for (auto row = static_cast<std::int32_t>(pattern.super[s]); row < pattern.super[s + 1]; ++row)
      pattern.indices[next[s]++] = row;
  for (std::int32_t row = 0; row < n; ++row) {
    seen[supernode_of[row]] = row;
    for (const std::int32_t column : before.of(post[row]))
      for (Offset s = supernode_of[place[column]]; seen[s] != row; s = pattern.parent[s]) {
        seen[s] = row;
        pattern.indices[next[s]++] = row;
      }
  }
}

}  // namespace

SymbolicAnalysis analyze(const SparseUpper& matrix, const Numbers& order) {
  const auto n = static_cast<std::int32_t>(matrix.size());
  const EarlierColumns before = earlier_columns(matrix, inverse(order));
  Numbers parent = elimination_tree(before, n);
  const Numbers post = postorder(parent), place = inverse(post);

  SupernodalPattern pattern;
  for (const std::int32_t k : post) pattern.permutation.push_back(order[k]);
  Numbers tree(parent.size(), -1);
  for (std::int32_t k = 0; k < n; ++k)
    if (parent[k] >= 0) tree[place[k]] = place[parent[k]];
  FactorEntries entries = factor_entries(matrix, inverse(pattern.permutation));
  const ColumnCounts columns(entries, tree);
  for (const double count : columns.counts) pattern.operations += count * count;

  pattern.super = pattern.row_begin = pattern.value_begin = {0};
  Numbers supernode_of(parent.size());
  for (const Run& run : runs_of(tree, columns.counts)) {
    std::fill_n(supernode_of.begin() + run.first, run.columns, static_cast<std::int32_t>(pattern.super.size()) - 1);
    pattern.super.push_back(run.first + run.columns);
    pattern.row_begin.push_back(pattern.row_begin.back() + run.rows);
    pattern.value_begin.push_back(pattern.value_begin.back() + static_cast<Offset>(run.rows) * run.columns);
  }
  for (std::size_t s = 0; s + 1 < pattern.super.size(); ++s) {
    const std::int32_t above = tree[pattern.super[s + 1] - 1];
    pattern.parent.push_back(above < 0 ? -1 : supernode_of[above]);
  }
  find_indices(pattern, supernode_of, before, post, place);
  pattern.groups = solve_groups(pattern.factor(false, nullptr), pattern.parent);
  return {std::move(pattern), std::move(entries)};
}

}  // namespace ahm
