#include "spanning_trees.hpp"

#include <algorithm>

#include "ahm/util/disjoint_sets.hpp"
#include "ahm/util/vec.hpp"
#include "orientation.hpp"

namespace ahm::distributed {
namespace {

/// An edge within the tile, places in the surroundings.
struct Inner {
  float bend;
  Index a, b;
  signed char turn;
};

signed char sign_of(double value) { return static_cast<signed char>((value > 0) - (value < 0)); }
signed char relative(signed char turn) { return turn < 0 ? -1 : 1; }
signed char product(signed char a, signed char b) { return static_cast<signed char>(a * b); }

}  // namespace

TileTrees tile_trees(const AroundFile& around, std::span<const Index> tails, std::span<const Index> heads) {
  const Index n = around.end - around.begin;
  const auto& normals = around.planes.normals;
  std::vector<Inner> inner;
  TileTrees result;
  std::vector<char> leads_out(static_cast<std::size_t>(n), 0);
  const auto add_joint = [&](float bend, Index tail, Index head, signed char turn, bool leaves) {
    result.joints.push_back(
        {bend, around.numbers[tail], around.numbers[head], 0, around.numbers[head], 0, turn, 0, leaves});
  };
  for (std::size_t e = 0; e < tails.size(); ++e) {
    const Index a = tails[e], b = heads[e];
    const float bend = pointcloud::bend(normals[a], normals[b]);
    const signed char turn = sign_of(dot(normals[a], normals[b]));
    if (around.is_own(a) && around.is_own(b)) {
      inner.push_back({bend, a, b, turn});
      continue;
    }
    leads_out[(around.is_own(a) ? a : b) - around.begin] = 1;
    if (around.is_own(a)) add_joint(bend, a, b, turn, true);
  }
  std::stable_sort(inner.begin(), inner.end(), [](const Inner& p, const Inner& q) { return p.bend < q.bend; });

  pointcloud::SignedForest sets(n);  // joined for certain
  detail::DisjointSets joined(static_cast<std::size_t>(n));
  std::vector<char> open = leads_out;  // sets with edges to other tiles, by their smallest members
  for (const Inner& edge : inner) {
    const Index a = edge.a - around.begin, b = edge.b - around.begin;
    if (joined.root(a) == joined.root(b)) continue;
    joined.join(a, b);
    const bool from = open[sets.find(a).vertex], to = open[sets.find(b).vertex];
    if (from && to) {
      add_joint(edge.bend, edge.a, edge.b, edge.turn, false);
      continue;
    }
    sets.join(a, b, relative(edge.turn));
    open[sets.find(a).vertex] = from || to;
  }
  const Index first = around.numbers[around.begin];
  for (Index i = 0; i < n; ++i) {
    const auto [root, sign] = sets.find(i);
    result.root.push_back(first + root);
    result.sign.push_back(sign);
    if (leads_out[i]) result.terminals.push_back({first + i, first + root, sign});
  }
  for (Joint& joint : result.joints) {  // in which sets their ends are is known only now
    joint.from = result.root[joint.tail - first];
    joint.inward = result.sign[joint.tail - first];
    joint.sign = product(joint.inward, relative(joint.turn));
    if (joint.leaves) continue;
    joint.to = result.root[joint.head - first];
    joint.sign = product(joint.sign, result.sign[joint.head - first]);
  }
  return result;
}

}  // namespace ahm::distributed
