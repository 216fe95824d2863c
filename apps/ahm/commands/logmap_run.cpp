#include "commands/logmap_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <utility>

#include "ahm/error.hpp"
#include "ahm/io/atomic_file.hpp"
#include "ahm/io/formats.hpp"
#include "ahm/maps/quality.hpp"
#include "ahm/util/parallel.hpp"
#include "ahm/util/vec.hpp"
#include "cli/console.hpp"
#include "cli/source_list.hpp"
#include "commands/logmap_report.hpp"
#include "commands/solve.hpp"
#include "input/left_out.hpp"
#include "output/output_paths.hpp"
#include "output/results.hpp"
#include "output/texture_output.hpp"

namespace ahm::app {
namespace {

/// Failures of the maps of one file.
constexpr std::size_t most_told = 10;

void write_results(const LogmapOptions& options, const PlacedSource& source, const RowLogMap& rows,
                   const std::vector<double>& quality, const std::vector<Vec3>& away, Results& results,
                   Journal& journal) {
  io::Table table = results.table();
  add_map(table, rows, quality);
  if (!away.empty()) table.add({"gx", "gy", "gz"}, away);
  view::Scene scene = results.scene(rows, quality, source);
  scene.told.source = to_string(options.source.spec);
  results.write(table, scene, journal);
}

/// The faces as they were given, with the map at their corners.
void write_corners(const std::string& path, const Input& input, const LogMap& map) {
  const Surface& surface = input.surface();
  if (surface.faces().size() == 0) throw InvalidArgument("--corners " + path + ": the surface has no faces");
  const SurfaceFaces faces = given_faces(input.geometry);
  const std::vector<double> coordinates = at_given_corners(input, surface.on_corners(map));
  const auto is_mapped = [&](std::size_t f) {
    return std::all_of(coordinates.begin() + 2 * faces.begin[f], coordinates.begin() + 2 * faces.begin[f + 1],
                       [](double x) { return !std::isnan(x); });
  };
  const FacesPart mapped(faces, is_mapped, coordinates);
  const FacesPart rest(faces, [&](std::size_t f) { return !is_mapped(f); });
  std::vector<io::MeshPart> parts;
  if (!mapped.empty()) parts.push_back(mapped.view("map"));
  if (!rest.empty()) parts.push_back(rest.view("rest"));
  std::vector<io::Property> properties = input.geometry.properties;
  for (io::Property& property : properties) property.name = input_column(property.name);
  for (io::MeshPart& part : parts) part.colors = input.geometry.colors, part.properties = properties;
  io::write_textured(path, parts);
}

/// @throws InvalidArgument where OUTPUT is a file for textures
void check_for_rows(const OutputOptions& output) {
  const std::string extension = io::lower_extension(output.output);
  const auto is_in = [&](io::Use use) {
    const std::vector<std::string> all = io::extensions(use);
    return std::find(all.begin(), all.end(), extension) != all.end();
  };
  if (output.format.empty() && is_in(io::Use::write_textured) && !is_in(io::Use::write))
    throw InvalidArgument(fmt::format(
        "--output {0}: {1} files have no rows for numbers; --corners {0} writes the faces with u,v at their corners",
        output.output, extension));
}

/// From a source on an input that is open. @param maps  of the input; made where there are none yet
/// @param count  of maps that `maps` is to make
/// @param is_named  whether the summary says of which input it is
void map_from_source(const LogmapOptions& options, const Input& input, std::optional<Maps>& maps, std::size_t count,
                     bool is_named, Journal& journal) {
  const PlacedSource source = resolve(options.source, input, options.input.threads);
  comment_on_positions(input, std::span(&options.source.spec, 1), "--source", journal);
  if (!maps) maps.emplace(options.solve, input, journal, static_cast<int>(count));
  std::optional<LogMap> solved;
  std::optional<QualityFront> front;
  const auto solve = [&] { solved = maps->map(options.solve, input, options.source.spec, source, journal); };
  const std::stop_token stop = journal.progress().stop;
  const auto unfold = [&] {
    if (maps->solver) front.emplace(input.graph(), source.source, map_options(options.solve).radius, stop);
  };
  detail::run_both(options.solve.threads, solve, unfold);
  const LogMap& map = *solved;
  RowLogMap rows = input.surface().on_rows(map, options.solve.threads);
  const std::vector<double> quality =
      on_rows(rows, front ? map_quality(input.graph(), map, *front, options.solve.threads)
                          : map_quality(input.graph(), map, options.solve.threads));
  front.reset();
  if (options.input.around_source) settle_left_out(input, source, *options.solve.radius, rows);
  comment_on_statuses(rows.status, options.input.path, journal);
  comment_on_quality(quality, "keep to what is near with --radius, or start elsewhere", journal);

  Results results(options.output, input, options.input);
  const std::vector<Vec3> away =
      options.gradient ? distance_gradients(input.surface(), map, rows) : std::vector<Vec3>();
  write_results(options, source, rows, quality, away, results, journal);
  if (!options.corners.empty()) write_corners(options.corners, input, map);
  report({options.input.path, options.source.spec, options.solve, input, maps->solver, source, map, rows, quality,
          is_named},
         options.output, journal);
}

/// Whether the surface depends on the source.
bool is_made_for_source(const LogmapOptions& options) {
  return options.input.around_source || options.input.voxel || options.input.outliers;
}

}  // namespace

void check_log_map(const LogmapOptions& options, const std::vector<std::string>& inputs) {
  check_for_rows(options.output);
  check_results(options.input.path, options.output);
  around_source(options.input, options.solve.radius);  // checks
  const OutputOptions& output = options.output;
  std::vector<OutputPath> files{{"--output", output.output}, {"--json", output.json}, {"--view", output.view}};
  if (!options.corners.empty()) {
    files.push_back({"--corners", options.corners});
    check_ending(files.back(), io::extensions(io::Use::write_textured));
    if (io::lower_extension(options.corners) == ".obj")
      files.push_back({"--corners", std::filesystem::path(options.corners).replace_extension(".mtl").string()});
  }
  check_outputs(inputs, files, output.keep_existing);
}

bool attempt(const std::string& what, bool alone, const std::function<void()>& work, bool tells) {
  if (alone) return work(), true;
  try {
    io::FileSet files;
    work();
    return true;
  } catch (const Cancelled&) {
    throw;
  } catch (const Error& e) {
    if (tells) say(fmt::format("ahm: error: {}: {}\n", what, worded(e)));
    return false;
  }
}

std::size_t run_log_maps(const std::vector<LogmapOptions>& maps, bool alone) {
  const LogmapOptions& first = maps.front();
  std::optional<Journal> journal(std::in_place, first.output.verbosity);
  io::Geometry geometry = read_input(first.input, *journal);
  std::optional<Input> input;
  std::optional<Maps> solvers;
  const bool for_source = is_made_for_source(first), one = maps.size() == 1;
  if (!for_source)
    input.emplace(open_input(std::exchange(geometry, {}), first.input, *journal,
                             one ? std::optional(first.source.spec) : std::nullopt));
  std::size_t failed = 0;
  for (const LogmapOptions& map : maps) {
    if (!journal) journal.emplace(map.output.verbosity);
    const auto work = [&] {
      if (for_source) {
        solvers.reset();
        input.emplace(open_input(geometry, around_source(map.input, map.solve.radius), *journal, map.source.spec));
      }
      map_from_source(map, *input, solvers, for_source ? 1 : maps.size(), !alone, *journal);
    };
    failed += !attempt(map.input.path, alone, work, failed < most_told);
    journal.reset();
  }
  if (failed > most_told)
    say(fmt::format("ahm: error: {}: {} more of its maps failed\n", first.input.path, failed - most_told));
  return failed;
}

}  // namespace ahm::app
