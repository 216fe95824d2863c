/// \file
/// The laws of the graph contract as functions, without the test suite of all of them (ahm/conformance/graph_contract.hpp).
#pragma once

#include "ahm/graph/tangent_graph.hpp"

namespace ahm::test {

/// One function per law. A violation fails the running test. Functions with `flat` in their name require a flat graph.
namespace contract {

void keeps_every_law_of_a_tangent_graph(const TangentGraph& graph);
void counts_its_edges(const TangentGraph& graph);
void has_non_negative_weights(const TangentGraph& graph);
void closes_every_loop_where_it_is_flat(const TangentGraph& graph);
void carries_one_frame_where_it_is_flat(const TangentGraph& graph);
void starts_between_vertices_exactly_where_it_is_flat(const TangentGraph& graph);
void agrees_with_the_papers_full_operator(const TangentGraph& graph);
void does_not_depend_on_the_frames(const TangentGraph& graph);
void does_not_depend_on_the_numbering(const TangentGraph& graph);
void scales_with_its_lengths(const TangentGraph& graph);
void masks_what_is_not_connected(const TangentGraph& graph);
void solves_batches_on_any_number_of_threads(const TangentGraph& graph);
void shows_its_stars_to_many_threads_at_once(const TangentGraph& graph);

}  // namespace contract

}  // namespace ahm::test
