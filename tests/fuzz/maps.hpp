/// \file
/// Laws of maps and surfaces, and options from the bytes of a fuzzer.
#pragma once

#include <cstring>
#include <vector>

#include "ahm/graph/validate.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/surface/mesh_topology.hpp"
#include "ahm/surface/surface.hpp"
#include "bytes.hpp"

namespace ahm::fuzz {

inline void check_map(const LogMap& map) {
  const auto d = static_cast<std::size_t>(map.dimension());
  for (Index i = 0; i < map.size(); ++i) {
    const bool ok = map.status(Vertex(i)) == Status::ok;
    for (const double x : map.coordinates(Vertex(i)))
      require(ok ? std::isfinite(x) : std::isnan(x), "coordinates are NaN exactly where the status is not ok");
    const double distance = map.distance(Vertex(i));
    require(ok ? distance >= 0 : std::isnan(distance), "distances are >= 0 where ok and NaN elsewhere");
    require(map.coordinates(Vertex(i)).size() == d, "d coordinates");
  }
}

inline bool same_bits(std::span<const double> a, std::span<const double> b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size_bytes()) == 0);
}

/// Solves for maps on a valid graph, with options and sources from the bytes.
inline void solve(const TangentGraph& graph, Bytes& bytes) {
  HeatOptions options{.threads = 1};
  const std::uint8_t flags = bytes.byte();
  options.variant = (flags & 1) != 0 ? Variant::localized : Variant::adaptive;
  options.strategy = (flags & 4) != 0 ? Strategy::march : Strategy::global;
  options.ordering = (flags & 16) != 0 ? Ordering::nested_dissection : Ordering::automatic;
  if ((flags & 32) != 0) options.t_coef = bytes.coordinate((flags & 64) != 0);
  const LogMapSolver solver(graph, options);
  std::vector<Source> sources;
  const int count = 1 + bytes.byte() % 6;
  for (int k = 0; k < count; ++k) sources.push_back(Source::at_vertex(Vertex(bytes.number(graph.size() - 1))));
  MapOptions map_options;
  if ((flags & 128) != 0) map_options.radius = bytes.coordinate(true);
  const std::vector<LogMap> maps = solver.solve(sources, map_options);
  for (const LogMap& map : maps) check_map(map);
  const LogMap first = solver.solve(std::span(sources), map_options).front();
  require(same_bits(maps.front().coordinates(), first.coordinates()) &&
              same_bits(maps.front().distances(), first.distances()),
          "a repeated map has the same bits");
}

inline void check_surface(const Surface& surface, Bytes& bytes) {
  validate(surface.graph());
  (void)surface.report();
  (void)surface.warnings();
  solve(surface.graph(), bytes);
}

/// The largest index of a vertex in faces: valid, or (bit 2) one too large.
inline Index largest_corner(std::size_t vertices, std::uint8_t flags) {
  return static_cast<Index>(vertices) - ((flags & 2) == 0 && vertices > 0 ? 1 : 0);
}

template <class Options>
Options mesh_options(std::uint8_t flags) {
  Options options{.threads = 1};
  options.non_manifold = (flags & 4) == 0 ? NonManifold::split : NonManifold::error;
  options.intrinsic_delaunay = (flags & 8) == 0;
  options.clamp_weights = (flags & 16) == 0;
  return options;
}

}  // namespace ahm::fuzz
