#include "input/nearest_face.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "ahm/error.hpp"

namespace ahm::app {
namespace {

constexpr std::size_t leaf = 8;  // triangles

Vec3 minus(const Vec3& a, const Vec3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
bool is_finite(const Vec3& p) { return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]); }

/// Where on the segment from a to b the point nearest to p lies, in [0, 1].
double along(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 d = minus(b, a);
  const double squared = dot(d, d);
  return squared > 0 ? std::clamp(dot(minus(p, a), d) / squared, 0.0, 1.0) : 0.0;
}

Vec3 combined(const std::array<Vec3, 3>& t, const std::array<double, 3>& weights) {
  Vec3 result{};
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t a = 0; a < 3; ++a) result[a] += weights[k] * t[k][a];
  return result;
}

/// Barycentric coordinates of the point of a triangle nearest to p: its projection, or the nearest on an edge.
std::array<double, 3> nearest_in(const std::array<Vec3, 3>& t, const Vec3& p) {
  const Vec3 u = minus(t[1], t[0]), v = minus(t[2], t[0]), w = minus(p, t[0]);
  const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), area = uu * vv - uv * uv;
  const double second = (vv * dot(w, u) - uv * dot(w, v)) / area, third = (uu * dot(w, v) - uv * dot(w, u)) / area;
  if (second >= 0 && third >= 0 && second + third <= 1) return {1 - second - third, second, third};
  std::array<double, 3> best{};
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 3; ++k) {
    std::array<double, 3> weights{};
    weights[(k + 1) % 3] = along(p, t[k], t[(k + 1) % 3]);
    weights[k] = 1 - weights[(k + 1) % 3];
    const Vec3 d = minus(combined(t, weights), p);
    if (!(dot(d, d) < least)) continue;
    least = dot(d, d);
    best = weights;
  }
  return best;
}

double squared_distance(const Vec3& p, const Vec3& low, const Vec3& high) {
  double sum = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    const double d = std::max({low[a] - p[a], 0.0, p[a] - high[a]});
    sum += d * d;
  }
  return sum;
}

}  // namespace

NearestFace::NearestFace(const io::Geometry& input) : input_(input) {
  for (std::size_t f = 0; f < input.face_count(); ++f)
    for (std::size_t c = 1; c + 1 < input.face(f).size(); ++c) {
      const Triangle triangle{static_cast<Index>(f), static_cast<Index>(c)};
      if (is_finite(corner(triangle, 0)) && is_finite(corner(triangle, 1)) && is_finite(corner(triangle, 2)))
        triangles_.push_back(triangle);
    }
  if (triangles_.empty()) throw InvalidGeometry("the mesh has no face with finite corners");
  build(0, triangles_.size());
}

Vec3 NearestFace::corner(const Triangle& triangle, int k) const {
  const auto face = input_.face(static_cast<std::size_t>(triangle.face));
  const Index c = k == 0 ? 0 : triangle.corner + k - 1;
  return input_.points[face[c]];
}

void NearestFace::build(std::size_t begin, std::size_t end) {
  const double infinity = std::numeric_limits<double>::infinity();
  Box box{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}, begin, end, 0};
  for (std::size_t t = begin; t < end; ++t)
    for (int k = 0; k < 3; ++k) {
      const Vec3 p = corner(triangles_[t], k);
      for (std::size_t a = 0; a < 3; ++a)
        box.low[a] = std::min(box.low[a], p[a]), box.high[a] = std::max(box.high[a], p[a]);
    }
  const std::size_t number = boxes_.size();
  boxes_.push_back(box);
  if (end - begin <= leaf) return;
  const Vec3 sides = minus(box.high, box.low);
  const auto axis = static_cast<std::size_t>(std::max_element(sides.begin(), sides.end()) - sides.begin());
  const auto middle_of = [&](const Triangle& t) {
    return corner(t, 0)[axis] / 3 + corner(t, 1)[axis] / 3 + corner(t, 2)[axis] / 3;
  };
  const std::size_t half = begin + (end - begin) / 2;
  const auto at = [&](std::size_t t) { return triangles_.begin() + static_cast<std::ptrdiff_t>(t); };
  std::nth_element(at(begin), at(half), at(end),
                   [&](const Triangle& a, const Triangle& b) { return middle_of(a) < middle_of(b); });
  build(begin, half);
  boxes_[number].second = boxes_.size();
  build(half, end);
}

NearestFace::Hit NearestFace::nearest(const Vec3& position) const {
  Hit best{{0, {}}, position, std::numeric_limits<double>::infinity()};
  search(0, position, best);
  return best;
}

void NearestFace::search(std::size_t number, const Vec3& position, Hit& best) const {
  const Box& box = boxes_[number];
  if (box.second == 0) {
    for (std::size_t t = box.begin; t < box.end; ++t) look_at(triangles_[t], position, best);
    return;
  }
  const auto away = [&](std::size_t b) { return std::sqrt(squared_distance(position, boxes_[b].low, boxes_[b].high)); };
  std::size_t near = number + 1, far = box.second;
  if (away(far) < away(near)) std::swap(near, far);
  if (away(near) < best.distance) search(near, position, best);
  if (away(far) < best.distance) search(far, position, best);
}

void NearestFace::look_at(const Triangle& triangle, const Vec3& position, Hit& best) const {
  const std::array<Vec3, 3> t{corner(triangle, 0), corner(triangle, 1), corner(triangle, 2)};
  const std::array<double, 3> weights = nearest_in(t, position);
  const Vec3 found = combined(t, weights), d = minus(found, position);
  const double distance = std::sqrt(dot(d, d));
  if (!(distance < best.distance)) return;
  std::vector<double> of_corners(input_.face(static_cast<std::size_t>(triangle.face)).size(), 0.0);
  of_corners[0] = weights[0];
  of_corners[triangle.corner] = weights[1];
  of_corners[static_cast<std::size_t>(triangle.corner) + 1] = weights[2];
  best = {{triangle.face, of_corners}, found, distance};
}

}  // namespace ahm::app
