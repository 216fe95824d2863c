#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "ahm/error.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "ahm/polymesh/polygon_mesh_surface.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "input/backend.hpp"

namespace ahm::app {
namespace {

bool is_cloud(const io::Geometry& input) { return input.face_count() == 0; }

bool has_triangles_only(const io::Geometry& input) {
  for (std::size_t f = 0; f < input.face_count(); ++f)
    if (input.face(f).size() != 3) return false;
  return !is_cloud(input);
}

bool has_faces(const io::Geometry& input) { return !is_cloud(input); }

constexpr std::array<Backend, 3> backends = {{
    {"trimesh", has_triangles_only, trimesh::build_cost, build_trimesh},
    {"polymesh", has_faces, polymesh::build_cost, build_polymesh},
    {"pointcloud", is_cloud, pointcloud::build_cost, build_pointcloud},
}};

}  // namespace

std::vector<std::string> backend_names() {
  std::vector<std::string> names;
  for (const Backend& backend : backends) names.emplace_back(backend.name);
  return names;
}

const Backend& choose_backend(const io::Geometry& input, const std::string& requested) {
  const auto* found = std::find_if(backends.begin(), backends.end(), [&](const Backend& b) {
    return requested == "auto" ? b.suits(input) : b.name == requested;
  });
  if (found == backends.end()) throw InvalidArgument(fmt::format("--backend {}: there is no such backend", requested));
  return *found;
}

}  // namespace ahm::app
