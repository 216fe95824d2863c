#include "ahm/cholesky/conjugate_gradient.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "ahm/error.hpp"
#include "ahm/util/small_math.hpp"

namespace ahm {
namespace {

/// Bound of the squared residual norm, relative. It is below rounding errors of the residual.
constexpr double tolerance = 1e-34;
constexpr int max_iterations = 5000;

}  // namespace

ConjugateGradient::ConjugateGradient(const SparseUpper& matrix, const char* name) : name_(name) {
  const auto n = static_cast<std::size_t>(matrix.size());
  scale_.resize(n);
  column_begin_.assign(1, 0);
  column_begin_.reserve(n + 1);
  rows_.reserve(matrix.rows.size());
  values_.reserve(matrix.rows.size());
  for (std::size_t j = 0; j < n; ++j) {
    const auto diagonal = static_cast<std::size_t>(matrix.column_begin[j + 1]) - 1;  // last entry, since rows ascend
    const double D = matrix.values[diagonal];
    if (!(D > 0) || !std::isfinite(D))
      throw NotPositiveDefinite(std::string("operator ") + name + ": diagonal entry " + std::to_string(j) +
                                " is not positive");
    scale_[j] = 1 / std::sqrt(D);
    for (auto k = static_cast<std::size_t>(matrix.column_begin[j]); k < diagonal; ++k) {
      const double value = matrix.values[k] * scale_[matrix.rows[k]] * scale_[j];
      if (value == 0) continue;  // explicit zeros in the blocks of diagonal transports
      rows_.push_back(static_cast<Index>(matrix.rows[k]));
      values_.push_back(value);
    }
    column_begin_.push_back(static_cast<Offset>(rows_.size()));
  }
}

void ConjugateGradient::forward(std::span<double> x) const {
  for (std::size_t j = 0; j < x.size(); ++j) {
    double sum = x[j];
    for (Offset k = column_begin_[j]; k < column_begin_[j + 1]; ++k) sum -= values_[k] * x[rows_[k]];
    x[j] = sum;
  }
}

void ConjugateGradient::backward(std::span<double> x) const {
  for (std::size_t j = x.size(); j-- > 0;) {
    const double value = x[j];
    for (Offset k = column_begin_[j]; k < column_begin_[j + 1]; ++k) x[rows_[k]] -= values_[k] * value;
  }
}

void ConjugateGradient::solve(std::span<double> X, Offset columns, unsigned) const {
  const std::size_t n = scale_.size();
  for (Offset c = 0; c < columns; ++c) solve(X.subspan(static_cast<std::size_t>(c) * n, n));
}

void ConjugateGradient::solve(std::span<double> x) const {
  const std::size_t n = x.size();
  double largest = 0;
  for (double value : x) largest = std::max(largest, std::abs(value));
  if (largest == 0) return;
  const double unit = std::ldexp(1.0, std::ilogb(largest));  // prevents overflow of squares
  std::vector<double> r(n), p, t(n), q(n);
  for (std::size_t i = 0; i < n; ++i) r[i] = x[i] / unit * scale_[i];
  forward(r);
  std::fill(x.begin(), x.end(), 0.0);
  p = r;
  double rr = dot(r, r);
  const double target_rr = tolerance * rr;
  for (int iteration = 0; rr > target_rr; ++iteration) {
    // q = (I + L)^-1 K (I + L^T)^-1 p
    t = p;
    backward(t);
    for (std::size_t i = 0; i < n; ++i) q[i] = p[i] - t[i];
    forward(q);
    for (std::size_t i = 0; i < n; ++i) q[i] += t[i];
    const double energy = dot(p, q);
    if (!(energy > 0) || iteration == max_iterations)
      throw NotPositiveDefinite(std::string("operator ") + name_ +
                                (energy > 0
                                     ? ": conjugate gradients do not converge; t_coef is too large for this graph"
                                     : " is not positive definite: too many negative weights"));
    const double step = rr / energy;
    for (std::size_t i = 0; i < n; ++i) {
      x[i] += step * p[i];
      r[i] -= step * q[i];
    }
    const double before = std::exchange(rr, dot(r, r));
    for (std::size_t i = 0; i < n; ++i) p[i] = r[i] + rr / before * p[i];
  }
  backward(x);
  for (std::size_t i = 0; i < n; ++i) x[i] *= scale_[i] * unit;
}

}  // namespace ahm
