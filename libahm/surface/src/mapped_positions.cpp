#include "ahm/surface/mapped_positions.hpp"

#include <limits>

namespace ahm {

std::vector<Vec3> mapped_positions(const Surface& surface) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<Vec3> result(surface.positions().begin(), surface.positions().end());
  for (std::size_t r = 0; r < result.size(); ++r) {
    const auto vertex = surface.rows().vertex(Row(static_cast<Index>(r)));
    if (!vertex)
      result[r] = {nan, nan, nan};
    else if (const auto frame = surface.graph().frame(vertex->index))
      result[r] = frame->origin;
  }
  return result;
}

}  // namespace ahm
