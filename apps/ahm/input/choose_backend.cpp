#include <fmt/format.h>

#include <algorithm>

#include "ahm/error.hpp"
#include "input/backend.hpp"

namespace ahm::app {

const Backend& choose_backend(const io::Geometry& input, const InputOptions& options) {
  const bool as_polygons = options.backend == "auto" && options.discretization == "polygons" && input.face_count() > 0;
  const std::string requested = as_polygons ? "polymesh" : options.backend;
  const auto all = backends();
  const auto found = std::find_if(all.begin(), all.end(), [&](const Backend& b) {
    return requested == "auto" ? b.suits(input) : b.name == requested;
  });
  if (found == all.end()) throw InvalidArgument(fmt::format("--backend {}: there is no such backend", requested));
  return *found;
}

}  // namespace ahm::app
