#include "ahm/applications/decal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "ahm/applications/distortion.hpp"
#include "ahm/applications/inverse_map.hpp"
#include "ahm/io/formats.hpp"
#include "ahm/io/write.hpp"
#include "ahm/view/textured_picture.hpp"
#include "cli/numbers.hpp"
#include "cli/option_adders.hpp"
#include "commands/solve.hpp"
#include "commands/subcommand.hpp"
#include "output/output_paths.hpp"
#include "output/results.hpp"
#include "output/summary.hpp"
#include "output/texture_output.hpp"

namespace ahm::app {
namespace {

constexpr const char* decal_footer =
    "SPEC is 123, x,y,z or face:7:.2,.3,.5 as in 'ahm logmap'; the middle of the image lies there. The image's\n"
    "direction from left to right is the u axis, turned by --angle.\n"
    "\n"
    "OUTPUT  .obj or .glb  the surface in gray and, a little above it, the piece under the image, cut at its borders,\n"
    "                      with its texture (opacity included); of clouds, the piece alone\n"
    "        .ply          the points of INPUT, colored where the image lies on them\n"
    "Where the map is not to be trusted there is no decal, and where it folds it lies on one sheet only.\n"
    "\n"
    "Examples:\n"
    "  ahm decal bowl.ply --image logo.png --source 0,0.2,1.4 --size 0.3 -o bowl.glb --view bowl.png\n"
    "  ahm decal scan.ply --image arrow.png --source 17 --size 0.2 --angle 45 -o painted.ply";

struct DecalCommandOptions {
  InputOptions input;
  SourceOptions source;
  SolveOptions solve;
  OutputOptions output;
  std::string image;
  double size = 0;
  DecalOptions decal;
  std::optional<double> lift;
  double min_quality = trusted_quality;
  bool alone = false;
};

/// From the source to the farthest point of the image.
double reach(const DecalOptions& decal) { return std::min(decal.radius, std::hypot(decal.width, decal.height) / 2); }

/// As far as the image reaches, and a few edges more, so that triangles at its border are whole.
double map_radius(const DecalOptions& decal, const TangentGraph& graph) {
  return reach(decal) + 5 * graph.mean_edge_length() * graph.length_unit();
}

/// What the decal amounts to.
struct Amount {
  DistortionSummary distortion;
  double covered = 0;  ///< share of the image's area that lies on the surface

  Amount(const Decal& decal, const DecalOptions& options) {
    std::vector<std::array<Index, 3>> triangles;
    for (std::size_t f = 0; f + 1 < decal.face_begin.size(); ++f)
      for (Offset c = decal.face_begin[f] + 1; c + 1 < decal.face_begin[f + 1]; ++c) {
        auto& triangle = triangles.emplace_back();
        for (std::size_t k = 0; k < 3; ++k)
          triangle[k] = decal.face_vertices[k == 0 ? decal.face_begin[f] : c + static_cast<Offset>(k) - 1];
      }
    std::vector<double> plane = decal.image_coordinates;
    for (std::size_t i = 0; i + 1 < plane.size(); i += 2)
      plane[i] *= options.mirrored ? -options.width : options.width, plane[i + 1] *= options.height;
    const auto measured = ahm::distortion(decal.points, triangles, plane);
    distortion = summary(measured);
    for (const TriangleDistortion& t : measured)
      if (!std::isnan(t.value())) covered += t.side / options.width * (t.side / options.height) * t.sigma1 * t.sigma2;
    covered = std::min(1.0, covered);  // triangles of clouds may overlap
  }
};

void write_mesh(const DecalCommandOptions& options, const Input& input, const Decal& decal, const Image& image,
                const Vec3& source) {
  const SurfaceFaces faces = options.alone ? SurfaceFaces() : all_faces(input);
  const FacesPart behind(faces, [](std::size_t) { return true; });
  std::vector<double> corners;
  for (Index v : decal.face_vertices)
    for (std::size_t c : {0, 1}) corners.push_back(decal.image_coordinates[2 * static_cast<std::size_t>(v) + c]);
  std::vector<io::MeshPart> parts;
  if (!behind.empty()) parts.push_back(behind.view("surface"));
  io::MeshPart& part = parts.emplace_back();
  part.name = "decal";
  part.points = decal.points, part.normals = decal.normals;
  part.faces = {decal.face_begin, decal.face_vertices};
  part.texture_coordinates = corners;
  part.texture = &image;
  part.transparent = true;
  io::write_textured(options.output.output, parts);
  if (options.output.view.empty()) return;
  view::TexturedScene scene;
  scene.parts = parts;
  scene.towards = source;
  view::write_textured_png(options.output.view, scene, picture_options(options.output.picture, options.input.threads));
}

/// The colors of the input, light gray where there are none, under the image.
std::vector<std::array<std::uint8_t, 3>> painted(const Input& input, const std::vector<double>& places,
                                                 const Image& image) {
  std::vector<std::array<std::uint8_t, 3>> colors = input.geometry.colors;
  colors.resize(input.rows(), {200, 200, 200});
  const RowMap& rows = input.surface().rows();
  for (std::size_t r = 0; r < colors.size(); ++r) {
    const auto vertex = rows.vertex(Row(static_cast<Index>(r)));
    if (!vertex) continue;
    // Of equal points the first one is in the inverse.
    const auto k = static_cast<std::size_t>(rows.row(*vertex)->index);
    if (std::isnan(places[2 * k])) continue;
    const auto texel = image.sample(places[2 * k], places[2 * k + 1]);
    for (std::size_t c = 0; c < 3; ++c) {
      std::uint8_t& color = colors[r][c];
      color = static_cast<std::uint8_t>(std::lround((1 - texel[3]) * color + texel[3] * 255 * texel[c]));
    }
  }
  return colors;
}

void write_points(const DecalCommandOptions& options, const Input& input, const InverseMap& inverse, const Image& image,
                  const Vec3& source) {
  const auto colors = painted(input, image_coordinates_of_vertices(inverse, options.decal), image);
  const std::vector<Vec3> normals = input.normals();
  const io::Geometry& given = input.geometry;
  io::Table table = table_of(given, given.normals, colors);
  table.title = "colored by libahm";
  io::write(options.output.output, table);
  if (options.output.view.empty()) return;
  view::TexturedScene scene;
  scene.points = given.points, scene.colors = colors, scene.normals = normals;
  scene.towards = source;
  view::write_textured_png(options.output.view, scene, picture_options(options.output.picture, options.input.threads));
}

void report(const DecalCommandOptions& options, const Input& input, const Decal& decal, const Amount& amount,
            const Vec3& source, Journal& journal) {
  nlohmann::ordered_json j = summary("ahm decal", options.input.path, options.output, input);
  const DistortionSummary& d = amount.distortion;
  j["image"] = options.image;
  j["source"] = {{"spec", to_string(options.source.spec)}, {"position", source}};
  j["width"] = options.decal.width;
  j["height"] = options.decal.height;
  j["faces"] = decal.face_begin.size() - 1;
  j["hidden"] = decal.hidden;
  j["covered"] = amount.covered;
  j["distortion"] = {{"mean", d.mean}, {"percentile_95", d.percentile_95}, {"largest", d.largest}};
  const std::string text = fmt::format(
      "image {:.4g} x {:.4g}, {:.1f} % of it on the surface, {} faces\n"
      "distortion: mean {:.4g}, 95 % of the area below {:.4g}\n",
      options.decal.width, options.decal.height, 100 * amount.covered, decal.face_begin.size() - 1, d.mean,
      d.percentile_95);
  deliver(std::move(j), text, options.output, journal);
}

void run(const DecalCommandOptions& given) {
  DecalCommandOptions options = given;
  check_texture_output(options.input.path, options.output, {".obj", ".glb", ".ply"}, {"decal"}, options.image);
  const Image image = io::read_image(options.image);
  const double longer = std::max(image.width, image.height);
  options.decal.width = options.size * image.width / longer;
  options.decal.height = options.size * image.height / longer;
  options.decal.lift = options.lift.value_or(0.002 * options.size);

  Journal journal(options.output.verbosity);
  const Input input = open_around(options.input, reach(options.decal), journal, options.source.spec);
  const PlacedSource source = resolve(options.source, input, options.input.threads);
  SolveOptions near = options.solve;
  near.radius = map_radius(options.decal, input.graph());
  const LogMap map = solve(near, input, options.source.spec, source, journal);

  comment_on_quality(quality_of(input, map, input.surface().on_rows(map), options.solve),
                     "lower --size, or choose another source", journal);

  journal.start("decal");
  const InverseMap inverse =
      inverse_map(input.surface(), map, {.min_quality = options.min_quality, .threads = options.solve.threads});
  const Decal decal = make_decal(inverse, options.decal);
  if (decal.face_begin.size() < 2)
    throw InvalidArgument(fmt::format(
        "--source {}: no part of the image lies on a trusted part of the surface; choose another source, or raise "
        "--size, or lower --min-quality",
        to_string(options.source.spec)));
  const Amount amount(decal, options.decal);
  if (amount.covered < 0.9 && std::isinf(options.decal.radius))
    journal.add_warning(
        fmt::format("{:.0f} % of the image do not lie on the surface: it ends there, or the map is not to be trusted",
                    100 - 100 * amount.covered));

  journal.start("write");
  io::lower_extension(options.output.output) == ".ply" ? write_points(options, input, inverse, image, source.position)
                                                       : write_mesh(options, input, decal, image, source.position);
  report(options, input, decal, amount, source.position, journal);
}

void offer(CLI::App& app, DecalCommandOptions& o) {
  add_input(app, o.input);
  add_parsed(app, "--image", o.image, non_empty, "FILE", "PNG or JPEG; its opacity counts")->required();
  add_source(app, o.source, "Where the middle of the image lies")->required();
  add_parsed(app, "--size", o.size, parse_positive, "S", "Longer side of the image, along the surface")->required();
  add_output(app, o.output)->required();
  add_parsed(app, "--angle", o.decal.angle, parse_degrees, "DEG", "Turns the image, from the u axis (default 0)");
  app.add_flag("--mirror", o.decal.mirrored, "Exchange left and right, for clouds whose normals point inwards");
  add_parsed(app, "--radius", o.decal.radius, parse_positive, "R", "Cut off what is farther from the source");
  add_parsed(app, "--lift", o.lift, parse_number, "L", "Above the surface, .obj and .glb (default: S / 500)");
  app.add_flag("--alone", o.alone, "Write the decal without the surface (.obj, .glb)");
  add_min_quality(app, o.min_quality);
  add_u_axis(app, o.source);
  add_method(app, o.solve);
  add_tolerance(app, o.solve);
  add_graph_options(app, o.input, o.solve);
  add_local(app, o.input, "To the corners of the image, or --radius");
  add_json(app, o.output);
  add_view(app, o.output)->description("Draw the result: .png");
  add_texture_picture(app, o.output.picture);
  add_verbosity(app, o.output.verbosity);
}

}  // namespace

Subcommand add_decal(CLI::App& program) {
  return subcommand<DecalCommandOptions>(program, "decal", "An image laid on a surface around a point", decal_footer,
                                         offer, run);
}

}  // namespace ahm::app
