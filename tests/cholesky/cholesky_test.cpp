// Factors by fronts against Eigen's dense and sparse ones, and the solvers under the two operators on matrices with known solutions.
#include "ahm/cholesky/cholesky.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <string>
#include <vector>

#include "ahm/cholesky/conjugate_gradient.hpp"
#include "ahm/error.hpp"
#include "cholesky/multifrontal.hpp"
#include "cholesky/supernodal_pattern.hpp"
#include "cholesky/triangular_solve.hpp"

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

/// The first columns of a Hermitian matrix whose diagonal dominates.
template <int W>
Matrix<W> front_of(Offset rows, Offset columns) {
  Matrix<W> K(rows, columns);
  for (Offset j = 0; j < columns; ++j)
    for (Offset i = 0; i < rows; ++i) {
      const auto [low, high] = std::minmax(i, j);
      const auto number = some_number<W>(1.0 + 3.0 * static_cast<double>(low) + 7.7 * static_cast<double>(high));
      K(i, j) = i > j ? number : i < j ? Eigen::numext::conj(number) : Number<W>(rows + 0.1 * static_cast<double>(j));
    }
  return K;
}

template <int W>
void expect_near_below_diagonal(const Matrix<W>& found, const Matrix<W>& expected, double tolerance) {
  for (Offset j = 0; j < found.cols(); ++j)
    for (Offset i = j; i < found.rows(); ++i)
      ASSERT_LT(std::abs(found(i, j) - expected(i, j)), tolerance) << i << ", " << j;
}

template <int W>
void expect_factor(Offset rows, Offset columns) {
  SCOPED_TRACE(std::to_string(rows) + " x " + std::to_string(columns));
  const Matrix<W> K = front_of<W>(rows, columns);
  const Offset below = rows - columns;
  const Matrix<W> own = Eigen::LLT<Matrix<W>>(K.topRows(columns)).matrixL();
  Matrix<W> under = K.bottomRows(below).adjoint();
  if (below > 0)
    own.template triangularView<Eigen::Lower>().solveInPlace(under);  // Eigen takes a reference to the first number
  Matrix<W> expected(rows, columns);
  expected << own, under.adjoint();

  Matrix<W> L = K, update = Matrix<W>::Constant(below, below, NAN);
  ASSERT_EQ(factor_front<W>(numbers<W>(L), rows, columns, numbers<W>(update)), columns);
  const double tolerance = 1e-13 * std::sqrt(static_cast<double>(rows));
  expect_near_below_diagonal<W>(L, expected, tolerance);
  expect_near_below_diagonal<W>(update, -(under.adjoint() * under), tolerance);
}

TEST(FactorFront, IsEigensOfEverySmallFrontAndOfLargeOnes) {
  std::vector<std::array<Offset, 2>> sizes{{150, 7}, {150, 150}, {301, 7}, {301, 150}, {500, 320}};
  ASSERT_TRUE(is_large_front(500, 320));
  sizes.push_back({700, 45});   // several blocks of rows below
  sizes.push_back({431, 129});  // one column more than two panels
  sizes.push_back({686, 45});   // the last block of rows has one or two doubles
  for (Offset rows = 1; rows <= 23; ++rows)
    for (Offset columns = 1; columns <= rows; ++columns) sizes.push_back({rows, columns});
  for (const auto& [rows, columns] : sizes) {
    expect_factor<1>(rows, columns);
    expect_factor<2>(rows, columns);
  }
}

/// Expects a zero update from a front whose own block is the identity and whose entries below are tiny.
template <int W>
void expect_zeros(Offset rows, Offset columns, unsigned threads) {
  Matrix<W> L = Matrix<W>::Constant(rows, columns, Number<W>(1e-160));
  L.topRows(columns).setIdentity();
  Matrix<W> update = Matrix<W>::Constant(rows - columns, rows - columns, NAN);
  EXPECT_EQ(factor_front<W>(numbers<W>(L), rows, columns, numbers<W>(update), threads), columns);
  for (Offset j = 0; j < update.cols(); ++j)
    for (Offset i = j; i < update.rows(); ++i) ASSERT_EQ(update(i, j), Number<W>(0)) << rows << ": " << i << ", " << j;
}

TEST(FactorFront, HasNoDenormalNumbers) {
#ifndef __SSE2__
  GTEST_SKIP() << "for x86";
#endif
  for (const auto& [rows, columns, threads] : {std::array{23, 7, 1}, {700, 45, 1}, {700, 45, 3}}) {
    expect_zeros<1>(rows, columns, static_cast<unsigned>(threads));
    expect_zeros<2>(rows, columns, static_cast<unsigned>(threads));
  }
  volatile double tiny = 1e-160;
  EXPECT_GT(tiny * tiny, 0) << "the mode of the processor is restored";
}

TEST(FactorFront, IsTheSameOnAnyNumberOfThreads) {
  for (const Offset rows : {700, 686}) {
    constexpr Offset columns = 45;
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
}

TEST(FactorFront, ReturnsTheNumberOfGoodPivots) {
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

/// The upper triangle of a matrix, column by column.
struct UpperColumns : SparseUpper {
  explicit UpperColumns(bool complex_numbers = false) {
    is_complex = complex_numbers;
    column_begin = {0};
  }
  void add(Offset row, double real, double imaginary = 0) {
    rows.push_back(row);
    values.push_back(real);
    if (is_complex) values.push_back(imaginary);
  }
  void end_column() { column_begin.push_back(std::ssize(rows)); }
};

/// A grid whose neighbors are joined by -1, or by numbers on the unit circle.
SparseUpper grid(Offset side, bool is_complex) {
  UpperColumns K(is_complex);
  for (Offset j = 0; j < side * side; ++j) {
    const double angle = std::sin(1.0 + static_cast<double>(j));
    const double re = is_complex ? std::cos(angle) : 1, im = std::sin(angle);
    if (j >= side) K.add(j - side, -re, -im);
    if (j % side > 0) K.add(j - 1, -re, im);
    K.add(j, 4.2);
    K.end_column();
  }
  return K;
}

/// Rows that are joined by hubs only: all other rows are children of one supernode.
SparseUpper hub_matrix(Offset rows, Offset hubs, bool is_complex) {
  UpperColumns K(is_complex);
  for (Offset j = 0; j < rows; ++j) {
    for (Offset i = 0; i < hubs && j >= hubs; ++i)
      K.add(i, std::sin(static_cast<double>(i + 3 * j)), std::cos(static_cast<double>(i * j)));
    K.add(j, 2.0 * static_cast<double>(j < hubs ? rows : hubs));
    K.end_column();
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
  std::vector<double> wide;  // a solution of 35 columns
  for (const Offset columns : {35, 1, 2, 3, 4, 7, 17})
    for (const bool only_points : {false, true}) {
      if ((columns > 7 && K.size() > 3000) || (only_points && columns != 1 && columns != 17)) continue;
      Matrix<W> b(K.size(), columns);
      for (Offset c = 0; c < columns; ++c)
        for (Offset i = 0; i < K.size(); ++i)
          b(i, c) = c == 1 || only_points ? Number<W>(i == 17) : some_number<W>(static_cast<double>(c + 2 * i));
      const Matrix<W> expected = eigens.solve(b);
      std::vector<double> x(numbers<W>(b), numbers<W>(b) + W * b.size()), again = x;
      factor.solve(x, columns);
      shared.solve(again, columns, 2);
      EXPECT_EQ(x, again);
      if (columns == 35) wide = x;
      if (columns > 4 && !only_points && !wide.empty())
        EXPECT_TRUE(std::equal(x.begin(), x.end(), wide.begin()));  // to the bit
      std::ranges::copy(x, numbers<W>(b));
      EXPECT_LT((b - expected).cwiseAbs().maxCoeff(), 1e-13) << K.size() << ", " << columns << " columns";
    }
}

TEST(CholeskyFactor, SolvesAsEigensWhereAHundredChildrenHaveOneParent) {
  for (const auto& [rows, count] : {std::pair<Offset, Offset>{300, 7}, {2000, 40}, {9000, 70}}) {
    expect_solutions<1>(hub_matrix(rows, count, false), Ordering::amd);
    expect_solutions<2>(hub_matrix(rows, count, true), Ordering::amd);
  }
}

TEST(CholeskyFactor, SolvesAsEigensFromOneRowToManyGroups) {
  for (const Offset side : {1, 2, 3, 10, 50, 160})
    for (const Ordering ordering : {Ordering::amd, Ordering::nested_dissection}) {
      expect_solutions<1>(grid(side, false), ordering);
      expect_solutions<2>(grid(side, true), ordering);
    }
}

TEST(CholeskyFactor, IsRefusedForAnotherMatrix) {
  for (const bool is_complex : {false, true}) {
    const SparseUpper K = grid(40, is_complex);
    const CholeskyFactor factor(K, SymbolicCholesky(K, Ordering::amd), "K");
    EXPECT_NO_THROW(check_residual(factor, K, "K"));
    for (const double by : {1.001, 1e9, 1e300, static_cast<double>(NAN)}) {
      SparseUpper other = K;
      other.values[other.values.size() / 2] *= by;
      EXPECT_THROW(check_residual(factor, other, "K"), NotPositiveDefinite) << by;
    }
  }
}

TEST(CholeskyFactor, NamesTheSameColumnOnAnyNumberOfThreads) {
  SparseUpper K = grid(160, false);
  for (const Offset bad : {3, 9000, 20001}) K.values[K.column_begin[bad + 1] - 1] = -1;  // on the diagonal
  const SymbolicCholesky symbolic(K, Ordering::amd);
  std::vector<std::string> messages;
  for (const unsigned threads : {1u, 2u, 4u}) try {
      const CholeskyFactor factor(K, symbolic, "K", threads);
    } catch (const NotPositiveDefinite& error) {
      messages.emplace_back(error.what());
    }
  ASSERT_EQ(messages.size(), 3U);
  EXPECT_NE(messages[0].find("K is not positive definite (column "), std::string::npos) << messages[0];
  EXPECT_EQ(messages[1], messages[0]);
  EXPECT_EQ(messages[2], messages[0]);
}

/// tridiag(-1, 2.5, -1).
SparseUpper chain(Offset n) {
  UpperColumns K;
  for (Offset j = 0; j < n; ++j) {
    if (j > 0) K.add(j - 1, -1);
    K.add(j, 2.5);
    K.end_column();
  }
  return K;
}

TEST(ConjugateGradient, InvertsAChain) {
  std::vector<double> x(202, 0.0), solved;  // with a zero at each end
  for (std::size_t i = 1; i <= 200; ++i) x[i] = std::sin(1.0 + 2.3 * static_cast<double>(i));
  for (std::size_t i = 1; i <= 200; ++i) solved.push_back(2.5 * x[i] - x[i - 1] - x[i + 1]);
  std::vector<double> twice = solved;
  twice.insert(twice.end(), solved.begin(), solved.end());
  const ConjugateGradient solver(chain(200), "A");
  EXPECT_EQ(solver.nonzeros(), 199);
  solver.solve(solved, 1);
  solver.solve(twice, 2);
  for (std::size_t i = 0; i < 200; ++i) {
    ASSERT_NEAR(solved[i], x[i + 1], 1e-12);
    ASSERT_EQ(twice[i], solved[i]);
    ASSERT_EQ(twice[i + 200], solved[i]);
  }
}

TEST(ConjugateGradient, RefusesWhatIsNotPositiveDefinite) {
  SparseUpper K = chain(3);
  K.values[0] = -1;
  EXPECT_THROW(ConjugateGradient(K, "A"), NotPositiveDefinite);
  K = chain(2);
  K.values[1] = 5;  // [2.5 5; 5 2.5] has the eigenvalue -2.5
  std::vector<double> b{1, -1};
  EXPECT_THROW(ConjugateGradient(K, "A").solve(b, 1), NotPositiveDefinite);
}

/// Appends a binary tree of supernodes in postorder; returns its root.
Offset append_tree(int depth, std::vector<Offset>& parent) {
  const Offset left = depth > 0 ? append_tree(depth - 1, parent) : -1;
  const Offset right = depth > 0 ? append_tree(depth - 1, parent) : -1;
  parent.push_back(-1);
  if (depth > 0) parent[left] = parent[right] = std::ssize(parent) - 1;
  return std::ssize(parent) - 1;
}

/// A factor whose supernodes are a binary tree in postorder, each of some columns above its path to the root.
struct TreeFactor {
  std::vector<std::int32_t> permutation, indices;
  std::vector<Offset> super{0}, row_begin{0}, value_begin{0}, parent;
  std::vector<double> values;

  explicit TreeFactor(int depth) {
    append_tree(depth, parent);
    const auto supernodes = std::ssize(parent);
    for (Offset s = 0; s < supernodes; ++s) super.push_back(size() + 3 + s % 2);
    for (Offset s = 0; s < supernodes; ++s) {
      for (Offset a = s; a >= 0; a = parent[a])
        for (Offset r = super[a]; r < super[a + 1]; ++r)
          if (a == s || r % 3 != 0 || a == parent[s]) indices.push_back(static_cast<std::int32_t>(r));
      row_begin.push_back(std::ssize(indices));
      const Offset columns = super[s + 1] - super[s], rows = row_begin[s + 1] - row_begin[s];
      value_begin.push_back(value_begin[s] + rows * columns);
      for (Offset j = 0; j < columns; ++j)
        for (Offset r = 0; r < rows; ++r)
          values.push_back(r < j ? 0 : r == j ? 3.0 : 0.1 * std::sin(1.0 + static_cast<double>(s + 3 * r + 7 * j)));
    }
    for (Offset k = 0; k < size(); ++k) permutation.push_back(static_cast<std::int32_t>(k));
  }
  Offset size() const { return super.back(); }
  SupernodalFactor view() const {
    return {size(), false, permutation, super, row_begin, value_begin, indices, values.data()};
  }
};

TEST(SolveGroups, AreSubtreesAndTheSupernodesAboveThem) {
  const TreeFactor factor(12), small(4);
  EXPECT_EQ(solve_groups(small.view(), small.parent), nullptr);  // where they would not be faster
  const auto groups = solve_groups(factor.view(), factor.parent);
  ASSERT_NE(groups, nullptr);
  std::vector<int> uses(factor.parent.size(), 0);
  for (const Offset s : groups->top) ++uses[s];
  std::vector<Offset> work;
  for (Offset g = 0; g < groups->count(); ++g) {
    work.push_back(0);
    for (std::size_t t = groups->begin[g]; t < groups->begin[g + 1]; ++t) {
      const auto [first, last, end] = groups->subtrees[t];
      EXPECT_EQ(end, factor.super[last]);
      for (Offset s = first; s < last; ++s) {
        ++uses[s];
        work.back() += factor.value_begin[s + 1] - factor.value_begin[s];
        for (Offset k = factor.row_begin[s]; k < factor.row_begin[s + 1]; ++k)
          ASSERT_EQ(factor.indices[k] < end, groups->place[factor.indices[k]] < 0) << "supernode " << s;
      }
    }
  }
  EXPECT_EQ(uses, std::vector<int>(uses.size(), 1));
  EXPECT_GT(groups->count(), 1);
  for (const Offset w : work) EXPECT_GT(5 * groups->count() * w, 4 * (work[0] + work[1]));
  EXPECT_EQ(std::ranges::count_if(groups->place, [](auto place) { return place >= 0; }),
            static_cast<Offset>(groups->top_rows));
}

TEST(SolveGroups, HaveTheSameSolutionOnAnyNumberOfThreads) {
  const TreeFactor factor(12);
  const auto groups = solve_groups(factor.view(), factor.parent);
  ASSERT_NE(groups, nullptr);
  for (Offset columns = 1; columns <= max_narrow_columns; ++columns)
    for (const bool is_point : {false, true}) {
      std::vector<double> b(static_cast<std::size_t>(factor.size() * columns), 0.0);
      for (std::size_t k = is_point ? 17 : 0; k < (is_point ? 18 : b.size()); ++k)
        b[k] = std::cos(1.0 + 0.7 * static_cast<double>(k));
      std::vector<double> plain = b, one = b;
      narrow_solve(factor.view(), plain, columns);
      narrow_solve(factor.view(), one, columns, groups.get(), 1);
      for (const unsigned threads : {2u, 3u, 9u}) {
        std::vector<double> many = b;
        narrow_solve(factor.view(), many, columns, groups.get(), threads);
        ASSERT_EQ(many, one) << threads;
      }
      for (std::size_t k = 0; k < b.size(); ++k) ASSERT_NEAR(one[k], plain[k], 1e-12 * (1 + std::abs(plain[k])));
    }
}

}  // namespace
}  // namespace ahm::test
