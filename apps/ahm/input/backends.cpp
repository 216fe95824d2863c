#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "ahm/error.hpp"
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
    {"trimesh", true, has_triangles_only, 800, 3e-6, build_trimesh},
    {"polymesh", true, has_faces, 800, 3e-6, build_polymesh},
    {"pointcloud", false, is_cloud, 800, 5.5e-6, build_pointcloud},
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
