#include "tangent_edges.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <utility>

#include "ahm/util/buckets.hpp"
#include "ahm/util/parallel.hpp"
#include "ahm/util/unset_vector.hpp"
#include "ahm/util/vec.hpp"

namespace ahm::pointcloud {
namespace {

/// Offsets of fewer standard deviations are noise. Larger offsets contribute less than 1 % of the squared lengths under normal
/// noise, so noisy planes keep their distances.
constexpr double noise_reach = 3;

/// A neighbor belongs to another sheet if its offset exceeds both this many standard deviations and this slope over the mean
/// plane. Distances on scans need such a bound, but hardly depend on it for slopes between 0.4 and 1.
constexpr double sheet_reach = 4;
constexpr double steepest = 0.6;

/// Squared length that an offset across the mean plane adds: nothing within noise, and all of it far beyond noise.
double squared_excess(double offset, double noise) {
  const double squared = offset * offset, reach = noise_reach * noise_reach * noise * noise;
  return squared > reach ? squared - reach * (reach / squared) : 0.0;
}

}  // namespace

MeanPlane::MeanPlane(const Vec3& from, const Vec3& to) {
  const double side = dot(from, to) < 0 ? -1.0 : 1.0;
  const Vec3 sum = from + side * to;
  const double length = norm(sum);
  normal = (1 / length) * sum;
  across = 0.5 * (from - side * to);
  cosine = std::min(1.0, 0.5 * length);
}

Vec3 unfolded_edge(const Vec3& tail, const Vec3& head, const Vec3& edge, double noise) {
  const MeanPlane mean(tail, head);
  const double offset = dot(mean.normal, edge);
  Vec3 flat = edge - offset * mean.normal;
  const double squared_sine = dot(mean.across, mean.across);
  if (squared_sine > 0) flat = flat + ((1 / mean.cosine - 1) * dot(mean.across, flat) / squared_sine) * mean.across;
  // Smallest rotation from the mean plane to the plane of the tail.
  flat = flat - (dot(tail, flat) / (1 + mean.cosine)) * (mean.normal + tail);
  const double excess = squared_excess(offset, noise), squared = dot(flat, flat);
  if (!(excess > 0 && squared > 0)) return flat;
  return std::sqrt(1 + excess / squared) * flat;
}

bool leaves_surface(const Vec3& tail, const Vec3& head, const Vec3& edge, double noise) {
  // Two unit normals at most a right angle apart have a sum at least sqrt(2) long. The squared offset is therefore at most half
  // of sum * sum, and this bound usually shows that the edge is not steep.
  const double sum = std::abs(dot(tail, edge)) + std::abs(dot(head, edge)), squared = dot(edge, edge);
  constexpr double steepest_squared = steepest * steepest;
  if (sum * sum * (1 + steepest_squared) < 1.99 * steepest_squared * squared) return false;
  const double offset = std::abs(dot(MeanPlane(tail, head).normal, edge));
  const double flat = std::sqrt(std::max(0.0, squared - offset * offset));
  return offset > sheet_reach * noise && offset > steepest * flat;
}

namespace {

constexpr Offset edges_per_task = 1 << 15;

/// The tangent plane of one point: axes x, y and normal.
struct Plane {
  explicit Plane(const Vec3& unit_normal) : axes(unit_normal), normal(unit_normal) {}
  PlaneAxes axes;
  Vec3 normal;
};

using Matrix2 = std::array<double, 4>;

/// Matrix from components in frame `from` to components in frame `to`, of the smallest rotation between the two planes. With n
/// the normal of `from` and m the normal of `to` it is v -> v - (m.v)/(1 + n.m) (n + m) for vectors v of the first plane. With
/// `reflect`, m is the negative normal of `to`, so that n.m >= 0, and the matrix is a reflection.
Matrix2 smallest_rotation(const Plane& from, const Plane& to, bool reflect) {
  const Vec3 m = reflect ? -1.0 * to.normal : to.normal;
  const double scale = 1.0 / (1.0 + std::max(dot(from.normal, m), -1.0 + 1e-12));
  Matrix2 R;
  const Vec3* rows[] = {&to.axes.x, &to.axes.y};
  const Vec3* columns[] = {&from.axes.x, &from.axes.y};
  for (int a = 0; a < 2; ++a)
    for (int b = 0; b < 2; ++b)
      R[2 * a + b] = dot(*rows[a], *columns[b]) - scale * dot(m, *columns[b]) * dot(from.normal, *rows[a]);
  // Removes rounding: the first column is normalized, and the second is its perpendicular.
  const double r = std::hypot(R[0], R[2]), c = R[0] / r, s = R[2] / r;
  return reflect ? Matrix2{c, s, s, -c} : Matrix2{c, -s, s, c};
}

/// Positions of edges in the rows of the symmetric graph. Edges are in lexicographic order. A row contains first the edges with
/// their head there, then those with their tail there, each in their order. Its neighbors therefore ascend.
struct RowPlaces {
  std::vector<Offset> begin;                    ///< start of each row; vertices + 1
  std::vector<Offset> tails_begin;              ///< start, in each row, of the edges with their tail there
  std::vector<Offset> first;                    ///< first edge with its tail at each vertex
  detail::UnsetVector<std::int32_t> from_head;  ///< position of each edge in its head's row, from the start of the row

  RowPlaces(const WeightedEdges& edges, const std::vector<Index>& vertex_of_clean, Index vertices, unsigned threads)
      : tails_begin(static_cast<std::size_t>(vertices), 0),
        first(static_cast<std::size_t>(vertices), 0),
        from_head(edges.heads.size()) {
    const auto count = static_cast<Offset>(edges.heads.size());
    std::vector<std::int32_t> as_tail(static_cast<std::size_t>(vertices), 0), as_head = as_tail;
    detail::for_key_ranges(vertices, threads, [&](Offset from, Offset to) {
      for (Offset e = 0; e < count; ++e) {
        const Index tail = vertex_of_clean[edges.tails[e]], head = vertex_of_clean[edges.heads[e]];
        if (from <= head && head < to) from_head[e] = as_head[head]++;
        if (from <= tail && tail < to && as_tail[tail]++ == 0) first[tail] = e;
      }
    });
    begin.reserve(static_cast<std::size_t>(vertices) + 1);
    begin.push_back(0);
    for (Index i = 0; i < vertices; ++i) {
      tails_begin[i] = begin.back() + as_head[i];
      begin.push_back(tails_begin[i] + as_tail[i]);
    }
  }
  Offset in_head(Offset edge, Index head) const { return begin[head] + from_head[edge]; }
  Offset in_tail(Offset edge, Index tail) const { return tails_begin[tail] + (edge - first[tail]); }
};

}  // namespace

CsrGraphData tangent_edges(const CleanPoints& cloud, const TangentPlanes& planes, const WeightedEdges& edges,
                           const std::vector<Index>& vertex_of_clean, Index vertices, const PerPart& consistent_signs,
                           const PerPart& noise, unsigned threads, CloudDetails& report,
                           std::optional<TransportKind> kind) {
  const auto count = static_cast<Offset>(edges.tails.size());
  auto is_reflection = [&](std::size_t e) {
    return consistent_signs.at(edges.tails[e]) == 0 &&
           dot(planes.normals[edges.tails[e]], planes.normals[edges.heads[e]]) < 0;
  };
  std::atomic<Offset> reflections{0};
  detail::parallel_chunks(count, edges_per_task, threads, [&](Offset begin, Offset end) {
    Offset here = 0;
    for (Offset e = begin; e < end; ++e) here += is_reflection(static_cast<std::size_t>(e));
    reflections += here;
  });
  report.reflections = reflections;

  CsrGraphData g;
  g.kind = kind.value_or(report.reflections > 0 ? TransportKind::block : TransportKind::rotation2);
  const std::size_t width = g.kind == TransportKind::block ? 4 : 2;
  RowPlaces places(edges, vertex_of_clean, vertices, threads);
  const std::size_t directed = 2 * edges.tails.size();
  detail::run_both(
      threads, [&] { g.transports.resize(width * directed); },
      [&] { g.neighbors.resize(directed), g.weights.resize(directed), g.logs.resize(2 * directed); });
  detail::parallel_chunks(count, edges_per_task, threads, [&](Offset begin, Offset end) {
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
      store(places.in_tail(e, vertex_of_clean[a]), b, plane_a,
            unfolded_edge(plane_a.normal, plane_b.normal, offset, noise.at(a)), R_ba);
      store(places.in_head(e, vertex_of_clean[b]), a, plane_b,
            unfolded_edge(plane_b.normal, plane_a.normal, -1.0 * offset, noise.at(a)), R_ab);
    }
  });
  g.row_begin = std::move(places.begin);
  return g;
}

}  // namespace ahm::pointcloud
