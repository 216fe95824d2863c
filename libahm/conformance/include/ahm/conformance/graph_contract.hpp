/// \file
/// What every backend's graph must satisfy, as a typed GoogleTest suite. To check your own graph, link ahm::conformance and
/// GTest::gtest_main:
///
/// \code
/// struct MyGraphs {
///   static constexpr bool signed_weights = true;           // only where the discretization has negative weights
///   static std::unique_ptr<ahm::TangentGraph> surface();   // any connected graph of at least 50 vertices
///   static std::unique_ptr<ahm::TangentGraph> flat();      // edge logs are differences of positions in the plane
/// };
/// namespace ahm::test {
/// INSTANTIATE_TYPED_TEST_SUITE_P(Mine, GraphContract, MyGraphs);
/// }
/// \endcode
#pragma once

#include <gtest/gtest.h>

#include <memory>

#include "ahm/conformance/graph_laws.hpp"
#include "ahm/graph/tangent_graph.hpp"

namespace ahm::test {

template <class Graphs>
class GraphContract : public ::testing::Test {};

TYPED_TEST_SUITE_P(GraphContract);

TYPED_TEST_P(GraphContract, KeepsEveryLawOfATangentGraph) {
  contract::keeps_every_law_of_a_tangent_graph(*TypeParam::surface());
  contract::keeps_every_law_of_a_tangent_graph(*TypeParam::flat());
}

TYPED_TEST_P(GraphContract, CountsItsEdges) { contract::counts_its_edges(*TypeParam::surface()); }
TYPED_TEST_P(GraphContract, HasNonNegativeWeights) {
  if constexpr (requires { TypeParam::signed_weights; }) GTEST_SKIP() << "this discretization has negative weights";
  contract::has_non_negative_weights(*TypeParam::surface());
}

TYPED_TEST_P(GraphContract, ClosesEveryLoopWhereItIsFlat) {
  contract::closes_every_loop_where_it_is_flat(*TypeParam::flat());
}
TYPED_TEST_P(GraphContract, CarriesOneFrameWhereItIsFlat) {
  contract::carries_one_frame_where_it_is_flat(*TypeParam::flat());
}
TYPED_TEST_P(GraphContract, StartsBetweenVerticesExactlyWhereItIsFlat) {
  contract::starts_between_vertices_exactly_where_it_is_flat(*TypeParam::flat());
}
TYPED_TEST_P(GraphContract, AgreesWithThePapersFullOperator) {
  contract::agrees_with_the_papers_full_operator(*TypeParam::surface());
}
TYPED_TEST_P(GraphContract, DoesNotDependOnTheFrames) {
  contract::does_not_depend_on_the_frames(*TypeParam::surface());
}
TYPED_TEST_P(GraphContract, DoesNotDependOnTheNumbering) {
  contract::does_not_depend_on_the_numbering(*TypeParam::surface());
}
TYPED_TEST_P(GraphContract, ScalesWithItsLengths) { contract::scales_with_its_lengths(*TypeParam::surface()); }
TYPED_TEST_P(GraphContract, MasksWhatIsNotConnected) { contract::masks_what_is_not_connected(*TypeParam::surface()); }
TYPED_TEST_P(GraphContract, SolvesBatchesOnAnyNumberOfThreads) {
  contract::solves_batches_on_any_number_of_threads(*TypeParam::surface());
}
TYPED_TEST_P(GraphContract, ShowsItsStarsToManyThreadsAtOnce) {
  contract::shows_its_stars_to_many_threads_at_once(*TypeParam::surface());
}

REGISTER_TYPED_TEST_SUITE_P(GraphContract, KeepsEveryLawOfATangentGraph, CountsItsEdges, HasNonNegativeWeights,
                            ClosesEveryLoopWhereItIsFlat, CarriesOneFrameWhereItIsFlat,
                            StartsBetweenVerticesExactlyWhereItIsFlat, AgreesWithThePapersFullOperator,
                            DoesNotDependOnTheFrames, DoesNotDependOnTheNumbering, ScalesWithItsLengths,
                            MasksWhatIsNotConnected, SolvesBatchesOnAnyNumberOfThreads,
                            ShowsItsStarsToManyThreadsAtOnce);

}  // namespace ahm::test
