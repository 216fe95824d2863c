/// \file
/// What enters the systems of the affine heat method, vertex by vertex: a source's samples, or the accepted values behind
/// the front of a march. Both are right-hand sides of the same solves.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "ahm/graph/tangent_graph.hpp"
#include "ahm/heat/heat_operators.hpp"
#include "ahm/maps/log_map.hpp"
#include "ahm/maps/source.hpp"

namespace ahm {

/// Right-hand sides at `vertices`; parallel arrays, d the dimension.
struct RightHandSide {
  std::vector<Index> vertices;
  std::vector<double> heat;          ///< b: enters A lambda
  std::vector<double> frames;        ///< b U: enters B U~; stored as transports are
  std::vector<double> values;        ///< of the variant's own: enters its system; d numbers
  std::vector<double> translations;  ///< enters rho, hence every variant; d numbers in the vertex's frame
  std::vector<double> squares;       ///< b |z|^2: enters the second moment
  std::vector<double> pairs;         ///< of known vertices, d x d numbers: enters the second moment with U; or empty
  std::vector<double> lengths;  ///< of known vertices: enters the second moment of distances instead of both; or empty
};

/// @throws InvalidArgument when the source does not fit the graph
void check_source(const Source& source, const TangentGraph& graph);

/// The outside length of 1 in x and Y: a power of two near the mean edge length, times the graph's own unit. It keeps x
/// and Y in the range of lambda, which is used up to both ends.
double solution_unit(const TangentGraph& graph);

/// The right-hand side that stands for a weight of 1 at these vertices: `heat_scale`, less where a tiny mass would make
/// the solution overflow.
double source_heat(const TangentGraph& graph, const HeatOperators& operators, std::span<const Vertex> vertices);

/// The samples of positive weight of a checked source. The largest b becomes `source_heat`; the factor cancels in every
/// quotient by lambda.
/// @param keep  which of them; none given: all
RightHandSide right_hand_side_of(const Source& source, const TangentGraph& graph, const HeatOperators& operators,
                                 Variant variant, const std::function<bool(Index)>& keep = {});
std::vector<RightHandSide> right_hand_side_of(std::span<const Source> sources, const TangentGraph& graph,
                                              const HeatOperators& operators, Variant variant);

/// Whether the component of a vertex holds a sample of positive weight.
class SourceComponents {
 public:
  /// @param component_of_vertex  as `HeatOperators::components`; must outlive this object
  SourceComponents(const Source& source, std::span<const Index> component_of_vertex);
  bool hold(Index vertex) const { return has_source_[component_[vertex]] != 0; }

 private:
  std::span<const Index> component_;
  std::vector<char> has_source_;
};

}  // namespace ahm
