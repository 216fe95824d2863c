#include "polygon.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include "ahm/error.hpp"
#include "ahm/maps/cost.hpp"
#include "ahm/util/component_lengths.hpp"
#include "ahm/util/parallel.hpp"

namespace ahm::polymesh {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Triangles thinner than this, relative to their longest side, are treated as if they had this height.
constexpr double min_height = 1e-10;

/// The x with the smallest |x| that minimizes |S x - b|, for symmetric positive semi-definite S. Treats eigenvalues below
/// `threshold` times the largest one as zero.
Vector3d solve_least(const Matrix3d& S, const Vector3d& b, double threshold) {
  const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(S);
  Vector3d y = eigen.eigenvectors().transpose() * b;
  const double largest = eigen.eigenvalues()[2];
  for (int k = 0; k < 3; ++k) y[k] = eigen.eigenvalues()[k] > threshold * largest ? y[k] / eigen.eigenvalues()[k] : 0.0;
  return eigen.eigenvectors() * y;
}

/// Twice the area of a triangle, at least `min_height` times its longest side squared.
double doubled_area(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const double longest = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
  return std::max((b - a).cross(c - a).norm(), min_height * longest);
}

}  // namespace

void Polygon::read_corners(const PolygonMesh& mesh, Index face) {
  corner_.clear();
  for (Index v : mesh.face(face)) corner_.emplace_back(mesh.position(Vertex(v)).data());
}

void Polygon::read(const PolygonMesh& mesh, Index face) {
  read_corners(mesh, face);
  find_middle();
  find_weights();
}

/// The gradient of sum (x_c - p)^T M_c (x_c - p), with M_c = |e|^2 I - e e^T for the side e at corner c, is zero where
/// (sum M_c) p = sum M_c x_c. Positions are relative to the mean of the corners, which is p if the corners lie on a line.
void Polygon::find_middle() {
  const std::size_t m = size();
  Vector3d mean = Vector3d::Zero();
  for (const Vector3d& x : corner_) mean += x / static_cast<double>(m);
  Matrix3d S = Matrix3d::Zero();
  Vector3d b = Vector3d::Zero();
  for (std::size_t c = 0; c < m; ++c) {
    const Vector3d side = corner_[(c + 1) % m] - corner_[c];
    const Matrix3d M = side.squaredNorm() * Matrix3d::Identity() - side * side.transpose();
    S += M;
    b += M * (corner_[c] - mean);
  }
  middle_ = mean + solve_least(S, b, 1e-12);
}

/// The smallest weights that sum to one and reproduce p: w_c = 1/m + X_c . y, where X are the corners relative to their mean and
/// (X^T X) y = p - mean. Finally p is recomputed from the weights.
void Polygon::find_weights() {
  const std::size_t m = size();
  Vector3d mean = Vector3d::Zero();
  for (const Vector3d& x : corner_) mean += x / static_cast<double>(m);
  Matrix3d S = Matrix3d::Zero();
  for (const Vector3d& x : corner_) S += (x - mean) * (x - mean).transpose();
  const Vector3d y = solve_least(S, middle_ - mean, 1e-10);
  weight_.resize(m);
  for (std::size_t c = 0; c < m; ++c) weight_[c] = 1.0 / static_cast<double>(m) + (corner_[c] - mean).dot(y);
  middle_.setZero();
  for (std::size_t c = 0; c < m; ++c) middle_ += weight_[c] * corner_[c];
}

Vector3d Polygon::vector_area() const {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t c = 1; c + 1 < size(); ++c) sum += (corner_[c] - corner_[0]).cross(corner_[c + 1] - corner_[0]);
  return 0.5 * sum;
}

bool Polygon::is_collinear() const {
  const auto away = [&](const Vector3d& x) { return (x - corner_[0]).norm(); };
  const Vector3d end = *std::max_element(corner_.begin(), corner_.end(),
                                         [&](const auto& a, const auto& b) { return away(a) < away(b); });
  const double length = away(end), least = std::max(min_height * length, 0x1p-50);
  return length <= least || std::all_of(corner_.begin(), corner_.end(), [&](const Vector3d& x) {
           return (x - corner_[0]).cross(end - corner_[0]).norm() <= least * length;
         });
}

bool Polygon::is_folded() const {
  const Vector3d area = vector_area();
  for (std::size_t c = 0; c < size(); ++c) {
    const Vector3d of_triangle = 0.5 * (corner_[c] - middle_).cross(corner_[(c + 1) % size()] - middle_);
    if (of_triangle.dot(area) < -1e-9 * area.squaredNorm()) return true;
  }
  return false;
}

bool Polygon::cut_ears(std::vector<std::array<std::size_t, 3>>& triangles) const {
  const Vector3d area = vector_area();
  const Vector3d normal = area.norm() > 0 ? Vector3d(area.normalized()) : Vector3d(0, 0, 1);
  const Vector3d x = normal.unitOrthogonal(), y = normal.cross(x);
  std::vector<Eigen::Vector2d> in_plane;
  for (const Vector3d& c : corner_) in_plane.emplace_back(x.dot(c), y.dot(c));
  auto turn = [&](std::size_t a, std::size_t b, std::size_t c) {
    const Eigen::Vector2d u = in_plane[b] - in_plane[a], v = in_plane[c] - in_plane[b];
    return u[0] * v[1] - u[1] * v[0];
  };
  std::vector<std::size_t> left(size());
  std::iota(left.begin(), left.end(), std::size_t{0});
  const std::size_t before = triangles.size();
  while (left.size() > 3) {
    // Takes the roundest ear, so that straight corners wait for a better triangle.
    std::size_t best = left.size();
    double most = 0;
    for (std::size_t k = 0; k < left.size(); ++k) {
      const std::size_t a = left[(k + left.size() - 1) % left.size()], b = left[k], c = left[(k + 1) % left.size()];
      const double sides = (in_plane[b] - in_plane[a]).squaredNorm() + (in_plane[c] - in_plane[b]).squaredNorm() +
                           (in_plane[a] - in_plane[c]).squaredNorm();
      const double roundness = turn(a, b, c) / sides;
      if (!(roundness > std::max(most, 1e-12))) continue;
      const bool empty = std::none_of(left.begin(), left.end(), [&](std::size_t p) {
        return p != a && p != b && p != c && turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0;
      });
      if (!empty) continue;
      most = roundness;
      best = k;
    }
    if (best == left.size()) break;
    triangles.push_back({left[(best + left.size() - 1) % left.size()], left[best], left[(best + 1) % left.size()]});
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(best));
  }
  if (left.size() == 3 && turn(left[0], left[1], left[2]) > 0) {
    triangles.push_back({left[0], left[1], left[2]});
    return true;
  }
  triangles.resize(before);
  if (size() != 4) return false;
  // A twisted quad is a bent one. Cuts it along the diagonal that leaves less area.
  auto area_of = [&](std::size_t a, std::size_t b, std::size_t c) {
    return (corner_[b] - corner_[a]).cross(corner_[c] - corner_[a]).norm();
  };
  if (area_of(0, 1, 2) + area_of(0, 2, 3) <= area_of(0, 1, 3) + area_of(1, 2, 3))
    triangles.insert(triangles.end(), {{0, 1, 2}, {0, 2, 3}});
  else
    triangles.insert(triangles.end(), {{0, 1, 3}, {1, 2, 3}});
  return true;
}

Vec3 Polygon::blend(std::span<const Vec3> positions, std::span<const Index> corners) const {
  Vec3 sum{0, 0, 0};
  for (std::size_t c = 0; c < corners.size(); ++c)
    for (int a = 0; a < 3; ++a) sum[a] += weight_[c] * positions[corners[c]][a];
  return sum;
}

void Polygon::stiffness(double* weights) {
  const std::size_t m = size();
  spoke_.assign(m, 0.0);  // cotan weights of the edges to p
  std::fill(weights, weights + m * m, 0.0);
  double sum = 0;
  for (std::size_t c = 0; c < m; ++c) {
    const std::size_t d = (c + 1) % m;
    const Vector3d &a = corner_[c], &b = corner_[d];
    const double area = 2 * doubled_area(a, b, middle_);
    const double at_a = (b - a).dot(middle_ - a) / area, at_b = (a - b).dot(middle_ - b) / area,
                 at_p = (a - middle_).dot(b - middle_) / area;  // half the cotangents
    spoke_[c] += at_b;
    spoke_[d] += at_a;
    sum += at_a + at_b;
    weights[c * m + d] += at_p;
    weights[d * m + c] += at_p;
  }
  for (std::size_t c = 0; c < m; ++c)
    for (std::size_t d = c + 1; d < m; ++d)
      weights[d * m + c] = weights[c * m + d] +=
          spoke_[c] * weight_[d] + spoke_[d] * weight_[c] - sum * weight_[c] * weight_[d];
}

void Polygon::mass(double* masses) const {
  const std::size_t m = size();
  std::fill(masses, masses + m, 0.0);
  double total = 0;
  for (std::size_t c = 0; c < m; ++c) {
    const double area = 0.5 * doubled_area(corner_[c], corner_[(c + 1) % m], middle_);
    masses[c] += area / 3;
    masses[(c + 1) % m] += area / 3;
    total += area;
  }
  for (std::size_t c = 0; c < m; ++c) masses[c] = std::max(masses[c] + weight_[c] * total / 3, 0.5 * masses[c]);
}

namespace {

using Eigen::Vector3d;

Vector3d position(const PolygonMesh& mesh, Index v) { return Vector3d(mesh.position(Vertex(v)).data()); }

/// A unit vector perpendicular to n.
Vector3d across(const Vector3d& n) { return n.unitOrthogonal(); }

/// Unit normal of a vertex: the direction of the sum of the vector areas around it. If they cancel, the direction of the
/// largest one; if all are zero, the z axis.
Vector3d vertex_normal(const PolygonMesh& mesh, const std::vector<Vector3d>& area, Index v) {
  Vector3d sum = Vector3d::Zero(), largest = Vector3d::Zero();
  for (Offset corner : mesh.corners_at(Vertex(v))) {
    const Vector3d& of_face = area[mesh.face_of(corner)];
    const Vector3d oriented = mesh.mirrored(corner) ? Vector3d(-of_face) : of_face;
    sum += oriented;
    if (oriented.squaredNorm() > largest.squaredNorm()) largest = oriented;
  }
  if (sum.norm() > 1e-9 * largest.norm()) return sum.normalized();
  return largest.norm() > 0 ? Vector3d(largest.normalized()) : Vector3d(0, 0, 1);
}

/// The rotation by the smallest angle that takes one plane to the other, between their axes: the polar factor of the
/// projection. If the normals are opposite, all rotations are equally small.
std::complex<double> smallest_turn(const Axes& from, const Axes& to) {
  const std::complex<double> z{to.x.dot(from.x) + to.y.dot(from.y), to.y.dot(from.x) - to.x.dot(from.y)};
  const double size = std::abs(z);
  return size > 1e-12 ? z / size : 1.0;
}

}  // namespace

Axes axes_along(const Vector3d& normal, const Vector3d& direction) {
  Vector3d x = direction - normal.dot(direction) * normal;
  x = x.norm() > 1e-12 * direction.norm() ? Vector3d(x.normalized()) : across(normal);
  x = (x - normal.dot(x) * normal).normalized();  // again, against rounding
  return {x, normal.cross(x), normal};
}

Frames find_frames(const PolygonMesh& mesh, unsigned threads) {
  const auto faces = static_cast<std::size_t>(mesh.face_count()), n = static_cast<std::size_t>(mesh.vertex_count());
  Frames frames;
  frames.vertex.resize(n);
  frames.face.resize(faces);
  frames.turn.resize(mesh.corners().size());
  std::vector<Vector3d> area(faces);
  detail::for_each_index(faces, threads, [&](std::size_t f) {
    const auto corners = mesh.face(static_cast<Index>(f));
    const Vector3d origin = position(mesh, corners[0]);
    area[f].setZero();
    for (std::size_t c = 1; c + 1 < corners.size(); ++c)
      area[f] += 0.5 * (position(mesh, corners[c]) - origin).cross(position(mesh, corners[c + 1]) - origin);
  });
  detail::for_each_index(n, threads, [&](std::size_t k) {
    const auto v = static_cast<Index>(k);
    const Offset corner = mesh.corners_at(Vertex(v)).front();
    const Index f = mesh.face_of(corner);
    const Offset next = corner + 1 == mesh.face_begin()[f + 1] ? mesh.face_begin()[f] : corner + 1;
    frames.vertex[k] =
        axes_along(vertex_normal(mesh, area, v), position(mesh, mesh.corners()[next]) - position(mesh, v));
  });
  detail::for_each_index(faces, threads, [&](std::size_t f) {
    const auto corners = mesh.face(static_cast<Index>(f));
    // A face without area gets the tangent plane of its first corner.
    const double size = area[f].norm();
    const Vector3d normal = size > 0 ? Vector3d(area[f] / size) : frames.vertex[corners[0]].normal;
    frames.face[f] = axes_along(normal, position(mesh, corners[1]) - position(mesh, corners[0]));
    for (std::size_t c = 0; c < corners.size(); ++c) {
      const auto corner = static_cast<std::size_t>(mesh.face_begin()[f]) + c;
      Axes plane = frames.face[f];
      if (mesh.mirrored(static_cast<Offset>(corner))) plane.y = -plane.y, plane.normal = -plane.normal;
      frames.turn[corner] = smallest_turn(frames.vertex[corners[c]], plane);
    }
  });
  return frames;
}

namespace {

using Eigen::Vector3d;

constexpr double largest_weight = 1e4;

/// Least weight of a sliver on the boundary; keeps vertices connected that have no other faces.
constexpr double min_conductance = 1e-3;

/// Stiffness and mass of every face, and their statistics.
class FaceMatrices {
 public:
  FaceMatrices(const PolygonMesh& mesh, const PolygonOptions& options) : mesh_(mesh), begin_(1, 0) {
    for (Index f = 0; f < mesh.face_count(); ++f) {
      const auto m = static_cast<Offset>(mesh.face(f).size());
      begin_.push_back(begin_.back() + m * m);
    }
    check_memory();
    weights_.resize(begin_.back());
    masses_.resize(mesh.corners().size());
    shape_.resize(mesh.face_count());
    detail::parallel_chunks(mesh.face_count(), 4096, options.threads, [&](Offset first, Offset last) {
      Polygon polygon;
      for (Offset f = first; f < last; ++f) fill(polygon, static_cast<Index>(f));
    });
  }

  /// The weight -K_cd between the corner `corner` and corner number d of its face.
  double weight(Offset corner, std::size_t d) const {
    const Index f = mesh_.face_of(corner);
    const Offset c = corner - mesh_.face_begin()[f], m = mesh_.face_begin()[f + 1] - mesh_.face_begin()[f];
    return weights_[static_cast<std::size_t>(begin_[f] + c * m) + d];
  }
  double mass(Offset corner) const { return masses_[corner]; }

  /// Makes triangles that are slivers on the boundary conduct only along their outer side, as in triangle meshes. The negative
  /// weight of this side balances the weights of the other two, so it cannot be set to 0 alone.
  void flatten_slivers() {
    const detail::HalfEdges edges = mesh_.topology().half_edges();
    std::vector<std::uint8_t> flat(shape_.size(), 0);
    std::vector<detail::Half> outer;
    for (detail::Half h = 0; h < edges.size(); ++h)
      if (edges.twin[h] < 0) outer.push_back(h);
    while (!outer.empty()) {
      const detail::Half base = outer.back(), beyond = edges.twin[base];
      outer.pop_back();
      const Index f = mesh_.face_of(base);
      if (mesh_.face(f).size() != 3 || flat[f]) continue;
      if (!((beyond >= 0 ? side_weight(beyond) : 0) + side_weight(base) < 0)) continue;
      flat[f] = 1;
      const detail::Half a = edges.next(base), b = edges.previous(base);
      const double weight_a = side_weight(a), weight_b = side_weight(b);
      set_side_weight(base, 0);
      set_side_weight(a, std::max(0.25 / weight_b, min_conductance));
      set_side_weight(b, std::max(0.25 / weight_a, min_conductance));
      for (const detail::Half side : {a, b})
        if (edges.twin[side] >= 0) outer.push_back(edges.twin[side]);
    }
  }

  /// If only one of the two weights at a side is negative, adds it to the other one and sets it to 0. Only their sum enters the
  /// operators.
  void balance_sides() {
    const detail::HalfEdges edges = mesh_.topology().half_edges();
    for (detail::Half h = 0; h < edges.size(); ++h) {
      const detail::Half beyond = edges.twin[h];
      if (beyond < h) continue;
      const double here = side_weight(h), there = side_weight(beyond);
      if ((here < 0) == (there < 0)) continue;
      set_side_weight(here < 0 ? h : beyond, 0);
      set_side_weight(here < 0 ? beyond : h, std::max(here + there, 0.0));
    }
  }

  void summarize(bool clamp, PolygonDetails& report) const {
    for (Index f = 0; f < mesh_.face_count(); ++f) {
      const auto m = static_cast<Index>(mesh_.face(f).size());
      report.triangles += m == 3;
      report.nonplanar_faces += shape_[f] == Shape::nonplanar;
      report.degenerate_faces += shape_[f] == Shape::degenerate;
      for (Index c = 0; c < m; ++c)
        for (Index d = c + 1; d < m; ++d) {
          const double w = weights_[begin_[f] + Offset{c} * m + d];
          report.negative_weights += w < -1e-12;
          report.capped_weights += clamp && w > largest_weight;
        }
      report.edges += Offset{m} * (m - 1) / 2;
    }
  }

 private:
  /// Position of the weight between the ends of a side, in the row of its tail.
  std::size_t place(detail::Half h) const {
    const Index f = mesh_.face_of(h);
    const auto m = static_cast<Offset>(mesh_.face(f).size()), c = h - mesh_.face_begin()[f];
    return static_cast<std::size_t>(begin_[f] + c * m + (c + 1) % m);
  }
  double side_weight(detail::Half h) const { return weights_[place(h)]; }
  void set_side_weight(detail::Half h, double w) {
    const Index f = mesh_.face_of(h);
    const auto m = static_cast<Offset>(mesh_.face(f).size()), c = h - mesh_.face_begin()[f];
    weights_[place(h)] = weights_[static_cast<std::size_t>(begin_[f] + (c + 1) % m * m + c)] = w;
  }

  /// The number of weights grows with the square of a face's corners. Throws instead of letting the machine swap.
  /// @throws ResourceExhausted
  void check_memory() const {
    const double bytes = 64.0 * static_cast<double>(begin_.back()), memory = machine_memory();
    if (memory > 0 && bytes > memory)
      throw ResourceExhausted("polygons_too_large",
                              "every pair of corners of a face is an edge, which would take " +
                                  std::to_string(static_cast<long>(bytes / 1e9)) + " GB for this mesh",
                              "refine it (PolygonMesh::refined) and map the triangles");
  }

  enum class Shape : std::uint8_t { plain, nonplanar, degenerate };

  void fill(Polygon& polygon, Index f) {
    polygon.read(mesh_, f);
    polygon.stiffness(weights_.data() + begin_[f]);
    polygon.mass(masses_.data() + mesh_.face_begin()[f]);
    double area = 0, perimeter = 0;
    const std::size_t m = polygon.size();
    for (std::size_t c = 0; c < m; ++c) {
      area += masses_[static_cast<std::size_t>(mesh_.face_begin()[f]) + c];
      perimeter += (polygon.corner((c + 1) % m) - polygon.corner(c)).norm();
    }
    if (area < 1e-10 * perimeter * perimeter)
      shape_[f] = Shape::degenerate;
    else if (polygon.vector_area().norm() < 0.99 * area)
      shape_[f] = Shape::nonplanar;
  }

  const PolygonMesh& mesh_;
  std::vector<Offset> begin_;  ///< start of each face's m x m weights
  std::vector<double> weights_, masses_;
  std::vector<Shape> shape_;
};

/// Computes the mean length of the sides of all faces, in total and per component, and the shortest and longest side.
void measure_sides(const PolygonMesh& mesh, CsrGraphData& g, PolygonDetails& report) {
  detail::ComponentLengths lengths(static_cast<std::size_t>(mesh.vertex_count()));
  double sum = 0, shortest = std::numeric_limits<double>::infinity(), longest = 0;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const auto corners = mesh.face(f);
    for (std::size_t c = 0; c < corners.size(); ++c) {
      const Vector3d a(mesh.position(Vertex(corners[c])).data()),
          b(mesh.position(Vertex(corners[(c + 1) % corners.size()])).data());
      const double length = (b - a).norm();
      sum += length;
      lengths.add(corners[c], corners[(c + 1) % corners.size()], length);
      shortest = std::min(shortest, length);
      longest = std::max(longest, length);
    }
  }
  report.shortest_edge = shortest * mesh.length_unit();
  report.longest_edge = longest * mesh.length_unit();
  if (!(longest > 0)) throw InvalidGeometry("all vertices of the mesh are at the same place");
  g.mean_edge_length = sum / static_cast<double>(mesh.corners().size());
  g.component_edge_lengths = lengths.means();
}

/// The chord projected to a tangent plane and scaled to its own length, by a factor of at most 10.
std::complex<double> log_of_chord(const Axes& axes, const Vector3d& chord) {
  const std::complex<double> projected = axes.components(chord);
  const double length = chord.norm(), in_plane = std::abs(projected);
  return in_plane > 0.1 * length ? length / in_plane * projected : 10.0 * projected;
}

/// Writes R_ji for corners i and j of one face, as the graph stores it.
void write_transport(std::complex<double> turn_i, bool mirrored_i, std::complex<double> turn_j, bool mirrored_j,
                     TransportKind kind, double* out) {
  const bool reflects = mirrored_i != mirrored_j;
  const std::complex<double> R = std::conj(turn_i) * (reflects ? std::conj(turn_j) : turn_j);
  if (kind == TransportKind::rotation2) {
    out[0] = R.real();
    out[1] = R.imag();
    return;
  }
  out[0] = R.real();
  out[1] = reflects ? R.imag() : -R.imag();
  out[2] = R.imag();
  out[3] = reflects ? -R.real() : R.real();
}

/// Gives vertices with no area around them a positive mass that is small within their component.
void raise_masses(CsrGraphData& g) {
  for (std::size_t v = 0; v < g.masses.size(); ++v) {
    const double own = g.component_edge_lengths.empty() ? 0 : g.component_edge_lengths[v];
    const double edge = own > 0 ? own : *g.mean_edge_length;
    g.masses[v] = std::max(g.masses[v], 1e-9 * edge * edge);
  }
}

}  // namespace

CsrGraphData polygon_edges(const PolygonMesh& mesh, const Frames& frames, const PolygonOptions& options,
                           PolygonDetails& report) {
  const auto n = static_cast<std::size_t>(mesh.vertex_count());
  CsrGraphData g;
  g.kind = mesh.report().orientable ? TransportKind::rotation2 : TransportKind::block;
  g.length_unit = mesh.length_unit();
  measure_sides(mesh, g, report);
  FaceMatrices matrices(mesh, options);
  matrices.summarize(options.clamp_weights, report);
  if (options.clamp_weights) {
    matrices.flatten_slivers();
    matrices.balance_sides();
  }

  g.row_begin.assign(n + 1, 0);
  for (std::size_t v = 0; v < n; ++v) {
    g.row_begin[v + 1] = g.row_begin[v];
    for (Offset corner : mesh.corners_at(Vertex(v)))
      g.row_begin[v + 1] += static_cast<Offset>(mesh.face(mesh.face_of(corner)).size()) - 1;
  }
  const auto edges = static_cast<std::size_t>(g.row_begin.back());
  const std::size_t width = g.kind == TransportKind::rotation2 ? 2 : 4;
  g.neighbors.resize(edges);
  g.weights.resize(edges);
  g.logs.resize(2 * edges);
  g.transports.resize(width * edges);
  g.masses.resize(n);
  detail::for_each_index(n, options.threads, [&](std::size_t k) {
    const auto v = static_cast<Index>(k);
    const Vector3d origin(mesh.position(Vertex(v)).data());
    auto at = static_cast<std::size_t>(g.row_begin[k]);
    double mass = 0;
    for (Offset corner : mesh.corners_at(Vertex(v))) {
      const Index f = mesh.face_of(corner);
      const auto vertices = mesh.face(f);
      mass += matrices.mass(corner);
      for (std::size_t d = 0; d < vertices.size(); ++d) {
        const Offset other = mesh.face_begin()[f] + static_cast<Offset>(d);
        if (other == corner) continue;
        const double w = matrices.weight(corner, d);
        g.neighbors[at] = vertices[d];
        g.weights[at] = options.clamp_weights ? std::clamp(w, 0.0, largest_weight) : w;
        const auto log = log_of_chord(frames.vertex[k], Vector3d(mesh.position(Vertex(vertices[d])).data()) - origin);
        g.logs[2 * at] = log.real();
        g.logs[2 * at + 1] = log.imag();
        write_transport(frames.turn[corner], mesh.mirrored(corner), frames.turn[other], mesh.mirrored(other), g.kind,
                        g.transports.data() + width * at);
        ++at;
      }
    }
    g.masses[k] = mass;
  });
  raise_masses(g);
  return g;
}

std::vector<Vec2> flat_faces(const PolygonMesh& mesh) {
  std::vector<Vec2> places;
  places.reserve(mesh.corners().size());
  Polygon polygon;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    polygon.read_corners(mesh, f);
    const Eigen::Vector3d area = polygon.vector_area(), first = polygon.corner(0), side = polygon.corner(1) - first;
    const Eigen::Vector3d normal = area.norm() > 0 ? Eigen::Vector3d(area.normalized()) : side.unitOrthogonal();
    const Axes plane = axes_along(normal, side);
    for (std::size_t c = 0; c < polygon.size(); ++c) {
      const std::complex<double> place = plane.components(polygon.corner(c) - first);
      places.push_back({place.real(), place.imag()});
    }
  }
  return places;
}

}  // namespace ahm::polymesh
