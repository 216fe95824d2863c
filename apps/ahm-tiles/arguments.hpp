/// \file
/// What the programs ahm-tiles and ahm-mpi have in common: the options of maps, and how they tell what they do.
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

namespace ahm::tiles::program {

struct MapArguments {
  std::string folder, output;
  Variant variant = Variant::adaptive;
  std::vector<std::string> sources{"0"};
  double radius = std::numeric_limits<double>::infinity(), t_coef = 1;
  std::size_t memory = std::size_t{2} << 30;
  unsigned threads = 0;
  Index checkpoint = TiledMapOptions().checkpoint;
};

struct LocalArguments {
  std::string folder, output;
  TiledLocalMapOptions options;
  std::size_t memory = std::size_t{2} << 30;
};

/// Stages as they begin, on standard error.
inline Progress telling(const std::string& name) {
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

inline std::size_t peak_megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) / 1024;
}

/// Of whatever is marched.
inline void add_march_options(CLI::App& app, MapArguments& a) {
  app.add_option("folder", a.folder, "of tiles")->required();
  app.add_option("-o,--output", a.output, "folder for the map")->required();
  app.add_option("--source", a.sources,
                 "row of the input, or position x,y,z: the vertex nearest to it; several: from the nearest of them")
      ->capture_default_str();
  app.add_option("--radius", a.radius, "no farther than this");
  app.add_option("--t-coef", a.t_coef, "diffusion time over the square of the mean edge length")->capture_default_str();
  app.add_option("--memory", a.memory, "for tiles of the graph and of the map, as 2GB; bands come on top")
      ->transform(CLI::AsSizeValue(false));
  app.add_option("--checkpoint", a.checkpoint, "bands after which a run that is killed may go on; 0: never")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
}

/// Of maps with coordinates.
inline void add_map_options(CLI::App& app, MapArguments& a) {
  std::map<std::string, Variant> named;
  for (Variant variant : all_variants) named.emplace(to_string(variant), variant);
  const auto take = [&a, named](const std::string& name) { a.variant = named.at(name); };
  app.add_option_function<std::string>("--variant", take, "of the diffusion")
      ->check(CLI::IsMember(named))
      ->default_str(std::string(to_string(a.variant)));
}

inline void add_local_options(CLI::App& app, LocalArguments& a) {
  a.options.maps.bound_by_straight_line = true;  // as the maps of ahm local-maps
  app.add_option("folder", a.folder, "of tiles")->required();
  app.add_option("-o,--output", a.output, "folder for the maps")->required();
  app.add_option("--radius", a.options.maps.radius, "how far each map goes")->required();
  app.add_option("--nearest", a.options.maps.nearest, "keep only so many of each; 0: all")->capture_default_str();
  app.add_option(
      "--feature", a.options.features,
      "keep of each map only these: count, area, curvature, mean:FILE.npy (of a number per row of the input)");
  app.add_option("--memory", a.memory, "for tiles of the graph, as 2GB; the maps of a tile come on top")
      ->transform(CLI::AsSizeValue(false));
  app.add_option("--threads", a.options.maps.heat.threads, "0: one per core")->capture_default_str();
}

inline void add_deal_option(CLI::App& app, Deal& deal) {
  app.add_option(
         "--deal", deal,
         "which tiles a rank owns: arrival (of those that the front comes to next, one each; the default), cards "
         "(every K-th) or ranges (successive ones)")
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
  if (!good) throw InvalidArgument("--source '" + text + "' is neither a row nor a position x,y,z");
  return position;
}

/// Rows by one pass over the tiles, each position by one of its own.
inline std::vector<Vertex> source_vertices(const TiledGraph& graph, const std::vector<std::string>& texts) {
  std::vector<Row> rows;
  for (const std::string& text : texts) {
    Index row = 0;
    if (text.find(',') != std::string::npos) continue;
    if (!CLI::detail::lexical_cast(text, row))
      throw InvalidArgument("--source '" + text + "' is neither a row nor a position x,y,z");
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
    if (!vertex) throw InvalidArgument("row " + text + " was removed from the surface; choose another one");
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

/// Half of the memory is for the graph's tiles, half for the map's.
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
  if (s.begun_at > 0) std::cout << "went on after band " << s.begun_at << " of a run that did not end\n";
  std::cout << s.ok << " of " << vertices << " vertices have " << (coordinates ? "coordinates" : "distances")
            << ", the farthest at " << s.farthest << '\n'
            << s.march.bands << " bands, the largest of " << s.march.largest_band << " vertices";
}

}  // namespace ahm::tiles::program
