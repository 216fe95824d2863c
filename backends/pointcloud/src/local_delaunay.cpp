#include "local_delaunay.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>

#include "ahm/util/buckets.hpp"
#include "ahm/util/parallel.hpp"
#include "ahm/util/unset_vector.hpp"
#include "cloud_parts.hpp"
#include "tangent_edges.hpp"
#include "tangent_planes.hpp"

namespace ahm::pointcloud {
namespace {

/// Neighbors with oriented normals more than 120 degrees apart belong to different sheets.
constexpr double sheet_cosine = -0.5;

/// A neighbor almost straight above the point has no direction in its tangent plane.
constexpr double min_projection = 1e-6;

/// Image of a neighbor under inversion about a point.
struct ImagePoint {
  double x, y;
  Index vertex;  ///< -1: the center of inversion itself
};

double turn(const ImagePoint& a, const ImagePoint& b, const ImagePoint& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Convex hull, counter-clockwise, corners only (Andrew's monotone chain).
void convex_hull(std::vector<ImagePoint>& points, std::vector<ImagePoint>& hull) {
  std::sort(points.begin(), points.end(), [](const ImagePoint& a, const ImagePoint& b) {
    return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.vertex < b.vertex;
  });
  hull.clear();
  auto extend = [&](const ImagePoint& p, std::size_t floor) {
    while (hull.size() >= floor + 2 && turn(hull[hull.size() - 2], hull.back(), p) <= 0) hull.pop_back();
    hull.push_back(p);
  };
  for (const ImagePoint& p : points) extend(p, 0);
  const std::size_t upper = hull.size() - 1;
  for (std::size_t k = points.size() - 1; k-- > 0;) extend(points[k], upper);
  hull.pop_back();
}

/// Removes images near the origin that lie inside a polygon of some of the first images, because they are no corners of the
/// hull. The nearest neighbors come first and have the farthest images, so most images are removed where neighbors lie on all
/// sides.
/// @return whether such a polygon exists; the origin is then no corner of the hull, either
bool drop_inner(std::vector<ImagePoint>& points) {
  constexpr std::size_t sample_count = 12, directions = 8;
  // Farthest image in each direction, counter-clockwise: corners of a convex polygon, some of them equal.
  std::array<double, directions> farthest{};
  std::array<const ImagePoint*, directions> corners{};
  for (std::size_t k = 0; k < std::min(points.size(), sample_count); ++k) {
    const double x = points[k].x, y = points[k].y;
    const std::array<double, directions> along{x, x + y, y, y - x, -x, -x - y, -y, x - y};
    for (std::size_t c = 0; c < directions; ++c)
      if (along[c] > farthest[c]) farthest[c] = along[c], corners[c] = &points[k];
  }
  double squared_radius = std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < directions; ++c) {
    const ImagePoint *a = corners[c], *b = corners[(c + 1) % directions];
    if (!a || !b) return false;
    if (a == b) continue;
    const double area = a->x * b->y - a->y * b->x, x = b->x - a->x, y = b->y - a->y;
    if (!(area > 0)) return false;
    squared_radius = std::min(squared_radius, area * area / (x * x + y * y));
  }
  if (!std::isfinite(squared_radius)) return false;
  // Leaves images within rounding of the polygon to the hull.
  squared_radius *= 1 - 1e-6;
  std::erase_if(points, [&](const ImagePoint& p) { return p.x * p.x + p.y * p.y < squared_radius; });
  return true;
}

/// Computes the Delaunay triangles at one point. Inversion about the point maps circles through it to lines. A circle through
/// the point and two neighbors is empty exactly if all other images, and the origin, lie on one side of the line through their
/// two images. The triangles are therefore the edges of the convex hull of the images and the origin that do not touch the
/// origin.
class StarTriangulator {
 public:
  StarTriangulator(const CleanPoints& cloud, const Neighborhoods& neighborhoods, const TangentPlanes& planes,
                   const PerPart& oriented, const PerPart& noise, double max_edge_ratio)
      : cloud_(cloud),
        neighborhoods_(neighborhoods),
        planes_(planes),
        oriented_(oriented),
        noise_(noise),
        max_ratio_(max_edge_ratio) {}

  Offset too_long = 0, other_sheet = 0, too_steep = 0;

  /// Appends the triangles at point i.
  /// @return whether they surround the point
  bool triangulate(Index i, std::vector<Triangle>& out) {
    images_.clear();
    const PlaneAxes axes(planes_.normals[i]);
    const double unit = 1.0 / neighborhoods_.radius[i];
    for (Index j : neighborhoods_.of(i)) {
      if (!planes_.has_plane(j)) continue;
      const Vec3 offset = unit * (cloud_.points[j] - cloud_.points[i]);
      const double length = norm(offset);
      if (!accept(i, j, length)) continue;
      const double x = dot(axes.x, offset), y = dot(axes.y, offset), squared = x * x + y * y;
      if (squared > min_projection * min_projection * length * length) images_.push_back({x / squared, y / squared, j});
    }
    if (images_.size() < 2) return false;
    if (!drop_inner(images_)) images_.push_back({0, 0, -1});
    convex_hull(images_, hull_);
    bool closed = hull_.size() > 2;
    for (std::size_t a = 0; a < hull_.size() && hull_.size() > 2; ++a) {
      const Index j = hull_[a].vertex, l = hull_[(a + 1) % hull_.size()].vertex;
      if (j < 0) closed = false;
      if (j < 0 || l < 0) continue;
      Triangle t{i, j, l};
      std::sort(t.begin(), t.end());
      out.push_back(t);
    }
    return closed;
  }

 private:
  bool accept(Index i, Index j, double length) {
    if (length * neighborhoods_.radius[i] > max_ratio_ * neighborhoods_.radius[j]) return ++too_long, false;
    if (oriented_.at(i) != 0 && dot(planes_.normals[i], planes_.normals[j]) < sheet_cosine) return ++other_sheet, false;
    if (leaves_surface(planes_.normals[i], planes_.normals[j], cloud_.points[j] - cloud_.points[i], noise_.at(i)))
      return ++too_steep, false;
    return true;
  }

  const CleanPoints& cloud_;
  const Neighborhoods& neighborhoods_;
  const TangentPlanes& planes_;
  const PerPart& oriented_;
  const PerPart& noise_;
  double max_ratio_;
  std::vector<ImagePoint> images_, hull_;
};

/// Counts how often each value occurs in a sorted range. Stores the counts in the order of the values, from `first` on.
void count_equal(const std::array<Index, 2>* values, Offset first, Offset last, std::vector<std::uint8_t>& times) {
  Offset at = first - 1;
  for (Offset t = first; t < last; ++t) {
    if (t == first || values[t] != values[t - 1]) times[++at] = 0;
    ++times[at];
  }
}

/// Sorts triangles, with buckets by the smallest corner, and removes duplicates.
/// @param votes  output, may be null: how often each triangle occurred
std::vector<Triangle> unique_triangles(const std::vector<std::vector<Triangle>>& parts, Index n, unsigned threads,
                                       std::vector<std::uint8_t>* votes) {
  std::vector<Offset> begin(static_cast<std::size_t>(n) + 1, 0);
  const auto for_each_triangle = [&](const auto& body) {
    detail::for_key_ranges(n, threads, [&](Offset from, Offset to) {
      for (const auto& part : parts)
        for (const Triangle& t : part)
          if (from <= t[0] && t[0] < to) body(t);
    });
  };
  for_each_triangle([&](const Triangle& t) { ++begin[t[0] + 1]; });
  begin = detail::begin_of_groups(std::move(begin));
  detail::UnsetVector<std::array<Index, 2>> rest(static_cast<std::size_t>(begin[n]));
  std::vector<std::uint8_t> times(votes ? rest.size() : 0);
  std::vector<Offset> fill(begin.begin(), begin.end() - 1);
  for_each_triangle([&](const Triangle& t) { rest[fill[t[0]]++] = {t[1], t[2]}; });
  detail::parallel_chunks(n, points_per_task, threads, [&](Offset first, Offset last) {
    for (Offset i = first; i < last; ++i) {
      const auto bucket = rest.begin() + begin[i];
      std::sort(bucket, rest.begin() + begin[i + 1]);
      if (votes) count_equal(rest.data(), begin[i], begin[i + 1], times);
      fill[i] = std::unique(bucket, rest.begin() + begin[i + 1]) - rest.begin();
    }
  });
  std::vector<Triangle> triangles;
  triangles.reserve(rest.size() / 2);
  if (votes) votes->reserve(rest.size() / 2);
  for (Index i = 0; i < n; ++i)
    for (Offset t = begin[i]; t < fill[i]; ++t) {
      triangles.push_back({i, rest[t][0], rest[t][1]});
      if (votes) votes->push_back(times[t]);
    }
  return triangles;
}

}  // namespace

std::vector<Triangle> local_delaunay(const CleanPoints& cloud, const Neighborhoods& neighborhoods,
                                     const TangentPlanes& planes, const PerPart& oriented, const PerPart& noise,
                                     const CloudOptions& options, CloudDetails& report, std::vector<char>* inner,
                                     std::vector<std::uint8_t>* votes) {
  const auto n = static_cast<Offset>(cloud.points.size());
  std::vector<std::vector<Triangle>> parts(static_cast<std::size_t>((n + points_per_task - 1) / points_per_task));
  if (inner) inner->assign(static_cast<std::size_t>(n), 0);
  std::atomic<Offset> too_long{0}, other_sheet{0}, too_steep{0};
  detail::parallel_chunks(n, points_per_task, options.threads, [&](Offset begin, Offset end) {
    StarTriangulator star(cloud, neighborhoods, planes, oriented, noise, options.max_edge_ratio);
    auto& part = parts[begin / points_per_task];
    part.reserve(static_cast<std::size_t>(end - begin) * 6);
    for (auto i = static_cast<Index>(begin); i < end; ++i)
      if (const bool closed = planes.has_plane(i) && star.triangulate(i, part); inner) (*inner)[i] = closed;
    too_long += star.too_long;
    other_sheet += star.other_sheet;
    too_steep += star.too_steep;
    if (options.progress.stop.stop_requested()) throw Cancelled("cancelled during the local triangulation");
  });
  report.rejected_long = neighborhoods.unreachable + too_long;
  report.rejected_normals = other_sheet;
  report.rejected_steep = too_steep;
  std::vector<Triangle> triangles = unique_triangles(parts, static_cast<Index>(n), options.threads, votes);
  report.triangles = static_cast<Offset>(triangles.size());
  options.progress.step("triangulate", 1.0);
  return triangles;
}

}  // namespace ahm::pointcloud
