#include "input/inverse.hpp"

namespace ahm::app {

InverseMap inverse_of(const Input& input, const LogMap& map, double min_quality) {
  const InverseMapOptions options{.min_quality = min_quality};
  return input.backend->has_faces ? inverse_map(input.surface->surface(), map, options)
                                  : inverse_map(input.graph(), map, options);
}

}  // namespace ahm::app
