/// \file
/// Parallel transports between tangent spaces, with the same interface for both kinds of storage.
///
/// \code
/// ahm::Star star = graph.star(i);
/// std::array<double, 2> there = {1, 0}, here;                     // d = 2
/// star.transport(e).apply(there.data(), here.data());            // frame of star.neighbors[e] -> frame of i
/// \endcode
#pragma once

#include <cstddef>
#include <span>

#include "ahm/types.hpp"

namespace ahm {

/// How the transports of a graph are stored.
enum class TransportKind {
  rotation2,  ///< d = 2, rotations only: (cos, sin), the complex number R_ji
  block,      ///< any d, rotations and reflections: d x d orthogonal matrix, row major
};

/// The storage layout of the transports of a graph.
struct TransportLayout {
  TransportKind kind = TransportKind::rotation2;
  int dimension = 2;

  /// Numbers per transport: 2 or d x d.
  constexpr std::size_t width() const {
    return kind == TransportKind::rotation2 ? 2 : static_cast<std::size_t>(dimension) * dimension;
  }
  /// Number of vector fields that represent a frame: 1 for rotation2 (the second axis is the first one rotated), otherwise d.
  constexpr Index columns() const { return kind == TransportKind::rotation2 ? 1 : dimension; }
  /// Position of component `c` of the image of axis `a` < columns() in a stored transport.
  constexpr std::size_t place(int c, int a) const {
    return kind == TransportKind::rotation2 ? static_cast<std::size_t>(c) : static_cast<std::size_t>(c * dimension + a);
  }
  /// Whether reflections can be stored.
  constexpr bool may_reflect() const { return kind == TransportKind::block; }

  void set_identity(double* transport) const;
  /// Stores a d x d matrix, row major. For rotation2, only its first column.
  void store(std::span<const double> matrix, double* transport) const;
  /// Replaces a stored matrix by the nearest orthogonal one (the polar factor, [Hig86]).
  /// @param transport  its largest entry must be of order one
  void make_orthogonal(double* transport) const;
};

/// A view of one transport R, an orthogonal map from one tangent space to another.
class Transport {
 public:
  /// @param numbers  layout.width() numbers, which must outlive this object
  constexpr Transport(TransportLayout layout, const double* numbers)
      : d_(layout.dimension), complex_(layout.kind == TransportKind::rotation2), R_(numbers) {}

  /// out = R x, d numbers each.
  void apply(const double* x, double* out) const {
    if (complex_) {
      out[0] = R_[0] * x[0] - R_[1] * x[1];
      out[1] = R_[1] * x[0] + R_[0] * x[1];
      return;
    }
    for (int c = 0; c < d_; ++c) {
      out[c] = R_[c * d_] * x[0];
      for (int b = 1; b < d_; ++b) out[c] += R_[c * d_ + b] * x[b];
    }
  }

  /// out = R^-1 x. The components of `out` are `stride` numbers apart.
  void apply_inverse(const double* x, double* out, std::size_t stride = 1) const {
    if (complex_) {
      out[0] = x[0] * R_[0] + x[1] * R_[1];
      out[stride] = x[1] * R_[0] - x[0] * R_[1];
      return;
    }
    for (int a = 0; a < d_; ++a) {
      double sum = 0;
      for (int c = 0; c < d_; ++c) sum += R_[c * d_ + a] * x[c];
      out[static_cast<std::size_t>(a) * stride] = sum;
    }
  }

  /// out += factor R x.
  void add_to(double factor, const double* x, double* out) const {
    if (complex_) {
      out[0] += factor * (R_[0] * x[0] - R_[1] * x[1]);
      out[1] += factor * (R_[0] * x[1] + R_[1] * x[0]);
      return;
    }
    for (int c = 0; c < d_; ++c)
      for (int b = 0; b < d_; ++b) out[c] += factor * R_[c * d_ + b] * x[b];
  }

  /// out += factor R S. S and `out` have the layout of R.
  void add_product(double factor, const double* S, double* out) const {
    if (complex_) return add_to(factor, S, out);
    for (int c = 0; c < d_; ++c)
      for (int b = 0; b < d_; ++b)
        for (int a = 0; a < d_; ++a) out[c * d_ + a] += factor * R_[c * d_ + b] * S[b * d_ + a];
  }

  /// out += factor R^-1. `out` has the layout of R.
  void add_inverse(double factor, double* out) const {
    if (complex_) {
      out[0] += factor * R_[0];
      out[1] -= factor * R_[1];
      return;
    }
    for (int a = 0; a < d_; ++a)
      for (int b = 0; b < d_; ++b) out[a * d_ + b] += factor * R_[b * d_ + a];
  }

  /// Writes R as a d x d matrix, row major.
  void matrix(double* out) const {
    if (complex_) {
      out[0] = R_[0];
      out[1] = -R_[1];
      out[2] = R_[1];
      out[3] = R_[0];
      return;
    }
    for (int k = 0; k < d_ * d_; ++k) out[k] = R_[k];
  }

  /// Whether R reverses orientation.
  bool reflects() const;
  /// Largest absolute entry of R R^T - id.
  double distance_from_orthogonal() const;
  /// Largest absolute entry of R S - id. S has the layout of R.
  double distance_from_inverse(const Transport& S) const;

 private:
  int d_;
  bool complex_;
  const double* R_;
};

}  // namespace ahm
