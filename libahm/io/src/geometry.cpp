#include "ahm/io/geometry.hpp"

namespace ahm::io {

std::vector<std::string> column_names(const Geometry& geometry) {
  std::vector<std::string> names{"x", "y", "z"};
  for (const Property& property : geometry.properties) names.push_back(property.name);
  return names;
}

std::optional<std::vector<double>> column(const Geometry& geometry, std::string_view name) {
  const std::vector<std::string> names = column_names(geometry);
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (names[k] != name) continue;
    if (k >= 3) return geometry.properties[k - 3].values;
    std::vector<double> values;
    for (const Vec3& p : geometry.points) values.push_back(p[k]);
    return values;
  }
  return std::nullopt;
}

}  // namespace ahm::io
