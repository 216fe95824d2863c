/// \file
/// Shared by the programs ahm-tiles and ahm-mpi: options of maps, progress and summaries.
#pragma once

#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <iostream>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "ahm/error.hpp"
#include "ahm/tiles/march_schedule.hpp"
#include "ahm/tiles/tiled_local_maps.hpp"
#include "ahm/tiles/tiled_log_map.hpp"
#include "ahm/util/text.hpp"

namespace ahm::tiles::program {

/// Arguments of a map or of distances.
struct MapArguments {
  std::string folder, output;
  Variant variant = Variant::adaptive;
  std::vector<std::string> sources{"0"};
  double radius = std::numeric_limits<double>::infinity(), t_coef = 1;
  std::size_t memory = std::size_t{2} << 30;
  unsigned threads = 0;
  Index checkpoint = TiledMapOptions().checkpoint;
};

/// Arguments of local maps.
struct LocalArguments {
  std::string folder, output;
  TiledLocalMapOptions options;
  std::size_t memory = std::size_t{2} << 30;
};

/// Prints each stage to standard error when it begins.
inline Progress progress_printer(const std::string& name) {
  Progress progress;
  progress.report = [name, last = std::string(), begin = std::chrono::steady_clock::now()](std::string_view stage,
                                                                                           double) mutable {
    if (last == stage) return;
    last = stage;
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
    std::cerr << name << ": " << static_cast<int>(seconds.count()) << " s: " << stage << '\n';
  };
  return progress;
}

/// Peak memory of the process, MB.
inline std::size_t peak_megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) / 1024;
}

/// Adds the options of all marches.
inline void add_march_options(CLI::App& app, MapArguments& a) {
  app.add_option("folder", a.folder, "folder of the tiles")->required();
  app.add_option("-o,--output", a.output, "output folder for the map")->required();
  app.add_option("--source", a.sources,
                 "row of the input, or position x,y,z for the nearest vertex; several: map from the nearest source")
      ->capture_default_str();
  app.add_option("--radius", a.radius, "map only vertices within this distance of the source");
  app.add_option("--t-coef", a.t_coef, "diffusion time in squared mean edge lengths")->capture_default_str();
  app.add_option("--memory", a.memory, "memory for tiles of the graph and of the map, such as 2GB; bands require more")
      ->transform(CLI::AsSizeValue(false));
  app.add_option("--checkpoint", a.checkpoint,
                 "save a checkpoint after this many bands, from which a killed run can resume; 0: never")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
}

/// Adds the options of maps with coordinates.
inline void add_map_options(CLI::App& app, MapArguments& a) {
  std::map<std::string, Variant> named;
  for (Variant variant : all_variants) named.emplace(to_string(variant), variant);
  const auto take = [&a, named](const std::string& name) { a.variant = named.at(name); };
  app.add_option_function<std::string>("--variant", take, "variant of the heat method")
      ->check(CLI::IsMember(named))
      ->default_str(std::string(to_string(a.variant)));
}

inline void add_local_options(CLI::App& app, LocalArguments& a) {
  a.options.maps.bound_by_straight_line = true;  // as in `ahm local-maps`
  app.add_option("folder", a.folder, "folder of the tiles")->required();
  app.add_option("-o,--output", a.output, "output folder for the maps")->required();
  app.add_option("--radius", a.options.maps.radius, "radius of each map")->required();
  app.add_option("--k", a.options.maps.k, "keep only the K nearest vertices of each map; 0: all")
      ->capture_default_str();
  app.add_option("--feature", a.options.features,
                 "write features instead of maps: count, area, curvature, mean:FILE.npy (mean of one number per row of "
                 "the input)");
  app.add_option("--memory", a.memory, "memory for tiles of the graph, such as 2GB; the maps of a tile require more")
      ->transform(CLI::AsSizeValue(false));
  app.add_option("--threads", a.options.maps.heat.threads, "number of threads; 0: one per core")->capture_default_str();
}

inline void add_deal_option(CLI::App& app, Deal& deal) {
  app.add_option("--deal", deal,
                 "assignment of tiles to ranks: arrival (default; the tiles that the front reaches next go to "
                 "different ranks), "
                 "cards (every K-th tile) or ranges (consecutive tiles)")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, Deal>{{"ranges", Deal::ranges}, {"cards", Deal::cards}, {"arrival", Deal::arrival}}))
      ->option_text("NAME");
}

inline Vec3 parse_position(const std::string& text) {
  const std::vector<std::string> words = CLI::detail::split(text, ',');
  Vec3 position{};
  bool good = words.size() == 3;
  for (std::size_t c = 0; good && c < 3; ++c)
    good = CLI::detail::lexical_cast(words[c], position[c]) && std::isfinite(position[c]);
  if (!good) throw InvalidArgument("--source '" + text + "': expected a row or a position x,y,z");
  return position;
}

/// The vertices of the sources. Reads all tiles once for the rows, and once more for each position.
inline std::vector<Vertex> source_vertices(const TiledGraph& graph, const std::vector<std::string>& texts) {
  std::vector<Row> rows;
  for (const std::string& text : texts) {
    Index row = 0;
    if (text.find(',') != std::string::npos) continue;
    if (!CLI::detail::lexical_cast(text, row))
      throw InvalidArgument("--source '" + text + "': expected a row or a position x,y,z");
    rows.emplace_back(row);
  }
  const auto of_rows = graph.vertices_of_rows(rows);
  std::vector<Vertex> result;
  std::size_t next = 0;
  for (const std::string& text : texts) {
    if (text.find(',') != std::string::npos) {
      result.push_back(graph.nearest_vertex(parse_position(text)));
      continue;
    }
    const auto vertex = of_rows[next++];
    if (!vertex)
      throw InvalidArgument("--source " + text + ": this row was removed from the surface; choose another row");
    result.push_back(*vertex);
  }
  return result;
}

inline std::vector<Vec3> positions_of(const TiledGraph& graph, const std::vector<Vertex>& vertices) {
  std::vector<Vec3> result;
  for (Vertex vertex : vertices) result.push_back(graph.frame(vertex.index)->origin);
  return result;
}

inline Source source_at(const std::vector<Vertex>& vertices) { return Source::at_vertices(vertices); }

/// The options of a map. Half of the memory is for tiles of the graph, half for tiles of the map.
inline TiledMapOptions map_options(const MapArguments& a, bool coordinates) {
  TiledMapOptions options;
  options.coordinates = coordinates;
  options.checkpoint = a.checkpoint;
  options.radius = a.radius;
  options.memory = a.memory / 2;
  options.heat.t_coef = a.t_coef;
  options.heat.threads = a.threads;
  options.heat.variant = a.variant;
  return options;
}

inline void print_map(const TiledMapSummary& s, Index vertices, bool coordinates) {
  if (s.begun_at > 0) std::cout << "resumed after band " << s.begun_at << " of an unfinished run\n";
  std::cout << s.ok << " of " << vertices << " vertices have " << (coordinates ? "coordinates" : "distances")
            << ", largest distance " << s.farthest << '\n'
            << detail::counted(s.march.bands, "band") << ", the largest with " << s.march.largest_band << " vertices";
}

}  // namespace ahm::tiles::program
