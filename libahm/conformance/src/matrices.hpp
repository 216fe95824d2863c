/// \file
/// Small square matrices, row major.
#pragma once

#include <cmath>
#include <random>
#include <span>
#include <vector>

namespace ahm::test {

using Matrix = std::vector<double>;

inline Matrix product(int d, std::span<const double> A, std::span<const double> B) {
  Matrix C(static_cast<std::size_t>(d) * d, 0.0);
  for (int a = 0; a < d; ++a)
    for (int b = 0; b < d; ++b)
      for (int c = 0; c < d; ++c) C[a * d + b] += A[a * d + c] * B[c * d + b];
  return C;
}

inline Matrix transposed(int d, std::span<const double> A) {
  Matrix T(A.size());
  for (int a = 0; a < d; ++a)
    for (int b = 0; b < d; ++b) T[a * d + b] = A[b * d + a];
  return T;
}

/// A random rotation in d <= 3 dimensions, by Gram-Schmidt. `mirror` flips its last row.
Matrix random_frame(int d, std::mt19937_64& random, bool mirror);

}  // namespace ahm::test
