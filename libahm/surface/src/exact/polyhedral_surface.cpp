#include "ahm/surface/exact/polyhedral_surface.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "ahm/error.hpp"
#include "ahm/surface/detail/gluing.hpp"
#include "ahm/util/disjoint_sets.hpp"
#include "ahm/util/parallel.hpp"
#include "ahm/util/text.hpp"
#include "ahm/util/vec.hpp"

namespace ahm::exact {
namespace {

using std::numbers::pi;

/// Angle sums that exceed 2 pi by less than this are flat.
constexpr double flat_excess = 1e-13;

constexpr const char* needs_faces = "a surface needs faces, each with three tails and three twins";

[[noreturn]] void refuse(Index face, const std::string& reason) {
  throw InvalidGeometry("face " + std::to_string(face) + " " + reason);
}

/// Twice the area, from the two shorter sides, which is most accurate.
double double_area(const FaceSides& sides, const std::array<double, 3>& length) {
  const auto longest = static_cast<int>(std::max_element(length.begin(), length.end()) - length.begin());
  return cross(sides[(longest + 1) % 3], sides[(longest + 2) % 3]);
}

void check_face(Index face, const FaceSides& sides, const std::array<double, 3>& length, double area) {
  const double longest = std::max({length[0], length[1], length[2]});
  for (int s = 0; s < 3; ++s) {
    if (!std::isfinite(length[s])) refuse(face, "has a side that is not finite");
    if (!(length[s] > 0)) refuse(face, "has a side of length 0; merge its ends");
  }
  for (int k : {0, 1})
    if (std::abs(sides[0][k] + sides[1][k] + sides[2][k]) > 1e-9 * longest) refuse(face, "has sides that do not close");
  if (!(area > PolyhedralSurface::min_height * longest * longest))
    refuse(face, "is degenerate: the ratio of its height to its longest side is " +
                     detail::number(area / longest / longest) + "; remove it or move its corners");
}

/// Lays out a triangle by its side lengths, with Kahan's stable form of 16 area^2.
FaceSides lay_out(Index face, const std::array<double, 3>& l) {
  std::array<double, 3> s = l;
  std::sort(s.begin(), s.end(), std::greater<>());
  if (!std::isfinite(s[0] + s[1] + s[2]) || !(s[2] > 0))
    refuse(face, "has a side whose length is not positive and finite");
  if (s[0] > (s[1] + s[2]) * (1 + 1e-9)) refuse(face, "breaks the triangle inequality");
  const double area = 0.5 * std::sqrt(std::max(0.0, (s[0] + (s[1] + s[2])) * (s[2] - (s[0] - s[1])) *
                                                        (s[2] + (s[0] - s[1])) * (s[0] + (s[1] - s[2]))));
  const double c = 0.5 * (l[0] + (l[2] - l[1]) * ((l[2] + l[1]) / l[0]));
  return {Vec2{l[0], 0}, Vec2{c - l[0], area / l[0]}, Vec2{-c, -area / l[0]}};
}

void check_twin(const HalfEdges& edges, Half h) {
  const Half t = edges.twin[h];
  if (t < 0) return;
  const auto refuse_side = [&](const char* reason) {
    throw InvalidGeometry("half-edge " + std::to_string(h) + " of face " + std::to_string(h / 3) + reason);
  };
  if (t >= edges.size() || t == h || edges.twin[t] != h) refuse_side(" and its twin are not mutual");
  const bool mirrored = edges.is_mirrored(h);
  if (mirrored != edges.is_mirrored(t)) refuse_side(" is mirrored, but its twin is not");
  if (edges.tail[mirrored ? next(t) : t] != edges.head(h) || edges.tail[mirrored ? t : next(t)] != edges.tail[h])
    refuse_side(" is glued to a side between other vertices");
}

/// Checks that there is one layout per face.
void check_count(const HalfEdges& edges, std::size_t faces) {
  if (edges.tail.size() != 3 * faces) throw InvalidGeometry(needs_faces);
}

}  // namespace

PolyhedralSurface::PolyhedralSurface(const HalfEdges& edges, const std::function<FaceSides(Index)>& sides_of,
                                     std::span<const Half> corners, unsigned threads) {
  if (edges.tail.empty() || edges.tail.size() % 3 != 0 || edges.twin.size() != edges.tail.size() ||
      (!edges.mirrored.empty() && edges.mirrored.size() != edges.tail.size()))
    throw InvalidGeometry(needs_faces);
  if (std::ranges::min(edges.tail) < 0) throw InvalidGeometry("a tail is negative; vertices are numbered from 0");
  face_.resize(edges.tail.size() / 3);
  detail::for_each_index(face_.size(), threads, [&](std::size_t i) {
    const auto f = static_cast<Index>(i);
    set_face(f, edges, sides_of(f));
  });
  detail::for_each_index(face_.size(), threads, [&](std::size_t f) { check_lengths(static_cast<Index>(f)); });
  set_fans(edges, corners, threads);
  set_components();
}

PolyhedralSurface::PolyhedralSurface(const HalfEdges& edges, std::span<const FaceSides> sides,
                                     std::span<const Half> corners, unsigned threads)
    : PolyhedralSurface((check_count(edges, sides.size()), edges), [&](Index f) { return sides[f]; }, corners,
                        threads) {}

PolyhedralSurface PolyhedralSurface::from_lengths(const HalfEdges& edges,
                                                  std::span<const std::array<double, 3>> lengths,
                                                  std::span<const Half> corners) {
  check_count(edges, lengths.size());
  return {edges, [&](Index f) { return lay_out(f, lengths[f]); }, corners};
}

void PolyhedralSurface::set_face(Index face, const HalfEdges& edges, const FaceSides& sides) {
  std::array<double, 3> length;
  for (int s = 0; s < 3; ++s) length[s] = std::hypot(sides[s][0], sides[s][1]);
  const double area = double_area(sides, length);
  check_face(face, sides, length, area);
  Face& f = face_[face];
  for (int s = 0; s < 3; ++s) {
    const Half h = 3 * face + s;
    check_twin(edges, h);
    const double along = -dot(sides[s], sides[(s + 2) % 3]);
    f.length[s] = length[s];
    f.apex_x[s] = along / length[s];
    f.apex_y[s] = area / length[s];
    f.angle[s] = std::atan2(area, along);
    f.tail[s] = edges.tail[h];
    f.beyond[s] = std::max(edges.twin[h], -1);
    f.mirrored |= static_cast<std::uint8_t>(edges.is_mirrored(h) << s);
  }
}

/// Checks that the faces across the sides of a face have the same lengths for them.
void PolyhedralSurface::check_lengths(Index face) const {
  for (Half h = 3 * face; h < 3 * face + 3; ++h) {
    const Half t = face_[face].beyond[h % 3];
    if (t < 0) continue;
    const double here = face_[face].length[h % 3], there = face_[t / 3].length[t % 3];
    if (std::abs(here - there) > 1e-9 * here)
      throw InvalidGeometry("faces " + std::to_string(face) + " and " + std::to_string(t / 3) +
                            " have different lengths for their common side: " + detail::number(here) + " and " +
                            detail::number(there));
  }
}

void PolyhedralSurface::set_fans(const HalfEdges& edges, std::span<const Half> corners, unsigned threads) {
  const Index vertices = std::max(std::ranges::max(edges.tail) + 1, static_cast<Index>(corners.size()));
  std::vector<Index> corners_at(vertices, 0);
  corner_.resize(corners_at.size());
  for (Half h = edges.size(); h-- > 0;) {
    ++corners_at[edges.tail[h]];
    corner_[edges.tail[h]] = {h, true};
  }
  angle_sum_.resize(corner_.size());
  on_boundary_.resize(corner_.size());
  detail::for_each_index(corner_.size(), threads, [&](std::size_t i) {
    const auto v = static_cast<Index>(i);
    if (!corners.empty()) corner_[v].half = corners[v];
    if (corner_[v].half < 0 && !corners.empty() && corners_at[v] == 0) {
      on_boundary_[v] = 1;
      return;
    }
    if (corner_[v].half < 0 || edges.tail[corner_[v].half] != v)
      throw InvalidGeometry("vertex " + std::to_string(v) + " has no face, or a corner of another vertex");
    corner_[v] = edges.rightmost(corner_[v]);
    on_boundary_[v] = edges.turn_right(corner_[v]).half < 0;
    Index met = 0;
    Corner at = corner_[v];
    do {
      angle_sum_[v] += angle(at.half);
      at = turn_left(at);
    } while (++met < corners_at[v] && at.half >= 0 && at != corner_[v]);
    if (met != corners_at[v])
      throw InvalidGeometry("vertex " + std::to_string(v) + " joins several fans of faces; split it");
  });
}

void PolyhedralSurface::set_components() {
  detail::DisjointSets parts(corner_.size());
  for (const Face& face : face_) {
    parts.join(face.tail[0], face.tail[1]);
    parts.join(face.tail[0], face.tail[2]);
  }
  component_.assign(corner_.size(), -1);
  for (Index v = 0; v < vertex_count(); ++v) {
    Index& number = component_[parts.root(v)];
    if (number < 0) number = static_cast<Index>(components_.size()), components_.emplace_back();
    component_[v] = number;
    ++components_[number].vertices;
  }
  std::vector<Offset> sides(components_.size(), 0);
  for (const Face& face : face_)
    for (int s = 0; s < 3; ++s) {
      components_[component_[face.tail[s]]].mean_length += face.length[s];
      ++sides[component_[face.tail[s]]];
    }
  for (std::size_t c = 0; c < components_.size(); ++c)
    if (sides[c] > 0) components_[c].mean_length /= static_cast<double>(sides[c]);
}

bool PolyhedralSurface::bends_paths(Index v) const { return on_boundary(v) || angle_sum_[v] > 2 * pi + flat_excess; }

double PolyhedralSurface::angle_scale(Index v) const { return on_boundary(v) ? 1.0 : 2 * pi / angle_sum_[v]; }

double PolyhedralSurface::turned(Corner corner) const {
  double sum = 0;
  for (Corner c = first_corner(face_[corner.half / 3].tail[corner.half % 3]); c.half != corner.half; c = turn_left(c))
    sum += angle(c.half);
  return sum;
}

MeshPoint PolyhedralSurface::vertex_point(Vertex vertex) const {
  if (vertex.index < 0 || vertex.index >= vertex_count())
    throw InvalidArgument("vertex " + std::to_string(vertex.index) + " is outside [0, " +
                          std::to_string(vertex_count()) + ")");
  const Half h = corner_[vertex.index].half;
  if (h < 0)
    throw InvalidGeometry("vertex_without_triangles", "vertex " + std::to_string(vertex.index) + " is in no triangle",
                          "choose another vertex");
  MeshPoint point{h / 3, {0, 0, 0}};
  point.barycentric[h % 3] = 1;
  return point;
}

Vec2 PolyhedralSurface::place(const MeshPoint& point) const {
  const Face& f = face_[point.face];
  const auto& b = point.barycentric;
  return {b[1] * f.length[0] + b[2] * f.apex_x[0], b[2] * f.apex_y[0]};
}

}  // namespace ahm::exact
