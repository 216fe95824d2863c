#include "ahm/cholesky/eigenpairs.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ahm/cholesky/cholesky.hpp"
#include "ahm/util/disjoint_sets.hpp"
#include "ahm/util/parallel.hpp"
#include "ahm/util/text.hpp"
#include "cholesky/block_lanczos.hpp"

namespace ahm {
namespace {

void check(const SparseUpper& L, std::span<const double> masses, Offset count) {
  const Offset n = L.size();
  if (L.is_complex) throw InvalidArgument("smallest_eigenpairs: L is complex; it must be real");
  if (static_cast<Offset>(masses.size()) != n)
    throw InvalidArgument("smallest_eigenpairs: " + std::to_string(masses.size()) + " masses for a matrix of " +
                          std::to_string(n) + " rows; pass one per row");
  for (std::size_t i = 0; i < masses.size(); ++i)
    if (!(masses[i] > 0) || !std::isfinite(masses[i]))
      throw InvalidArgument("smallest_eigenpairs: mass " + std::to_string(i) + " is " + detail::number(masses[i]) +
                            "; masses must be positive and finite");
  if (count < 1 || count > n)
    throw InvalidArgument("smallest_eigenpairs: count is " + std::to_string(count) +
                          "; it must be between 1 and the number of rows, " + std::to_string(n));
}

/// Rows of every connected component, ascending.
std::vector<std::vector<Offset>> components(const SparseUpper& L) {
  const auto n = static_cast<std::size_t>(L.size());
  detail::DisjointSets sets(n);
  for (Offset j = 0; j < L.size(); ++j)
    for (Offset p = L.column_begin[j]; p < L.column_begin[j + 1]; ++p)
      if (L.values[p] != 0) sets.join(static_cast<Index>(L.rows[p]), static_cast<Index>(j));
  std::vector<std::vector<Offset>> result;
  std::vector<Offset> number(n, -1);
  for (std::size_t i = 0; i < n; ++i) {
    Offset& c = number[static_cast<std::size_t>(sets.root(static_cast<Index>(i)))];
    if (c < 0) c = static_cast<Offset>(result.size()), result.emplace_back();
    result[static_cast<std::size_t>(c)].push_back(static_cast<Offset>(i));
  }
  return result;
}

/// M^-1/2 L M^-1/2 + shift I on the rows of one component.
struct ScaledPart {
  SparseUpper matrix;
  double shift;
};

/// @param place  place of each row of L in its component
ScaledPart scaled_part(const SparseUpper& L, std::span<const double> masses, std::span<const Offset> rows,
                       std::span<const Offset> place, Offset count) {
  double trace = 0, area = 0;
  ScaledPart part;
  SparseUpper& K = part.matrix;
  std::vector<Offset> diagonal;
  K.column_begin.push_back(0);
  for (const Offset j : rows) {
    for (Offset p = L.column_begin[j]; p < L.column_begin[j + 1]; ++p) {
      const Offset i = L.rows[p];
      if (i != j && L.values[p] == 0) continue;  // may belong to another component
      if (i == j) diagonal.push_back(static_cast<Offset>(K.rows.size())), trace += L.values[p];
      K.rows.push_back(place[i]);
      K.values.push_back(L.values[p] / std::sqrt(masses[i] * masses[j]));
    }
    area += masses[j];
    K.column_begin.push_back(static_cast<Offset>(K.rows.size()));
  }
  // By Weyl's law, on surfaces this is about 1 % of the largest wanted eigenvalue: small enough for fast convergence, and large enough
  // that rounding errors of 1 / shift do not matter.
  part.shift = 0.03 * static_cast<double>(count) / static_cast<double>(rows.size()) * trace / area;
  for (const Offset p : diagonal) K.values[p] += part.shift;
  return part;
}

/// Eigenpairs of a matrix, ascending.
Eigenpairs dense_eigenpairs(const SparseUpper& K, Offset count) {
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(K.size(), K.size());
  for (Offset j = 0; j < K.size(); ++j)
    for (Offset p = K.column_begin[j]; p < K.column_begin[j + 1]; ++p) A(j, K.rows[p]) = K.values[p];
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solved(A);  // reads the lower triangle
  const Eigen::MatrixXd vectors = solved.eigenvectors().leftCols(count);
  return {{solved.eigenvalues().begin(), solved.eigenvalues().begin() + count},
          {vectors.data(), vectors.data() + vectors.size()}};
}

/// Matrices of up to this size are solved densely: Lanczos needs a basis of about this size.
Offset dense_size(Offset count) { return 4 * count + 6 * lanczos_block; }

/// The smallest eigenvalues of M^-1/2 L M^-1/2 on one component, and their orthonormal eigenvectors.
Eigenpairs part_eigenpairs(const ScaledPart& part, Offset count, unsigned threads, const Progress& progress) {
  const SparseUpper& K = part.matrix;
  std::optional<Eigenpairs> found;
  if (K.size() > dense_size(count)) {
    const CholeskyFactor factor(K, SymbolicCholesky(K, Ordering::automatic, threads), "L + shift M", threads);
    check_residual(factor, K, "L + shift M", threads);
    found = largest_inverse_eigenpairs(factor, K.size(), count, threads, progress);
    if (found)
      for (double& mu : found->values) mu = 1 / mu;
  }
  if (!found) found = dense_eigenpairs(K, count);
  for (double& value : found->values) value -= part.shift;
  return std::move(*found);
}

}  // namespace

Eigenpairs smallest_eigenpairs(const SparseUpper& L, std::span<const double> masses, Offset count, unsigned threads,
                               const Progress& progress) {
  check(L, masses, count);
  const auto n = static_cast<std::size_t>(L.size()), k = static_cast<std::size_t>(count);
  const auto parts = components(L);
  std::vector<Offset> place(n);
  for (const auto& rows : parts)
    for (std::size_t i = 0; i < rows.size(); ++i) place[static_cast<std::size_t>(rows[i])] = static_cast<Offset>(i);

  struct Candidate {
    double value;
    std::size_t part, column;
  };
  std::vector<Candidate> best;
  std::vector<Eigenpairs> found;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const Offset wanted = std::min(count, static_cast<Offset>(parts[p].size()));
    progress.step("eigenvectors", static_cast<double>(p) / static_cast<double>(parts.size()));
    found.push_back(part_eigenpairs(scaled_part(L, masses, parts[p], place, wanted), wanted,
                                    detail::thread_count(threads), progress));
    for (std::size_t c = 0; c < found[p].values.size(); ++c) best.push_back({found[p].values[c], p, c});
  }
  std::stable_sort(best.begin(), best.end(), [](const Candidate& a, const Candidate& b) { return a.value < b.value; });

  Eigenpairs result{std::vector<double>(k), std::vector<double>(n * k, 0.0)};
  for (std::size_t c = 0; c < k; ++c) {
    const std::vector<Offset>& rows = parts[best[c].part];
    const double* vector = found[best[c].part].vectors.data() + best[c].column * rows.size();
    result.values[c] = best[c].value;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const auto row = static_cast<std::size_t>(rows[i]);
      result.vectors[c * n + row] = vector[i] / std::sqrt(masses[row]);
    }
  }
  return result;
}

}  // namespace ahm
