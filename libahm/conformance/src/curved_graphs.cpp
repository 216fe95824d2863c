#include "ahm/conformance/curved_graphs.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <set>
#include <utility>

#include "ahm/conformance/clouds.hpp"
#include "ahm/conformance/flat_graphs.hpp"
#include "ahm/conformance/vectors.hpp"
#include "matrices.hpp"

namespace ahm::test {
namespace {

/// A unit vector perpendicular to a unit vector.
Vec3 perpendicular_to(const Vec3& p) {
  const double r = std::hypot(p[0], p[1]);
  return r > 1e-6 ? Vec3{-p[1] / r, p[0] / r, 0} : Vec3{0, -p[2], p[1]};
}

/// A vector rotated by the smallest rotation from unit vector `from` to unit vector `to`.
Vec3 rotate_between(const Vec3& from, const Vec3& to, const Vec3& vector) {
  const Vec3 axis = cross(from, to), once = cross(axis, vector), twice = cross(axis, once);
  const double scale = 1 / (1 + dot(from, to));
  return {vector[0] + once[0] + scale * twice[0], vector[1] + once[1] + scale * twice[1],
          vector[2] + once[2] + scale * twice[2]};
}

/// The `count` nearest points of point i. Points are sorted by z, so the search from i in both directions ends when z alone
/// is too far.
std::vector<Index> nearest_by_z(const std::vector<Vec3>& points, Index i, std::size_t count) {
  std::vector<std::pair<double, Index>> found;
  auto can_be_nearer = [&](Index j) {
    const double step = points[j][2] - points[i][2];
    return found.size() < count || step * step < found.back().first;
  };
  auto add = [&](Index j) {
    const Vec3 offset = minus(points[j], points[i]);
    found.insert(std::upper_bound(found.begin(), found.end(), std::pair{dot(offset, offset), j}),
                 {dot(offset, offset), j});
    if (found.size() > count) found.pop_back();
  };
  for (Index j = i - 1; j >= 0 && can_be_nearer(j); --j) add(j);
  for (Index j = i + 1; j < static_cast<Index>(points.size()) && can_be_nearer(j); ++j) add(j);
  std::vector<Index> result;
  for (const auto& [distance, j] : found) result.push_back(j);
  return result;
}

/// A rotation about the z axis of space, then one about the x axis.
Matrix small_rotation(double about_x, double about_z) {
  const double c = std::cos(about_x), s = std::sin(about_x), k = std::cos(about_z), t = std::sin(about_z);
  return product(3, Matrix{1, 0, 0, 0, c, -s, 0, s, c}, Matrix{k, -t, 0, t, k, 0, 0, 0, 1});
}

}  // namespace

CsrGraphData sphere_graph(Index n, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const std::vector<Vec3> points = even_sphere(n).points;
  std::vector<Vec3> axis_x, axis_y;
  for (const Vec3& p : points) {
    const Vec3 side = perpendicular_to(p), other = cross(p, side);
    const double angle = 2.0 * std::numbers::pi * uniform(random), c = std::cos(angle), s = std::sin(angle);
    axis_x.push_back({c * side[0] + s * other[0], c * side[1] + s * other[1], c * side[2] + s * other[2]});
    axis_y.push_back(cross(p, axis_x.back()));
  }
  std::set<std::pair<Index, Index>> edges;
  for (Index i = 0; i < n; ++i)
    for (Index j : nearest_by_z(points, i, 6)) edges.insert(std::minmax(i, j));
  std::vector<std::vector<std::pair<Index, double>>> rows(static_cast<std::size_t>(n));
  for (const auto& [a, b] : edges) {
    const double w = 0.2 + uniform(random);
    rows[a].push_back({b, w});
    rows[b].push_back({a, w});
  }
  CsrGraphData g;
  g.row_begin = {0};
  for (Index i = 0; i < n; ++i) {
    for (const auto& [j, w] : rows[i]) {
      const Vec3 offset = minus(points[j], points[i]);
      g.neighbors.push_back(j);
      g.weights.push_back(w);
      g.logs.insert(g.logs.end(), {dot(axis_x[i], offset), dot(axis_y[i], offset)});
      const Vec3 axis = rotate_between(points[j], points[i], axis_x[j]);
      const double c = dot(axis_x[i], axis), s = dot(axis_y[i], axis), r = std::hypot(c, s);
      g.transports.insert(g.transports.end(), {c / r, s / r});
    }
    g.row_begin.push_back(static_cast<Offset>(g.neighbors.size()));
    g.masses.push_back(4.0 * std::numbers::pi / n * (0.5 + uniform(random)));
  }
  return g;
}

CsrGraphData bent_lattice(Index side, unsigned seed) {
  CsrGraphData g = lattice3(side).data;
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> angle(-0.1, 0.1);
  auto block = [&](Offset e) { return g.transports.begin() + 9 * e; };
  for (Index i = 0; i < static_cast<Index>(g.masses.size()); ++i)
    for (Offset e = g.row_begin[i]; e < g.row_begin[i + 1]; ++e) {
      const Index j = g.neighbors[e];
      if (j < i) continue;
      const double about_x = angle(random), about_z = angle(random);
      const Matrix R_ji = product(3, small_rotation(about_x, about_z), Matrix(block(e), block(e) + 9)),
                   R_ij = transposed(3, R_ji);
      Offset back = g.row_begin[j];
      while (g.neighbors[back] != i) ++back;
      std::copy(R_ji.begin(), R_ji.end(), block(e));
      std::copy(R_ij.begin(), R_ij.end(), block(back));
    }
  return g;
}

}  // namespace ahm::test
