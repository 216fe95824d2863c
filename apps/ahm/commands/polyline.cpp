#include "commands/polyline.hpp"

#include <fmt/format.h>

#include "ahm/error.hpp"
#include "ahm/io/atomic_file.hpp"
#include "ahm/io/write.hpp"
#include "ahm/util/vec.hpp"
#include "cli/source_list.hpp"
#include "output/output_paths.hpp"
#include "output/results.hpp"

namespace ahm::app {
namespace {

void write_obj(const std::string& name, const std::vector<Vec3>& points) {
  std::string text = "# curve by libahm\n", line = "l";
  for (std::size_t k = 0; k < points.size(); ++k) {
    text += fmt::format("v {} {} {}\n", points[k][0], points[k][1], points[k][2]);
    line += fmt::format(" {}", k + 1);
  }
  io::AtomicFile file(name);
  file.write(text + line + "\n");
  file.commit();
}

}  // namespace

std::vector<std::string> polyline_endings() { return {".csv", ".ply", ".obj"}; }

ExactGeodesics geodesics_of(const Input& input) {
  if (input.surface().faces().size() == 0)
    throw InvalidArgument("geodesics run over faces, which this input does not have, or which --backend ignores");
  return ExactGeodesics(input.surface());
}

SurfacePoint point_on_faces(const Input& input, const SourceSpec& spec, const std::string& option) {
  position_in(input.geometry, spec, option);
  if (const auto* position = std::get_if<SourcePosition>(&spec))
    return input.surface().closest_point(position->position).point;
  place(input.surface(), spec, std::nullopt, option);  // checks
  return point_of(input.surface(), spec);
}

void write_polyline(const std::string& name, const std::vector<Vec3>& points) {
  if (extension_of(name) == ".obj") return write_obj(name, points);
  std::vector<double> arclength{0};
  io::Table table{.title = "curve by libahm", .text = true};
  for (std::size_t k = 1; k < points.size(); ++k) {
    arclength.push_back(arclength.back() + distance(points[k - 1], points[k]));
    table.edges.push_back({static_cast<Index>(k) - 1, static_cast<Index>(k)});
  }
  table.add({"x", "y", "z"}, points);
  table.add("arclength", arclength);
  io::write(name, table);
}

void write_polyline_view(const ExactGeodesics& geodesics, const Input& input, const InputOptions& options,
                         const OutputOptions& output, const SurfacePoint& from, const std::vector<Vec3>& points,
                         Journal& journal) {
  if (output.view.empty()) return;
  Results results(output, input, options);
  const RowLogMap rows = input.surface().on_rows(geodesics.log_map(from));
  view::Scene scene = results.scene(rows, {}, input.surface().source(from));
  scene.source_axes.reset();
  scene.curve = points;
  results.write_view(scene, journal);
  results.keep();
}

}  // namespace ahm::app
