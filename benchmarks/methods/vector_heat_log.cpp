// VHM_log: the direction from two transported fields, a constant and a radial one; the distance as the integral of the
// radial one.
#include <Eigen/Dense>
#include <cmath>

#include "methods/edge_integration.hpp"
#include "methods/heat_fields.hpp"
#include "methods/method.hpp"

namespace ahm::methods {
namespace {

class VectorHeatLog final : public Baseline {
 public:
  VectorHeatLog(const TangentGraph& graph, const VectorHeatOptions& options)
      : graph_(graph), options_(options), heat_(graph, {.t_coef = options.t_coef}), integration_(graph) {}

  std::string_view name() const noexcept override { return "VHM_log"; }
  Result solve(Index source) const override;

 private:
  /// Number of transported axes: for d = 2 with rotations the second axis follows from the first.
  int axes() const { return graph_.transport_kind() == TransportKind::rotation2 ? 1 : graph_.dimension(); }
  /// The outward field, then the axes of the source's frame, each transported to all vertices: column major, n d numbers
  /// each.
  std::vector<double> fields(Index source) const;
  /// The orthonormal frame nearest to the transported axes; false where no heat arrived.
  bool frame(std::span<const double> axes, Index vertex, Eigen::MatrixXd& U) const;

  const TangentGraph& graph_;
  VectorHeatOptions options_;
  HeatOperators heat_;
  EdgeIntegration integration_;
};

std::vector<double> VectorHeatLog::fields(Index source) const {
  const auto d = static_cast<std::size_t>(graph_.dimension()), nd = static_cast<std::size_t>(graph_.size()) * d;
  const auto columns = static_cast<std::size_t>(axes()) + 1;
  std::vector<double> fields(nd * columns, 0.0);
  add_outward_circle(graph_, source, std::span(fields).first(nd));
  for (std::size_t a = 0; a + 1 < columns; ++a)
    fields[(a + 1) * nd + static_cast<std::size_t>(source) * d + a] = source_heat;
  heat_.solve_vector(fields, static_cast<Index>(columns));
  return fields;
}

bool VectorHeatLog::frame(std::span<const double> axes, Index vertex, Eigen::MatrixXd& U) const {
  const int d = graph_.dimension();
  const auto begin = static_cast<std::size_t>(vertex) * static_cast<std::size_t>(d);
  if (graph_.transport_kind() == TransportKind::rotation2) {
    const double x = axes[begin], y = axes[begin + 1], length = std::hypot(x, y);
    U << x / length, -y / length, y / length, x / length;
    return length >= least_heat;
  }
  for (int a = 0; a < d; ++a)
    U.col(a) = Eigen::Map<const Eigen::VectorXd>(
        &axes[begin + static_cast<std::size_t>(a) * static_cast<std::size_t>(graph_.size() * d)], d);
  const bool reached = U.col(0).norm() >= least_heat;
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(U, Eigen::ComputeFullU | Eigen::ComputeFullV);
  U = svd.matrixU() * svd.matrixV().transpose();
  return reached;
}

Result VectorHeatLog::solve(Index source) const {
  check_source(source, graph_.size());
  const int d = graph_.dimension();
  const auto nd = static_cast<std::size_t>(graph_.size()) * static_cast<std::size_t>(d);
  std::vector<double> fields = this->fields(source);
  const std::span radial = std::span(fields).first(nd);

  // R: the normalized outward field; zero at the source itself.
  normalize(radial, d);
  std::fill_n(&radial[static_cast<std::size_t>(source) * static_cast<std::size_t>(d)], d, 0.0);
  // Laplacian r = div R.
  const std::vector<double> r = integration_.integrate(radial, options_.radial_at_source ? source : -1);
  const double zero = r[source];

  // phi = r (R in the transported frame).
  Result result{std::vector<double>(nd, nan), std::vector<double>(r.size(), nan)};
  Eigen::MatrixXd U(d, d);
  for (Index i = 0; i < graph_.size(); ++i) {
    const auto begin = static_cast<std::size_t>(i) * static_cast<std::size_t>(d);
    const Eigen::Map<const Eigen::VectorXd> R(&radial[begin], d);
    if (!frame(std::span(fields).subspan(nd), i, U) || (i != source && R.isZero(0))) continue;
    double& distance = result.distance[i];
    distance = (r[i] - zero) * graph_.length_unit();
    Eigen::Map<Eigen::VectorXd>(&result.coordinates[begin], d) = distance * U.transpose() * R;
  }
  return result;
}

}  // namespace

Method vector_heat_log(const TangentGraph& graph, const VectorHeatOptions& options) {
  return std::make_unique<VectorHeatLog>(graph, options);
}

}  // namespace ahm::methods
