#include "ahm/applications/decal.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>

#include "ahm/error.hpp"
#include "ahm/util/disjoint_sets.hpp"
#include "ahm/util/memory.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/text.hpp"

namespace ahm {
namespace {

using Weights = std::array<double, 3>;

constexpr int circle_corners = 64;

void check(const DecalOptions& o) {
  const auto check_positive = [](const char* name, double value, bool may_be_infinite) {
    if (!(value > 0) || (!may_be_infinite && !std::isfinite(value)))
      throw InvalidArgument(std::string(name) + " is " + detail::number(value) + "; it must be a number > 0");
  };
  check_positive("width", o.width, false);
  check_positive("height", o.height, false);
  check_positive("radius", o.radius, true);
  if (!std::isfinite(o.angle)) throw InvalidArgument("angle is not finite");
  if (!std::isfinite(o.lift)) throw InvalidArgument("lift is not finite");
}

/// The image in the plane: coordinates in it, and its borders.
class Placement {
 public:
  explicit Placement(const DecalOptions& options)
      : options_(options), c_(std::cos(options.angle)), s_(std::sin(options.angle)) {
    const double far = std::hypot(options.width, options.height) / 2;
    if (!(options.radius < far)) return;
    const double apothem = options.radius * std::cos(std::numbers::pi / circle_corners);
    for (int k = 0; k < circle_corners; ++k) {
      const double turn = (2 * k + 1) * std::numbers::pi / circle_corners;
      circle_.push_back({std::cos(turn) / apothem, std::sin(turn) / apothem});
    }
  }

  /// Image coordinates of (u, v), in [0, 1]^2 inside.
  Vec2 to_image(const Vec2& q) const {
    const double x = (c_ * q[0] + s_ * q[1]) / options_.width, y = (c_ * q[1] - s_ * q[0]) / options_.height;
    return {0.5 + (options_.mirrored ? -x : x), 0.5 + y};
  }

  std::size_t borders() const { return 4 + circle_.size(); }
  /// A linear function of (u, v) that is 0 on border `k` and positive inside it.
  double inside(std::size_t k, const Vec2& q) const {
    if (k >= 4) return 1 - circle_[k - 4][0] * q[0] - circle_[k - 4][1] * q[1];
    const double x = to_image(q)[k / 2];
    return k % 2 == 0 ? x : 1 - x;
  }
  bool is_inside(const Vec2& q) const {
    for (std::size_t k = 0; k < borders(); ++k)
      if (!(inside(k, q) >= 0)) return false;
    return true;
  }

 private:
  DecalOptions options_;
  double c_, s_;
  std::vector<Vec2> circle_;  ///< normals of the polygon's sides, divided by their distance from the source
};

Vec2 combine(const Weights& w, const std::array<Vec2, 3>& q) {
  return {w[0] * q[0][0] + w[1] * q[1][0] + w[2] * q[2][0], w[0] * q[0][1] + w[1] * q[1][1] + w[2] * q[2][1]};
}

/// The part of a triangle inside the image, as a polygon of barycentric weights [SH74]; empty if there is none.
std::vector<Weights> clip(const Placement& image, const std::array<Vec2, 3>& q) {
  std::vector<Weights> polygon{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, kept;
  std::vector<double> inside;
  for (std::size_t k = 0; k < image.borders() && !polygon.empty(); ++k) {
    inside.clear();
    for (const Weights& w : polygon) inside.push_back(image.inside(k, combine(w, q)));
    if (*std::min_element(inside.begin(), inside.end()) >= 0) continue;
    kept.clear();
    for (std::size_t a = 0; a < polygon.size(); ++a) {
      const std::size_t b = (a + 1) % polygon.size();
      if (inside[a] >= 0) kept.push_back(polygon[a]);
      if ((inside[a] >= 0) == (inside[b] >= 0)) continue;
      const double t = inside[a] / (inside[a] - inside[b]);
      Weights& w = kept.emplace_back();
      for (std::size_t c = 0; c < 3; ++c) w[c] = (1 - t) * polygon[a][c] + t * polygon[b][c];
    }
    polygon.swap(kept);
  }
  return polygon.size() < 3 ? std::vector<Weights>{} : polygon;
}

/// Whether the inverse map returns a point of this sheet at the middle of the polygon.
bool is_visible(const InverseMap& inverse, const Triangle& t, const std::vector<Weights>& polygon) {
  Weights middle{};
  for (const Weights& w : polygon)
    for (std::size_t c = 0; c < 3; ++c) middle[c] += w[c] / static_cast<double>(polygon.size());
  const Vec2 q = combine(middle, inverse.corners(t));
  const auto answer = inverse.at(q[0], q[1]);
  if (!answer || answer->vertices == t) return true;
  double longest = 0;
  Vec3 away = answer->position;
  for (std::size_t k = 0; k < 3; ++k) {
    Vec3 edge;
    for (std::size_t c = 0; c < 3; ++c) {
      edge[c] = inverse.positions()[t[(k + 1) % 3]][c] - inverse.positions()[t[k]][c];
      away[c] -= middle[k] * inverse.positions()[t[k]][c];
    }
    longest = std::max(longest, length(edge));
  }
  return length(away) <= longest;  // on clouds, triangles of one sheet may overlap
}

/// The triangles that are connected to the first one through shared vertices, in the same order.
std::vector<Triangle> connected_to_first(const std::vector<Triangle>& triangles, std::size_t vertices) {
  detail::DisjointSets parts(triangles.empty() ? 0 : vertices);
  for (const Triangle& t : triangles)
    for (std::size_t k : {1, 2}) parts.join(t[0], t[k]);
  std::vector<Triangle> result;
  for (const Triangle& t : triangles)
    if (parts.root(t[0]) == parts.root(triangles.front()[0])) result.push_back(t);
  return result;
}

/// The triangles that show a part of the image, nearest to the source first.
struct VisibleTriangles {
  std::vector<Triangle> triangles;
  Index hidden = 0;

  VisibleTriangles(const InverseMap& inverse, const Placement& image) {
    Index all = 0;
    for (const Triangle& t : inverse.triangles()) {
      const std::vector<Weights> polygon = clip(image, inverse.corners(t));
      if (polygon.empty()) continue;
      ++all;
      if (is_visible(inverse, t, polygon)) triangles.push_back(t);
    }
    triangles = connected_to_first(triangles, inverse.positions().size());
    hidden = all - static_cast<Index>(triangles.size());
  }
};

/// Collects the pieces of a decal. They share those corners that are vertices of the surface.
class DecalBuilder {
 public:
  DecalBuilder(const InverseMap& inverse, const Placement& image, double lift)
      : inverse_(inverse), image_(image), lift_(lift), number_(inverse.positions().size(), -1) {
    decal_.face_begin.push_back(0);
  }

  void add(const Triangle& t, const std::vector<Weights>& polygon) {
    for (const Weights& w : polygon) decal_.face_vertices.push_back(point(t, w));
    decal_.face_begin.push_back(static_cast<Offset>(decal_.face_vertices.size()));
  }
  Decal take() { return std::move(decal_); }

 private:
  Index point(const Triangle& t, const Weights& w) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (w[k] != 1) continue;
      Index& number = number_[t[k]];
      if (number < 0) number = append(t, w);
      return number;
    }
    return append(t, w);
  }

  Index append(const Triangle& t, const Weights& w) {
    Vec3 position{}, normal{};
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t c = 0; c < 3; ++c) {
        position[c] += w[k] * inverse_.positions()[t[k]][c];
        normal[c] += w[k] * inverse_.normals()[t[k]][c];
      }
    const double norm = length(normal);
    for (std::size_t c = 0; c < 3; ++c) {
      if (norm > 0) normal[c] /= norm;
      position[c] += lift_ * normal[c];
    }
    decal_.points.push_back(position);
    decal_.normals.push_back(normal);
    for (double x : image_.to_image(combine(w, inverse_.corners(t))))
      decal_.image_coordinates.push_back(std::clamp(x, 0.0, 1.0));  // removes rounding errors at the borders
    return static_cast<Index>(decal_.points.size()) - 1;
  }

  const InverseMap& inverse_;
  const Placement& image_;
  double lift_;
  std::vector<Index> number_;
  Decal decal_;
};

}  // namespace

DecalOptions decal_of(const Image& image, double longer_side) {
  const double pixels = std::max(image.width, image.height);
  return {.width = longer_side * image.width / pixels,
          .height = longer_side * image.height / pixels,
          .lift = 0.002 * longer_side};
}

double reach(const DecalOptions& options) {
  return std::min(options.radius, std::hypot(options.width, options.height) / 2);
}

double map_radius(const DecalOptions& options, const TangentGraph& graph) {
  return reach(options) + 5 * graph.mean_edge_length() * graph.length_unit();
}

Decal make_decal(const InverseMap& inverse, const DecalOptions& options) {
  check(options);
  return detail::with_memory_check("making a decal", [&] {
    const Placement image(options);
    const VisibleTriangles visible(inverse, image);
    DecalBuilder builder(inverse, image, options.lift);
    for (const Triangle& t : visible.triangles) builder.add(t, clip(image, inverse.corners(t)));
    Decal decal = builder.take();
    decal.hidden = visible.hidden;
    return decal;
  });
}

std::vector<double> image_coordinates_of_vertices(const InverseMap& inverse, const DecalOptions& options) {
  check(options);
  return detail::with_memory_check("making a decal", [&] {
    const Placement image(options);
    std::vector<double> result(2 * inverse.positions().size(), std::numeric_limits<double>::quiet_NaN());
    for (const Triangle& t : VisibleTriangles(inverse, image).triangles) {
      const std::array<Vec2, 3> q = inverse.corners(t);
      for (std::size_t k = 0; k < 3; ++k) {
        if (!image.is_inside(q[k])) continue;
        const Vec2 place = image.to_image(q[k]);
        std::copy(place.begin(), place.end(), result.begin() + 2 * t[k]);
      }
    }
    return result;
  });
}

}  // namespace ahm
