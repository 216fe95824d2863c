#include "ahm/applications/decal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "ahm/applications/distortion.hpp"
#include "ahm/applications/inverse_map.hpp"
#include "ahm/io/formats.hpp"
#include "ahm/io/write.hpp"
#include "ahm/maps/quality.hpp"
#include "ahm/render/textured_picture.hpp"
#include "cli/option_adders.hpp"
#include "cli/source_list.hpp"
#include "commands/solve.hpp"
#include "commands/subcommand.hpp"
#include "output/output_paths.hpp"
#include "output/results.hpp"
#include "output/summary.hpp"
#include "output/texture_output.hpp"

namespace ahm::app {
namespace {

constexpr const char* decal_footer =
    "SPEC is 123, x,y,z (the nearest vertex) or face:7:0.2,0.3,0.5 as in 'ahm logmap'. It is the center of the\n"
    "image. The image runs from left to right along the u axis, turned by --angle.\n"
    "\n"
    "OUTPUT  .obj or .glb  the surface in gray, and slightly above it the part under the image, cut at the borders of\n"
    "                      the image, with the image as texture (including opacity); for clouds only that part\n"
    "        .ply          the points of INPUT, with the colors of the image where it covers them; points that\n"
    "                      --voxel replaced get the color of the nearest point that remains\n"
    "Parts of the surface where the quality of the map is below --min-quality stay uncovered. Where the map folds,\n"
    "the image covers one sheet only.\n"
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
  double min_quality = reliable_quality;
  bool alone = false;
};

/// Figures of the report.
struct Amount {
  DistortionSummary distortion;
  double covered = 0;  ///< share of the image's area that is on the surface

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

void write_view(const DecalCommandOptions& options, render::TexturedScene scene, const Vec3& source) {
  if (options.output.view.empty()) return;
  scene.towards = source;
  render::write_textured_png(options.output.view, scene,
                             picture_options(options.output.picture, options.input.threads));
}

void write_mesh(const DecalCommandOptions& options, const Input& input, const Decal& decal, const Image& image,
                const Vec3& source) {
  const DecalMesh mesh(options.alone ? SurfaceFaces() : all_faces(input), decal, image);
  io::write_textured(options.output.output, mesh.parts());
  render::TexturedScene scene;
  scene.parts = mesh.parts();
  write_view(options, scene, source);
}

void write_points(const DecalCommandOptions& options, const Input& input, const InverseMap& inverse, const Image& image,
                  const Vec3& source) {
  const auto colors = painted(input, image_coordinates_of_vertices(inverse, options.decal), image);
  io::write(options.output.output, painted_table(input, colors));
  const std::vector<Vec3> normals = input.normals(), drawn = drawn_points(input, options.input);
  render::TexturedScene scene;
  scene.points = drawn.empty() ? input.geometry.points : drawn;
  scene.colors = colors, scene.normals = normals;
  write_view(options, scene, source);
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
      "image {:.4g} x {:.4g}, {:.1f} % of it on the surface; faces: {}\n"
      "distortion: mean {:.4g}, 95 % of the area below {:.4g}\n",
      options.decal.width, options.decal.height, 100 * amount.covered, decal.face_begin.size() - 1, d.mean,
      d.percentile_95);
  deliver(std::move(j), text, options.output, journal);
}

/// Whether the output is the input's points with colors, and not a mesh.
bool is_points(const OutputOptions& output) { return io::lower_extension(output.output) == ".ply"; }

void run(const DecalCommandOptions& given) {
  DecalCommandOptions options = given;
  check_texture_output(options.input.path, options.output, {".obj", ".glb", ".ply"}, {"decal"}, options.image);
  if (is_points(options.output) && (options.lift || options.alone))
    throw InvalidArgument(
        "--lift and --alone require .obj or .glb output; a .ply file contains the points of INPUT with colors");
  const Image image = io::read_image(options.image);
  const DecalOptions usual = decal_of(image, options.size);
  options.decal.width = usual.width, options.decal.height = usual.height;
  options.decal.lift = options.lift.value_or(usual.lift);

  Journal journal(options.output.verbosity);
  const Input input = open_around(options.input, reach(options.decal), journal, options.source.spec);
  const SurfaceSource source = resolve(options.source, input, options.input.threads);
  comment_on_positions(input, std::span(&options.source.spec, 1), "--source", journal);
  SolveOptions near = options.solve;
  near.radius = map_radius(options.decal, input.graph());
  const LogMap map = solve(near, input, options.source.spec, source, journal);

  const std::vector<double> quality = map_quality(input.graph(), map, options.solve.threads);
  comment_on_quality(to_rows(input.surface().to_rows(map), quality), "lower --size, or choose another source", journal);

  journal.start("decal");
  const InverseMap inverse =
      inverse_map(input.surface(), map, {.min_quality = options.min_quality, .quality = quality});
  const Decal decal = make_decal(inverse, options.decal);
  if (decal.face_begin.size() < 2)
    throw InvalidArgument(fmt::format(
        "--source {}: the image covers no part of the surface where the map is reliable; choose another source, raise "
        "--size, or lower --min-quality",
        to_string(options.source.spec)));
  const Amount amount(decal, options.decal);
  if (amount.covered < 0.9 && std::isinf(options.decal.radius))
    journal.add_warning(
        fmt::format("{:.0f} % of the image is not on the surface: the surface ends there, or the map is not reliable",
                    100 - 100 * amount.covered));

  journal.start("write");
  is_points(options.output) ? write_points(options, input, inverse, image, source.position)
                            : write_mesh(options, input, decal, image, source.position);
  report(options, input, decal, amount, source.position, journal);
}

void offer(CLI::App& app, DecalCommandOptions& o) {
  add_input(app, o.input);
  add_parsed(app, "--image", o.image, non_empty, "FILE",
             "Image to place on the surface, PNG or JPEG; its opacity is used")
      ->required();
  add_source(app, o.source, "Center of the image on the surface, see below")->required();
  add_parsed(app, "--size", o.size, parse_positive, "S", "Length of the longer side of the image, along the surface")
      ->required();
  add_output(app, o.output)->required();
  add_parsed(app, "--angle", o.decal.angle, parse_degrees, "DEG",
             "Angle from the u axis to the image's horizontal, in degrees (default 0)");
  app.add_flag("--mirror", o.decal.mirrored, "Swap left and right, for clouds whose normals point inward");
  add_parsed(app, "--radius", o.decal.radius, parse_positive, "R",
             "Cut the image off at this distance from the source");
  add_parsed(app, "--lift", o.lift, parse_number, "L",
             "Height of the decal above the surface, for .obj and .glb (default: S / 500)");
  app.add_flag("--alone", o.alone, "Write the decal without the surface (.obj, .glb)");
  add_min_quality(app, o.min_quality);
  add_u_axis(app, o.source);
  add_method(app, o.solve);
  add_graph_options(app, o.input, o.solve);
  add_local(app, o.input, "Up to the corners of the image, or to --radius");
  add_json(app, o.output);
  add_view(app, o.output)->description("Write a picture of the result: .png");
  add_texture_picture(app, o.output.picture);
  add_verbosity(app, o.output.verbosity);
}

}  // namespace

Subcommand add_decal(CLI::App& program) {
  return subcommand<DecalCommandOptions>(program, "decal", "Image placed on a surface around a point", decal_footer,
                                         offer, run);
}

}  // namespace ahm::app
