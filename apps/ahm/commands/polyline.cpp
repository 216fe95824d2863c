#include "commands/polyline.hpp"

#include <fmt/format.h>

#include "ahm/error.hpp"
#include "ahm/io/atomic_file.hpp"
#include "ahm/io/write.hpp"
#include "ahm/util/vec.hpp"
#include "cli/source_list.hpp"
#include "output/output_paths.hpp"
#include "output/results.hpp"
#include "output/summary.hpp"

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

ExactGeodesics geodesics_of(const Input& input) {
  if (input.surface().faces().size() == 0)
    throw InvalidArgument("geodesics run over faces, which this input does not have, or which --backend ignores");
  return ExactGeodesics(input.surface());
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

void write_view(const ExactGeodesics& geodesics, const Input& input, const InputOptions& options,
                const OutputOptions& output, const Polyline& line, Journal& journal) {
  if (output.view.empty()) return;
  Results results(output, input, options);
  const RowLogMap rows = input.surface().on_rows(geodesics.log_map(line.from));
  view::Scene scene = results.scene(rows, {}, input.surface().source(line.from));
  scene.source_axes.reset();
  scene.curve = line.points;
  results.write_view(scene, journal);
  results.keep();
}

}  // namespace

void run_polyline(const std::string& name, const InputOptions& options, const OutputOptions& output,
                  const std::optional<SourceSpec>& source, const FindPolyline& find) {
  check_results(options.path, output, {".csv", ".ply", ".obj"});
  Journal journal(output.verbose);
  const Input input = open_input(options, journal, source);
  journal.start(name);
  const ExactGeodesics geodesics = geodesics_of(input);
  const Polyline line = find(geodesics, input);
  write_view(geodesics, input, options, output, line, journal);
  journal.start("write");
  write_polyline(output.output, line.points);
  nlohmann::ordered_json j = summary("ahm " + name, options.path, output, input);
  j.update(line.json);
  deliver(std::move(j), line.text, output, journal);
}

SurfacePoint point_on_faces(const Input& input, const SourceSpec& spec, const std::string& option) {
  position_in(input.geometry, spec, option);
  if (const auto* position = std::get_if<SourcePosition>(&spec))
    return input.surface().closest_point(position->position).point;
  place(input.surface(), spec, std::nullopt, option);  // checks
  return point_of(input.surface(), spec);
}

std::vector<Vec3> positions_of(const ExactGeodesics& geodesics, const std::vector<exact::MeshPoint>& points) {
  std::vector<Vec3> positions;
  for (const exact::MeshPoint& point : points) positions.push_back(geodesics.position(point));
  return positions;
}

}  // namespace ahm::app
