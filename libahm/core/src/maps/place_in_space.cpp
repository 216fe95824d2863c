#include "ahm/maps/place_in_space.hpp"

#include "ahm/util/vec.hpp"

namespace ahm {

std::optional<Vec3> place_in_space(const TangentGraph& graph, const Source& source) {
  if (source.is_curve() || source.vertices().empty()) return std::nullopt;
  Vec3 sum{};
  double weights = 0;
  for (std::size_t k = 0; k < source.vertices().size(); ++k) {
    if (source.place(k).point != 0) return std::nullopt;
    const auto frame = graph.frame(source.vertices()[k].index);
    if (!frame) return std::nullopt;
    Vec3 place = frame->origin;
    for (std::size_t a = 0; a < 2 && !source.offsets().empty(); ++a) {
      const double z = source.offsets()[2 * k + a];
      place = place - (z * source.axes()[4 * k + a]) * frame->x - (z * source.axes()[4 * k + 2 + a]) * frame->y;
    }
    sum = sum + source.weights()[k] * place;
    weights += source.weights()[k];
  }
  return (1 / weights) * sum;
}

std::optional<Vec3> start_of_lines(const TangentGraph& graph, const Source& source) {
  const bool at_vertex = source.vertices().size() == 1 && source.offsets().empty();
  return at_vertex || !graph.is_delaunay() ? place_in_space(graph, source) : std::nullopt;
}

}  // namespace ahm
