#include "input/mesh_survey.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ahm/util/vec.hpp"

namespace ahm::app {
namespace {

std::vector<double> edge_lengths(const io::Geometry& input) {
  std::vector<std::pair<Index, Index>> edges;
  for (std::size_t f = 0; f < input.face_count(); ++f) {
    const auto face = input.face(f);
    for (std::size_t c = 0; c < face.size(); ++c) {
      const auto [low, high] = std::minmax(face[c], face[(c + 1) % face.size()]);
      if (low != high) edges.emplace_back(low, high);
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  std::vector<double> lengths;
  for (const auto& [a, b] : edges)
    if (const double length = distance(input.points[a], input.points[b]); std::isfinite(length))
      lengths.push_back(length);
  return lengths;
}

}  // namespace

std::optional<LengthRange> range_of(std::vector<double> lengths) {
  if (lengths.empty()) return std::nullopt;
  std::sort(lengths.begin(), lengths.end());
  return LengthRange{lengths.front(), lengths[lengths.size() / 2], lengths.back(), lengths.size()};
}

MeshSurvey survey_mesh(const io::Geometry& input) {
  MeshSurvey result;
  for (std::size_t f = 0; f < input.face_count(); ++f) {
    const std::size_t corners = input.face(f).size();
    ++(corners == 3 ? result.triangles : corners == 4 ? result.quadrilaterals : result.others);
  }
  result.inspection = inspect_mesh(static_cast<Index>(input.points.size()), input.faces());
  result.edges = range_of(edge_lengths(input));
  return result;
}

}  // namespace ahm::app
