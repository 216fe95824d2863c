#include "tool_path/fine_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

#include "ahm/error.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/vec.hpp"

namespace ahm {
namespace {

using detail::Half;

void check_number(double faces) {
  constexpr double most = 1 << 26;
  if (!(faces <= most))
    throw ResourceExhausted("the spacing requires more than 2^26 triangles; enlarge it, or cover a smaller region");
}

Vec3 corner_position(const FaceMesh& mesh, Index face, std::size_t corner) {
  return mesh.points[static_cast<std::size_t>(mesh.faces[static_cast<std::size_t>(face)][corner])];
}

/// One step of a refinement: sides are split, and faces are divided at the points on their sides.
class Splitter {
 public:
  explicit Splitter(const Refinement& coarse) : coarse_(coarse), middle_(3 * coarse.mesh.size(), -1) {
    fine_.mesh.points = coarse.mesh.points;
    fine_.mesh.vertices = coarse.mesh.vertices;
  }

  /// Splits all sides longer than a limit in two, so that as few parts as possible are at most `longest` in the end.
  /// @return whether there was one
  bool split_sides(double limit, double longest) {
    const FaceMesh& mesh = coarse_.mesh;
    for (std::size_t h = 0; h < middle_.size(); ++h) {
      const Half twin = mesh.twin[h];
      if (twin >= 0 && to_size(twin) < h) {
        middle_[h] = middle_[to_size(twin)];
        continue;
      }
      const Vec3 a = mesh.points[to_size(mesh.tail(static_cast<Half>(h)))],
                 b = mesh.points[to_size(mesh.head(static_cast<Half>(h)))];
      const double length = distance(a, b);
      if (!(length > limit)) continue;
      const double parts = std::ceil(length / longest), share = std::ceil(parts / 2) / parts;
      middle_[h] = static_cast<Index>(fine_.mesh.points.size());
      fine_.mesh.points.push_back((1 - share) * a + share * b);
      fine_.mesh.vertices.push_back(-1);
    }
    return fine_.mesh.points.size() > mesh.points.size();
  }

  /// @throws ResourceExhausted
  Refinement divide_faces() && {
    halves_.assign(middle_.size(), {-1, -1});
    for (std::size_t f = 0; f < coarse_.mesh.size(); ++f) divide(f);
    glue_sides();
    return std::move(fine_);
  }

 private:
  void divide(std::size_t f) {
    std::array<Index, 3> p = coarse_.mesh.faces[f], m{middle_[3 * f], middle_[3 * f + 1], middle_[3 * f + 2]};
    const auto split = std::ranges::count_if(m, [](Index k) { return k >= 0; });
    const auto turn = [&] {
      std::rotate(p.begin(), p.begin() + 1, p.end());
      std::rotate(m.begin(), m.begin() + 1, m.end());
    };
    std::vector<Triangle>& faces = fine_.mesh.faces;
    const std::size_t first = faces.size();
    if (split == 0) faces.push_back(p);
    if (split == 1) {
      while (m[0] < 0) turn();
      faces.insert(faces.end(), {{p[0], m[0], p[2]}, {m[0], p[1], p[2]}});
    }
    if (split == 2) {
      while (m[2] >= 0) turn();
      const auto at = [&](Index k) { return fine_.mesh.points[to_size(k)]; };
      faces.push_back({m[0], p[1], m[1]});
      if (distance(at(p[0]), at(m[1])) < distance(at(m[0]), at(p[2])))
        faces.insert(faces.end(), {{p[0], m[0], m[1]}, {p[0], m[1], p[2]}});
      else
        faces.insert(faces.end(), {{p[0], m[0], p[2]}, {m[0], m[1], p[2]}});
    }
    if (split == 3)
      faces.insert(faces.end(), {{p[0], m[0], m[2]}, {m[0], p[1], m[1]}, {m[2], m[1], p[2]}, {m[0], m[1], m[2]}});
    check_number(static_cast<double>(faces.size()));
    fine_.parent.resize(faces.size(), coarse_.parent[f]);
    fine_.mesh.twin.resize(3 * faces.size(), -1);
    fine_.mesh.mirrored.resize(3 * faces.size(), 0);
    for (std::size_t h = 3 * first; h < 3 * faces.size(); ++h) place(f, first, static_cast<Half>(h));
  }

  /// Finds the side of a face that contains a side of one of its parts, or the other part that has this side.
  void place(std::size_t f, std::size_t first, Half h) {
    const FaceMesh& fine = fine_.mesh;
    const Index from = fine.tail(h), to = fine.head(h);
    for (std::size_t side = 3 * f; side < 3 * f + 3; ++side) {
      const Index tail = coarse_.mesh.tail(static_cast<Half>(side)), head = coarse_.mesh.head(static_cast<Half>(side));
      if (from == tail && to == (middle_[side] < 0 ? head : middle_[side])) halves_[side][0] = h;
      if (from == middle_[side] && to == head) halves_[side][1] = h;
    }
    for (Half other = static_cast<Half>(3 * first); other < h; ++other)
      if (fine.tail(other) == to && fine.head(other) == from) {
        fine_.mesh.twin[to_size(h)] = other;
        fine_.mesh.twin[to_size(other)] = h;
      }
  }

  /// Glues the parts of sides as the sides were.
  void glue_sides() {
    for (std::size_t h = 0; h < halves_.size(); ++h) {
      if (coarse_.mesh.twin[h] < 0) continue;
      const std::array<Half, 2> own = halves_[h];
      std::array<Half, 2> other = halves_[to_size(coarse_.mesh.twin[h])];
      const bool mirrored = coarse_.mesh.mirrored[h] != 0;
      if (middle_[h] >= 0 && !mirrored) std::swap(other[0], other[1]);
      for (std::size_t k = 0; k < (middle_[h] >= 0 ? 2U : 1U); ++k) {
        fine_.mesh.twin[to_size(own[k])] = other[k];
        fine_.mesh.mirrored[to_size(own[k])] = mirrored ? 1 : 0;
      }
    }
  }

  const Refinement& coarse_;
  Refinement fine_;
  std::vector<Index> middle_;                ///< per half-edge: the point that splits it; -1: none
  std::vector<std::array<Half, 2>> halves_;  ///< per half-edge: its parts, from its tail
};

}  // namespace

void BoundingBox::include(const Vec3& p) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    low[axis] = std::min(low[axis], p[axis]), high[axis] = std::max(high[axis], p[axis]);
}

double BoundingBox::diagonal() const { return distance(low, high); }
Vec3 BoundingBox::center() const { return 0.5 * (low + high); }

double BoundingBox::distance_to(const Vec3& p) const {
  Vec3 nearest;
  for (std::size_t axis = 0; axis < 3; ++axis) nearest[axis] = std::clamp(p[axis], low[axis], high[axis]);
  return distance(nearest, p);
}

BoundingBox bounding_box(const std::vector<Vec3>& points) {
  BoundingBox box{points.front(), points.front()};
  for (const Vec3& p : points) box.include(p);
  return box;
}

void check_refinement(const FaceMesh& mesh, double longest) {
  double area = 0;
  for (std::size_t f = 0; f < mesh.size(); ++f) area += mesh.area(static_cast<Index>(f));
  check_number(area / (std::numbers::sqrt3 / 4 * longest * longest));
}

Refinement refined(const FaceMesh& mesh, double longest) {
  Refinement result{mesh, std::vector<Index>(mesh.size())};
  std::iota(result.parent.begin(), result.parent.end(), 0);
  double longest_now = 0;
  for (std::size_t h = 0; h < 3 * mesh.size(); ++h)
    longest_now = std::max(longest_now, distance(mesh.points[to_size(mesh.tail(static_cast<Half>(h)))],
                                                 mesh.points[to_size(mesh.head(static_cast<Half>(h)))]));
  // Long sides first, so that needles are cut across.
  for (double limit = longest_now; limit > longest;) {
    limit = std::max(limit / 2, longest);
    for (;;) {
      Splitter splitter(result);
      if (!splitter.split_sides(limit, longest)) break;
      result = std::move(splitter).divide_faces();
    }
  }
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

MeshTree::MeshTree(const FaceMesh& mesh)
    : mesh_(mesh),
      begin_([&] {
        std::vector<Offset> begin;
        for (std::size_t f = 0; f <= mesh.size(); ++f) begin.push_back(static_cast<Offset>(3 * f));
        return begin;
      }()),
      tree_(mesh.points, FaceList{begin_, {mesh.faces.front().data(), 3 * mesh.size()}}) {}

MeshTree::Hit MeshTree::nearest(const Vec3& position) const {
  const detail::FaceTree::Hit hit = tree_.nearest(position);
  const std::vector<double>& weights = hit.point.barycentric;
  return {{hit.point.face, {weights[0], weights[1], weights[2]}}, hit.distance};
}

}  // namespace ahm
