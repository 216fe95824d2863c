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

/// What noise explains: offsets of fewer standard deviations. Of the rest of normal noise the share in squared lengths is
/// below a percent, so that noisy planes keep their distances.
constexpr double noise_reach = 3;

/// Neighbours are of another sheet beyond this many deviations and this slope over the mean plane. Distances on scans need some
/// such bound, but hardly tell slopes between 0.4 and 1 apart.
constexpr double sheet_reach = 4;
constexpr double steepest = 0.6;

/// Squared length that an offset across the mean plane adds: all of it where it is far beyond noise, nothing within.
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
  // From the mean plane to that of the tail by the smallest rotation.
  flat = flat - (dot(tail, flat) / (1 + mean.cosine)) * (mean.normal + tail);
  const double excess = squared_excess(offset, noise), squared = dot(flat, flat);
  if (!(excess > 0 && squared > 0)) return flat;
  return std::sqrt(1 + excess / squared) * flat;
}

bool leaves_surface(const Vec3& tail, const Vec3& head, const Vec3& edge, double noise) {
  // Normals less than a right angle apart add up to the root of two at least: this is twice the square of what the offset is at
  // the most, and mostly tells that it is not steep.
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

/// Where edges lie in the rows of the symmetric graph. They come in lexicographic order: a row has first the edges that it is the
/// head of, then those that it is the tail of, each in their order, and its neighbours ascend.
struct RowPlaces {
  std::vector<Offset> begin;                    ///< of the rows; vertices + 1
  std::vector<Offset> tails_begin;              ///< where the edges begin that the row is the tail of ...
  std::vector<Offset> first;                    ///< ... and the first of these
  detail::UnsetVector<std::int32_t> from_head;  ///< of each edge: so many places behind the begin of its head's row

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
                           const std::vector<Index>& vertex_of_clean, Index vertices, const PerPart& trusted,
                           const PerPart& noise, unsigned threads, CloudDetails& report,
                           std::optional<TransportKind> kind) {
  const auto count = static_cast<Offset>(edges.tails.size());
  auto is_reflection = [&](std::size_t e) {
    return trusted.at(edges.tails[e]) == 0 && dot(planes.normals[edges.tails[e]], planes.normals[edges.heads[e]]) < 0;
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
