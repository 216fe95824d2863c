#include "ahm/graph/transport.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <type_traits>

namespace ahm {
namespace {

/// Replaces a 2 x 2 matrix by the nearest rotation (determinant >= 0) or the nearest reflection (determinant < 0).
void make_orthogonal_2(double* matrix) {
  const double sign = matrix[0] * matrix[3] - matrix[1] * matrix[2] < 0 ? -1.0 : 1.0;
  const double c = matrix[0] + sign * matrix[3], s = matrix[2] - sign * matrix[1];
  const double r = std::hypot(c, s);
  const double cosine = r > 0 ? c / r : 1.0, sine = r > 0 ? s / r : 0.0;
  matrix[0] = cosine;
  matrix[1] = -sign * sine;
  matrix[2] = sine;
  matrix[3] = sign * cosine;
}

template <class Matrix>
void make_orthogonal_by_svd(double* matrix, Matrix X) {
  const Eigen::Index d = X.rows();
  X = Eigen::Map<const Eigen::Matrix<double, -1, -1, Eigen::RowMajor>>(matrix, d, d);
  Eigen::JacobiSVD<Matrix, Eigen::NoQRPreconditioner> svd(X, Eigen::ComputeFullU | Eigen::ComputeFullV);
  X = svd.matrixU() * svd.matrixV().transpose();
  Eigen::Map<Eigen::Matrix<double, -1, -1, Eigen::RowMajor>>(matrix, d, d) = X;
}

}  // namespace

void TransportLayout::set_identity(double* transport) const {
  for (int a = 0; a < columns(); ++a)
    for (int c = 0; c < dimension; ++c) transport[place(c, a)] = a == c;
}

void TransportLayout::store(std::span<const double> matrix, double* transport) const {
  for (int a = 0; a < columns(); ++a)
    for (int c = 0; c < dimension; ++c) transport[place(c, a)] = matrix[c * dimension + a];
}

void TransportLayout::make_orthogonal(double* transport) const {
  if (kind == TransportKind::rotation2) {
    const double r = std::sqrt(transport[0] * transport[0] + transport[1] * transport[1]);
    transport[0] /= r;
    transport[1] /= r;
  } else if (dimension == 1) {
    transport[0] = transport[0] < 0 ? -1.0 : 1.0;
  } else if (dimension == 2) {
    make_orthogonal_2(transport);
  } else if (dimension == 3) {
    make_orthogonal_by_svd(transport, Eigen::Matrix3d());
  } else {
    make_orthogonal_by_svd(transport, Eigen::MatrixXd(dimension, dimension));
  }
}

bool Transport::reflects() const {
  if (complex_) return false;
  if (d_ == 2) return R_[0] * R_[3] - R_[1] * R_[2] < 0;
  return Eigen::Map<const Eigen::MatrixXd>(R_, d_, d_).determinant() < 0;
}

double Transport::distance_from_orthogonal() const {
  if (complex_) return std::abs(R_[0] * R_[0] + R_[1] * R_[1] - 1.0);
  double worst = 0;
  for (int a = 0; a < d_; ++a)
    for (int b = 0; b < d_; ++b) {
      double sum = a == b ? -1.0 : 0.0;
      for (int c = 0; c < d_; ++c) sum += R_[a * d_ + c] * R_[b * d_ + c];
      worst = std::max(worst, std::abs(sum));
    }
  return worst;
}

double Transport::distance_from_inverse(const Transport& other) const {
  const double* S = other.R_;
  if (complex_) return std::max(std::abs(R_[0] * S[0] - R_[1] * S[1] - 1.0), std::abs(R_[0] * S[1] + R_[1] * S[0]));
  double worst = 0;
  for (int a = 0; a < d_; ++a)
    for (int b = 0; b < d_; ++b) {
      double sum = a == b ? -1.0 : 0.0;
      for (int c = 0; c < d_; ++c) sum += R_[a * d_ + c] * S[c * d_ + b];
      worst = std::max(worst, std::abs(sum));
    }
  return worst;
}

}  // namespace ahm
