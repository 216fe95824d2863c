#include "cases.hpp"

#include <array>
#include <charconv>
#include <cmath>

namespace ahm::io::test {
namespace {

std::string number(double value) {
  std::array<char, 32> digits;  // the shortest that reads back the same
  return std::isnan(value) ? "nan" : std::string(digits.data(), std::to_chars(digits.begin(), digits.end(), value).ptr);
}

template <class Numbers>
std::string numbers(const Numbers& values) {
  std::string text;
  for (const auto value : values) text += (text.empty() ? "" : " ") + number(value);
  return text;
}

template <class Rows>
std::string rows(const std::string& title, const Rows& values) {
  std::string text;
  for (const auto& row : values) text += (text.empty() ? title : ", ") + numbers(row);
  return text;
}

}  // namespace

std::string contents_of(const Geometry& g) {
  std::string text = rows("", g.points);
  std::vector<std::span<const Index>> faces;
  for (std::size_t f = 0; f < g.face_count(); ++f) faces.push_back(g.face(f));
  text += rows("; faces ", faces) + rows("; normals ", g.normals) + rows("; colors ", g.colors);
  for (const Property& property : g.properties) text += "; " + property.name + " " + numbers(property.values);
  if (const auto& a = g.acquisition; a && a->height > 1)
    text += "; image " + std::to_string(a->width) + " x " + std::to_string(a->height) + " from " +
            numbers(a->position) + " along " + numbers(a->orientation);
  for (const Warning& warning : g.warnings) {
    text += "; " + std::string(warning.id);
    if (!warning.numbers.empty()) text += " " + numbers(warning.numbers);
    if (!warning.name.empty()) text += " " + warning.name;
  }
  return text;
}

const std::map<std::string, Cases>& all_cases() {
  static const std::map<std::string, Cases> cases = {
#ifdef AHM_WITH_PCL
      {"pcd", pcd_cases()},
#endif
#ifdef AHM_WITH_PUGIXML
      {"vtk", vtk_cases()},
#endif
      {"columns", column_cases()}, {"gltf", gltf_cases()}, {"las", las_cases()}, {"obj", obj_cases()},
      {"off", off_cases()},        {"ply", ply_cases()},   {"stl", stl_cases()}};
  return cases;
}

}  // namespace ahm::io::test
