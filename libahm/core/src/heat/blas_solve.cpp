#include "heat/blas_solve.hpp"

#include <algorithm>
#include <vector>

#include "heat/blas.hpp"
#include "heat/blas_control.hpp"
#include "heat/permuted_columns.hpp"

namespace ahm {
namespace {

/// Columns at a time: the BLAS gains nothing by more, and they stay in memory that grows with their number.
constexpr Offset at_once = 64;

template <int W>
class BlasSolve {
 public:
  BlasSolve(const SupernodalFactor& L, Offset columns)
      : L_(L),
        x_(L, columns),
        below_(static_cast<std::size_t>(L.most_rows() * columns * W)),
        ld_(static_cast<int>(L.size)) {}

  void solve(std::span<double> X, Offset columns) {
    columns_ = static_cast<int>(columns);
    x_.template permute<true>(X, columns);
    for (Offset s = 0; s < L_.supernodes(); ++s) forward(Supernode<W>(L_, s));
    for (Offset s = L_.supernodes(); s-- > 0;) backward(Supernode<W>(L_, s));
    x_.template permute<false>(X, columns);
  }

 private:
  /// y_own <- L_own^-1 y_own, or by its adjoint
  void divide(const Supernode<W>& s, const char* how) {
    const int own = static_cast<int>(s.columns), rows = static_cast<int>(s.rows);
    (W == 1 ? dtrsm_ : ztrsm_)("L", "L", how, "N", &own, &columns_, one, s.values, &rows, x_.at(0, s.first), &ld_);
  }

  /// Calls visit(number of y, number of below) for each row below.
  template <class Visit>
  void each_below(const Supernode<W>& s, const Visit& visit) {
    const Offset below = s.rows - s.columns;
    for (int c = 0; c < columns_; ++c)
      for (Offset r = 0; r < below; ++r)
        for (int w = 0; w < W; ++w) visit(x_.at(c, s.index[s.columns + r])[w], below_[(c * below + r) * W + w]);
  }

  void forward(const Supernode<W>& s) {
    if (x_.is_zero(s, columns_)) return;
    divide(s, "N");
    const int own = static_cast<int>(s.columns), rows = static_cast<int>(s.rows), below = rows - own;
    if (below == 0) return;
    (W == 1 ? dgemm_ : zgemm_)("N", "N", &below, &columns_, &own, one, s.at(s.columns, 0), &rows, x_.at(0, s.first),
                               &ld_, zero, below_.data(), &below);
    each_below(s, [](double& y, double product) { y -= product; });
  }

  void backward(const Supernode<W>& s) {
    const int own = static_cast<int>(s.columns), rows = static_cast<int>(s.rows), below = rows - own;
    if (below > 0) {
      each_below(s, [](double y, double& gathered) { gathered = y; });
      (W == 1 ? dgemm_ : zgemm_)("C", "N", &own, &columns_, &below, minus, s.at(s.columns, 0), &rows, below_.data(),
                                 &below, one, x_.at(0, s.first), &ld_);
    }
    divide(s, "C");
  }

  static constexpr double one[2] = {1, 0}, minus[2] = {-1, 0}, zero[2] = {0, 0};
  const SupernodalFactor& L_;
  PermutedColumns<W> x_;
  std::vector<double> below_;
  int ld_, columns_ = 0;
};

template <int W>
void by_width(const SupernodalFactor& L, std::span<double> X, Offset columns) {
  BlasSolve<W> solver(L, std::min(columns, at_once));
  const Offset size = L.size * W;
  const BlasBuffer buffer;
  for (Offset c = 0; c < columns; c += at_once) {
    const Offset count = std::min(at_once, columns - c);
    solver.solve(X.subspan(c * size, count * size), count);
  }
}

}  // namespace

void blas_solve(const SupernodalFactor& L, std::span<double> X, Offset columns) {
  (L.is_complex ? by_width<2> : by_width<1>)(L, X, columns);
}

}  // namespace ahm
