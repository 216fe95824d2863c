#include "tangent_edges.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "ahm/util/parallel.hpp"
#include "ahm/util/unset_vector.hpp"
#include "edge_unfolding.hpp"
#include "plane_axes.hpp"

namespace ahm::pointcloud {
namespace {

/// The tangent plane of one point: axes x, y and normal.
struct Plane {
  explicit Plane(const Vec3& unit_normal) : axes(unit_normal), normal(unit_normal) {}
  PlaneAxes axes;
  Vec3 normal;
};

using Matrix2 = std::array<double, 4>;

/// Components in frame `from` -> components in frame `to` under the smallest rotation that takes the plane of `from` to
/// that of `to`. With n the normal of `from` and m = +-(normal of `to`) it is v -> v - (m.v)/(1 + n.m) (n + m) on
/// vectors v of the first plane; the sign that makes n.m >= 0 is taken when `reflect` asks for it, which makes the
/// matrix a reflection.
Matrix2 smallest_rotation(const Plane& from, const Plane& to, bool reflect) {
  const Vec3 m = reflect ? -1.0 * to.normal : to.normal;
  const double scale = 1.0 / (1.0 + std::max(dot(from.normal, m), -1.0 + 1e-12));
  Matrix2 R;
  const Vec3* rows[] = {&to.axes.x, &to.axes.y};
  const Vec3* columns[] = {&from.axes.x, &from.axes.y};
  for (int a = 0; a < 2; ++a)
    for (int b = 0; b < 2; ++b)
      R[2 * a + b] = dot(*rows[a], *columns[b]) - scale * dot(m, *columns[b]) * dot(from.normal, *rows[a]);
  // Orthogonal to the last bit: first column normalized, second its perpendicular.
  const double r = std::hypot(R[0], R[2]), c = R[0] / r, s = R[2] / r;
  return reflect ? Matrix2{c, s, s, -c} : Matrix2{c, -s, s, c};
}

/// Row starts of the symmetric graph of the given undirected edges.
std::vector<Offset> row_starts(const WeightedEdges& edges, const std::vector<Index>& vertex_of_clean, Index vertices) {
  std::vector<Offset> begin(static_cast<std::size_t>(vertices) + 1, 0);
  for (std::size_t e = 0; e < edges.tails.size(); ++e) {
    ++begin[vertex_of_clean[edges.tails[e]] + 1];
    ++begin[vertex_of_clean[edges.heads[e]] + 1];
  }
  for (Index i = 0; i < vertices; ++i) begin[i + 1] += begin[i];
  return begin;
}

}  // namespace

CsrGraphData tangent_edges(const CleanPoints& cloud, const TangentPlanes& planes, const WeightedEdges& edges,
                           const std::vector<Index>& vertex_of_clean, Index vertices, const PerPart& trusted,
                           const PerPart& noise, unsigned threads, CloudDetails& report,
                           std::optional<TransportKind> kind) {
  const auto count = static_cast<Offset>(edges.tails.size());
  auto is_reflection = [&](std::size_t e) {
    return trusted.at(edges.tails[e]) == 0 && dot(planes.normals[edges.tails[e]], planes.normals[edges.heads[e]]) < 0;
  };
  report.reflections = 0;
  for (std::size_t e = 0; e < edges.tails.size(); ++e) report.reflections += is_reflection(e);

  CsrGraphData g;
  g.kind = kind.value_or(report.reflections > 0 ? TransportKind::block : TransportKind::rotation2);
  const std::size_t width = g.kind == TransportKind::block ? 4 : 2;
  g.row_begin = row_starts(edges, vertex_of_clean, vertices);
  const std::size_t directed = 2 * edges.tails.size();
  detail::run_both(
      threads != 1, [&] { g.transports.resize(width * directed); },
      [&] { g.neighbors.resize(directed), g.weights.resize(directed), g.logs.resize(2 * directed); });
  // Edges come in lexicographic order, so every row fills up with ascending neighbours once the smaller ones went
  // first.
  std::vector<Offset> fill(g.row_begin.begin(), g.row_begin.end() - 1);
  detail::UnsetVector<Offset> position_in_head(edges.tails.size()), position_in_tail(edges.tails.size());
  for (std::size_t e = 0; e < edges.tails.size(); ++e) position_in_head[e] = fill[vertex_of_clean[edges.heads[e]]]++;
  for (std::size_t e = 0; e < edges.tails.size(); ++e) position_in_tail[e] = fill[vertex_of_clean[edges.tails[e]]]++;

  detail::parallel_chunks(count, 1 << 15, threads, [&](Offset begin, Offset end) {
    for (Offset e = begin; e < end; ++e) {
      const Index a = edges.tails[e], b = edges.heads[e];
      const Plane plane_a(planes.normals[a]), plane_b(planes.normals[b]);
      const bool reflect = g.kind == TransportKind::block && is_reflection(static_cast<std::size_t>(e));
      const Vec3 offset = cloud.points[b] - cloud.points[a];
      const Matrix2 R_ab = smallest_rotation(plane_a, plane_b, reflect);
      const Matrix2 R_ba{R_ab[0], R_ab[2], R_ab[1], R_ab[3]};
      auto store = [&](Offset at, Index neighbor, const Plane& plane, const Vec3& log, const Matrix2& R) {
        g.neighbors[at] = vertex_of_clean[neighbor];
        g.weights[at] = edges.weights[e];
        g.logs[2 * at] = dot(plane.axes.x, log);
        g.logs[2 * at + 1] = dot(plane.axes.y, log);
        double* transport = g.transports.data() + static_cast<std::size_t>(at) * width;
        transport[0] = R[0];
        transport[1] = width == 2 ? R[2] : R[1];
        if (width == 4) transport[2] = R[2], transport[3] = R[3];
      };
      store(position_in_tail[e], b, plane_a, unfolded_edge(plane_a.normal, plane_b.normal, offset, noise.at(a)), R_ba);
      store(position_in_head[e], a, plane_b, unfolded_edge(plane_b.normal, plane_a.normal, -1.0 * offset, noise.at(a)),
            R_ab);
    }
  });
  return g;
}

}  // namespace ahm::pointcloud
