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

void write_obj(const std::string& name, const Polylines& curves) {
  std::string text = "# curve by libahm\n";
  for (const Vec3& p : curves.points) text += fmt::format("v {} {} {}\n", p[0], p[1], p[2]);
  for (std::size_t k = 0; k < curves.begin.size(); ++k) {
    if (curves.begin[k] == curves.end(k)) continue;
    text += "l";
    for (Index i = curves.begin[k]; i < curves.end(k); ++i) text += fmt::format(" {}", i + 1);
    text += "\n";
  }
  io::AtomicFile file(name);
  file.write(text);
  file.commit();
}

ExactGeodesics geodesics_of(const Input& input) {
  if (input.surface().faces().size() == 0)
    throw InvalidArgument(
        "geodesics run over faces, which this input does not have, or which --backend ignores; the triangles around "
        "the "
        "points of a cloud do not agree on one surface: mesh it first");
  return ExactGeodesics(input.surface());
}

void write_polylines(const std::string& name, const Polylines& curves) {
  if (extension_of(name) == ".obj") return write_obj(name, curves);
  std::vector<double> arclength, number;
  io::Table table{.title = "curve by libahm", .text = true};
  for (std::size_t k = 0; k < curves.begin.size(); ++k)
    for (Index i = curves.begin[k]; i < curves.end(k); ++i) {
      number.push_back(static_cast<double>(k));
      const bool first = i == curves.begin[k];
      arclength.push_back(first ? 0 : arclength.back() + distance(curves.points[i - 1], curves.points[i]));
      if (!first) table.edges.push_back({i - 1, i});
    }
  if (curves.numbered) table.add("curve", number);
  table.add({"x", "y", "z"}, curves.points);
  table.add("arclength", arclength);
  io::write(name, table);
}

void write_view(const ExactGeodesics& geodesics, const Input& input, const InputOptions& options,
                const OutputOptions& output, const Polylines& curves, Journal& journal) {
  if (output.view.empty()) return;
  Results results(output, input, options);
  RowLogMap rows;
  view::Scene scene = results.scene();
  view::PictureOptions picture;
  picture.pattern = view::Pattern::none;
  if (curves.from) {
    rows = input.surface().on_rows(geodesics.log_map(*curves.from));
    scene = results.scene(rows, {}, input.surface().source(*curves.from));
    scene.source_axes.reset();
    picture.pattern = view::Pattern::polar;
  }
  std::vector<Index> pieces;
  for (Index b : curves.begin)
    if (b > (pieces.empty() ? 0 : pieces.back()) && b < std::ssize(curves.points)) pieces.push_back(b);
  scene.curve = curves.points;
  scene.curve_pieces = pieces;
  if (!curves.from && !curves.points.empty()) scene.source = curves.points.front();
  results.write_view(scene, journal, picture);
  results.keep();
}

}  // namespace

void run_polyline(const std::string& name, const InputOptions& options, const OutputOptions& output,
                  const std::optional<SourceSpec>& source, const FindPolylines& find) {
  check_results(options.path, output, {".csv", ".ply", ".obj"});
  Journal journal(output.verbose);
  const Input input = open_input(options, journal, source);
  journal.start(name);
  const ExactGeodesics geodesics = geodesics_of(input);
  const Polylines curves = find(geodesics, input, journal);
  write_view(geodesics, input, options, output, curves, journal);
  journal.start("write");
  write_polylines(output.output, curves);
  nlohmann::ordered_json j = summary("ahm " + name, options.path, output, input);
  j.update(curves.json);
  deliver(std::move(j), curves.text, output, journal);
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
