#include "polygon.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace ahm::polymesh {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Triangles thinner than this, relative to their longest side, count as this thin.
constexpr double least_height = 1e-10;

/// x with the smallest |x| among those that minimize |S x - b|, S symmetric positive semi-definite. Directions in which S
/// is smaller than `threshold` of its largest eigenvalue count as none.
Vector3d solve_least(const Matrix3d& S, const Vector3d& b, double threshold) {
  const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(S);
  Vector3d y = eigen.eigenvectors().transpose() * b;
  const double largest = eigen.eigenvalues()[2];
  for (int k = 0; k < 3; ++k) y[k] = eigen.eigenvalues()[k] > threshold * largest ? y[k] / eigen.eigenvalues()[k] : 0.0;
  return eigen.eigenvectors() * y;
}

/// Twice the area of a triangle, kept away from zero relative to its longest side.
double doubled_area(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const double longest = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
  return std::max((b - a).cross(c - a).norm(), least_height * longest);
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

/// The gradient of sum (x_c - p)^T M_c (x_c - p) with M_c = |e|^2 I - e e^T for the side e at corner c is zero where
/// (sum M_c) p = sum M_c x_c. All relative to the mean of the corners, which is p where the corners are on a line.
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

/// w_c = 1/m + X_c . y with X the corners about their mean and (X^T X) y = p - mean: the smallest weights that sum to one
/// and hit p. p is then what the weights give.
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
  const double length = away(end), least = std::max(least_height * length, 0x1p-50);
  return length <= least || std::all_of(corner_.begin(), corner_.end(), [&](const Vector3d& x) {
           return (x - corner_[0]).cross(end - corner_[0]).norm() <= least * length;
         });
}

bool Polygon::folds() const {
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
  std::vector<Eigen::Vector2d> seen;
  for (const Vector3d& c : corner_) seen.emplace_back(x.dot(c), y.dot(c));
  auto turn = [&](std::size_t a, std::size_t b, std::size_t c) {
    const Eigen::Vector2d u = seen[b] - seen[a], v = seen[c] - seen[b];
    return u[0] * v[1] - u[1] * v[0];
  };
  std::vector<std::size_t> left(size());
  std::iota(left.begin(), left.end(), std::size_t{0});
  const std::size_t before = triangles.size();
  while (left.size() > 3) {
    // The roundest ear, so that straight corners wait for a better triangle.
    std::size_t best = left.size();
    double most = 0;
    for (std::size_t k = 0; k < left.size(); ++k) {
      const std::size_t a = left[(k + left.size() - 1) % left.size()], b = left[k], c = left[(k + 1) % left.size()];
      const double sides =
          (seen[b] - seen[a]).squaredNorm() + (seen[c] - seen[b]).squaredNorm() + (seen[a] - seen[c]).squaredNorm();
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
  // A twisted quad is a bent one: along the diagonal that leaves less area.
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

}  // namespace ahm::polymesh
