#include "methods/edge_integration.hpp"

#include "methods/heat_fields.hpp"

namespace ahm::methods {
namespace {

std::vector<Index> first_vertices(const Components& components) {
  std::vector<Index> first(static_cast<std::size_t>(components.count), -1);
  for (std::size_t i = 0; i < components.of_vertex.size(); ++i)
    if (Index& entry = first[components.of_vertex[i]]; entry < 0) entry = static_cast<Index>(i);
  return first;
}

/// The graph Laplacian with the rows and columns of the pinned vertices replaced by those of the identity.
Eigen::SparseMatrix<double> pinned_laplacian(const TangentGraph& graph, const std::vector<Index>& pinned) {
  std::vector<bool> is_pinned(static_cast<std::size_t>(graph.size()), false);
  for (Index i : pinned) is_pinned[i] = true;
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(static_cast<std::size_t>(graph.edge_count()) / 2 + is_pinned.size());
  for (Index i = 0; i < graph.size(); ++i) {
    if (is_pinned[i]) {
      entries.emplace_back(i, i, 1.0);
      continue;
    }
    const Star star = graph.star(i);
    double diagonal = 0;
    for (std::size_t e = 0; e < star.degree(); ++e) {
      const Index j = star.neighbors[e];
      diagonal += star.weights[e];
      if (j < i && !is_pinned[j]) entries.emplace_back(i, j, -star.weights[e]);
    }
    entries.emplace_back(i, i, diagonal);
  }
  Eigen::SparseMatrix<double> L(graph.size(), graph.size());
  L.setFromTriplets(entries.begin(), entries.end());
  return L;
}

}  // namespace

EdgeIntegration::EdgeIntegration(const TangentGraph& graph)
    : graph_(graph),
      components_(connected_components(graph)),
      pinned_(first_vertices(components_)),
      laplacian_(pinned_laplacian(graph, pinned_), "the graph's Laplacian") {}

std::vector<double> EdgeIntegration::integrate(std::span<const double> field, Index pole) const {
  const auto d = static_cast<std::size_t>(graph_.dimension());
  Eigen::VectorXd b = Eigen::VectorXd::Zero(graph_.size());
  std::vector<double> carried(d);
  for (Index i = 0; i < graph_.size(); ++i) {
    const Star star = graph_.star(i);
    for (std::size_t e = 0; e < star.degree(); ++e) {
      const Index j = star.neighbors[e];
      carry_here(graph_, star, e, &field[static_cast<std::size_t>(j) * d], carried.data());
      const double share_i = i == pole ? 0.0 : j == pole ? 1.0 : 0.5;
      double increment = 0;  // <X, e_ij>
      for (std::size_t a = 0; a < d; ++a)
        increment +=
            (share_i * field[static_cast<std::size_t>(i) * d + a] + (1 - share_i) * carried[a]) * star.log(e)[a];
      // An edge occurs at both of its ends, where its logarithms may differ; each counts half. The sum of b remains zero.
      b[i] -= 0.5 * star.weights[e] * increment;
      b[j] += 0.5 * star.weights[e] * increment;
    }
  }
  for (Index i : pinned_) b[i] = 0;
  const Eigen::VectorXd f = laplacian_.solve(b);
  return {f.begin(), f.end()};
}

}  // namespace ahm::methods
