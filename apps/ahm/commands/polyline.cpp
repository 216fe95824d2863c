#include "commands/polyline.hpp"

#include <fmt/format.h>

#include "ahm/error.hpp"
#include "ahm/io/formats.hpp"
#include "ahm/io/write.hpp"
#include "ahm/util/vec.hpp"
#include "cli/source_list.hpp"
#include "output/output_paths.hpp"
#include "output/results.hpp"
#include "output/summary.hpp"

namespace ahm::app {

void write_polylines(const std::string& file, const std::string& format, const Polylines& curves) {
  if (format.empty() && io::lower_extension(file) == ".obj")
    return io::write_obj_lines(file, curves.points, curves.begin);
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
  io::write(file, table, format);
}

namespace {

void write_view(const LineFinder& finder, const Input& input, const InputOptions& options, const OutputOptions& output,
                const Polylines& curves, Journal& journal) {
  if (output.view.empty()) return;
  Results results(output, input, options);
  RowLogMap rows;
  view::Scene scene = results.scene();
  view::PictureOptions picture;
  picture.pattern = view::Pattern::none;
  if (curves.from) {
    rows = input.surface().on_rows(finder.map(*curves.from));
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
}

}  // namespace

void run_polyline(const std::string& name, const InputOptions& options, const OutputOptions& output,
                  const std::optional<SourceSpec>& source, const FindPolylines& find) {
  check_results(options.path, output, {".csv", ".jsonl", ".ply", ".vtp", ".obj"});
  Journal journal(output.verbosity);
  const Input input = open_input(options, journal, source);
  journal.start(name);
  const LineFinder finder(input.surface());
  const Polylines curves = find(finder, input, journal);
  write_view(finder, input, options, output, curves, journal);
  journal.start("write");
  write_polylines(output.output, output.format, curves);
  nlohmann::ordered_json j = summary("ahm " + name, options.path, output, input);
  j.update(curves.json);
  deliver(std::move(j), curves.text, output, journal);
}

SurfacePoint point_on_surface(const Input& input, const SourceSpec& spec, const std::string& option) {
  position_of(input, spec, option);
  if (const auto* position = std::get_if<SourcePosition>(&spec))
    return input.surface().closest_point(position->position).point;
  place(input, spec, std::nullopt, option);  // checks
  return point_of(input, spec);
}

}  // namespace ahm::app
