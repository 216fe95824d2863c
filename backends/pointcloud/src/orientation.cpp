#include "orientation.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "ahm/util/vec.hpp"

namespace ahm::pointcloud {
namespace {

/// Edge numbers, flattest first.
std::vector<std::uint32_t> flattest_first(const WeightedEdges& edges, const TangentPlanes& planes) {
  std::vector<float> bends(edges.tails.size());
  for (std::size_t e = 0; e < bends.size(); ++e)
    bends[e] = bend(planes.normals[edges.tails[e]], planes.normals[edges.heads[e]]);
  std::vector<std::uint32_t> order(bends.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return bends[a] != bends[b] ? bends[a] < bends[b] : a < b; });
  return order;
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
  while (parent_[v] != root && v != root) {  // path compression keeps the signs relative to the root
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
      // Twice the mean of how high each lies above the other.
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
                                  const CloudParts& parts, const std::vector<char>& kept, TangentPlanes& planes) {
  const auto n = static_cast<Index>(cloud.points.size());
  SignedForest forest(n);
  for (std::uint32_t e : flattest_first(edges, planes)) {
    const Index a = edges.tails[e], b = edges.heads[e];
    forest.join(a, b, dot(planes.normals[a], planes.normals[b]) < 0 ? -1 : 1);
  }
  std::vector<Evidence> evidence(static_cast<std::size_t>(n));
  for (Index i = 0; i < n; ++i) evidence[forest.find(i).vertex].count(cloud.points[i]);
  const auto is_kept = [&](Index i) { return kept[parts.of_point[i]] != 0; };
  for (Index i = 0; i < n; ++i) {
    if (is_kept(i)) continue;
    const auto [root, sign] = forest.find(i);
    planes.normals[i] = static_cast<double>(sign) * planes.normals[i];
    evidence[root].weigh(cloud.points[i], planes.normals[i], sign);
  }
  std::vector<Index> against_majority(static_cast<std::size_t>(parts.count), 0);
  for (Index i = 0; i < n; ++i) {
    if (is_kept(i)) continue;
    const auto [root, sign] = forest.find(i);
    const bool turn = evidence[root].sign(signs_given) < 0;
    if (turn) planes.normals[i] = -1.0 * planes.normals[i];
    against_majority[parts.of_point[i]] += (sign < 0) != turn;
  }
  return against_majority;
}

}  // namespace ahm::pointcloud
