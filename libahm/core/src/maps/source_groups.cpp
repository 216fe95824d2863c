#include "maps/source_groups.hpp"

#include "maps/ball.hpp"

namespace ahm {
namespace {

/// Sources that share a patch. Measured: more make the patch larger, fewer factor more often.
constexpr std::size_t group_size = 48;

}  // namespace

std::vector<std::vector<Index>> groups_of(const TangentGraph& graph, std::span<const Source> sources,
                                          const std::function<double(Index seed)>& reach) {
  const auto n = static_cast<std::size_t>(graph.size());
  SparseArray<Index> first(n);  // 1 + the first source at a vertex that has no group yet
  std::vector<Index> after(sources.size(), -1);
  for (auto s = static_cast<Index>(sources.size()); s-- > 0;) {
    Index& head = first[sources[s].vertices().front().index];
    after[s] = head - 1;
    head = s + 1;
  }
  std::vector<std::uint8_t> grouped(sources.size(), 0);
  std::vector<std::vector<Index>> groups;
  Ball ball(graph);
  for (std::size_t seed = 0; seed < sources.size(); ++seed) {
    if (grouped[seed]) continue;
    std::vector<Index> members;
    ball.grow(sources[seed].vertices().first(1), reach(static_cast<Index>(seed)), [&](Index vertex, double) {
      for (Index s = first[vertex] - 1; s >= 0; s = first[vertex] - 1) {
        if (members.size() == group_size) return false;
        members.push_back(s);
        grouped[s] = 1;
        first[vertex] = after[s] + 1;
      }
      return members.size() < group_size;
    });
    groups.push_back(std::move(members));
  }
  return groups;
}

}  // namespace ahm
