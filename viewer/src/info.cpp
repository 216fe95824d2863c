#include "info.hpp"

#include <nlohmann/json.hpp>
#include <string>

#include "requests.hpp"

namespace ahm::viewer {
namespace {

using nlohmann::json;

json point_as_json(const SurfacePoint& point) {
  if (const auto* row = std::get_if<Row>(&point)) return {{"row", row->index}};
  const auto& face = std::get<FacePoint>(point);
  return {{"face", face.face}, {"weights", face.barycentric}};
}

/// "1,234 points"
std::string counted(std::size_t n, const char* what) {
  std::string digits = std::to_string(n);
  for (auto k = static_cast<std::ptrdiff_t>(digits.size()) - 3; k > 0; k -= 3)
    digits.insert(static_cast<std::size_t>(k), ",");
  return digits + " " + what;
}

}  // namespace

json session_info(const Surface& surface, const io::Geometry& geometry, const SessionOptions& options) {
  const std::size_t faces = surface.faces().size(), rows = geometry.points.size();
  json variants = json::array();
  for (const Variant variant : all_variants) variants.push_back(to_string(variant));
  const Settings& usual = options.settings;
  json info = {{"about", faces > 0 ? counted(rows, "vertices, ") + counted(faces, "faces") : counted(rows, "points")},
               {"has_faces", faces > 0},
               {"variants", variants},
               {"formats", options.formats},
               {"method", to_string(usual.method)},
               {"variant", to_string(usual.variant)},
               {"t_coef", usual.t_coef}};
  if (usual.radius) info["radius"] = *usual.radius;
  if (options.source) info["source"] = point_as_json(standing_for(surface, *options.source));
  return info;
}

}  // namespace ahm::viewer
