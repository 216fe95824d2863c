#include "orientation.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "ahm/util/buckets.hpp"
#include "ahm/util/parallel.hpp"
#include "ahm/util/vec.hpp"

namespace ahm::pointcloud {
namespace {

/// An edge between two trees of the forest, given by their roots.
struct Bridge {
  Index root, other;
  float bend;
  signed char sign;  ///< sign of one root's normal relative to the other's
};

/// Sign of a normal relative to another one.
signed char relative_sign(const Vec3& normal, const Vec3& other) {
  return static_cast<signed char>(dot(normal, other) < 0 ? -1 : 1);
}

std::vector<Bridge> bridges(const WeightedEdges& edges, const TangentPlanes& planes, unsigned threads) {
  std::vector<Bridge> result(edges.tails.size());
  detail::for_each_index(result.size(), threads, [&](std::size_t e) {
    const Index a = edges.tails[e], b = edges.heads[e];
    const Vec3 &normal = planes.normals[a], &other = planes.normals[b];
    result[e] = {a, b, bend(normal, other), relative_sign(normal, other)};
  });
  return result;
}

/// Spanning forest of the flattest edges, by Boruvka's algorithm: each tree takes the flattest edge that leaves it, until no
/// edge leaves a tree. Of equally flat edges it takes the first.
SignedForest flattest_forest(Index n, std::vector<Bridge> bridges) {
  SignedForest forest(n);
  constexpr auto none = static_cast<std::size_t>(-1);
  std::vector<std::size_t> flattest(static_cast<std::size_t>(n), none);
  while (!bridges.empty()) {
    for (std::size_t e = 0; e < bridges.size(); ++e)
      for (const Index root : {bridges[e].root, bridges[e].other})
        if (std::size_t& best = flattest[root]; best == none || bridges[e].bend < bridges[best].bend) best = e;
    for (const Bridge& bridge : bridges)
      for (const Index root : {bridge.root, bridge.other})
        if (const std::size_t best = std::exchange(flattest[root], none); best != none)
          forest.join(bridges[best].root, bridges[best].other, bridges[best].sign);
    std::size_t left = 0;
    for (const Bridge& bridge : bridges) {
      const auto [root, sign] = forest.find(bridge.root);
      const auto [other, other_sign] = forest.find(bridge.other);
      if (root != other)
        bridges[left++] = {root, other, bridge.bend, static_cast<signed char>(sign * bridge.sign * other_sign)};
    }
    bridges.resize(left);
  }
  return forest;
}

/// A spanning forest if the signs agree around every loop of edges: the signs relative to the roots are then the same in all
/// spanning forests. None if a loop disagrees. Grows trees within several ranges of points in parallel, then adds the edges
/// between ranges.
std::optional<SignedForest> undisputed_forest(Index n, const WeightedEdges& edges, const TangentPlanes& planes,
                                              unsigned threads) {
  SignedForest forest(n);
  std::atomic<bool> disputed{false};
  std::vector<char> is_between(edges.tails.size(), 0);  // whether an edge joins two ranges
  const auto join = [&](Index a, Index b) {
    const signed char sign = relative_sign(planes.normals[a], planes.normals[b]);
    if (!forest.join(a, b, sign) && forest.find(a).sign * forest.find(b).sign != sign) disputed = true;
  };
  detail::for_key_ranges(n, threads, [&](Offset from, Offset to) {
    for (std::size_t e = 0; e < edges.tails.size() && !disputed; ++e) {
      const Index a = edges.tails[e], b = edges.heads[e];
      if (!(from <= a && a < to)) continue;
      if (from <= b && b < to)
        join(a, b);
      else
        is_between[e] = 1;
    }
  });
  for (std::size_t e = 0; e < edges.tails.size() && !disputed; ++e)
    if (is_between[e] != 0) join(edges.tails[e], edges.heads[e]);
  if (disputed) return std::nullopt;
  return forest;
}

}  // namespace

SignedForest::SignedForest(Index n) : parent_(static_cast<std::size_t>(n)), sign_(static_cast<std::size_t>(n), 1) {
  std::iota(parent_.begin(), parent_.end(), 0);
}

SignedForest::Root SignedForest::find(Index v) {
  Index root = v;
  signed char sign = 1;
  while (parent_[root] != root) {
    sign = static_cast<signed char>(sign * sign_[root]);
    root = parent_[root];
  }
  const Root result{root, sign};
  while (parent_[v] != root && v != root) {  // path compression; signs become relative to the root
    const Index up = parent_[v];
    const auto rest = static_cast<signed char>(sign * sign_[v]);
    parent_[v] = root;
    sign_[v] = sign;
    sign = rest;
    v = up;
  }
  return result;
}

bool SignedForest::join(Index a, Index b, signed char relative) {
  Root p = find(a), q = find(b);
  if (p.vertex == q.vertex) return false;
  if (p.vertex > q.vertex) std::swap(p, q);
  parent_[q.vertex] = p.vertex;
  sign_[q.vertex] = static_cast<signed char>(p.sign * q.sign * relative);
  return true;
}

void Evidence::count(const Vec3& point) {
  ++points;
  for (int axis = 0; axis < 3; ++axis) centroid[axis] += point[axis];
}

void Evidence::weigh(const Vec3& point, const Vec3& normal, signed char sign) {
  const Vec3 offset = point - (1.0 / points) * centroid;
  given += sign;
  outward += dot(offset, normal);
  spread += norm(offset);
  for (int axis = 0; axis < 3; ++axis) normal_sum[axis] += normal[axis];
}

double Evidence::sign(bool signs_given) const {
  if (signs_given && given != 0) return given;
  if (std::abs(outward) > 1e-3 * spread) return outward;
  const auto& n = normal_sum;
  return *std::max_element(n.begin(), n.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
}

std::vector<char> have_thin_walls(const CleanPoints& cloud, const TangentPlanes& planes,
                                  const Neighborhoods& neighborhoods, const CloudParts& parts) {
  struct Count {
    Offset opposed = 0, before = 0, behind = 0;
  };
  std::vector<Count> counts(static_cast<std::size_t>(parts.count));
  const auto n = static_cast<Index>(planes.normals.size());
  for (Index i = 0; i < n; ++i)
    for (Index j : neighborhoods.of(i)) {
      if (!(dot(planes.normals[i], planes.normals[j]) < -0.5)) continue;
      Count& count = counts[parts.of_point[i]];
      ++count.opposed;
      // Twice the mean height of each point over the plane of the other.
      const double height = dot(planes.normals[i] - planes.normals[j], cloud.points[j] - cloud.points[i]);
      count.before += height > 0;
      count.behind += height < 0;
    }
  std::vector<char> result;
  for (const Count& count : counts)
    result.push_back(count.opposed > 0 && 4 * std::abs(count.before - count.behind) >= 3 * count.opposed);
  return result;
}

std::vector<Index> orient_normals(const CleanPoints& cloud, const WeightedEdges& edges, bool signs_given,
                                  const CloudParts& parts, const std::vector<char>& kept, unsigned threads,
                                  TangentPlanes& planes) {
  const auto n = static_cast<Index>(cloud.points.size());
  std::optional<SignedForest> undisputed = undisputed_forest(n, edges, planes, threads);
  SignedForest forest = undisputed ? *std::move(undisputed) : flattest_forest(n, bridges(edges, planes, threads));
  std::vector<Index> tree(static_cast<std::size_t>(n));  // tree of each point
  std::vector<Evidence> evidence;
  for (Index i = 0; i < n; ++i) {
    const Index root = forest.find(i).vertex;  // the lowest point of the tree
    if (root == i) evidence.emplace_back();
    tree[i] = root == i ? static_cast<Index>(evidence.size()) - 1 : tree[root];
    evidence[tree[i]].count(cloud.points[i]);
  }
  const auto is_kept = [&](Index i) { return kept[parts.of_point[i]] != 0; };
  for (Index i = 0; i < n; ++i) {
    if (is_kept(i)) continue;
    const signed char sign = forest.find(i).sign;
    planes.normals[i] = static_cast<double>(sign) * planes.normals[i];
    evidence[tree[i]].weigh(cloud.points[i], planes.normals[i], sign);
  }
  std::vector<char> turned;
  for (const Evidence& of_tree : evidence) turned.push_back(of_tree.sign(signs_given) < 0);
  std::vector<Index> against_majority(static_cast<std::size_t>(parts.count), 0);
  for (Index i = 0; i < n; ++i) {
    if (is_kept(i)) continue;
    const bool turn = turned[tree[i]] != 0;
    if (turn) planes.normals[i] = -1.0 * planes.normals[i];
    against_majority[parts.of_point[i]] += (forest.find(i).sign < 0) != turn;
  }
  return against_majority;
}

}  // namespace ahm::pointcloud
