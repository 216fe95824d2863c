/// \file
/// What holds of every map.
#pragma once

#include <cstring>
#include <vector>

#include "ahm/graph/validate.hpp"
#include "ahm/maps/log_map_solver.hpp"
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

inline bool same(const LogMap& a, const LogMap& b) {
  return same_bits(a.coordinates(), b.coordinates()) && same_bits(a.distances(), b.distances());
}

/// Everything a solver is asked for, on a graph that keeps its laws.
inline void solve(const TangentGraph& graph, Bytes& bytes) {
  HeatOptions options{.threads = 1};
  const std::uint8_t way = bytes.byte();
  options.variant = (way & 1) != 0 ? Variant::localized : Variant::adaptive;
  options.strategy = (way & 4) != 0 ? Strategy::march : Strategy::global;
  options.ordering = (way & 16) != 0 ? Ordering::nested_dissection : Ordering::amd;
  if ((way & 32) != 0) options.t_coef = bytes.coordinate((way & 64) != 0);
  const LogMapSolver solver(graph, options);
  std::vector<Source> sources;
  const int count = 1 + bytes.byte() % 6;
  for (int k = 0; k < count; ++k) sources.push_back(Source::at_vertex(Vertex(bytes.number(graph.size() - 1))));
  MapOptions map_options;
  if ((way & 128) != 0) map_options.radius = bytes.coordinate(true);
  const std::vector<LogMap> maps = solver.solve(sources, map_options);
  for (const LogMap& map : maps) check_map(map);
  require(same(maps.front(), solver.solve(std::span(sources), map_options).front()), "a map again is the same bits");
}

/// What every surface that could be built has to stand.
inline void check_surface(const Surface& surface, Bytes& bytes) {
  validate(surface.graph());
  (void)surface.report();
  (void)surface.warnings();
  solve(surface.graph(), bytes);
}

}  // namespace ahm::fuzz
