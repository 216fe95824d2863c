#include "heat/heat_system.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>
#include <string>

#include "ahm/cholesky/conjugate_gradient.hpp"
#include "ahm/cholesky/linear_solver.hpp"
#include "ahm/error.hpp"
#include "ahm/graph/validate.hpp"
#include "ahm/util/parallel.hpp"
#include "ahm/util/stopwatch.hpp"
#include "ahm/util/text.hpp"
#include "heat/component_scales.hpp"

namespace ahm {
namespace {

/// Assembles the upper triangles of A, from the scalar Laplacian L, and of B, from the connection Laplacian L^nabla, column by column.
/// No edge leaves the graph, so the boundary conditions are natural (Neumann). Column i has an entry for each edge of star i to a smaller
/// vertex, and the diagonal.
class ColumnWriter {
 public:
  ColumnWriter(const TangentGraph& graph, std::span<const double> tau, double scaling)
      : d_(graph.dimension()),
        layout_(graph.transport_layout()),
        complex_(layout_.kind == TransportKind::rotation2),
        tau_(tau),
        scaling_(scaling) {
    const auto n = static_cast<std::size_t>(graph.size());
    const auto entries = static_cast<std::size_t>(graph.edge_count()) / 2 + n;
    const std::size_t blocks = complex_ ? 1 : static_cast<std::size_t>(d_) * d_;
    B_.is_complex = complex_;
    A_.column_begin.reserve(n + 1);
    B_.column_begin.reserve((complex_ ? n : n * d_) + 1);
    A_.rows.reserve(entries);
    A_.values.reserve(entries);
    B_.rows.reserve(entries * blocks);
    B_.values.reserve(entries * (complex_ ? 2 : blocks));
    A_.column_begin.push_back(0);
    B_.column_begin.push_back(0);
  }

  void add_column(Index i, double mass, const Star& star) {
    gather(i, star);
    double diagonal = mass;
    for (double w : star.weights) diagonal += tau_[i] * w;
    diagonal *= scaling_;
    A_.rows.insert(A_.rows.end(), columns_.begin(), columns_.end());
    A_.values.insert(A_.values.end(), scalar_.begin(), scalar_.end());
    A_.rows.push_back(i);
    A_.values.push_back(diagonal);
    A_.column_begin.push_back(static_cast<Offset>(A_.rows.size()));
    complex_ ? add_complex_column(i, diagonal) : add_block_columns(i, diagonal);
  }

  AssembledOperators take() { return {std::move(A_), std::move(B_)}; }

 private:
  /// Sums parallel edges. Sets columns_ to the neighbors j < i, ascending, scalar_ to the entries A_ji and blocks_ to the entries B_ji.
  void gather(Index i, const Star& star) {
    order_.clear();
    for (std::size_t e = 0; e < star.degree(); ++e)
      if (star.neighbors[e] < i && star.weights[e] != 0) order_.emplace_back(star.neighbors[e], e);
    std::sort(order_.begin(), order_.end());
    columns_.clear();
    scalar_.clear();
    blocks_.clear();
    const std::size_t width = layout_.width();
    for (const auto& [j, e] : order_) {
      if (columns_.empty() || columns_.back() != j) {
        columns_.push_back(j);
        scalar_.push_back(0);
        blocks_.insert(blocks_.end(), width, 0.0);
      }
      const double entry = -scaling_ * tau_[i] * star.weights[e];
      scalar_.back() += entry;
      // B_ji gains -tau w R_ij, the inverse of the star's R_ji.
      star.transport(e).add_inverse(entry, blocks_.data() + blocks_.size() - width);
    }
  }

  void add_complex_column(Index i, double diagonal) {
    B_.rows.insert(B_.rows.end(), columns_.begin(), columns_.end());
    B_.values.insert(B_.values.end(), blocks_.begin(), blocks_.end());
    B_.rows.push_back(i);
    B_.values.insert(B_.values.end(), {diagonal, 0.0});
    B_.column_begin.push_back(static_cast<Offset>(B_.rows.size()));
  }

  void add_block_columns(Index i, double diagonal) {
    for (int b = 0; b < d_; ++b) {
      for (std::size_t k = 0; k < columns_.size(); ++k)
        for (int a = 0; a < d_; ++a) {
          B_.rows.push_back(static_cast<Offset>(columns_[k]) * d_ + a);
          B_.values.push_back(blocks_[(k * d_ + a) * d_ + b]);
        }
      B_.rows.push_back(static_cast<Offset>(i) * d_ + b);
      B_.values.push_back(diagonal);
      B_.column_begin.push_back(static_cast<Offset>(B_.rows.size()));
    }
  }

  int d_;
  TransportLayout layout_;
  bool complex_;  ///< whether B is n x n complex; otherwise it is n d x n d real
  std::span<const double> tau_;
  double scaling_;
  SparseUpper A_, B_;
  std::vector<std::pair<Index, std::size_t>> order_;  ///< (neighbor, edge), sorted
  std::vector<Offset> columns_;
  std::vector<double> scalar_, blocks_;
};

}  // namespace

AssembledOperators assemble(const TangentGraph& graph, std::span<const double> tau, double scaling) {
  ColumnWriter writer(graph, tau, scaling);
  for (Index i = 0; i < graph.size(); ++i) writer.add_column(i, graph.mass(i), graph.star(i));
  return writer.take();
}

namespace {

constexpr const char *name_A = "A = M + tau L", *name_B = "B = M + tau L^nabla";

double mean_mass(const TangentGraph& graph) {
  double mean = 0;
  for (Index i = 0; i < graph.size(); ++i) mean += graph.mass(i) / graph.size();
  return mean;
}

/// Largest relative loss of heat. It acts like masses that are larger by this factor: distances change by half of it, and on flat
/// graphs not at all.
constexpr double max_heat_loss = 1e-6;

/// The symbolic analyses of A and B. A complex B has the pattern of A and shares its analysis.
class Analysis {
 public:
  Analysis(const AssembledOperators& matrices, const FactorOptions& options)
      : scalar_(matrices.A, options.ordering, options.threads) {}

  const SymbolicCholesky& of_A() const { return scalar_; }
  /// @param dimension  dimension of the graph
  const SymbolicCholesky& of_B(const SparseUpper& B, int dimension) {
    if (!B.is_complex && !blocks_) blocks_.emplace(B, scalar_, dimension);
    return blocks_ ? *blocks_ : scalar_;
  }

 private:
  SymbolicCholesky scalar_;
  std::optional<SymbolicCholesky> blocks_;
};

/// The masses times c.
std::vector<double> scaled_masses(const TangentGraph& graph, double scaling) {
  std::vector<double> masses(static_cast<std::size_t>(graph.size()));
  for (Index i = 0; i < graph.size(); ++i) masses[i] = scaling * graph.mass(i);
  return masses;
}

double max_difference_from_one(std::span<const double> values) {
  double worst = 0;
  for (const double x : values) worst = std::isfinite(x) ? std::max(worst, std::abs(x - 1)) : INFINITY;
  return worst;
}

/// Checks the residual and the conservation of heat with one solve.
/// @param masses  masses times c
void check_A(const LinearSolver& A, const SparseUpper& matrix, std::vector<double> masses, unsigned threads) {
  check_conservation(max_difference_from_one(checked_solve(A, matrix, std::move(masses), name_A, threads)));
}

/// A and B with one solver each.
class SolverSystem final : public HeatSystem {
 public:
  SolverSystem(std::vector<double> tau, double scaling) : HeatSystem(std::move(tau), scaling) {}

  void solve_A(std::span<double> X, Offset columns, unsigned threads) const override { A->solve(X, columns, threads); }
  void solve_B(std::span<double> X, Offset columns, unsigned threads) const override { B->solve(X, columns, threads); }

  FactorStatistics& statistics_to_fill() { return statistics_; }
  void finish() {
    statistics_.bytes = A->bytes() + B->bytes();
    statistics_.nonzeros_A = A->nonzeros();
    statistics_.nonzeros_B = B->nonzeros();
  }

  std::unique_ptr<const LinearSolver> A, B;
};

/// Factors A at once, and B on the first solve with it. Keeps the matrices until then.
class DeferredSystem final : public HeatSystem {
 public:
  DeferredSystem(const TangentGraph& graph, std::vector<double> tau, const FactorOptions& options)
      : HeatSystem(std::move(tau), mass_scaling(mean_mass(graph))),
        dimension_(graph.dimension()),
        masses_(scaled_masses(graph, scaling_)),
        matrices_(assemble(graph, tau_, scaling_)),
        analysis_(std::in_place, matrices_, options),
        threads_(options.threads),
        A_(matrices_.A, analysis_->of_A(), name_A, threads_) {}

  void solve_A(std::span<double> X, Offset columns, unsigned threads) const override { A_.solve(X, columns, threads); }
  void solve_B(std::span<double> X, Offset columns, unsigned threads) const override {
    std::call_once(factored_, [&] {
      check();
      B_.emplace(matrices_.B, analysis_->of_B(matrices_.B, dimension_), name_B, threads_);
      check_residual(*B_, matrices_.B, name_B, threads_);
      masses_ = {};
      matrices_ = {};
      analysis_.reset();
    });
    B_->solve(X, columns, threads);
  }
  void check() const override {
    std::call_once(checked_, [&] { check_A(A_, matrices_.A, masses_, threads_); });
  }

 private:
  int dimension_;
  mutable std::once_flag checked_, factored_;
  mutable std::vector<double> masses_;
  mutable AssembledOperators matrices_;
  mutable std::optional<Analysis> analysis_;
  unsigned threads_;
  CholeskyFactor A_;
  mutable std::optional<CholeskyFactor> B_;
};

/// Makes a system without solvers, checks the masses and assembles the matrices.
std::pair<std::unique_ptr<SolverSystem>, AssembledOperators> begin(const TangentGraph& graph, std::vector<double> tau,
                                                                   const FactorOptions& options) {
  auto system = std::make_unique<SolverSystem>(std::move(tau), mass_scaling(mean_mass(graph)));
  options.progress.step("assemble", 0.0);
  detail::Stopwatch stopwatch;
  AssembledOperators matrices = assemble(graph, system->tau(), system->scaling());
  system->statistics_to_fill().assemble_seconds = stopwatch.lap();
  return {std::move(system), std::move(matrices)};
}

/// Calls `options.solver`. @throws InvalidArgument (it returns no solver)
std::unique_ptr<const LinearSolver> made_solver(const FactorOptions& options, const SparseUpper& matrix,
                                                const char* name) {
  std::unique_ptr<const LinearSolver> solver = options.solver(matrix, name, options.threads);
  if (!solver) throw InvalidArgument(std::string("'solver' returned no solver for operator ") + name);
  return solver;
}

/// Makes and checks both solvers by `options.solver`, one after the other.
void make_solvers(SolverSystem& system, const AssembledOperators& matrices, std::vector<double> masses,
                  const FactorOptions& options) {
  system.A = made_solver(options, matrices.A, name_A);
  check_A(*system.A, matrices.A, std::move(masses), options.threads);
  system.B = made_solver(options, matrices.B, name_B);
  check_residual(*system.B, matrices.B, name_B, options.threads);
}

/// Factors both matrices and checks the factors.
void factor(SolverSystem& system, const AssembledOperators& matrices, Analysis& analysis, int dimension,
            std::vector<double> masses, const FactorOptions& options) {
  const SymbolicCholesky& of_B = analysis.of_B(matrices.B, dimension);
  // Large factors: one after the other, each on all threads. Small factors: at the same time, one thread each.
  const bool in_turn = of_B.is_shared();
  const unsigned each = in_turn ? options.threads : 1;
  detail::run_both(
      in_turn ? 1 : options.threads,
      [&] {
        system.A = std::make_unique<CholeskyFactor>(matrices.A, analysis.of_A(), name_A, each);
        check_A(*system.A, matrices.A, std::move(masses), each);
      },
      [&] {
        system.B = std::make_unique<CholeskyFactor>(matrices.B, of_B, name_B, each);
        check_residual(*system.B, matrices.B, name_B, each);
      });
}

}  // namespace

double mass_scaling(double mean_mass) {
  if (!(mean_mass > 0) || !std::isfinite(mean_mass))
    throw InvalidGraph("the mean mass is " + detail::number(mean_mass) + "; masses must be finite and > 0");
  return std::ldexp(1.0, -std::ilogb(mean_mass));
}

double conservation_residual(const HeatSystem& system, const TangentGraph& graph, Index own) {
  std::vector<double> heat = scaled_masses(graph, system.scaling());
  system.solve_A(heat, 1);
  return max_difference_from_one(std::span(heat).first(static_cast<std::size_t>(own)));
}

void check_conservation(double lost) {
  if (!(lost <= max_heat_loss))
    throw NotPositiveDefinite("heat_not_conserved",
                              "the diffusion loses heat (relative loss " + detail::number(lost) +
                                  "): its time is too long, or the sizes of faces and edges differ too much",
                              "use a smaller t_coef");
}

void check_heat_options(const TangentGraph& graph, const HeatOptions& options) {
  if (!(options.accuracy >= 1e-14 && options.accuracy <= 0.1))
    throw InvalidArgument("accuracy is " + detail::number(options.accuracy) + "; it must be in [1e-14, 0.1]");
  if (options.expected_maps < 0)
    throw InvalidArgument("expected_maps is " + std::to_string(options.expected_maps) + "; it must be >= 0 (0: many)");
  if (options.solver && options.strategy == Strategy::march)
    throw InvalidArgument("a march uses libahm's own factors; leave out 'solver', or use strategy 'global'");
  check_diffusion(graph, options.factor());
}

void check_diffusion(const TangentGraph& graph, const FactorOptions& options) {
  if (options.check_graph) {
    options.progress.step("check", 0.0);
    validate(graph, options.threads);
  }
  diffusion_time(options.t_coef, graph.mean_edge_length());
}

std::unique_ptr<const HeatSystem> factored_system(const TangentGraph& graph, std::vector<double> tau,
                                                  const FactorOptions& options) {
  auto [system, matrices] = begin(graph, std::move(tau), options);
  std::vector<double> masses = scaled_masses(graph, system->scaling());
  detail::Stopwatch stopwatch;
  std::optional<Analysis> analysis;
  if (!options.solver) {
    options.progress.step("analyze", 0.0);
    analysis.emplace(matrices, options);
    analysis->of_B(matrices.B, graph.dimension());
    system->statistics_to_fill().analyze_seconds = stopwatch.lap();
  }
  options.progress.step("factor", 0.0);
  if (analysis)
    factor(*system, matrices, *analysis, graph.dimension(), std::move(masses), options);
  else
    make_solvers(*system, matrices, std::move(masses), options);
  system->statistics_to_fill().factor_seconds = stopwatch.lap();
  options.progress.step("factor", 1.0);
  system->finish();
  return std::move(system);
}

std::unique_ptr<const HeatSystem> deferred_system(const TangentGraph& graph, std::vector<double> tau,
                                                  const FactorOptions& options) {
  return std::make_unique<DeferredSystem>(graph, std::move(tau), options);
}

std::unique_ptr<const HeatSystem> iterative_system(const TangentGraph& graph, std::vector<double> tau,
                                                   const FactorOptions& options) {
  auto [system, matrices] = begin(graph, std::move(tau), options);
  system->A = std::make_unique<ConjugateGradient>(matrices.A, name_A);
  system->B = std::make_unique<ConjugateGradient>(matrices.B, name_B);
  check_conservation(conservation_residual(*system, graph, graph.size()));
  system->finish();
  return std::move(system);
}

}  // namespace ahm
