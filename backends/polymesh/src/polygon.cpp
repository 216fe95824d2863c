#include "polygon.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace ahm::polymesh {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Triangles thinner than this, relative to their longest side, count as this thin.
constexpr double least_height = 1e-10;

/// x with the smallest |x| among those that minimise |S x - b|, S symmetric positive semi-definite. Directions in which S
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

void Polygon::read(const PolygonMesh& mesh, Index face) {
  const auto vertices = mesh.face(face);
  corner_.clear();
  for (Index v : vertices) corner_.emplace_back(mesh.position(v).data());
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

bool Polygon::folds() const {
  const Vector3d area = vector_area();
  for (std::size_t c = 0; c < size(); ++c) {
    const Vector3d of_triangle = 0.5 * (corner_[c] - middle_).cross(corner_[(c + 1) % size()] - middle_);
    if (of_triangle.dot(area) < -1e-9 * area.squaredNorm()) return true;
  }
  return false;
}

Vec3 Polygon::blend(std::span<const Vec3> positions, std::span<const Index> corners) const {
  Vec3 sum{0, 0, 0};
  for (std::size_t c = 0; c < corners.size(); ++c)
    for (int a = 0; a < 3; ++a) sum[a] += weight_[c] * positions[static_cast<std::size_t>(corners[c])][a];
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
