#include "read/properties.hpp"

#include <algorithm>
#include <utility>

namespace ahm::io {

void add_property(Geometry& g, const std::string& name, std::vector<double> values) {
  std::string plain;
  for (const char c : name) {
    const bool fit = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    plain += fit ? c : '_';
  }
  if (plain.empty()) plain = "property";
  const auto taken = [&](const std::string& other) {
    return std::ranges::find(g.properties, other, &Property::name) != g.properties.end();
  };
  std::string own = plain;
  for (int number = 2; taken(own); ++number) own = plain + '_' + std::to_string(number);
  g.properties.push_back({std::move(own), std::move(values)});
}

}  // namespace ahm::io
