// The solvers under the two operators, each alone: on matrices small enough to know the answer.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "ahm/cholesky/conjugate_gradient.hpp"
#include "ahm/error.hpp"
#include "cholesky/blas.hpp"
#include "cholesky/supernodal_pattern.hpp"
#include "cholesky/triangular_solve.hpp"

namespace ahm::test {
namespace {

/// tridiag(-1, 2.5, -1), the upper triangle by columns.
SparseUpper chain(Offset n) {
  SparseUpper K;
  K.column_begin = {0};
  for (Offset j = 0; j < n; ++j) {
    if (j > 0) K.rows.push_back(j - 1), K.values.push_back(-1);
    K.rows.push_back(j), K.values.push_back(2.5);
    K.column_begin.push_back(static_cast<Offset>(K.rows.size()));
  }
  return K;
}

std::vector<double> chain_times(const std::vector<double>& x) {
  std::vector<double> y(x.size());
  for (std::size_t i = 0; i < x.size(); ++i)
    y[i] = 2.5 * x[i] - (i > 0 ? x[i - 1] : 0) - (i + 1 < x.size() ? x[i + 1] : 0);
  return y;
}

TEST(ConjugateGradient, InvertsAChain) {
  std::vector<double> x(200);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = std::sin(1.0 + 2.3 * static_cast<double>(i));
  std::vector<double> solved = chain_times(x), twice = solved;
  twice.insert(twice.end(), solved.begin(), solved.end());
  const ConjugateGradient solver(chain(200), "A");
  EXPECT_EQ(solver.nonzeros(), 199);
  solver.solve(solved, 1);
  solver.solve(twice, 2);
  for (std::size_t i = 0; i < x.size(); ++i) {
    ASSERT_NEAR(solved[i], x[i], 1e-12);
    ASSERT_EQ(twice[i], solved[i]);
    ASSERT_EQ(twice[i + x.size()], solved[i]);
  }
}

TEST(ConjugateGradient, RefusesWhatIsNotPositiveDefinite) {
  SparseUpper K = chain(3);
  K.values[0] = -1;
  EXPECT_THROW(ConjugateGradient(K, "A"), NotPositiveDefinite);
  K = chain(2);
  K.values[1] = 5;  // [2.5 5; 5 2.5] has the eigenvalue -2.5
  const ConjugateGradient solver(K, "A");
  std::vector<double> b{1, -1};
  EXPECT_THROW(solver.solve(b, 1), NotPositiveDefinite);
}

/// L of two supernodes, {0, 1} and {2}, by hand: columns (2, 1, 3), (., 4, 5), (6).
struct HandFactor {
  std::vector<std::int32_t> permutation, indices{0, 1, 2, 2};
  std::vector<Offset> super{0, 2, 3}, row_begin{0, 3, 4}, value_begin{0, 6, 7};
  std::vector<double> values{2, 1, 3, 0, 4, 5, 6};
  SupernodalFactor view() const {
    return {3, false, permutation, super, row_begin, value_begin, indices, values.data()};
  }
};

TEST(NarrowSolve, InvertsAFactorWrittenByHand) {
  const double L[3][3] = {{2, 0, 0}, {1, 4, 0}, {3, 5, 6}};
  for (const std::vector<std::int32_t>& order : {std::vector<std::int32_t>{0, 1, 2}, {2, 0, 1}}) {
    HandFactor factor;
    factor.permutation = order;
    for (Offset columns = 1; columns <= max_narrow_columns; ++columns) {
      std::vector<double> x(static_cast<std::size_t>(3 * columns)), b(x.size(), 0.0);
      for (std::size_t k = 0; k < x.size(); ++k) x[k] = 1.0 + static_cast<double>(k * k);
      for (Offset c = 0; c < columns; ++c)  // K = P^T L L^T P: row order[i] of K is row i of L L^T
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j)
            for (int k = 0; k < 3; ++k)
              b[static_cast<std::size_t>(3 * c + order[i])] +=
                  L[i][k] * L[j][k] * x[static_cast<std::size_t>(3 * c + order[j])];
      narrow_solve(factor.view(), b, columns);
      for (std::size_t k = 0; k < x.size(); ++k) ASSERT_NEAR(b[k], x[k], 1e-13 * std::abs(x.back())) << columns;
    }
  }
}

/// A factor of real or complex numbers on a chain of supernodes of 1 to 4 columns, each above some rows of those after it.
struct ChainFactor {
  Offset n = 0;
  int width;
  std::vector<std::int32_t> permutation, indices;
  std::vector<Offset> super{0}, row_begin{0}, value_begin{0};
  std::vector<double> values;

  explicit ChainFactor(bool is_complex) : width(is_complex ? 2 : 1) {
    constexpr Offset supernodes = 9;
    for (Offset s = 0; s < supernodes; ++s) super.push_back(n += 1 + s % 4);
    for (Offset s = 0; s < supernodes; ++s) {
      const Offset columns = super[s + 1] - super[s];
      for (Offset r = super[s]; r < n; ++r)
        if (r < super[s + 1] || r % 3 == 0 || r + 2 >= n) indices.push_back(static_cast<std::int32_t>(r));
      row_begin.push_back(static_cast<Offset>(indices.size()));
      const Offset rows = row_begin[s + 1] - row_begin[s];
      value_begin.push_back(value_begin[s] + rows * columns);
      for (Offset j = 0; j < columns; ++j)
        for (Offset r = 0; r < rows; ++r)
          for (int w = 0; w < width; ++w)
            values.push_back(r < j ? 0 : r == j ? (w == 0 ? 2.0 + 0.1 * s : 0) : std::sin(1.0 + s + 3 * r + 7 * j + w));
    }
    for (Offset k = 0; k < n; ++k) permutation.push_back(static_cast<std::int32_t>((5 * k + 2) % n));
  }
  SupernodalFactor view() const {
    return {n, width == 2, permutation, super, row_begin, value_begin, indices, values.data()};
  }
};

TEST(BlockSolve, IsTheNarrowSolveOfEveryColumnWhateverIsBesideIt) {
  for (const bool is_complex : {false, true}) {
    const ChainFactor factor(is_complex);
    const auto column = static_cast<std::size_t>(factor.n * factor.width);
    constexpr std::size_t most = 35;
    std::vector<double> b(most * column), alone;
    // Some columns are zero but for a number: the way to the root is all there is to solve for, on the way down.
    for (std::size_t k = 0; k < b.size(); ++k)
      b[k] = k / column % 3 == 0 && k % column != k / column ? 0 : std::cos(1.0 + static_cast<double>(k));
    for (std::size_t c = 0; c < most; ++c) {
      std::vector<double> x(b.begin() + static_cast<std::ptrdiff_t>(c * column),
                            b.begin() + static_cast<std::ptrdiff_t>((c + 1) * column));
      narrow_solve(factor.view(), x, 1);
      alone.insert(alone.end(), x.begin(), x.end());
    }
    std::vector<double> all = b;
    block_solve(factor.view(), all, most);
    for (std::size_t k = 0; k < all.size(); ++k) ASSERT_NEAR(all[k], alone[k], 1e-11 * (1 + std::abs(alone[k])));
    for (std::size_t columns : {std::size_t{1}, std::size_t{8}, std::size_t{17}}) {
      std::vector<double> some(b.begin(), b.begin() + static_cast<std::ptrdiff_t>(columns * column));
      block_solve(factor.view(), some, static_cast<Offset>(columns));
      for (std::size_t k = 0; k < some.size(); ++k) ASSERT_EQ(some[k], all[k]) << columns;
    }
  }
}

/// A factor whose supernodes are a binary tree in postorder, each of some columns above its way to the root.
struct TreeFactor {
  Offset n = 0;
  std::vector<std::int32_t> permutation, indices;
  std::vector<Offset> super{0}, row_begin{0}, value_begin{0};
  std::vector<double> values;
  std::vector<Offset> parent;

  explicit TreeFactor(int depth) {
    number(depth, parent);
    const auto supernodes = static_cast<Offset>(parent.size());
    for (Offset s = 0; s < supernodes; ++s) super.push_back(n += 3 + s % 2);
    for (Offset s = 0; s < supernodes; ++s) {
      for (Offset a = s; a >= 0; a = parent[a])
        for (Offset r = super[a]; r < super[a + 1]; ++r)
          if (a == s || r % 3 != 0 || a == parent[s]) indices.push_back(static_cast<std::int32_t>(r));
      row_begin.push_back(static_cast<Offset>(indices.size()));
      const Offset columns = super[s + 1] - super[s], rows = row_begin[s + 1] - row_begin[s];
      value_begin.push_back(value_begin[s] + rows * columns);
      for (Offset j = 0; j < columns; ++j)
        for (Offset r = 0; r < rows; ++r)
          values.push_back(r < j ? 0 : r == j ? 3.0 : 0.1 * std::sin(1.0 + static_cast<double>(s + 3 * r + 7 * j)));
    }
    for (Offset k = 0; k < n; ++k) permutation.push_back(static_cast<std::int32_t>(k));
  }
  SupernodalFactor view() const {
    return {n, false, permutation, super, row_begin, value_begin, indices, values.data()};
  }

 private:
  static Offset number(int depth, std::vector<Offset>& parent) {
    const Offset left = depth > 0 ? number(depth - 1, parent) : -1, right = depth > 0 ? number(depth - 1, parent) : -1;
    const auto self = static_cast<Offset>(parent.size());
    parent.push_back(-1);
    if (depth > 0) parent[left] = parent[right] = self;
    return self;
  }
};

TEST(SolveGroups, AreSubtreesAndWhatIsAboveThem) {
  const TreeFactor factor(12);
  const SupernodalFactor L = factor.view();
  const auto groups = solve_groups(L, factor.parent);
  ASSERT_NE(groups, nullptr);
  std::vector<int> seen(factor.super.size() - 1, 0);
  for (const Offset s : groups->top) ++seen[s];
  std::vector<Offset> work;
  for (Offset g = 0; g < groups->count(); ++g) {
    work.push_back(0);
    for (std::size_t t = groups->begin[g]; t < groups->begin[g + 1]; ++t) {
      const auto [first, last, end] = groups->subtrees[t];
      EXPECT_EQ(end, factor.super[last]);
      for (Offset s = first; s < last; ++s) {
        ++seen[s];
        work.back() += factor.value_begin[s + 1] - factor.value_begin[s];
        for (Offset k = factor.row_begin[s]; k < factor.row_begin[s + 1]; ++k)
          ASSERT_EQ(factor.indices[k] < end, groups->place[factor.indices[k]] < 0) << "supernode " << s;
      }
    }
  }
  for (const int times : seen) ASSERT_EQ(times, 1);
  EXPECT_GT(groups->count(), 1);
  for (const Offset w : work) EXPECT_GT(5 * groups->count() * w, 4 * (work[0] + work[1]));
  std::size_t rows = 0;
  for (const auto place : groups->place) rows += place >= 0;
  EXPECT_EQ(rows, groups->top_rows);
}

TEST(SolveGroups, GiveTheSolutionOfOneThreadAfterTheOther) {
  const TreeFactor factor(12);
  const auto groups = solve_groups(factor.view(), factor.parent);
  ASSERT_NE(groups, nullptr);
  for (Offset columns = 1; columns <= max_narrow_columns; ++columns)
    for (const bool is_point : {false, true}) {
      std::vector<double> b(static_cast<std::size_t>(factor.n * columns), 0.0);
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

TEST(SolveGroups, AreNotMadeWhereTheyDoNotPay) {
  const TreeFactor factor(4);
  EXPECT_EQ(solve_groups(factor.view(), factor.parent), nullptr);
}

TEST(OneBlasThread, MayBeNestedAndSaysWhatTheBlasIs) {
  const std::string before = blas_name();
  {
    const OneBlasThread outer;
    const OneBlasThread inner;
    EXPECT_EQ(blas_name(), before);
  }
  EXPECT_FALSE(before.empty());
  EXPECT_TRUE(blas_is_optimized("OpenBLAS 0.3.21"));
}

}  // namespace
}  // namespace ahm::test
