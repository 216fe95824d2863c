#include "maps/right_hand_side.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "ahm/error.hpp"
#include "ahm/util/small_math.hpp"
#include "maps/frame_field.hpp"
#include "maps/variants/variant_system.hpp"

namespace ahm {

void check_source(const Source& source, const TangentGraph& graph) {
  const int d = graph.dimension();
  if (source.dimension().value_or(d) != d)
    throw InvalidArgument("source has dimension " + std::to_string(*source.dimension()) + ", the graph has " +
                          std::to_string(d));
  for (Vertex vertex : source.vertices())
    if (vertex.index < 0 || vertex.index >= graph.size())
      throw InvalidArgument("source vertex " + std::to_string(vertex.index) + " is outside [0, " +
                            std::to_string(graph.size()) + ")");
  const auto weights = source.weights();
  if (std::none_of(weights.begin(), weights.end(), [](double b) { return b > 0; }))
    throw InvalidArgument("source has no vertex of positive weight");
  if (graph.transport_layout().may_reflect()) return;
  for (std::size_t k = 0; k * 4 < source.axes().size(); ++k)
    if (const auto U = source.axes().subspan(k * 4, 4); U[0] * U[3] - U[1] * U[2] < 0)
      throw InvalidArgument("source axes at vertex " + std::to_string(source.vertices()[k].index) +
                            " are a reflection; this graph's frames are all oriented alike, so give a rotation");
}

double solution_unit(const TangentGraph& graph) {
  return std::ldexp(graph.length_unit(), std::ilogb(graph.mean_edge_length()));
}

double source_heat(const TangentGraph& graph, const HeatOperators& operators, std::span<const Vertex> vertices) {
  double mass = 1;
  for (Vertex vertex : vertices) mass = std::min(mass, operators.scaling() * graph.mass(vertex.index));
  return std::ldexp(heat_scale, std::max(-900, std::ilogb(mass)));
}

RightHandSide right_hand_side_of(const Source& source, const TangentGraph& graph, const HeatOperators& operators,
                                 Variant variant, const std::function<bool(Index)>& keep) {
  const auto d = static_cast<std::size_t>(graph.dimension());
  const TransportLayout layout = graph.transport_layout();
  const VariantSystem& system = system_of(variant);
  const double largest = *std::max_element(source.weights().begin(), source.weights().end());
  const double scale = source_heat(graph, operators, source.vertices()), unit = solution_unit(graph);
  std::vector<double> identity(d * d, 0.0), z(d, 0.0);
  for (std::size_t a = 0; a < d; ++a) identity[a * (d + 1)] = 1.0;
  RightHandSide in;
  for (std::size_t k = 0; k < source.vertices().size(); ++k) {
    if (!(source.weights()[k] > 0) || (keep && !keep(source.vertices()[k].index))) continue;
    const double b = source.weights()[k] / largest * scale;
    for (std::size_t a = 0; a < d && !source.offsets().empty(); ++a) z[a] = source.offsets()[k * d + a] / unit;
    const auto U = source.axes().empty() ? std::span<const double>(identity) : source.axes().subspan(k * d * d, d * d);
    in.vertices.push_back(source.vertices()[k].index);
    in.heat.push_back(b);
    const std::size_t first = in.frames.size();
    in.frames.resize(first + layout.width());
    layout.store(U, in.frames.data() + first);
    for (std::size_t c = first; c < in.frames.size(); ++c) in.frames[c] *= b;
    in.values.resize(in.values.size() + d);
    system.add_sample(b, U, z, in.values.data() + in.values.size() - d);
    in.squares.push_back(b * dot(z, z));
  }
  in.translations.assign(in.vertices.size() * d, 0.0);
  return in;
}

std::vector<RightHandSide> right_hand_side_of(std::span<const Source> sources, const TangentGraph& graph,
                                              const HeatOperators& operators, Variant variant) {
  std::vector<RightHandSide> result;
  for (const Source& source : sources) result.push_back(right_hand_side_of(source, graph, operators, variant));
  return result;
}

SourceComponents::SourceComponents(const Source& source, std::span<const Index> component_of_vertex)
    : component_(component_of_vertex), has_source_(component_of_vertex.size(), 0) {
  for (std::size_t k = 0; k < source.vertices().size(); ++k)
    if (source.weights()[k] > 0) has_source_[component_[source.vertices()[k].index]] = 1;
}

}  // namespace ahm
