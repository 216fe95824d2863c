// Eigenpairs of Laplacians with known eigenvalues: grids of any size, several components, by Lanczos and densely.
#include "ahm/cholesky/eigenpairs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "ahm/error.hpp"

namespace ahm::test {
namespace {

/// The Laplacian of `copies` grids of nx x ny vertices that are not connected with each other.
SparseUpper grids(Offset nx, Offset ny, Offset copies) {
  SparseUpper L;
  L.column_begin.push_back(0);
  const auto add = [&](Offset row, double value) { L.rows.push_back(row), L.values.push_back(value); };
  for (Offset c = 0, j = 0; c < copies; ++c)
    for (Offset y = 0; y < ny; ++y)
      for (Offset x = 0; x < nx; ++x, ++j) {
        if (y > 0) add(j - nx, -1);
        if (x > 0) add(j - 1, -1);
        add(j, (x > 0) + (x < nx - 1) + (y > 0) + (y < ny - 1));
        L.column_begin.push_back(static_cast<Offset>(L.rows.size()));
      }
  return L;
}

/// The smallest eigenvalues of `grids`, with unit masses.
std::vector<double> eigenvalues_of_grids(Offset nx, Offset ny, Offset copies, std::size_t count) {
  const auto path = [](Offset k, Offset n) { return 2 - 2 * std::cos(std::numbers::pi * double(k) / double(n)); };
  std::vector<double> result;
  for (Offset c = 0; c < copies; ++c)
    for (Offset y = 0; y < ny; ++y)
      for (Offset x = 0; x < nx; ++x) result.push_back(path(x, nx) + path(y, ny));
  std::sort(result.begin(), result.end());
  result.resize(count);
  return result;
}

void expect_eigenpairs(const SparseUpper& L, const std::vector<double>& masses, const Eigenpairs& found) {
  const std::size_t n = masses.size(), k = found.values.size();
  ASSERT_EQ(found.vectors.size(), n * k);
  for (std::size_t c = 0; c < k; ++c) {
    const double* x = found.vectors.data() + c * n;
    std::vector<double> residual(n);
    for (std::size_t i = 0; i < n; ++i) residual[i] = -found.values[c] * masses[i] * x[i];
    for (Offset j = 0; j < L.size(); ++j)
      for (Offset p = L.column_begin[j]; p < L.column_begin[j + 1]; ++p) {
        residual[L.rows[p]] += L.values[p] * x[j];
        if (L.rows[p] != j) residual[j] += L.values[p] * x[L.rows[p]];
      }
    for (const double r : residual) ASSERT_LT(std::abs(r), 1e-10) << "pair " << c;
    for (std::size_t e = 0; e <= c; ++e) {
      double dot = 0;
      for (std::size_t i = 0; i < n; ++i) dot += masses[i] * x[i] * found.vectors[e * n + i];
      ASSERT_NEAR(dot, c == e, 1e-11) << c << ", " << e;
    }
  }
}

TEST(Eigenpairs, AreThoseOfGridsInClosedForm) {
  struct Case {
    Offset nx, ny, copies, count;
  };
  // Lanczos; squares, whose eigenvalues are double; equal components; more kernels than columns of a block; dense; all pairs.
  for (const auto& [nx, ny, copies, count] : {Case{40, 37, 1, 50},
                                              {40, 40, 1, 40},
                                              {35, 30, 3, 30},
                                              {20, 20, 40, 45},
                                              {9, 8, 1, 30},
                                              {5, 4, 1, 20},
                                              {1, 1, 3, 3}}) {
    const SparseUpper L = grids(nx, ny, copies);
    const std::vector<double> masses(static_cast<std::size_t>(L.size()), 1.0);
    const Eigenpairs found = smallest_eigenpairs(L, masses, count);
    const std::vector<double> expected = eigenvalues_of_grids(nx, ny, copies, static_cast<std::size_t>(count));
    for (std::size_t k = 0; k < expected.size(); ++k)
      ASSERT_NEAR(found.values[k], expected[k], 1e-11) << nx << ", " << k;
    expect_eigenpairs(L, masses, found);
  }
}

TEST(Eigenpairs, SolveTheProblemWithAnyMassesAndHaveTheSameBitsOnAnyNumberOfThreads) {
  const SparseUpper L = grids(90, 70, 1);
  std::vector<double> masses;
  for (Offset i = 0; i < L.size(); ++i) masses.push_back(1.5 + std::sin(3.0 * static_cast<double>(i)));
  const Eigenpairs one = smallest_eigenpairs(L, masses, 20, 1), three = smallest_eigenpairs(L, masses, 20, 3);
  expect_eigenpairs(L, masses, one);
  EXPECT_EQ(one.values, three.values);
  EXPECT_EQ(one.vectors, three.vectors);
}

TEST(Eigenpairs, RefuseBadArguments) {
  SparseUpper L = grids(4, 4, 1);
  std::vector<double> masses(16, 1.0);
  EXPECT_THROW(smallest_eigenpairs(L, masses, 0), InvalidArgument);
  EXPECT_THROW(smallest_eigenpairs(L, masses, 17), InvalidArgument);
  masses[3] = 0;
  EXPECT_THROW(smallest_eigenpairs(L, masses, 2), InvalidArgument);
  masses.pop_back();
  EXPECT_THROW(smallest_eigenpairs(L, masses, 2), InvalidArgument);
  L.is_complex = true;
  EXPECT_THROW(smallest_eigenpairs(L, std::vector<double>(16, 1.0), 2), InvalidArgument);
}

}  // namespace
}  // namespace ahm::test
