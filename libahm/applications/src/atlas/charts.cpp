#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "ahm/applications/atlas.hpp"
#include "ahm/error.hpp"
#include "ahm/util/memory.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/vec.hpp"

namespace ahm {
namespace {

/// Corners of the convex hull, counter-clockwise (Andrew's monotone chains).
std::vector<Vec2> convex_hull(std::vector<Vec2> points) {
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  std::vector<Vec2> hull;
  for (int chain = 0; chain < 2; ++chain) {
    const std::size_t start = hull.size();
    for (const Vec2& p : points) {
      const auto turns_right = [&](const Vec2& o) { return !(cross(hull.back() - o, p - o) > 0); };
      while (hull.size() >= start + 2 && turns_right(hull[hull.size() - 2])) hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();  // the next chain begins with it
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

ChartBox box_along(const std::vector<Vec2>& hull, double c, double s) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  ChartBox box{{c, s}, {infinity, infinity}, {-infinity, -infinity}};
  for (const Vec2& p : hull) {
    const Vec2 q{c * p[0] + s * p[1], c * p[1] - s * p[0]};
    for (std::size_t k : {0, 1}) box.low[k] = std::min(box.low[k], q[k]), box.high[k] = std::max(box.high[k], q[k]);
  }
  return box;
}

/// One side of the least rectangle lies along a side of the convex hull [FS75].
ChartBox least_box(const std::vector<Vec2>& hull) {
  ChartBox best = box_along(hull, 1, 0);
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < hull.size(); ++k) {
    const Vec2 &a = hull[k], &b = hull[(k + 1) % hull.size()];
    const double length = std::hypot(b[0] - a[0], b[1] - a[1]);
    if (!(length > 0)) continue;
    const ChartBox box = box_along(hull, (b[0] - a[0]) / length, (b[1] - a[1]) / length);
    const double area = (box.high[0] - box.low[0]) * (box.high[1] - box.low[1]);
    if (area < least) least = area, best = box;
  }
  if (best.high[0] - best.low[0] < best.high[1] - best.low[1])
    best = box_along(hull, -best.turn[1], best.turn[0]);  // a quarter further
  return best;
}

}  // namespace

std::vector<ChartBox> chart_boxes(const Atlas& atlas, const FaceList& faces) {
  return detail::with_memory_check("bounding charts", [&] {
    if (faces.size() != atlas.chart_of_face.size() || 2 * faces.vertices.size() != atlas.coordinates.size())
      throw InvalidArgument("there are " + std::to_string(faces.size()) + " faces with " +
                            std::to_string(faces.vertices.size()) + " corners, but the atlas has " +
                            std::to_string(atlas.chart_of_face.size()) + " with " +
                            std::to_string(atlas.coordinates.size() / 2));
    std::vector<ChartBox> boxes;
    for (const Chart& chart : atlas.charts) {
      std::vector<Vec2> points;
      for (Index f : chart.faces)
        for (Offset c = faces.begin[f]; c < faces.begin[f + 1]; ++c) points.push_back(atlas.corner(c));
      double size = 0;
      for (const Vec2& p : points) size = std::max(size, largest(p));
      const double unit = power_of_two_below(size);
      for (Vec2& p : points) p = 1 / unit * p;
      ChartBox box = least_box(convex_hull(std::move(points)));
      box.low = unit * box.low, box.high = unit * box.high;
      boxes.push_back(box);
    }
    return boxes;
  });
}

}  // namespace ahm
