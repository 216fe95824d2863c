// The affine heat method of this library. Its distance is that of the paper: the length of phi.
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/util/small_math.hpp"
#include "methods/heat_fields.hpp"
#include "methods/method.hpp"

namespace ahm::methods {
namespace {

class AffineHeat final : public Baseline {
 public:
  AffineHeat(const TangentGraph& graph, Variant variant, double t_coef)
      : solver_(graph, {.t_coef = t_coef}), variant_(variant) {}

  std::string_view name() const noexcept override { return variant_ == Variant::adaptive ? "AHM_a" : "AHM_l"; }

  Result solve(Index source) const override {
    check_source(source, solver_.graph().size());
    const LogMap map = solver_.solve(Source::at_vertex(Vertex(source)), {.variant = variant_});
    Result result{{map.coordinates().begin(), map.coordinates().end()}, {}};
    for (Index i = 0; i < map.size(); ++i) result.distance.push_back(length(map.coordinates(Vertex(i))));
    return result;
  }

 private:
  LogMapSolver solver_;
  Variant variant_;
};

}  // namespace

Method affine_heat(const TangentGraph& graph, Variant variant, double t_coef) {
  return std::make_unique<AffineHeat>(graph, variant, t_coef);
}

}  // namespace ahm::methods
