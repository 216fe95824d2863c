#include "tool_path/fine_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

#include "ahm/error.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/vec.hpp"

namespace ahm {
namespace {

using detail::Half;

constexpr std::size_t max_faces = std::size_t{1} << 26;

Vec3 corner_position(const FaceMesh& mesh, Index face, std::size_t corner) {
  return mesh.points[static_cast<std::size_t>(mesh.faces[static_cast<std::size_t>(face)][corner])];
}

/// Splits all sides longer than a limit once, so that as few parts as possible are at most `longest`.
/// @return whether there was one
bool split_long_sides(FaceMesh& mesh, double limit, double longest, std::vector<Index>& parents) {
  std::vector<Index> middle(3 * mesh.size(), -1);
  bool any = false;
  for (std::size_t h = 0; h < middle.size(); ++h) {
    const auto half = static_cast<Half>(h);
    const Half twin = mesh.twin[h];
    if (twin >= 0 && twin < half) {
      middle[h] = middle[static_cast<std::size_t>(twin)];
      continue;
    }
    const Vec3 a = mesh.points[static_cast<std::size_t>(mesh.tail(half))],
               b = mesh.points[static_cast<std::size_t>(mesh.head(half))];
    const double length = distance(a, b);
    if (!(length > limit)) continue;
    const double parts = std::ceil(length / longest), share = std::ceil(parts / 2) / parts;
    middle[h] = static_cast<Index>(mesh.points.size());
    mesh.points.push_back((1 - share) * a + share * b);
    mesh.vertices.push_back(-1);
    any = true;
  }
  if (!any) return false;
  std::vector<Triangle> faces;
  std::vector<Index> of;
  const auto add = [&](std::size_t parent, Index a, Index b, Index c) {
    faces.push_back({a, b, c});
    of.push_back(parents[parent]);
  };
  for (std::size_t f = 0; f < mesh.size(); ++f) {
    std::array<Index, 3> p = mesh.faces[f], m{middle[3 * f], middle[3 * f + 1], middle[3 * f + 2]};
    const auto split = std::ranges::count_if(m, [](Index k) { return k >= 0; });
    const auto turn = [&] {
      std::rotate(p.begin(), p.begin() + 1, p.end());
      std::rotate(m.begin(), m.begin() + 1, m.end());
    };
    if (split == 0) add(f, p[0], p[1], p[2]);
    if (split == 1) {
      while (m[0] < 0) turn();
      add(f, p[0], m[0], p[2]);
      add(f, m[0], p[1], p[2]);
    }
    if (split == 2) {
      while (m[2] >= 0) turn();
      add(f, m[0], p[1], m[1]);
      const auto at = [&](Index k) { return mesh.points[static_cast<std::size_t>(k)]; };
      if (distance(at(p[0]), at(m[1])) < distance(at(m[0]), at(p[2]))) {
        add(f, p[0], m[0], m[1]);
        add(f, p[0], m[1], p[2]);
      } else {
        add(f, p[0], m[0], p[2]);
        add(f, m[0], m[1], p[2]);
      }
    }
    if (split == 3) {
      add(f, p[0], m[0], m[2]);
      add(f, m[0], p[1], m[1]);
      add(f, m[2], m[1], p[2]);
      add(f, m[0], m[1], m[2]);
    }
    if (faces.size() > max_faces)
      throw ResourceExhausted("the spacing requires more than 2^26 triangles; enlarge it, or cover a smaller region");
  }
  parents = std::move(of);
  mesh = glued(std::move(mesh.points), std::move(faces), std::move(mesh.vertices));
  return true;
}

}  // namespace

Refinement refined(const FaceMesh& mesh, double longest) {
  Refinement result{mesh, std::vector<Index>(mesh.size()), {}};
  std::iota(result.face.begin(), result.face.end(), 0);
  std::iota(result.mesh.vertices.begin(), result.mesh.vertices.end(), 0);
  double longest_now = 0;
  for (std::size_t h = 0; h < 3 * mesh.size(); ++h)
    longest_now = std::max(longest_now, distance(mesh.points[to_size(mesh.tail(static_cast<Half>(h)))],
                                                 mesh.points[to_size(mesh.head(static_cast<Half>(h)))]));
  // Long sides first, so that needles are cut across.
  for (double limit = longest_now; limit > longest;) {
    limit = std::max(limit / 2, longest);
    while (split_long_sides(result.mesh, limit, longest, result.face)) continue;
  }
  result.point = result.mesh.vertices;
  for (Index& vertex : result.mesh.vertices)
    if (vertex >= 0) vertex = mesh.vertices[to_size(vertex)];
  return result;
}

FaceMesh part_of(const FaceMesh& mesh, const std::vector<bool>& kept) {
  std::vector<Triangle> faces;
  for (std::size_t f = 0; f < mesh.size(); ++f)
    if (kept[f]) faces.push_back(mesh.faces[f]);
  return glued(mesh.points, std::move(faces), mesh.vertices);
}

exact::PolyhedralSurface polyhedral(const FaceMesh& mesh) {
  // Boundary sides have distinct negative twins.
  std::vector<Index> tails(3 * mesh.size());
  std::vector<Half> twin = mesh.twin;
  Half boundary = 0;
  for (std::size_t h = 0; h < twin.size(); ++h) {
    tails[h] = mesh.tail(static_cast<Half>(h));
    if (twin[h] < 0) twin[h] = -1 - boundary++;
  }
  const detail::HalfEdges edges{tails, twin, mesh.mirrored};
  return {edges, [&](Index f) -> exact::FaceSides {
            const Vec3 a = corner_position(mesh, f, 0), ab = corner_position(mesh, f, 1) - a,
                       ac = corner_position(mesh, f, 2) - a;
            const double length = norm(ab), along = dot(ab, ac) / length;
            const Vec2 third{along, norm(cross(ab, ac)) / length};
            return {Vec2{length, 0}, third - Vec2{length, 0}, -third};
          }};
}

std::array<double, 3> nearest_in_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  // The regions that are nearest to the corners, to the sides, and to the interior.
  const Vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap), d3 = dot(ab, bp), d4 = dot(ac, bp), d5 = dot(ab, cp),
               d6 = dot(ac, cp);
  if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
  if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {1 - d1 / (d1 - d3), d1 / (d1 - d3), 0};
  if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {1 - d2 / (d2 - d6), 0, d2 / (d2 - d6)};
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {0, 1 - w, w};
  }
  const double v = vb / (va + vb + vc), w = vc / (va + vb + vc);
  return {1 - v - w, v, w};
}

/// Faces by the cubes that their bounding boxes, enlarged by the reach, meet.
struct FaceLocator::Grid {
  static constexpr int bits = 21;
  using Key = std::uint64_t;

  double cell;
  std::vector<std::pair<Key, Index>> entries;

  std::int64_t number(double x) const { return static_cast<std::int64_t>(std::floor(x / cell)); }
  static Key key(std::int64_t x, std::int64_t y, std::int64_t z) {
    constexpr Key mask = (Key{1} << bits) - 1;
    return (static_cast<Key>(x) & mask) << (2 * bits) | (static_cast<Key>(y) & mask) << bits |
           (static_cast<Key>(z) & mask);
  }
};

FaceLocator::FaceLocator(const FaceMesh& mesh, double reach)
    : mesh_(&mesh), reach_(reach), grid_(std::make_unique<Grid>()) {
  grid_->cell = 2 * reach;
  for (std::size_t f = 0; f < mesh.size(); ++f) {
    std::array<std::int64_t, 3> low{}, high{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      double least = std::numeric_limits<double>::infinity(), most = -least;
      for (std::size_t c = 0; c < 3; ++c) {
        const double x = corner_position(mesh, static_cast<Index>(f), c)[axis];
        least = std::min(least, x), most = std::max(most, x);
      }
      low[axis] = grid_->number(least - reach), high[axis] = grid_->number(most + reach);
    }
    for (std::int64_t x = low[0]; x <= high[0]; ++x)
      for (std::int64_t y = low[1]; y <= high[1]; ++y)
        for (std::int64_t z = low[2]; z <= high[2]; ++z)
          grid_->entries.emplace_back(Grid::key(x, y, z), static_cast<Index>(f));
  }
  std::sort(grid_->entries.begin(), grid_->entries.end());
}

FaceLocator::~FaceLocator() = default;
FaceLocator::FaceLocator(FaceLocator&&) noexcept = default;

std::optional<exact::MeshPoint> FaceLocator::nearest(const Vec3& position) const {
  const Grid::Key key = Grid::key(grid_->number(position[0]), grid_->number(position[1]), grid_->number(position[2]));
  std::optional<exact::MeshPoint> best;
  double least = reach_;
  for (auto entry = std::lower_bound(grid_->entries.begin(), grid_->entries.end(), std::pair{key, Index{-1}});
       entry != grid_->entries.end() && entry->first == key; ++entry) {
    const Index f = entry->second;
    const exact::MeshPoint point{f, nearest_in_triangle(position, corner_position(*mesh_, f, 0),
                                                        corner_position(*mesh_, f, 1), corner_position(*mesh_, f, 2))};
    if (const double away = distance(mesh_->position(point), position); away < least) least = away, best = point;
  }
  return best;
}

}  // namespace ahm
