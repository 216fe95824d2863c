// The paper's operator as assembled for the tests, libahm/conformance/src/reference_operator.cpp.
#include "ahm/conformance/reference_operator.hpp"

#include <Eigen/Core>

#include "methods/heat_fields.hpp"
#include "methods/method.hpp"

namespace ahm::methods {
namespace {

class ReferenceOperator final : public Baseline {
 public:
  ReferenceOperator(const TangentGraph& graph, Variant variant, double t_coef)
      : graph_(graph), variant_(variant), t_coef_(t_coef) {}

  std::string_view name() const noexcept override {
    return variant_ == Variant::adaptive ? "AHM_a 3n x 3n" : "AHM_l 3n x 3n";
  }

  Result solve(Index source) const override {
    check_source(source, graph_.size());
    Result result{test::reference_log_map(graph_, source, variant_, t_coef_), {}};
    const int d = graph_.dimension();
    for (Index i = 0; i < graph_.size(); ++i)
      result.distance.push_back(
          Eigen::Map<const Eigen::VectorXd>(&result.coordinates[static_cast<std::size_t>(i) * d], d).norm());
    return result;
  }

 private:
  const TangentGraph& graph_;
  Variant variant_;
  double t_coef_;
};

}  // namespace

Method reference_operator(const TangentGraph& graph, Variant variant, double t_coef) {
  return std::make_unique<ReferenceOperator>(graph, variant, t_coef);
}

}  // namespace ahm::methods
