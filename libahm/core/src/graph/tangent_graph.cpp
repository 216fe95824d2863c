#include "ahm/graph/tangent_graph.hpp"

#include <cmath>
#include <limits>

namespace ahm {

double world_mass(const TangentGraph& graph, double mass) {
  double result = mass;
  for (int a = 0; a < graph.dimension(); ++a) result *= graph.length_unit();
  return mass == 0 || std::isnormal(result) ? result : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace ahm
