#include "ahm/heat/heat_operators.hpp"

#include <string>
#include <utility>

#include "ahm/error.hpp"
#include "ahm/graph/components.hpp"
#include "ahm/util/memory.hpp"
#include "ahm/util/text.hpp"
#include "heat/component_scales.hpp"
#include "heat/heat_system.hpp"

namespace ahm {

struct HeatOperators::Impl {
  Index n;
  int d;
  TransportKind kind;
  Components components;
  std::unique_ptr<const HeatSystem> system;
};

HeatOperators::HeatOperators(const TangentGraph& graph, const FactorOptions& options) {
  detail::with_memory_check("factoring a graph of " + detail::counted(graph.size(), "vertex"), [&] {
    check_diffusion(graph, options);
    ComponentScales scales(graph);
    auto system = factored_system(graph, diffusion_times(scales, options.t_coef), options);
    *this = HeatOperatorsAccess::make(std::move(system), graph, std::move(scales.components));
  });
}

HeatOperators HeatOperatorsAccess::make(std::unique_ptr<const HeatSystem> system, const TangentGraph& graph,
                                        Components components) {
  HeatOperators result;
  result.impl_ = std::make_unique<HeatOperators::Impl>(HeatOperators::Impl{
      graph.size(), graph.dimension(), graph.transport_kind(), std::move(components), std::move(system)});
  return result;
}

HeatOperators::~HeatOperators() = default;
HeatOperators::HeatOperators(HeatOperators&&) noexcept = default;
HeatOperators& HeatOperators::operator=(HeatOperators&&) noexcept = default;

Index HeatOperators::size() const noexcept { return impl_->n; }
int HeatOperators::dimension() const noexcept { return impl_->d; }
TransportKind HeatOperators::transport_kind() const noexcept { return impl_->kind; }
std::span<const double> HeatOperators::tau() const noexcept { return impl_->system->tau(); }
double HeatOperators::scaling() const noexcept { return impl_->system->scaling(); }
const FactorStatistics& HeatOperators::statistics() const noexcept { return impl_->system->statistics(); }
std::span<const Index> HeatOperators::components() const noexcept { return impl_->components.of_vertex; }
Index HeatOperators::component_count() const noexcept { return impl_->components.count; }

void HeatOperators::solve_scalar(std::span<double> X, Index columns, unsigned threads) const {
  if (columns < 0 || static_cast<Offset>(X.size()) != static_cast<Offset>(impl_->n) * columns)
    throw InvalidArgument("solve_scalar: 'X' has " + detail::counted(X.size(), "number") + ", expected n x columns");
  if (columns > 0) detail::with_memory_check("solving with A", [&] { impl_->system->solve_A(X, columns, threads); });
}

void HeatOperators::solve_vector(std::span<double> X, Index columns, unsigned threads) const {
  if (columns < 0 || static_cast<Offset>(X.size()) != static_cast<Offset>(impl_->n) * impl_->d * columns)
    throw InvalidArgument("solve_vector: 'X' has " + detail::counted(X.size(), "number") +
                          ", expected n x d x columns");
  if (columns > 0) detail::with_memory_check("solving with B", [&] { impl_->system->solve_B(X, columns, threads); });
}

}  // namespace ahm
