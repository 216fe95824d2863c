#include "maps/frame_field.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace ahm {
namespace {

/// Orthogonal polar factor of a d x d matrix, in place, row major: the nearest orthogonal matrix.
void polar_factor(double* matrix, int d) {
  if (d == 1) {
    matrix[0] = matrix[0] < 0 ? -1.0 : 1.0;
    return;
  }
  if (d == 2) {
    // The nearer of the nearest rotation and the nearest reflection, by the sign of the determinant.
    const double sign = matrix[0] * matrix[3] - matrix[1] * matrix[2] < 0 ? -1.0 : 1.0;
    const double c = matrix[0] + sign * matrix[3], s = matrix[2] - sign * matrix[1];
    const double r = std::hypot(c, s);
    const double cosine = r > 0 ? c / r : 1.0, sine = r > 0 ? s / r : 0.0;
    matrix[0] = cosine;
    matrix[1] = -sign * sine;
    matrix[2] = sine;
    matrix[3] = sign * cosine;
    return;
  }
  auto project = [matrix, d](auto& X) {
    using Matrix = std::remove_reference_t<decltype(X)>;
    X = Eigen::Map<const Eigen::Matrix<double, -1, -1, Eigen::RowMajor>>(matrix, d, d);
    Eigen::JacobiSVD<Matrix, Eigen::NoQRPreconditioner> svd(X, Eigen::ComputeFullU | Eigen::ComputeFullV);
    X = svd.matrixU() * svd.matrixV().transpose();
    Eigen::Map<Eigen::Matrix<double, -1, -1, Eigen::RowMajor>>(matrix, d, d) = X;
  };
  if (d == 3) {
    Eigen::Matrix3d X;
    project(X);
  } else {
    Eigen::MatrixXd X(d, d);
    project(X);
  }
}

void set_identity(double* matrix, int d) {
  for (int a = 0; a < d; ++a)
    for (int b = 0; b < d; ++b) matrix[a * d + b] = a == b;
}

/// Space for one frame: on the stack for d <= 3.
class FrameBuffer {
 public:
  explicit FrameBuffer(std::size_t width) {
    if (width > small_.size()) large_.resize(width);
  }
  double* data() { return large_.empty() ? small_.data() : large_.data(); }

 private:
  std::array<double, 9> small_;
  std::vector<double> large_;
};

}  // namespace

FrameField::FrameField(Index n, int dimension, TransportKind kind, std::span<const double> solution)
    : n_(static_cast<std::size_t>(n)), d_(dimension), complex_(kind == TransportKind::rotation2), solution_(solution) {}

void FrameField::raw(Index vertex, double* out) const {
  const auto i = static_cast<std::size_t>(vertex);
  for (int a = 0; a < columns(); ++a)
    for (int c = 0; c < d_; ++c) out[complex_ ? c : c * d_ + a] = solution_[(a * n_ + i) * d_ + c];
}

double FrameField::heat(Index vertex) const {
  const auto i = static_cast<std::size_t>(vertex);
  double largest = 0;
  for (int a = 0; a < columns(); ++a)
    for (int c = 0; c < d_; ++c) largest = std::max(largest, std::abs(solution_[(a * n_ + i) * d_ + c]));
  return largest;
}

/// U_i as a unit complex number or an orthogonal matrix.
void FrameField::frame(Index vertex, double* out) const {
  raw(vertex, out);
  const double largest = heat(vertex);
  if (!(largest >= std::numeric_limits<double>::min())) {
    complex_ ? void((out[0] = 1, out[1] = 0)) : set_identity(out, d_);
    return;
  }
  for (std::size_t k = 0; k < width(); ++k) out[k] /= largest;
  if (!complex_) return polar_factor(out, d_);
  const double r = std::sqrt(out[0] * out[0] + out[1] * out[1]);
  out[0] /= r;
  out[1] /= r;
}

void FrameField::to_source(Index vertex, const double* in, double* out, std::size_t stride) const {
  FrameBuffer buffer(width());
  double* U = buffer.data();
  frame(vertex, U);
  if (complex_) {
    out[0] = in[0] * U[0] + in[1] * U[1];
    out[stride] = in[1] * U[0] - in[0] * U[1];
    return;
  }
  for (int a = 0; a < d_; ++a) {
    double sum = 0;
    for (int c = 0; c < d_; ++c) sum += U[c * d_ + a] * in[c];
    out[a * stride] = sum;
  }
}

void FrameField::axes(Index vertex, double* out) const {
  if (!complex_) return frame(vertex, out);
  double u[2];
  frame(vertex, u);
  out[0] = u[0];
  out[1] = -u[1];
  out[2] = u[1];
  out[3] = u[0];
}

}  // namespace ahm
