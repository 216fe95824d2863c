#include "ahm/applications/atlas.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "ahm/applications/cells.hpp"
#include "ahm/graph/components.hpp"
#include "ahm/render/textured_picture.hpp"
#include "cli/option_adders.hpp"
#include "cli/source_list.hpp"
#include "commands/solve.hpp"
#include "commands/subcommand.hpp"
#include "output/summary.hpp"
#include "output/texture_output.hpp"
#include "output/wording.hpp"

namespace ahm::app {
namespace {

constexpr const char* atlas_footer =
    "SOURCES is a list separated by blanks, or a file with one entry per line. An entry is a vertex of INPUT\n"
    "(123, counted from 0) or a position (1.5,0,-2: the nearest vertex). The region nearest to each source becomes\n"
    "one chart, flattened by a map of its own.\n"
    "\n"
    "OUTPUT  .obj (also writes .mtl and _atlas.png) or .glb. An .obj keeps polygons whole; clouds are triangulated.\n"
    "\n"
    "Distortion D = max(1/sigma1, sigma2) of a triangle is 1 where the map keeps its shape and size. Triangles are\n"
    "flipped where a chart closes around a handle or a limb. More charts, or --max-distortion, avoid this.\n"
    "\n"
    "Examples:\n"
    "  ahm atlas bunny.ply --charts 30 -o bunny.glb --view bunny.png\n"
    "  ahm atlas part.stl --max-distortion 2 --size 4096 -o part.obj\n"
    "  ahm atlas quads.obj --sources '12 480 901' --texture wood.jpg -o wood.obj";

struct AtlasCommandOptions {
  InputOptions input;
  SolveOptions solve;
  OutputOptions output;
  std::vector<SourceSpec> sources;
  Index charts = 20;
  std::optional<double> max_distortion;
  PackOptions pack;
  std::string texture;
};

std::vector<Vertex> choose_sources(const AtlasCommandOptions& options, const Input& input) {
  if (options.sources.empty()) {
    const std::vector<Vertex> among = vertices_with_rows(input.surface().rows());
    return farthest_points(input.graph(), first_vertex(input.surface().rows()),
                           std::min(options.charts, static_cast<Index>(among.size())), {}, among);
  }
  return vertices_at(input, options.sources, "--sources");
}

/// The atlas and the figures of its report.
struct AtlasResult {
  Atlas atlas;
  AtlasDistortion distortion;
  TextureAtlas packed;
  std::size_t faces = 0, uncharted = 0;
  std::vector<Vec3> sources;

  AtlasResult(Atlas made, const SurfaceFaces& polygons, const TangentGraph& graph, const std::vector<Vec3>& positions,
              const PackOptions& options)
      : atlas(std::move(made)),
        distortion(ahm::distortion(atlas, polygons.of_vertices(), positions)),
        packed(ahm::pack(atlas, polygons.of_vertices(), options)),
        faces(atlas.chart_of_face.size()),
        uncharted(static_cast<std::size_t>(std::count(atlas.chart_of_face.begin(), atlas.chart_of_face.end(), -1))) {
    for (Vertex vertex : atlas.sources) sources.push_back(graph.frame(vertex.index)->origin);
  }
};

std::vector<Vec3> vertex_positions(const SurfaceFaces& faces, Index vertices) {
  std::vector<Vec3> positions(static_cast<std::size_t>(vertices));
  for (std::size_t c = 0; c < faces.corner_vertices.size(); ++c)
    positions[faces.corner_vertices[c]] = faces.points[faces.corner_points[c]];
  return positions;
}

void comment(const AtlasCommandOptions& options, const AtlasResult& made, const TangentGraph& graph, Journal& journal) {
  if (made.uncharted > 0) {
    const Index components = connected_components(graph).count;
    journal.add_warning(
        fmt::format("faces without a chart, drawn in gray: {} of {}{}", made.uncharted, made.faces,
                    components > static_cast<Index>(made.atlas.sources.size())
                        ? fmt::format("; the surface has {} components, place a source in each", components)
                        : "; no map reaches them"));
  }
  const auto bad = std::count_if(made.distortion.charts.begin(), made.distortion.charts.end(),
                                 [](const DistortionSummary& chart) { return chart.flipped_area > 0.01; });
  if (bad > 0)
    journal.add_warning(fmt::format(
        "charts with more than 1 % of their area flipped: {} of {}; they close around a handle or a limb; {}", bad,
        made.atlas.charts.size(),
        options.max_distortion ? "raise --charts or lower --max-distortion"
                               : "raise --charts, or add sources with --max-distortion 2"));
  const auto distorted = std::ranges::count_if(made.distortion.charts, [&](const DistortionSummary& chart) {
    return options.max_distortion && chart.percentile_95 > *options.max_distortion;
  });
  if (distorted > 0)
    journal.add_warning(fmt::format(
        "charts with a distortion above {2:.4g} on more than 5 % of their area: {0} of {1}; more sources did "
        "not help, or their number is at its limit; the mesh is too coarse for the bends there",
        distorted, made.atlas.charts.size(), *options.max_distortion));
}

void write_files(const AtlasCommandOptions& options, const SurfaceFaces& faces, const AtlasResult& made) {
  const Image texture = options.texture.empty() ? checkerboard(made.packed) : io::read_image(options.texture);
  const auto is_charted = [&](std::size_t f) { return made.atlas.chart_of_face[f] >= 0; };
  const FacesPart charted(faces, is_charted, made.packed.coordinates);
  const FacesPart rest(faces, [&](std::size_t f) { return !is_charted(f); });
  std::vector<io::MeshPart> parts{charted.view("atlas")};
  parts.front().texture = &texture;
  if (!rest.empty()) parts.push_back(rest.view("rest"));
  io::write_textured(options.output.output, parts);
  if (options.output.view.empty()) return;
  render::TexturedScene scene;
  scene.parts = parts;
  scene.towards = made.sources.front();
  render::write_textured_png(options.output.view, scene,
                             picture_options(options.output.picture, options.input.threads));
}

nlohmann::ordered_json as_json(const DistortionSummary& s) {
  return {{"mean", s.mean},
          {"median", s.median},
          {"percentile_95", s.percentile_95},
          {"largest", s.largest},
          {"collapsed_area", s.collapsed_area},
          {"flipped", s.flipped},
          {"flipped_area", s.flipped_area}};
}

void report(const AtlasCommandOptions& options, const Input& input, const AtlasResult& made, Journal& journal) {
  nlohmann::ordered_json j = summary("ahm atlas", options.input.path, options.output, input);
  j["faces"] = made.faces;
  j["uncharted"] = made.uncharted;
  j["sources"] = made.sources;
  j["distortion"] = as_json(made.distortion.all);
  for (std::size_t k = 0; k < made.atlas.charts.size(); ++k) {
    nlohmann::ordered_json chart = {{"source", made.atlas.charts[k].source},
                                    {"faces", made.atlas.charts[k].faces.size()}};
    chart["distortion"] = as_json(made.distortion.charts[k]);
    j["charts"].push_back(chart);
  }
  const TextureAtlas& packed = made.packed;
  j["texture"] = {
      {"size", packed.size}, {"margin", packed.margin}, {"texels_per_unit", packed.scale}, {"filled", packed.filled}};
  const DistortionSummary& d = made.distortion.all;
  const std::string text = fmt::format(
      "{} around {}, {}\n"
      "distortion: mean {:.4g}, median {:.4g}, 95 % of the area below {:.4g}{}; flipped: {:.3g} % of the triangles, "
      "{:.3g} % of the area\n"
      "texture: {} x {}, {:.1f} % filled, {:.4g} texels per unit of length\n",
      counted(made.atlas.charts.size(), "chart"), counted(made.atlas.sources.size(), "source"),
      counted(made.faces, "face"), d.mean, d.median, d.percentile_95,
      d.collapsed_area > 0 ? fmt::format(", {:.2g} % collapses", 100 * d.collapsed_area) : "", 100 * d.flipped,
      100 * d.flipped_area, packed.size, packed.size, 100 * packed.filled, packed.scale);
  deliver(std::move(j), text, options.output, journal);
}

void run(const AtlasCommandOptions& options) {
  check_texture_output(options.input.path, options.output, {".obj", ".glb"}, {"atlas"}, options.texture);
  if (!options.texture.empty()) io::read_image(options.texture);  // reports a bad file before the work
  Journal journal(options.output.verbosity);
  const Input input = open_input(with_named_points(options.input, options.sources), journal);
  const TangentGraph& graph = input.graph();
  SolveOptions solve = options.solve;
  if (input.surface().faces().size() > 0)
    solve.strategy = Strategy::march;  // charts do not need factors of the whole surface
  const Maps maps(solve, input, journal, 0);

  journal.start("sources");
  const std::vector<Vertex> sources = choose_sources(options, input);
  comment_on_positions(input, options.sources, "--sources", journal);
  const SurfaceFaces faces = maps.solver  ? surface_faces(input.surface(), *maps.solver, sources)
                             : maps.polar ? surface_faces(input.surface(), *maps.polar, sources)
                                          : surface_faces(input.surface());
  const std::vector<Vec3> positions = vertex_positions(faces, graph.size());
  journal.start("charts");
  RefineOptions refine;
  if (options.max_distortion) refine.max_distortion = *options.max_distortion;
  const AtlasResult made(options.max_distortion
                             ? make_atlas(maps.maker(), sources, faces.of_vertices(), positions, refine)
                             : make_atlas(maps.maker(), sources, faces.of_vertices()),
                         faces, graph, positions, options.pack);
  comment(options, made, graph, journal);

  journal.start("write");
  write_files(options, faces, made);
  report(options, input, made, journal);
}

void offer(CLI::App& app, AtlasCommandOptions& o) {
  add_input(app, o.input);
  auto* charts = add_parsed(app, "--charts", o.charts, integer_parser(1), "K",
                            "Number of spread sources, each the farthest from those before it (default 20)");
  add_parsed(app, "--sources", o.sources, parse_sources, "SOURCES",
             "Sources instead of --charts: list or file, see below")
      ->excludes(charts);
  add_parsed(
      app, "--max-distortion", o.max_distortion,
      [](const std::string& text) {
        const double value = parse_number(text);
        if (!(value > 1)) throw std::invalid_argument(fmt::format("'{}' is not greater than 1", text));
        return value;
      },
      "D", "Add sources until 99 % of each chart is below distortion D and not flipped");
  add_parsed(app, "--size", o.pack.size, integer_parser(16, 32768), "N",
             "Side of the texture in pixels (default 2048)");
  add_parsed(app, "--margin", o.pack.margin, integer_parser(0, 1024), "N",
             "Empty pixels around each chart (default 4)");
  add_parsed(app, "--texture", o.texture, non_empty, "FILE", "Texture image, PNG or JPEG (default: a checkerboard)");
  add_output(app, o.output)->required();
  add_method(app, o.solve);
  add_graph_options(app, o.input, o.solve);
  add_json(app, o.output);
  add_view(app, o.output)->description("Write a picture of the result: .png");
  add_texture_picture(app, o.output.picture);
  add_verbosity(app, o.output.verbosity);
}

}  // namespace

Subcommand add_atlas(CLI::App& program) {
  return subcommand<AtlasCommandOptions>(
      program, "atlas", "Texture atlas: charts of low distortion, packed into a square", atlas_footer, offer, run);
}

}  // namespace ahm::app
