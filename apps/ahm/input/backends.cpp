#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "ahm/error.hpp"
#include "input/backend.hpp"

namespace ahm::app {
namespace {

using Build = std::unique_ptr<Model> (*)(const io::Geometry&, const RunOptions&, const Progress&);

struct Entry {
  std::string_view name;
  Build build;
};

constexpr std::array<Entry, 3> backends = {{
    {"trimesh", build_trimesh},
    {"polymesh", build_polymesh},
    {"pointcloud", build_pointcloud},
}};

}  // namespace

std::string choose_backend(const io::Geometry& input, const std::string& requested) {
  if (requested != "auto") return requested;
  if (input.face_count() == 0) return "pointcloud";
  for (std::size_t f = 0; f < input.face_count(); ++f)
    if (input.face(f).size() != 3) return "polymesh";
  return "trimesh";
}

std::unique_ptr<Model> build_model(const std::string& backend, const io::Geometry& input, const RunOptions& options,
                                   const Progress& progress) {
  const auto* entry = std::find_if(backends.begin(), backends.end(), [&](const Entry& e) { return e.name == backend; });
  if (entry == backends.end()) throw InvalidArgument(fmt::format("--backend {}: there is no such backend", backend));
  return entry->build(input, options, progress);
}

}  // namespace ahm::app
