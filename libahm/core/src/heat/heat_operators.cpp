#include "ahm/heat/heat_operators.hpp"

#include <cmath>
#include <new>
#include <optional>
#include <string>
#include <variant>

#include "ahm/error.hpp"
#include "ahm/graph/components.hpp"
#include "ahm/graph/validate.hpp"
#include "ahm/util/memory.hpp"
#include "ahm/util/parallel.hpp"
#include "ahm/util/stopwatch.hpp"
#include "ahm/util/text.hpp"
#include "heat/assemble.hpp"
#include "heat/blas_control.hpp"
#include "heat/check_options.hpp"
#include "heat/cholesky.hpp"
#include "heat/conjugate_gradient.hpp"

namespace ahm {
namespace {

constexpr const char *name_A = "A = M + tau L", *name_B = "B = M + tau L^nabla";

/// The power of two that brings the mean mass to order one. A power of two, so that scaled models give the same bits.
/// @throws InvalidGraph
double scaling_for(const TangentGraph& graph) {
  double mean = 0;
  for (Index i = 0; i < graph.size(); ++i) mean += graph.mass(i) / graph.size();
  if (!(mean > 0) || !std::isfinite(mean))
    throw InvalidGraph("the mean mass is " + detail::number(mean) + "; masses must be finite and > 0");
  return std::ldexp(1.0, -std::ilogb(mean));
}

/// @throws InvalidArgument
double checked_tau(const TangentGraph& graph, double t_coef) {
  const double tau = t_coef * graph.mean_edge_length() * graph.mean_edge_length();
  if (!(t_coef > 0) || !std::isfinite(t_coef))
    throw InvalidArgument("t_coef is " + detail::number(t_coef) + "; it must be finite and > 0 (default 1)");
  if (!(tau >= 1e-290) || !(tau <= 1e290))
    throw InvalidArgument("tau = t_coef h^2 leaves the range of double precision (t_coef " + detail::number(t_coef) +
                          ", mean edge length " + detail::number(graph.mean_edge_length()) +
                          "): give the graph a length_unit near its edge length");
  return tau;
}

}  // namespace

struct HeatOperators::Impl {
  Index n;
  int d;
  TransportKind kind;
  double tau, scaling;
  Components components;
  FactorStatistics statistics;
  std::variant<std::monostate, CholeskyFactor, ConjugateGradient> A, B;

  static void solve(const auto& K, std::span<double> X, Offset columns) {
    if (const auto* factor = std::get_if<CholeskyFactor>(&K)) return factor->solve(X, columns);
    std::get<ConjugateGradient>(K).solve(X, columns);
  }

  /// Constants are in the kernel of L, so A 1 = m: how far A^-1 m is from 1 tells what conditioning leaves of the digits.
  void check_conservation(const TangentGraph& graph) const {
    std::vector<double> x(static_cast<std::size_t>(n));
    for (Index i = 0; i < n; ++i) x[i] = scaling * graph.mass(i);
    solve(A, x, 1);
    double worst = 0;
    for (double value : x) worst = std::isfinite(value) ? std::max(worst, std::abs(value - 1)) : INFINITY;
    if (!(worst <= 1e-9))
      throw NotPositiveDefinite("operator A = M + tau L loses heat (" + detail::number(worst) +
                                " relative): t_coef is too large for this graph, or its weights differ too much");
  }

  void prepare(const TangentGraph& graph, const OperatorOptions& options, bool iterative) {
    detail::Stopwatch stopwatch;
    AssembledOperators matrices = assemble(graph, tau, scaling);
    statistics.assemble_seconds = stopwatch.lap();
    iterative ? precondition(matrices) : factorize(matrices, options);
    check_conservation(graph);
    const auto count = [&](const auto& K) {
      statistics.bytes += K.bytes();
      return K.nonzeros();
    };
    statistics.nonzeros_A = iterative ? count(std::get<ConjugateGradient>(A)) : count(std::get<CholeskyFactor>(A));
    statistics.nonzeros_B = iterative ? count(std::get<ConjugateGradient>(B)) : count(std::get<CholeskyFactor>(B));
  }

  void precondition(const AssembledOperators& matrices) {
    A.emplace<ConjugateGradient>(matrices.A, name_A);
    B.emplace<ConjugateGradient>(matrices.B, name_B);
  }

  void factorize(const AssembledOperators& matrices, const OperatorOptions& options) {
    detail::Stopwatch stopwatch;
    options.progress.step("analyze", 0.0);

    const SymbolicCholesky scalar(matrices.A, options.ordering, options.supernodal);
    std::optional<SymbolicCholesky> blocks;
    if (kind == TransportKind::block) blocks.emplace(matrices.B, scalar, d);
    statistics.analyze_seconds = stopwatch.lap();
    options.progress.step("factor", 0.0);

    detail::run_both(
        options.threads != 1,
        [&] {
          without_openmp_regions([&] { B.emplace<CholeskyFactor>(matrices.B, blocks ? *blocks : scalar, name_B); });
        },
        [&] { without_openmp_regions([&] { A.emplace<CholeskyFactor>(matrices.A, scalar, name_A); }); });
    statistics.factor_seconds = stopwatch.lap();
    options.progress.step("factor", 1.0);
  }
};

double check_operator_options(const TangentGraph& graph, const OperatorOptions& options) {
  if (options.check_graph) {
    options.progress.step("check", 0.0);
    validate(graph);
  }
  return checked_tau(graph, options.t_coef);
}

HeatOperators::HeatOperators(const TangentGraph& graph, const OperatorOptions& options)
    : HeatOperators(graph, options, false) {}

HeatOperators::HeatOperators(const TangentGraph& graph, const OperatorOptions& options, bool iterative) try
    : impl_(std::make_unique<Impl>()) {
  impl_->tau = check_operator_options(graph, options);
  impl_->n = graph.size();
  impl_->d = graph.dimension();
  impl_->kind = graph.transport_kind();
  impl_->scaling = scaling_for(graph);
  options.progress.step("assemble", 0.0);
  impl_->components = connected_components(graph);
  impl_->prepare(graph, options, iterative);
} catch (const std::bad_alloc&) {
  throw ResourceExhausted("out of memory while factoring a graph of " + std::to_string(graph.size()) + " vertices");
}

HeatOperators::~HeatOperators() = default;
HeatOperators::HeatOperators(HeatOperators&&) noexcept = default;
HeatOperators& HeatOperators::operator=(HeatOperators&&) noexcept = default;

Index HeatOperators::size() const noexcept { return impl_->n; }
int HeatOperators::dimension() const noexcept { return impl_->d; }
TransportKind HeatOperators::transport_kind() const noexcept { return impl_->kind; }
double HeatOperators::tau() const noexcept { return impl_->tau; }
double HeatOperators::scaling() const noexcept { return impl_->scaling; }
const FactorStatistics& HeatOperators::statistics() const noexcept { return impl_->statistics; }
std::span<const Index> HeatOperators::components() const noexcept { return impl_->components.of_vertex; }
Index HeatOperators::component_count() const noexcept { return impl_->components.count; }

void HeatOperators::solve_scalar(std::span<double> X, Index columns) const {
  if (columns < 0 || static_cast<Offset>(X.size()) != static_cast<Offset>(impl_->n) * columns)
    throw InvalidArgument("solve_scalar: 'X' has " + std::to_string(X.size()) + " numbers, expected n x columns");
  if (columns > 0) detail::with_memory_check("solving with A", [&] { Impl::solve(impl_->A, X, columns); });
}

void HeatOperators::solve_vector(std::span<double> X, Index columns) const {
  if (columns < 0 || static_cast<Offset>(X.size()) != static_cast<Offset>(impl_->n) * impl_->d * columns)
    throw InvalidArgument("solve_vector: 'X' has " + std::to_string(X.size()) + " numbers, expected n x d x columns");
  if (columns > 0) detail::with_memory_check("solving with B", [&] { Impl::solve(impl_->B, X, columns); });
}

}  // namespace ahm
