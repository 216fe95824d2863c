#include "frame_field.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "ahm/detail/parallel.hpp"

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

}  // namespace

FrameField::FrameField(Index n, int dimension, TransportKind kind)
    : n_(n), d_(dimension), complex_(kind == TransportKind::rotation2) {}

void FrameField::add_to_rhs(std::span<double> rhs, Index vertex, std::span<const double> axes, double scale) const {
  const auto column_length = static_cast<std::size_t>(n_) * d_;
  for (int a = 0; a < columns(); ++a)
    for (int c = 0; c < d_; ++c) {
      const double entry = axes.empty() ? (a == c ? 1.0 : 0.0) : axes[c * d_ + a];
      rhs[a * column_length + static_cast<std::size_t>(vertex) * d_ + c] += scale * entry;
    }
}

void FrameField::normalize(std::span<const double> solution, unsigned threads) {
  const std::size_t width = complex_ ? 2 : static_cast<std::size_t>(d_) * d_;
  const auto n = static_cast<std::size_t>(n_);
  frames_.resize(n * width);
  heat_.resize(n);
  detail::for_each_index(n, threads, [&](std::size_t i) {
    double* frame = frames_.data() + i * width;
    double largest = 0;
    for (int a = 0; a < columns(); ++a)
      for (int c = 0; c < d_; ++c) {
        const double entry = solution[(a * n + i) * d_ + c];
        frame[complex_ ? c : c * d_ + a] = entry;
        largest = std::max(largest, std::abs(entry));
      }
    heat_[i] = largest;
    if (!(largest >= std::numeric_limits<double>::min())) {
      complex_ ? void((frame[0] = 1, frame[1] = 0)) : set_identity(frame, d_);
      return;
    }
    for (std::size_t k = 0; k < width; ++k) frame[k] /= largest;
    if (complex_) {
      const double r = std::sqrt(frame[0] * frame[0] + frame[1] * frame[1]);
      frame[0] /= r;
      frame[1] /= r;
    } else {
      polar_factor(frame, d_);
    }
  });
}

void FrameField::to_source(Index vertex, const double* in, double* out, std::size_t stride) const {
  if (complex_) {
    const double* u = frames_.data() + static_cast<std::size_t>(vertex) * 2;
    out[0] = in[0] * u[0] + in[1] * u[1];
    out[stride] = in[1] * u[0] - in[0] * u[1];
    return;
  }
  const double* Q = frames_.data() + static_cast<std::size_t>(vertex) * d_ * d_;
  for (int a = 0; a < d_; ++a) {
    double sum = 0;
    for (int c = 0; c < d_; ++c) sum += Q[c * d_ + a] * in[c];
    out[a * stride] = sum;
  }
}

void FrameField::axes(Index vertex, double* out) const {
  if (complex_) {
    const double* u = frames_.data() + static_cast<std::size_t>(vertex) * 2;
    out[0] = u[0];
    out[1] = -u[1];
    out[2] = u[1];
    out[3] = u[0];
    return;
  }
  std::copy_n(frames_.data() + static_cast<std::size_t>(vertex) * d_ * d_, d_ * d_, out);
}

}  // namespace ahm
