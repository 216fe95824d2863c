// Factors by fronts, beside Eigen's dense and sparse ones.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/SparseCholesky>
#include <cmath>
#include <complex>
#include <string>
#include <vector>

#include "ahm/cholesky/cholesky.hpp"
#include "ahm/error.hpp"
#include "cholesky/blas.hpp"
#include "cholesky/multifrontal.hpp"

namespace ahm::test {
namespace {

template <int W>
using Number = std::conditional_t<W == 1, double, std::complex<double>>;
template <int W>
using Matrix = Eigen::Matrix<Number<W>, Eigen::Dynamic, Eigen::Dynamic>;

template <int W>
double* numbers(Matrix<W>& matrix) {
  return reinterpret_cast<double*>(matrix.data());
}

template <int W>
Number<W> some_number(double seed) {
  if constexpr (W == 1)
    return std::sin(seed);
  else
    return {std::sin(seed), std::cos(1.3 * seed)};
}

/// The first columns of a Hermitian matrix that dominates its diagonal.
template <int W>
Matrix<W> front_of(Offset rows, Offset columns) {
  Matrix<W> K(rows, columns);
  for (Offset j = 0; j < columns; ++j)
    for (Offset i = 0; i < rows; ++i)
      K(i, j) =
          some_number<W>(1.0 + 3.0 * static_cast<double>(std::min(i, j)) + 7.7 * static_cast<double>(std::max(i, j)));
  for (Offset j = 0; j < columns; ++j) {
    for (Offset i = 0; i < j; ++i) K(i, j) = Eigen::numext::conj(K(j, i));
    K(j, j) = static_cast<double>(rows) + 0.1 * static_cast<double>(j);
  }
  return K;
}

template <int W>
void expect_factor(Offset rows, Offset columns) {
  const Matrix<W> K = front_of<W>(rows, columns);
  const Offset below = rows - columns;
  const Matrix<W> own = Eigen::LLT<Matrix<W>>(K.topRows(columns)).matrixL();
  Matrix<W> under = K.bottomRows(below).adjoint();
  if (below > 0)
    own.template triangularView<Eigen::Lower>().solveInPlace(under);  // Eigen takes a reference to the first number
  const Matrix<W> left = -(under.adjoint() * under);

  Matrix<W> L = K, update = Matrix<W>::Constant(below, below, NAN);
  ASSERT_EQ(factor_front<W>(numbers<W>(L), rows, columns, numbers<W>(update)), columns);
  const double near = 1e-13 * std::sqrt(static_cast<double>(rows));
  for (Offset j = 0; j < columns; ++j)
    for (Offset i = j; i < rows; ++i)
      ASSERT_LT(std::abs(L(i, j) - (i < columns ? own(i, j) : Eigen::numext::conj(under(j, i - columns)))), near)
          << rows << " x " << columns << ": " << i << ", " << j;
  for (Offset j = 0; j < below; ++j)
    for (Offset i = j; i < below; ++i)
      ASSERT_LT(std::abs(update(i, j) - left(i, j)), near) << rows << " x " << columns << ": " << i << ", " << j;
}

TEST(FactorFront, IsEigensOfEverySmallFrontAndOfLargeOnes) {
  const OneBlasThread one_thread;
  for (Offset rows = 1; rows <= 23; ++rows)
    for (Offset columns = 1; columns <= rows; ++columns) {
      expect_factor<1>(rows, columns);
      expect_factor<2>(rows, columns);
    }
  for (const Offset rows : {150, 301})
    for (const Offset columns : {7, 150}) {
      expect_factor<1>(rows, columns);
      expect_factor<2>(rows, columns);
    }
  ASSERT_TRUE(is_large_front(500, 320));
  expect_factor<1>(500, 320);
  expect_factor<2>(500, 320);
  expect_factor<1>(700, 45);  // several blocks of rows below
  expect_factor<2>(700, 45);
}

/// Of a front whose own block is the identity and whose entries below are tiny nothing is left.
template <int W>
void expect_zeros(Offset rows, Offset columns, unsigned threads) {
  Matrix<W> L = Matrix<W>::Constant(rows, columns, Number<W>(1e-160));
  L.topRows(columns).setIdentity();
  Matrix<W> update = Matrix<W>::Constant(rows - columns, rows - columns, NAN);
  EXPECT_EQ(factor_front<W>(numbers<W>(L), rows, columns, numbers<W>(update), threads), columns);
  for (Offset j = 0; j < update.cols(); ++j)
    for (Offset i = j; i < update.rows(); ++i) ASSERT_EQ(update(i, j), Number<W>(0)) << rows << ": " << i << ", " << j;
}

TEST(FactorFront, KeepsNoNumbersBelowTheNormalOnes) {
#ifndef __SSE2__
  GTEST_SKIP() << "for x86";
#endif
  const OneBlasThread one_thread;
  expect_zeros<1>(23, 7, 1);
  expect_zeros<2>(23, 7, 1);
  for (const unsigned threads : {1, 3}) {
    expect_zeros<1>(700, 45, threads);
    expect_zeros<2>(700, 45, threads);
  }
  volatile double tiny = 1e-160;
  EXPECT_GT(tiny * tiny, 0) << "only the front's";
}

TEST(FactorFront, IsTheSameOnAnyNumberOfThreads) {
  const OneBlasThread one_thread;
  constexpr Offset rows = 700, columns = 45;
  ASSERT_TRUE(is_large_front(rows, columns));
  const Matrix<2> K = front_of<2>(rows, columns), unset = Matrix<2>::Zero(rows - columns, rows - columns);
  Matrix<2> L = K, update = unset;
  factor_front<2>(numbers<2>(L), rows, columns, numbers<2>(update));
  for (const unsigned threads : {2u, 3u, 8u}) {
    Matrix<2> shared = K, shared_update = unset;
    factor_front<2>(numbers<2>(shared), rows, columns, numbers<2>(shared_update), threads);
    EXPECT_EQ(shared.bottomRows(rows - columns), L.bottomRows(rows - columns)) << threads;
    EXPECT_EQ(shared_update, update) << threads;
  }
}

TEST(FactorFront, TellsHowManyPivotsAreGood) {
  const OneBlasThread one_thread;
  for (const Offset columns : {9, 320})
    for (const Offset bad : {Offset{0}, Offset{5}, columns - 1})
      for (const double pivot : {-1.0, 0.0, static_cast<double>(NAN)}) {
        const Offset rows = columns + 180;
        Matrix<1> L = front_of<1>(rows, columns), update(rows - columns, rows - columns);
        L.row(bad).setZero();
        L.col(bad).setZero();
        L(bad, bad) = pivot;
        EXPECT_EQ(factor_front<1>(L.data(), rows, columns, update.data()), bad) << pivot;
      }
}

/// A grid whose neighbours are joined by -1, or by numbers on the unit circle.
SparseUpper grid(Offset side, bool is_complex) {
  SparseUpper K;
  K.is_complex = is_complex;
  K.column_begin = {0};
  const auto add = [&](Offset row, double real, double imaginary) {
    K.rows.push_back(row);
    K.values.push_back(real);
    if (is_complex) K.values.push_back(imaginary);
  };
  for (Offset j = 0; j < side * side; ++j) {
    const double angle = std::sin(1.0 + static_cast<double>(j));
    const double re = is_complex ? std::cos(angle) : 1, im = std::sin(angle);
    if (j >= side) add(j - side, -re, -im);
    if (j % side > 0) add(j - 1, -re, im);
    add(j, 4.2, 0);
    K.column_begin.push_back(static_cast<Offset>(K.rows.size()));
  }
  return K;
}

template <int W>
Eigen::SparseMatrix<Number<W>> eigen_matrix(const SparseUpper& K) {
  std::vector<Eigen::Triplet<Number<W>>> entries;
  for (Offset j = 0; j < K.size(); ++j)
    for (Offset p = K.column_begin[j]; p < K.column_begin[j + 1]; ++p) {
      Number<W> value = K.values[p * W];
      if constexpr (W == 2) value = {K.values[p * W], K.values[p * W + 1]};
      entries.emplace_back(K.rows[p], j, value);
      if (K.rows[p] != j) entries.emplace_back(j, K.rows[p], Eigen::numext::conj(value));
    }
  Eigen::SparseMatrix<Number<W>> matrix(K.size(), K.size());
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

template <int W>
void expect_solutions(const SparseUpper& K, Ordering ordering) {
  const SymbolicCholesky symbolic(K, ordering);
  const CholeskyFactor factor(K, symbolic, "K"), shared(K, symbolic, "K", 3);
  const Eigen::SimplicialLLT<Eigen::SparseMatrix<Number<W>>> eigens(eigen_matrix<W>(K));
  for (const Offset columns : {1, 2, 3, 4, 7}) {
    Matrix<W> b(K.size(), columns);
    for (Offset c = 0; c < columns; ++c)
      for (Offset i = 0; i < K.size(); ++i)
        b(i, c) = c == 1 ? Number<W>(i == 17) : some_number<W>(static_cast<double>(c + 2 * i));
    const Matrix<W> known = eigens.solve(b);
    std::vector<double> X(reinterpret_cast<const double*>(b.data()),
                          reinterpret_cast<const double*>(b.data() + b.size()));
    std::vector<double> again = X;
    factor.solve(X, columns);
    shared.solve(again, columns, 2);
    EXPECT_EQ(X, again);
    const Matrix<W> found =
        Eigen::Map<const Matrix<W>>(reinterpret_cast<const Number<W>*>(X.data()), K.size(), columns);
    EXPECT_LT((found - known).cwiseAbs().maxCoeff(), 1e-13) << K.size() << ", " << columns << " columns";
  }
}

/// Rows that only hubs join: all the others are children of one supernode.
SparseUpper hubs(Offset rows, Offset hubs, bool is_complex) {
  SparseUpper K;
  K.is_complex = is_complex;
  K.column_begin = {0};
  for (Offset j = 0; j < rows; ++j) {
    for (Offset i = 0; i < std::min(j, hubs) && j >= hubs; ++i) {
      K.rows.push_back(i);
      K.values.push_back(std::sin(static_cast<double>(i + 3 * j)));
      if (is_complex) K.values.push_back(std::cos(static_cast<double>(i * j)));
    }
    K.rows.push_back(j);
    K.values.push_back(2.0 * static_cast<double>(j < hubs ? rows : hubs));
    if (is_complex) K.values.push_back(0);
    K.column_begin.push_back(static_cast<Offset>(K.rows.size()));
  }
  return K;
}

TEST(CholeskyFactor, SolvesAsEigensWhereAHundredChildrenHaveOneParent) {
  for (const auto& [rows, count] : {std::pair<Offset, Offset>{300, 7}, {2000, 40}, {9000, 70}}) {
    expect_solutions<1>(hubs(rows, count, false), Ordering::amd);
    expect_solutions<2>(hubs(rows, count, true), Ordering::amd);
  }
}

TEST(CholeskyFactor, SolvesAsEigensFromOneRowToManyGroups) {
  for (const Offset side : {1, 2, 3, 10, 50, 160})
    for (const Ordering ordering : {Ordering::amd, Ordering::nested_dissection}) {
      expect_solutions<1>(grid(side, false), ordering);
      expect_solutions<2>(grid(side, true), ordering);
    }
}

TEST(CholeskyFactor, IsToldFromThoseOfOtherMatrices) {
  for (const bool is_complex : {false, true}) {
    const SparseUpper K = grid(40, is_complex);
    const CholeskyFactor factor(K, SymbolicCholesky(K, Ordering::amd), "K");
    EXPECT_NO_THROW(factor.check(K, "K"));
    for (const double by : {1.001, 1e9, 1e300, std::numeric_limits<double>::quiet_NaN()}) {
      SparseUpper other = K;
      other.values[other.values.size() / 2] *= by;
      EXPECT_THROW(factor.check(other, "K"), NotPositiveDefinite) << by;
    }
  }
}

TEST(CholeskyFactor, NamesTheSameColumnOnAnyNumberOfThreads) {
  SparseUpper K = grid(160, false);
  for (const Offset bad : {Offset{3}, Offset{9000}, Offset{20001}})
    for (Offset p = K.column_begin[bad]; p < K.column_begin[bad + 1]; ++p)
      if (K.rows[p] == bad) K.values[p] = -1;
  const SymbolicCholesky symbolic(K, Ordering::amd);
  std::vector<std::string> told;
  for (const unsigned threads : {1u, 2u, 4u}) try {
      const CholeskyFactor factor(K, symbolic, "K", threads);
    } catch (const NotPositiveDefinite& error) {
      told.emplace_back(error.what());
    }
  ASSERT_EQ(told.size(), 3U);
  EXPECT_NE(told[0].find("operator K is not positive definite (column "), std::string::npos) << told[0];
  EXPECT_EQ(told[1], told[0]);
  EXPECT_EQ(told[2], told[0]);
}

}  // namespace
}  // namespace ahm::test
