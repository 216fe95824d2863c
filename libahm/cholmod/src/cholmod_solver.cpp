#include "ahm/cholmod/cholmod_solver.hpp"

#include "ahm/error.hpp"

#ifdef AHM_WITH_CHOLMOD
#include <cholmod.h>
#include <dlfcn.h>

#include <algorithm>
#include <mutex>
#include <string>
#include <utility>
#endif

namespace ahm {

#ifdef AHM_WITH_CHOLMOD
namespace {

static_assert(sizeof(Offset) == sizeof(SuiteSparse_long), "CHOLMOD's long indices are passed without a copy");

/// Sets OpenBLAS, if it is the BLAS, to one thread while an object of this class exists. Results then do not depend on the number of threads.
/// The last destructor restores the setting of the process.
class OneBlasThread {
 public:
  OneBlasThread() {
    const std::scoped_lock lock(mutex_);
    if (users_++ > 0 || !get_ || !set_) return;
    threads_before_ = get_();
    if (threads_before_ != 1) set_(1);
  }
  ~OneBlasThread() {
    const std::scoped_lock lock(mutex_);
    if (--users_ == 0 && set_ && threads_before_ > 1) set_(threads_before_);
  }
  OneBlasThread(const OneBlasThread&) = delete;
  OneBlasThread& operator=(const OneBlasThread&) = delete;

 private:
  // The BLAS is selected when the process starts, so functions that only OpenBLAS has are found by name.
  static inline int (*const get_)() = reinterpret_cast<int (*)()>(dlsym(RTLD_DEFAULT, "openblas_get_num_threads"));
  static inline void (*const set_)(int) = reinterpret_cast<void (*)(int)>(dlsym(RTLD_DEFAULT,
                                                                                "openblas_set_num_threads"));
  static inline std::mutex mutex_;
  static inline int users_ = 0, threads_before_ = 0;
};

/// The parameters, status and workspace of CHOLMOD, for one thread.
class Common {
 public:
  Common() {
    cholmod_l_start(&common_);
    common_.print = 0;
    common_.final_ll = 1;  // LL^T; CHOLMOD's LDL^T of an indefinite matrix is no error
  }
  ~Common() { cholmod_l_finish(&common_); }
  Common(const Common&) = delete;
  Common& operator=(const Common&) = delete;

  cholmod_common* get() { return &common_; }
  cholmod_common* operator->() { return &common_; }

  /// @throws ResourceExhausted; Error (any other failure of CHOLMOD)
  void check(const char* name) const {
    if (common_.status >= CHOLMOD_OK) return;
    const std::string operation = std::string("operator ") + name + ": CHOLMOD ";
    if (common_.status == CHOLMOD_OUT_OF_MEMORY) throw ResourceExhausted(operation + "is out of memory");
    if (common_.status == CHOLMOD_TOO_LARGE) throw ResourceExhausted(operation + "has too small an index type");
    throw Error(operation + "fails with status " + std::to_string(common_.status));
  }

 private:
  cholmod_common common_{};
};

struct FreeFactor {
  void operator()(cholmod_factor* factor) const {
    Common common;
    cholmod_l_free_factor(&factor, common.get());
  }
};

struct FreeDense {
  void operator()(cholmod_dense* matrix) const {
    Common common;
    cholmod_l_free_dense(&matrix, common.get());
  }
};

/// The matrix for CHOLMOD, which only reads it. It must not outlive `K`.
cholmod_sparse view(const SparseUpper& K) {
  cholmod_sparse result{};
  result.nrow = result.ncol = static_cast<std::size_t>(K.size());
  result.nzmax = K.rows.size();
  result.p = const_cast<Offset*>(K.column_begin.data());
  result.i = const_cast<Offset*>(K.rows.data());
  result.x = const_cast<double*>(K.values.data());
  result.stype = 1;  // the upper triangle
  result.itype = CHOLMOD_LONG;
  result.xtype = K.is_complex ? CHOLMOD_COMPLEX : CHOLMOD_REAL;
  result.dtype = CHOLMOD_DOUBLE;
  result.sorted = result.packed = 1;
  return result;
}

class CholmodSolver final : public LinearSolver {
 public:
  CholmodSolver(const SparseUpper& matrix, const char* name, CholmodFactorization factorization)
      : name_(name), xtype_(matrix.is_complex ? CHOLMOD_COMPLEX : CHOLMOD_REAL) {
    const OneBlasThread one_thread;
    Common common;
    if (factorization == CholmodFactorization::simplicial) common->supernodal = CHOLMOD_SIMPLICIAL;
    cholmod_sparse K = view(matrix);
    factor_.reset(cholmod_l_analyze(&K, common.get()));
    common.check(name);
    cholmod_l_factorize(&K, factor_.get(), common.get());
    common.check(name);
    if (factor_->minor < factor_->n)
      throw not_positive_definite(name, static_cast<Offset>(factor_->minor), static_cast<Offset>(factor_->n));
    cholmod_l_free_work(common.get());
    bytes_ = common->memory_inuse;  // without the workspace only the factor is left
  }

  void solve(std::span<double> X, Offset columns, unsigned) const override {
    const OneBlasThread one_thread;
    Common common;
    cholmod_dense B{};
    B.nrow = B.d = factor_->n;
    B.ncol = static_cast<std::size_t>(columns);
    B.nzmax = B.nrow * B.ncol;
    B.x = X.data();
    B.xtype = xtype_;
    B.dtype = CHOLMOD_DOUBLE;
    // The factor is only an input of cholmod_solve (cholmod_cholesky.h), so threads may share it.
    const std::unique_ptr<cholmod_dense, FreeDense> result(cholmod_l_solve(CHOLMOD_A, factor_.get(), &B, common.get()));
    common.check(name_.c_str());
    std::copy_n(static_cast<const double*>(result->x), X.size(), X.data());
  }

  Offset nonzeros() const noexcept override {
    return static_cast<Offset>(factor_->is_super != 0 ? factor_->xsize : factor_->nzmax);
  }
  std::size_t bytes() const noexcept override { return bytes_; }

 private:
  std::string name_;
  int xtype_;
  std::unique_ptr<cholmod_factor, FreeFactor> factor_;
  std::size_t bytes_ = 0;
};

}  // namespace

SolverFactory cholmod_solver(CholmodFactorization factorization) {
  return [factorization](const SparseUpper& matrix, const char* name, unsigned) {
    return std::make_unique<const CholmodSolver>(matrix, name, factorization);
  };
}

#else

SolverFactory cholmod_solver(CholmodFactorization) {
  throw InvalidArgument("no_cholmod", "this build has no CHOLMOD (AHM_WITH_CHOLMOD=OFF)",
                        "use libahm's own factors: leave out cholmod_solver");
}

#endif

}  // namespace ahm
