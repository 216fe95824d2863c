#include "output/wording.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <utility>

namespace ahm::app {
namespace {

struct Advice {
  std::string_view fault, remedy;
};

constexpr std::string_view join_points =
    "the cause may be points that nearly coincide: join them with --voxel (clouds) or --weld (meshes)";

constexpr Advice advices[] = {
    {"unknown_bytes", "set the format with --input-format"},
    {"unknown_type", "if it is one of these formats, set it with --input-format"},
    {"duplicate_faces", "drop duplicates with --drop-duplicates, or repair the mesh with --repair"},
    {"repeated_vertices", "drop such faces with --drop-degenerate, or repair the mesh with --repair"},
    {"small_faces", "drop such faces with --drop-degenerate, or repair the mesh with --repair"},
    {"not_finite", "drop its faces with --drop-degenerate, or repair the mesh with --repair"},
    {"non_manifold_edges", "cut the mesh there with --non-manifold split, or repair it with --repair"},
    {"non_manifold_vertices", "split the mesh there with --non-manifold split, or repair it with --repair"},
    {"diffusion_time_range", "use a --t-coef near 1"},
    {"no_cholmod", "use --factor own"},
    {"heat_not_conserved", "use a smaller --t-coef"},
    {"not_positive_definite", join_points},
    {"ill_conditioned", join_points},
    {"twisted_faces", "use --discretization polygons"},
    {"collinear_faces", "remove such faces, or use --method polar or heat"},
    {"no_flat_triangles", "use --method polar or --method heat"},
    {"windows_without_end", "repair the mesh, or use --method heat"},
    {"windows_lost", "repair the thin triangles there, or use --method polar or heat (paths: --fast)"},
    {"polygons_not_refined", "use --discretization refined, or --method heat"},
    {"polygons_too_large", "use --discretization refined"},
    {"no_bending_direction", "write the axis as X,Y,Z"},
    {"row_left_out", "--voxel, --outliers, --drop-nan or --local removed it; choose another row, or write x,y,z"},
};

}  // namespace

std::string worded(const Error& error) {
  for (const auto& [fault, remedy] : advices)
    if (error.fault() == fault) return fmt::format("{}; {}", error.problem(), remedy);
  return error.what();
}

std::string bytes_as_text(std::int64_t bytes) {
  const auto x = static_cast<double>(bytes);
  if (x >= 1e9) return fmt::format("{:.2f} GB", x / 1e9);
  if (x >= 1e6) return fmt::format("{:.0f} MB", x / 1e6);
  return fmt::format("{:.0f} kB", x / 1e3);
}

nlohmann::ordered_json as_json(const Report& report) {
  nlohmann::ordered_json json;
  for (const auto& [id, value] : report) {
    const std::size_t dot = id.find('.');
    nlohmann::ordered_json& entry = dot == std::string_view::npos
                                        ? json[std::string(id)]
                                        : json[std::string(id.substr(0, dot))][std::string(id.substr(dot + 1))];
    std::visit([&](const auto& x) { entry = x; }, value);
  }
  return json;
}

}  // namespace ahm::app
