#include "ahm-mpi/petsc_system.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace ahm::tiles::mpi {
namespace {

/// Target residual as a share of the requested accuracy, and its lower limit, below which rounding dominates.
constexpr double residual_share = 1e-6;
constexpr double least_residual = 1e-16;

/// Rows of a matrix of square blocks. Columns are numbered over all ranks and ascend.
struct BlockRows {
  PetscInt width = 1;
  std::vector<PetscInt> begin{0}, columns;
  std::vector<PetscScalar> values;

  /// Adds a multiple of a block to an entry of the current row. Columns must not descend from call to call.
  void add(PetscInt column, double factor, std::span<const double> block) {
    if (static_cast<PetscInt>(columns.size()) == begin.back() || columns.back() != column) {
      columns.push_back(column);
      values.insert(values.end(), block.size(), 0.0);
    }
    PetscScalar* entry = values.data() + (values.size() - block.size());
    for (std::size_t k = 0; k < block.size(); ++k) entry[k] += factor * block[k];
  }
  void end_row() { begin.push_back(static_cast<PetscInt>(columns.size())); }
};

/// One operator: its matrix and its Krylov solver.
class Operator {
 public:
  Operator(MPI_Comm ranks, const BlockRows& rows, std::span<const PetscInt> halo, const char* name, double accuracy,
           Traffic& traffic)
      : ranks_(ranks),
        name_(name),
        width_(rows.width),
        own_(static_cast<PetscInt>(rows.begin.size()) - 1),
        halo_(static_cast<PetscInt>(halo.size())),
        traffic_(traffic) {
    const PetscInt own = width_ * own_;
    check(MatCreate(ranks, matrix_.out()));
    check(MatSetSizes(matrix_.get(), own, own, PETSC_DETERMINE, PETSC_DETERMINE));
    check(MatSetType(matrix_.get(), width_ == 1 ? MATAIJ : MATBAIJ));
    check(MatSetBlockSize(matrix_.get(), width_));
    // Of each pair of calls, only the one for the type of the matrix (sequential or parallel) has an effect.
    if (width_ == 1) {
      check(MatSeqAIJSetPreallocationCSR(matrix_.get(), rows.begin.data(), rows.columns.data(), rows.values.data()));
      check(MatMPIAIJSetPreallocationCSR(matrix_.get(), rows.begin.data(), rows.columns.data(), rows.values.data()));
    } else {
      check(MatSeqBAIJSetPreallocationCSR(matrix_.get(), width_, rows.begin.data(), rows.columns.data(),
                                          rows.values.data()));
      check(MatMPIBAIJSetPreallocationCSR(matrix_.get(), width_, rows.begin.data(), rows.columns.data(),
                                          rows.values.data()));
    }
    check(MatSetOption(matrix_.get(), MAT_SYMMETRIC, PETSC_TRUE));
    check(VecCreateGhostBlock(ranks, width_, own, PETSC_DETERMINE, halo_, halo.data(), solution_.out()));
    check(MatCreateVecs(matrix_.get(), nullptr, right_side_.out()));
    check(KSPCreate(ranks, solver_.out()));
    check(KSPSetOperators(solver_.get(), matrix_.get(), matrix_.get()));
    check(KSPSetType(solver_.get(), KSPCG));
    check(KSPSetTolerances(solver_.get(), residual_for(accuracy), PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT));
    check(KSPSetFromOptions(solver_.get()));
  }

  /// Solves in place. On return, x has the solution at own vertices, then at the halo.
  void solve(std::span<double> x) const {
    const double unit = unit_of(x.first(static_cast<std::size_t>(width_) * static_cast<std::size_t>(own_)));
    if (unit == 0) return std::fill(x.begin(), x.end(), 0.0);
    PetscScalar* entries = nullptr;
    check(VecGetArrayWrite(right_side_.get(), &entries));
    for (PetscInt k = 0; k < width_ * own_; ++k) entries[k] = x[static_cast<std::size_t>(k)] / unit;
    check(VecRestoreArrayWrite(right_side_.get(), &entries));
    check(KSPSolve(solver_.get(), right_side_.get(), solution_.get()));
    check_convergence();
    check(VecGhostUpdateBegin(solution_.get(), INSERT_VALUES, SCATTER_FORWARD));
    check(VecGhostUpdateEnd(solution_.get(), INSERT_VALUES, SCATTER_FORWARD));
    Vec all = nullptr;
    const PetscScalar* found = nullptr;
    check(VecGhostGetLocalForm(solution_.get(), &all));
    check(VecGetArrayRead(all, &found));
    for (std::size_t k = 0; k < x.size(); ++k) x[k] = found[k] * unit;
    check(VecRestoreArrayRead(all, &found));
    check(VecGhostRestoreLocalForm(solution_.get(), &all));
  }

 private:
  /// The largest power of two below the largest absolute value of all ranks. Dividing by it avoids overflow of squares.
  double unit_of(std::span<const double> x) const {
    double own = 0, largest = 0;
    for (double value : x) own = std::max(own, std::abs(value));
    MPI_Allreduce(&own, &largest, 1, MPI_DOUBLE, MPI_MAX, ranks_);
    ++traffic_.reductions;
    return largest == 0 ? 0 : std::ldexp(1.0, std::ilogb(largest));
  }
  void check_convergence() const {
    KSPConvergedReason reason{};
    PetscInt iterations = 0;
    check(KSPGetConvergedReason(solver_.get(), &reason));
    check(KSPGetIterationNumber(solver_.get(), &iterations));
    if (reason < 0)
      throw NotPositiveDefinite(std::string("operator ") + name_ + ": PETSc's solver stopped after " +
                                std::to_string(iterations) + " iterations with " + KSPConvergedReasons[reason] +
                                "; use a smaller t_coef, or other options of PETSc");
    ++traffic_.solves;
    traffic_.iterations += iterations;
    traffic_.reductions += 3 * std::int64_t{iterations};
    traffic_.solve_messages += (std::int64_t{iterations} + 1) * traffic_.neighbors;
    traffic_.solve_bytes += (std::int64_t{iterations} + 1) * width_ * halo_ * std::int64_t{sizeof(PetscScalar)};
  }

  MPI_Comm ranks_;
  const char* name_;
  PetscInt width_, own_, halo_;
  Traffic& traffic_;
  Matrix matrix_;
  Vector solution_, right_side_;
  Krylov solver_;
};

class PetscSystem final : public HeatSystem {
 public:
  PetscSystem(MPI_Comm ranks, BandPart part, double scaling, const HeatOptions& options, Traffic& traffic)
      : HeatSystem(std::move(part.tau), scaling),
        d_(static_cast<std::size_t>(part.graph.dimension())),
        n_(static_cast<std::size_t>(part.graph.size())),
        identity_(d_ * d_, 0.0),
        block_(d_ * d_) {
    for (std::size_t a = 0; a < d_; ++a) identity_[a * (d_ + 1)] = 1;
    const auto own = static_cast<Index>(n_ - part.halo.size());
    std::int64_t mine = own, last = 0;
    MPI_Scan(&mine, &last, 1, MPI_INT64_T, MPI_SUM, ranks);
    first_row_ = static_cast<PetscInt>(last - mine);
    for (const HaloVertex& next : part.halo) halo_rows_.push_back(static_cast<PetscInt>(next.row));
    BlockRows A, B;
    B.width = static_cast<PetscInt>(d_);
    for (Index i = 0; i < own; ++i) add_rows(part.graph, own, i, A, B);
    A_ = std::make_unique<Operator>(ranks, A, halo_rows_, "A", options.accuracy, traffic);
    B_ = std::make_unique<Operator>(ranks, B, halo_rows_, "B", options.accuracy, traffic);
  }

  void solve_A(std::span<double> X, Offset columns, unsigned) const override { solve(*A_, X, columns, n_); }
  void solve_B(std::span<double> X, Offset columns, unsigned) const override { solve(*B_, X, columns, n_ * d_); }

 private:
  static void solve(const Operator& with, std::span<double> X, Offset columns, std::size_t rows) {
    for (Offset c = 0; c < columns; ++c) with.solve(X.subspan(static_cast<std::size_t>(c) * rows, rows));
  }
  PetscInt row_of(Index place, Index own) const {
    return place < own ? first_row_ + place : halo_rows_[static_cast<std::size_t>(place - own)];
  }
  /// Row i of A has the entries c (m_i + tau sum w_ij) and -c tau w_ij, with c = `scaling_`. The blocks of B are these times I and R_ji.
  void add_rows(const CsrGraph& graph, Index own, Index i, BlockRows& A, BlockRows& B) {
    constexpr std::size_t diagonal_entry = std::numeric_limits<std::size_t>::max();
    const Star star = graph.star(i);
    const double tau = tau_[static_cast<std::size_t>(i)];
    double diagonal = graph.mass(i);
    order_.assign(1, {row_of(i, own), diagonal_entry});
    for (std::size_t e = 0; e < star.degree(); ++e) {
      diagonal += tau * star.weights[e];
      if (star.weights[e] != 0) order_.emplace_back(row_of(star.neighbors[e], own), e);
    }
    std::sort(order_.begin(), order_.end());
    const double one[] = {1.0};
    for (const auto& [column, e] : order_) {
      const bool on_diagonal = e == diagonal_entry;
      const double factor = scaling_ * (on_diagonal ? diagonal : -tau * star.weights[e]);
      if (!on_diagonal) star.transport(e).matrix(block_.data());
      A.add(column, factor, one);
      B.add(column, factor, on_diagonal ? identity_ : block_);
    }
    A.end_row();
    B.end_row();
  }

  std::size_t d_, n_;
  std::vector<double> identity_, block_;
  std::vector<std::pair<PetscInt, std::size_t>> order_;  ///< column and edge of each entry of a row
  PetscInt first_row_ = 0;
  std::vector<PetscInt> halo_rows_;
  std::unique_ptr<Operator> A_, B_;
};

}  // namespace

double residual_for(double accuracy) { return std::max(least_residual, residual_share * accuracy); }

std::unique_ptr<const HeatSystem> petsc_system(MPI_Comm ranks, BandPart part, const HeatOptions& options,
                                               Traffic& traffic) {
  const auto own = static_cast<Index>(static_cast<std::size_t>(part.graph.size()) - part.halo.size());
  double mine[2] = {0, static_cast<double>(own)}, all[2] = {};
  for (Index i = 0; i < own; ++i) mine[0] += part.graph.mass(i);
  MPI_Allreduce(mine, all, 2, MPI_DOUBLE, MPI_SUM, ranks);
  const CsrGraph& graph = part.graph;
  auto system = std::make_unique<PetscSystem>(ranks, std::move(part), mass_scaling(all[0] / all[1]), options, traffic);
  double lost = conservation_residual(*system, graph, own);
  MPI_Allreduce(MPI_IN_PLACE, &lost, 1, MPI_DOUBLE, MPI_MAX, ranks);
  traffic.reductions += 2;
  check_conservation(lost);
  return system;
}

}  // namespace ahm::tiles::mpi
