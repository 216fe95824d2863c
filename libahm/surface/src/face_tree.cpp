#include "ahm/surface/detail/face_tree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "ahm/error.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/vec.hpp"

namespace ahm::detail {
namespace {

constexpr std::size_t leaf = 4;  ///< maximum number of triangles in a leaf
constexpr double infinity = std::numeric_limits<double>::infinity();
/// Relative tolerance. A point within this fraction of a side from an edge or a corner lies on it. Of faces whose distances
/// differ by less than this fraction of their coordinates, the first is the nearest. So a curve that crosses an edge is the
/// same one at any scale and rotation.
constexpr double rounding = 1e-12;

/// Parameter in [0, 1] of the point of the segment from a to b that is nearest to p.
double along(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 d = b - a;
  const double squared = dot(d, d);
  const double t = squared > 0 ? dot(p - a, d) / squared : 0.0;
  return t < rounding ? 0 : t > 1 - rounding ? 1 : t;
}

Vec3 combined(const std::array<Vec3, 3>& t, const std::array<double, 3>& weights) {
  Vec3 result{};
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t a = 0; a < 3; ++a) result[a] += weights[k] * t[k][a];
  return result;
}

/// Whether the plane of a triangle is certainly farther from p than a distance. The normal of a needle is inexact, so a needle is beyond
/// only if its plane is farther by the error.
bool is_beyond(const std::array<Vec3, 3>& t, const Vec3& p, double distance) {
  constexpr double margin = 1e-6, rounding_of_normals = 1e-24;
  const Vec3 u = t[1] - t[0], v = t[2] - t[0], w = p - t[0], normal = cross(u, v);
  const double height = dot(w, normal);
  return height * height > (1 + margin) * distance * distance * dot(normal, normal) +
                               rounding_of_normals * dot(u, u) * dot(v, v) * dot(w, w);
}

/// Barycentric coordinates of the point of a triangle nearest to p: its projection, or the nearest point on an edge.
std::array<double, 3> nearest_weights(const std::array<Vec3, 3>& t, const Vec3& p) {
  const Vec3 u = t[1] - t[0], v = t[2] - t[0], w = p - t[0];
  const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), area = uu * vv - uv * uv;
  const double second = (vv * dot(w, u) - uv * dot(w, v)) / area, third = (uu * dot(w, v) - uv * dot(w, u)) / area;
  if (second >= rounding && third >= rounding && second + third <= 1 - rounding)
    return {1 - second - third, second, third};
  std::array<double, 3> best{};
  double least = infinity;
  for (std::size_t k = 0; k < 3; ++k) {
    std::array<double, 3> weights{};
    weights[(k + 1) % 3] = along(p, t[k], t[(k + 1) % 3]);
    weights[k] = 1 - weights[(k + 1) % 3];
    const Vec3 d = combined(t, weights) - p;
    if (!(dot(d, d) < least)) continue;
    least = dot(d, d);
    best = weights;
  }
  return best;
}

/// The point of a triangle that is nearest to a position.
struct Candidate {
  std::array<double, 3> weights;  ///< barycentric coordinates
  Vec3 position;
  double distance;
};
Candidate nearest_in(const std::array<Vec3, 3>& t, const Vec3& p) {
  const std::array<double, 3> weights = nearest_weights(t, p);
  const Vec3 position = combined(t, weights);
  return {weights, position, norm(position - p)};
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

FaceTree::FaceTree(std::span<const Vec3> positions, const FaceList& faces) : positions_(positions), faces_(faces) {
  for (std::size_t f = 0; f < faces.size(); ++f)
    for (std::size_t c = 1; c + 1 < faces[f].size(); ++c) {
      const Piece piece{static_cast<Index>(f), static_cast<Index>(c)};
      if (is_finite(corner(piece, 0)) && is_finite(corner(piece, 1)) && is_finite(corner(piece, 2)))
        pieces_.push_back(piece);
    }
  if (pieces_.empty()) throw InvalidGeometry("the mesh has no face with finite corners");
  build(0, pieces_.size());
}

const Vec3& FaceTree::corner(const Piece& piece, int k) const {
  const Index c = k == 0 ? 0 : piece.corner + k - 1;
  return positions_[faces_[piece.face][c]];
}

void FaceTree::build(std::size_t begin, std::size_t end) {
  Box box{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}, begin, end, 0};
  for (std::size_t t = begin; t < end; ++t)
    for (int k = 0; k < 3; ++k) {
      const Vec3& p = corner(pieces_[t], k);
      for (std::size_t a = 0; a < 3; ++a)
        box.low[a] = std::min(box.low[a], p[a]), box.high[a] = std::max(box.high[a], p[a]);
    }
  const std::size_t number = boxes_.size();
  boxes_.push_back(box);
  if (end - begin <= leaf) return;
  const auto middle_of = [&](const Piece& t) {
    return (1.0 / 3) * corner(t, 0) + (1.0 / 3) * corner(t, 1) + (1.0 / 3) * corner(t, 2);
  };
  Vec3 low = middle_of(pieces_[begin]), high = low;
  for (std::size_t t = begin; t < end; ++t) {
    const Vec3 middle = middle_of(pieces_[t]);
    for (std::size_t a = 0; a < 3; ++a) low[a] = std::min(low[a], middle[a]), high[a] = std::max(high[a], middle[a]);
  }
  const Vec3 sides = high - low;
  const auto axis = static_cast<std::size_t>(std::max_element(sides.begin(), sides.end()) - sides.begin());
  const std::size_t half = begin + (end - begin) / 2;
  const auto at = [&](std::size_t t) { return pieces_.begin() + static_cast<std::ptrdiff_t>(t); };
  std::nth_element(at(begin), at(half), at(end),
                   [&](const Piece& a, const Piece& b) { return middle_of(a)[axis] < middle_of(b)[axis]; });
  build(begin, half);
  boxes_[number].second = boxes_.size();
  build(half, end);
}

/// State of a search; all lengths times `scale`, so that coordinates are less than 2.
struct FaceTree::Search {
  double scale;
  Vec3 from;
  double size;  ///< largest coordinate of `from`
  double least = infinity;

  double squared_distance(const Box& box) const {
    return detail::squared_distance(from, scale * box.low, scale * box.high);
  }
  /// The square of the largest distance of a box that must be searched: that of the nearest point so far, and rounding.
  double squared_reach() const { return (least + 2 * rounding) * (least + 2 * rounding); }
};

/// Visits the triangles in a box that may be the nearest.
template <class Visitor>
void FaceTree::visit(std::size_t number, const Search& search, const Visitor& visitor) const {
  const Box& box = boxes_[number];
  if (box.second == 0) {
    for (std::size_t t = box.begin; t < box.end; ++t) visitor(pieces_[t]);
    return;
  }
  std::size_t near = number + 1, far = box.second;
  double to_near = search.squared_distance(boxes_[near]), to_far = search.squared_distance(boxes_[far]);
  if (to_far < to_near) std::swap(near, far), std::swap(to_near, to_far);
  if (to_near <= search.squared_reach()) visit(near, search, visitor);
  if (to_far <= search.squared_reach()) visit(far, search, visitor);
}

FaceTree::Search FaceTree::search_from(const Vec3& position) const {
  const double size = std::max({largest(boxes_[0].low), largest(boxes_[0].high), largest(position)});
  const double scale = 1 / power_of_two_below(size);
  return {scale, scale * position, scale * largest(position)};
}

std::optional<Vec3> FaceTree::nearest_position(const Vec3& position, double within) const {
  Search search = search_from(position);
  search.least = search.scale * within;
  std::optional<Vec3> best;
  visit(0, search, [&](const Piece& piece) {
    const std::array<Vec3, 3> triangle = corners(piece, search.scale);
    if (is_beyond(triangle, search.from, search.least)) return;
    const Candidate here = nearest_in(triangle, search.from);
    if (here.distance < search.least) search.least = here.distance, best = here.position;
  });
  if (best) *best = (1 / search.scale) * *best;
  return best;
}

FaceTree::Hit FaceTree::nearest(const Vec3& position) const {
  Search search = search_from(position);
  const double scale = search.scale, unit = 1 / scale;
  visit(0, search, [&](const Piece& piece) {
    const std::array<Vec3, 3> triangle = corners(piece, scale);
    if (!is_beyond(triangle, search.from, search.least))
      search.least = std::min(search.least, nearest_in(triangle, search.from).distance);
  });
  Hit best;
  bool found = false;
  visit(0, search, [&](const Piece& piece) {
    if (found && piece.face > best.point.face) return;
    const std::array<Vec3, 3> triangle = corners(piece, scale);
    const Candidate here = nearest_in(triangle, search.from);
    const double size = std::max({search.size, largest(triangle[0]), largest(triangle[1]), largest(triangle[2])});
    if (here.distance > search.least + rounding * size) return;
    if (found && piece.face == best.point.face && !(unit * here.distance < best.distance)) return;
    std::vector<double> of_corners(faces_[piece.face].size(), 0.0);
    of_corners[0] = here.weights[0];
    of_corners[piece.corner] = here.weights[1];
    of_corners[piece.corner + 1] = here.weights[2];
    best = {{piece.face, std::move(of_corners)}, unit * here.position, unit * here.distance};
    found = true;
  });
  return best;
}

/// Times `scale`.
std::array<Vec3, 3> FaceTree::corners(const Piece& piece, double scale) const {
  return {scale * corner(piece, 0), scale * corner(piece, 1), scale * corner(piece, 2)};
}

}  // namespace ahm::detail
