#include "heat/blas_solve.hpp"

#include <algorithm>
#include <memory>
#include <vector>

#include "heat/blas.hpp"
#include "heat/blas_control.hpp"

namespace ahm {
namespace {

/// Columns at a time: the BLAS gains nothing by more, and they stay in memory that grows with their number.
constexpr Offset at_once = 64;

template <int W>
class BlasSolve {
 public:
  explicit BlasSolve(const SupernodalFactor& L, Offset columns)
      : L_(L),
        x_(std::make_unique_for_overwrite<double[]>(static_cast<std::size_t>(L.size * columns * W))),
        ld_(static_cast<int>(L.size)) {
    Offset longest = 0;
    for (std::size_t s = 0; s + 1 < L.row_begin.size(); ++s)
      longest = std::max(longest, L.row_begin[s + 1] - L.row_begin[s]);
    below_.resize(static_cast<std::size_t>(longest * columns * W));
  }

  void solve(std::span<double> X, Offset columns) {
    columns_ = static_cast<int>(columns);
    permute<true>(X);
    const auto supernodes = static_cast<Offset>(L_.super.size()) - 1;
    for (Offset s = 0; s < supernodes; ++s) forward(Supernode<W>(L_, s));
    for (Offset s = supernodes; s-- > 0;) backward(Supernode<W>(L_, s));
    permute<false>(X);
  }

 private:
  double* at(int column, Offset row) { return x_.get() + (column * L_.size + row) * W; }

  template <bool In>
  void permute(std::span<double> X) {
    for (int c = 0; c < columns_; ++c)
      for (Offset k = 0; k < L_.size; ++k)
        for (int w = 0; w < W; ++w) {
          double& outside = X[(c * L_.size + L_.permutation[k]) * W + w];
          double& inside = at(c, k)[w];
          In ? inside = outside : outside = inside;
        }
  }

  bool is_zero(const Supernode<W>& s) {
    for (int c = 0; c < columns_; ++c)
      if (!std::all_of(at(c, s.first), at(c, s.first + s.columns), [](double value) { return value == 0; }))
        return false;
    return true;
  }

  /// y_own <- L_own^-1 y_own, or by its adjoint
  void divide(const Supernode<W>& s, const char* how) {
    const int own = static_cast<int>(s.columns), rows = static_cast<int>(s.rows);
    (W == 1 ? dtrsm_ : ztrsm_)("L", "L", how, "N", &own, &columns_, one, s.values, &rows, at(0, s.first), &ld_);
  }

  /// Calls visit(number of y, number of below) for each row below.
  template <class Visit>
  void each_below(const Supernode<W>& s, const Visit& visit) {
    const Offset below = s.rows - s.columns;
    for (int c = 0; c < columns_; ++c)
      for (Offset r = 0; r < below; ++r)
        for (int w = 0; w < W; ++w) visit(at(c, s.index[s.columns + r])[w], below_[(c * below + r) * W + w]);
  }

  void forward(const Supernode<W>& s) {
    // A point source is zero almost everywhere, and stays so outside its path to the root of the elimination tree.
    if (is_zero(s)) return;
    divide(s, "N");
    const int own = static_cast<int>(s.columns), rows = static_cast<int>(s.rows), below = rows - own;
    if (below == 0) return;
    (W == 1 ? dgemm_ : zgemm_)("N", "N", &below, &columns_, &own, one, s.at(s.columns, 0), &rows, at(0, s.first), &ld_,
                               zero, below_.data(), &below);
    each_below(s, [](double& y, double product) { y -= product; });
  }

  void backward(const Supernode<W>& s) {
    const int own = static_cast<int>(s.columns), rows = static_cast<int>(s.rows), below = rows - own;
    if (below > 0) {
      each_below(s, [](double y, double& gathered) { gathered = y; });
      (W == 1 ? dgemm_ : zgemm_)("C", "N", &own, &columns_, &below, minus, s.at(s.columns, 0), &rows, below_.data(),
                                 &below, one, at(0, s.first), &ld_);
    }
    divide(s, "C");
  }

  static constexpr double one[2] = {1, 0}, minus[2] = {-1, 0}, zero[2] = {0, 0};
  const SupernodalFactor& L_;
  std::unique_ptr<double[]> x_;
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
