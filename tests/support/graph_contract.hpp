/// \file
/// What every backend's graph must satisfy, as a typed GoogleTest suite. To check your own graph:
///
/// \code
/// struct MyGraphs {
///   static std::unique_ptr<ahm::TangentGraph> surface();   // any connected graph of at least 50 vertices
///   static std::unique_ptr<ahm::TangentGraph> flat();      // edge logs are differences of positions in the plane
/// };
/// INSTANTIATE_TYPED_TEST_SUITE_P(Mine, GraphContract, MyGraphs);
/// \endcode
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "ahm/log_map_solver.hpp"
#include "ahm/validate.hpp"
#include "support/reference_operator.hpp"

namespace ahm::test {

template <class Graphs>
class GraphContract : public testing::Test {};

TYPED_TEST_SUITE_P(GraphContract);

TYPED_TEST_P(GraphContract, KeepsEveryLawOfATangentGraph) {
  EXPECT_NO_THROW(validate(*TypeParam::surface()));
  EXPECT_NO_THROW(validate(*TypeParam::flat()));
}

TYPED_TEST_P(GraphContract, CountsItsEdges) {
  const auto graph = TypeParam::surface();
  Offset edges = 0;
  for (Index i = 0; i < graph->size(); ++i) edges += static_cast<Offset>(graph->star(i).degree());
  EXPECT_EQ(edges, graph->edge_count());
}

TYPED_TEST_P(GraphContract, HasNonNegativeWeights) {
  const auto graph = TypeParam::surface();
  for (Index i = 0; i < graph->size(); ++i)
    for (double w : graph->star(i).weights) EXPECT_GE(w, 0.0) << "vertex " << i;
}

TYPED_TEST_P(GraphContract, ClosesEveryLoopWhereItIsFlat) {
  // On a flat graph the log map of the solver must satisfy every edge: phi_j - phi_i = e_ij in the source's frame, so
  // that the residual of Alg. 2 vanishes whatever the weights.
  const auto graph = TypeParam::flat();
  LogMapSolver solver(*graph);
  const Index source = graph->size() / 2;
  for (Variant variant : {Variant::adaptive, Variant::localized}) {
    const LogMap map = solver.solve(Source::at_vertex(source), {.variant = variant});
    double diameter = 0;
    for (Index i = 0; i < graph->size(); ++i) diameter = std::max(diameter, map.distance(i));
    for (Index i = 0; i < graph->size(); ++i) {
      const Star star = graph->star(i);
      for (std::size_t e = 0; e < star.degree(); ++e) {
        double difference = 0, log = 0;
        for (int a = 0; a < graph->dimension(); ++a) {
          const double step = map.coordinates(star.neighbors[e])[a] - map.coordinates(i)[a];
          difference += step * step;
          log += star.log(e)[a] * star.log(e)[a];
        }
        EXPECT_NEAR(std::sqrt(difference), std::sqrt(log) * graph->length_unit(), 1e-11 * diameter) << "vertex " << i;
      }
    }
  }
}

TYPED_TEST_P(GraphContract, AgreesWithThePapersFullOperator) {
  const auto graph = TypeParam::surface();
  LogMapSolver solver(*graph);
  for (Variant variant : {Variant::adaptive, Variant::localized}) {
    const LogMap map = solver.solve(Source::at_vertex(3), {.variant = variant});
    const std::vector<double> reference = reference_log_map(*graph, 3, variant);
    double largest = 0;
    for (double x : reference) largest = std::max(largest, std::abs(x));
    for (std::size_t k = 0; k < reference.size(); ++k) EXPECT_NEAR(map.coordinates()[k], reference[k], 1e-11 * largest);
  }
}

REGISTER_TYPED_TEST_SUITE_P(GraphContract, KeepsEveryLawOfATangentGraph, CountsItsEdges, HasNonNegativeWeights,
                            ClosesEveryLoopWhereItIsFlat, AgreesWithThePapersFullOperator);

}  // namespace ahm::test
