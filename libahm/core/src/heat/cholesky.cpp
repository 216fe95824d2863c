#include "heat/cholesky.hpp"

#include <cholmod.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <string>
#include <utility>

#include "ahm/error.hpp"
#include "ahm/util/text.hpp"
#include "heat/blas_control.hpp"
#include "heat/block_solve.hpp"
#include "heat/multifrontal.hpp"
#include "heat/solve_groups.hpp"
#include "heat/triangular_solve.hpp"

namespace ahm {
namespace {

/// CHOLMOD's workspace. One per call: it must not be shared between threads.
class Common {
 public:
  explicit Common(bool supernodal = true) {
    cholmod_l_start(&common_);
    common_.print = 0;     // the library never prints
    common_.final_ll = 1;  // LL^T, never LDL^T: a non-positive pivot is an error
    common_.quick_return_if_not_posdef = 1;
    common_.supernodal = supernodal && AHM_SUPERNODAL ? CHOLMOD_SUPERNODAL : CHOLMOD_SIMPLICIAL;
  }
  ~Common() { cholmod_l_finish(&common_); }
  Common(const Common&) = delete;
  Common& operator=(const Common&) = delete;

  cholmod_common* get() { return &common_; }

  /// @throws for CHOLMOD's error codes; the positive warnings are left to the caller.
  void check(const char* what) const {
    if (common_.status == CHOLMOD_OUT_OF_MEMORY)
      throw ResourceExhausted(std::string(what) + ": out of memory in the sparse factorization");
    if (common_.status == CHOLMOD_TOO_LARGE)
      throw ResourceExhausted(std::string(what) + ": the factor is too large for its index type");
    if (common_.status < 0)
      throw Error(std::string(what) + ": CHOLMOD failed with status " + std::to_string(common_.status));
  }

  /// What CHOLMOD allocated. A failure may be forgotten: each allocation that succeeds resets the status.
  template <class Object>
  Object* check(Object* object, const char* what) const {
    check(what);
    if (object == nullptr) throw ResourceExhausted(std::string(what) + ": out of memory in the sparse factorization");
    return object;
  }

 private:
  cholmod_common common_;
};

/// Frees a factor with a workspace of its own, so that it can outlive the one that made it.
struct FreeFactor {
  void operator()(cholmod_factor* L) const {
    Common common;
    cholmod_l_free_factor(&L, common.get());
  }
};
using FactorPointer = std::unique_ptr<cholmod_factor, FreeFactor>;

/// A dense matrix of CHOLMOD's, or none yet.
class Dense {
 public:
  explicit Dense(Common& common) : common_(common) {}
  Dense(Common& common, std::size_t rows, std::size_t columns, int xtype, const char* what)
      : common_(common),
        matrix_(common.check(cholmod_l_allocate_dense(rows, columns, rows, xtype, common.get()), what)) {}
  ~Dense() { cholmod_l_free_dense(&matrix_, common_.get()); }
  Dense(const Dense&) = delete;
  Dense& operator=(const Dense&) = delete;

  cholmod_dense** handle() { return &matrix_; }

 private:
  Common& common_;
  cholmod_dense* matrix_ = nullptr;
};

/// A view of the matrix in CHOLMOD's terms; nothing is copied.
cholmod_sparse view(const SparseUpper& matrix, bool with_values) {
  cholmod_sparse view{};
  view.nrow = view.ncol = static_cast<std::size_t>(matrix.size());
  view.nzmax = matrix.rows.size();
  view.p = const_cast<Offset*>(matrix.column_begin.data());
  view.i = const_cast<Offset*>(matrix.rows.data());
  view.x = with_values ? const_cast<double*>(matrix.values.data()) : nullptr;
  view.stype = 1;
  view.itype = CHOLMOD_LONG;
  view.xtype = !with_values ? CHOLMOD_PATTERN : matrix.is_complex ? CHOLMOD_COMPLEX : CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  view.sorted = view.packed = 1;
  return view;
}

cholmod_dense dense_view(std::span<double> X, Offset rows, Offset columns, bool is_complex) {
  cholmod_dense view{};
  view.nrow = view.d = static_cast<std::size_t>(rows);
  view.ncol = static_cast<std::size_t>(columns);
  view.nzmax = view.nrow * view.ncol;
  view.x = X.data();
  view.xtype = is_complex ? CHOLMOD_COMPLEX : CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  return view;
}

SupernodalFactor supernodal_view(const cholmod_factor& L) {
  auto array = [](void* data, std::size_t size) { return std::span(static_cast<const std::int64_t*>(data), size); };
  return {static_cast<Offset>(L.n),  L.xtype == CHOLMOD_COMPLEX, array(L.Perm, L.n),  array(L.super, L.nsuper + 1),
          array(L.pi, L.nsuper + 1), array(L.px, L.nsuper + 1),  array(L.s, L.ssize), static_cast<const double*>(L.x)};
}

/// Smallest and largest real diagonal entry of L; NaN where one is not finite.
std::pair<double, double> pivot_range(const cholmod_factor& L) {
  const std::size_t width = L.xtype == CHOLMOD_COMPLEX ? 2 : 1;
  const auto* x = static_cast<const double*>(L.x);
  double low = INFINITY, high = 0;
  auto visit = [&](std::size_t position) {
    const double pivot = x[position * width];
    if (!std::isfinite(pivot)) low = high = NAN;
    if (pivot < low) low = pivot;
    if (pivot > high) high = pivot;
  };
  if (L.is_super) {
    const auto *super = static_cast<const Offset*>(L.super), *pi = static_cast<const Offset*>(L.pi),
               *px = static_cast<const Offset*>(L.px);
    for (std::size_t s = 0; s < L.nsuper; ++s)
      for (Offset k = 0, rows = pi[s + 1] - pi[s]; k < super[s + 1] - super[s]; ++k)
        visit(static_cast<std::size_t>(px[s] + k * (rows + 1)));
  } else {
    const auto* p = static_cast<const Offset*>(L.p);
    for (std::size_t j = 0; j < L.n; ++j) visit(static_cast<std::size_t>(p[j]));
  }
  return {low, high};
}

/// y += K x for the full matrix whose upper triangle is given, real (W = 1) or complex (W = 2).
template <int W>
void add_product(const SparseUpper& K, const double* x, double* y) {
  const auto add = [](const double* a, double sign, const double* from, double* to) {
    to[0] += a[0] * from[0];
    if constexpr (W == 2) {
      const double imaginary = sign * a[1];
      to[0] -= imaginary * from[1];
      to[1] += a[0] * from[1] + imaginary * from[0];
    }
  };
  for (Offset j = 0; j < K.size(); ++j)
    for (Offset p = K.column_begin[j]; p < K.column_begin[j + 1]; ++p) {
      const Offset i = K.rows[p];
      const double* a = K.values.data() + p * W;
      add(a, 1, x + j * W, y + i * W);
      if (i != j) add(a, -1, x + i * W, y + j * W);
    }
}

/// K x
std::vector<double> multiply(const SparseUpper& K, const std::vector<double>& x) {
  std::vector<double> y(x.size(), 0.0);
  (K.is_complex ? add_product<2> : add_product<1>)(K, x.data(), y.data());
  return y;
}

double largest(const std::vector<double>& v) {
  double m = 0;
  for (double x : v) m = std::isnan(x) ? INFINITY : std::max(m, std::abs(x));
  return m;
}

}  // namespace

constexpr const char* solving = "triangular solve";

struct SymbolicCholesky::Impl {
  FactorPointer L;
  bool supernodal;
  std::optional<FactorPattern> pattern;  ///< of supernodes
  Offset nonzeros = 0;
  double operations = 0;

  void finish(const SparseUpper& matrix, const cholmod_common& common) {
    nonzeros = static_cast<Offset>(L->is_super ? static_cast<double>(L->xsize) : common.lnz);
    operations = common.fl;
    if (!L->is_super) return;
    const SupernodalFactor view = supernodal_view(*L);
    SupernodeTree tree = supernode_tree(view);
    std::shared_ptr<const SolveGroups> groups = solve_groups(view, tree);
    pattern.emplace(FactorPattern{FactorEntries(matrix, view), std::move(tree), std::move(groups)});
  }
};

SymbolicCholesky::SymbolicCholesky(const SparseUpper& pattern, Ordering ordering, bool supernodal)
    : impl_(std::make_unique<Impl>()) {
  Common common(supernodal);
  common.get()->nmethods = 1;
  common.get()->method[0].ordering = ordering == Ordering::amd ? CHOLMOD_AMD : CHOLMOD_METIS;
  common.get()->postorder = 1;
  cholmod_sparse matrix = view(pattern, false);
  impl_->supernodal = supernodal;
  impl_->L.reset(common.check(cholmod_l_analyze(&matrix, common.get()), "symbolic analysis"));
  impl_->finish(pattern, *common.get());
}

SymbolicCholesky::SymbolicCholesky(const SparseUpper& blocks, const SymbolicCholesky& scalar, int width)
    : impl_(std::make_unique<Impl>()) {
  const cholmod_factor& base = *scalar.impl_->L;
  const auto* perm = static_cast<const Offset*>(base.Perm);
  std::vector<Offset> order;
  order.reserve(base.n * static_cast<std::size_t>(width));
  for (std::size_t k = 0; k < base.n; ++k)
    for (int a = 0; a < width; ++a) order.push_back(perm[k] * width + a);
  impl_->supernodal = scalar.impl_->supernodal;
  Common common(impl_->supernodal);
  common.get()->nmethods = 1;
  common.get()->method[0].ordering = CHOLMOD_GIVEN;
  common.get()->postorder = 0;  // the scalar ordering is postordered already
  cholmod_sparse matrix = view(blocks, false);
  impl_->L.reset(
      common.check(cholmod_l_analyze_p(&matrix, order.data(), nullptr, 0, common.get()), "symbolic analysis"));
  impl_->finish(blocks, *common.get());
}

SymbolicCholesky::~SymbolicCholesky() = default;
SymbolicCholesky::SymbolicCholesky(SymbolicCholesky&&) noexcept = default;

Offset SymbolicCholesky::nonzeros() const noexcept { return impl_->nonzeros; }
double SymbolicCholesky::operations() const noexcept { return impl_->operations; }

struct CholeskyFactor::Impl {
  FactorPointer L;
  std::shared_ptr<const SolveGroups> groups;  ///< of all factors of that pattern
  Offset rows;
  bool is_complex;

  /// CHOLMOD makes room for the numbers.
  void factor_supernodal(const SparseUpper& matrix, const FactorPattern& pattern, Common& common, const char* name,
                         unsigned threads) {
    groups = pattern.groups;
    cholmod_l_change_factor(is_complex ? CHOLMOD_COMPLEX : CHOLMOD_REAL, 1, 1, 1, 1, L.get(), common.get());
    common.check(name);
    check_pivots(factor_by_fronts(matrix, pattern, supernodal_view(*L), static_cast<double*>(L->x), threads), name);
  }

  void factor_simplicial(const SparseUpper& matrix, Common& common, const char* name) {
    cholmod_sparse K = view(matrix, true);
    cholmod_l_factorize(&K, L.get(), common.get());
    common.check(name);
    check_pivots(static_cast<Offset>(L->minor), name);
  }

  /// @param good  columns that could be eliminated
  void check_pivots(Offset good, const char* name) const {
    if (good == rows)
      if (const auto [low, high] = pivot_range(*L); low > 0 && std::isfinite(high)) return;
    throw NotPositiveDefinite("not_positive_definite",
                              std::string("operator ") + name + " is not positive definite (column " +
                                  std::to_string(good) + " of " + std::to_string(rows) + " in elimination order)",
                              "check the graph's weights: negative ones can cause this, and points nearly on top of "
                              "each other");
  }

  void solve(cholmod_dense& X, Dense& solution, Dense& Y, Dense& E, Common& common) const {
    const int done = cholmod_l_solve2(CHOLMOD_A, L.get(), &X, nullptr, solution.handle(), nullptr, Y.handle(),
                                      E.handle(), common.get());
    const cholmod_dense& result = *common.check(*solution.handle(), solving);
    if (!done) throw Error(std::string(solving) + ": CHOLMOD failed");
    std::memcpy(X.x, result.x, X.nzmax * (is_complex ? 2 : 1) * sizeof(double));
  }

  void solve_simplicial(cholmod_dense& X, Common& common) const {
    Dense solution(common), Y(common), E(common);
    solve(X, solution, Y, E, common);
  }

  /// With all workspace made beforehand: CHOLMOD's own code for it uses what it could not allocate.
  void solve_supernodal(cholmod_dense& X, Common& common) const {
    Dense solution(common, X.nrow, X.ncol, X.xtype, solving), Y(common, X.nrow, X.ncol, X.xtype, solving),
        E(common, X.ncol, L->maxesize, X.xtype, solving);
    const BlasBuffer buffer;
    solve(X, solution, Y, E, common);
  }

  /// CHOLMOD reports success on some broken factorizations, so one solve with a known right-hand side is checked.
  void check_residual(const CholeskyFactor& self, const SparseUpper& matrix, const char* name) const {
    std::vector<double> x(static_cast<std::size_t>(rows) * (is_complex ? 2 : 1));
    std::uint32_t state = 12345;
    for (double& value : x) value = ((state = state * 1664525u + 1013904223u) >> 8) * 0x1p-23 - 1.0;
    const std::vector<double> b = multiply(matrix, x);
    const double scale = largest(matrix.values) * largest(x) + largest(b);
    x = b;
    self.solve(x, 1);
    std::vector<double> residual = multiply(matrix, x);
    for (std::size_t i = 0; i < b.size(); ++i) residual[i] -= b[i];
    if (!(largest(residual) <= 1e-10 * scale))
      throw NotPositiveDefinite("ill_conditioned",
                                std::string("operator ") + name + ": the factorization fails its residual check (" +
                                    detail::number(largest(residual) / scale) + " relative)",
                                "the graph is too ill-conditioned");
  }
};

CholeskyFactor::CholeskyFactor(const SparseUpper& matrix, const SymbolicCholesky& symbolic, const char* name,
                               unsigned threads)
    : impl_(std::make_unique<Impl>()) {
  OneBlasThread one_thread;
  Common common(symbolic.impl_->supernodal);
  impl_->rows = matrix.size();
  impl_->is_complex = matrix.is_complex;
  impl_->L.reset(common.check(cholmod_l_copy_factor(symbolic.impl_->L.get(), common.get()), name));
  impl_->L->is_super ? impl_->factor_supernodal(matrix, *symbolic.impl_->pattern, common, name, threads)
                     : impl_->factor_simplicial(matrix, common, name);
  impl_->check_residual(*this, matrix, name);
}

CholeskyFactor::~CholeskyFactor() = default;
CholeskyFactor::CholeskyFactor(CholeskyFactor&&) noexcept = default;

void CholeskyFactor::solve(std::span<double> X, Offset columns, unsigned threads) const {
  if (impl_->L->is_super && columns <= max_narrow_columns)
    return narrow_solve(supernodal_view(*impl_->L), X, columns, impl_->groups.get(), threads);
  if (impl_->L->is_super && nonzeros() <= most_block_numbers)
    return block_solve(supernodal_view(*impl_->L), X, columns);
  OneBlasThread one_thread;
  Common common;
  cholmod_dense B = dense_view(X, impl_->rows, columns, impl_->is_complex);
  impl_->L->is_super ? impl_->solve_supernodal(B, common) : impl_->solve_simplicial(B, common);
}

Offset CholeskyFactor::nonzeros() const noexcept {
  const cholmod_factor& L = *impl_->L;
  return static_cast<Offset>(L.is_super ? L.xsize : L.nzmax);
}

std::size_t CholeskyFactor::bytes() const noexcept {
  const cholmod_factor& L = *impl_->L;
  const std::size_t indices = L.is_super ? L.ssize + 3 * L.nsuper : L.nzmax + 4 * L.n;
  return static_cast<std::size_t>(nonzeros()) * (impl_->is_complex ? 16 : 8) + (indices + 2 * L.n) * sizeof(Offset) +
         (impl_->groups ? impl_->groups->bytes() : 0);
}

LinearAlgebraInfo linear_algebra_info() {
  int version[3];
  cholmod_l_version(version);
  const std::string blas = blas_name();
  return {std::to_string(version[0]) + "." + std::to_string(version[1]) + "." + std::to_string(version[2]), blas,
          blas_is_optimized(blas)};
}

}  // namespace ahm
