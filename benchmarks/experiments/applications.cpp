// Errors of applications (decals, atlases, tool paths, means) for each method of their maps.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "ahm/applications/atlas.hpp"
#include "ahm/applications/cells.hpp"
#include "ahm/applications/coverage.hpp"
#include "ahm/applications/distortion.hpp"
#include "ahm/applications/inverse_map.hpp"
#include "ahm/applications/mean.hpp"
#include "ahm/error.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/surface/polar_map_solver.hpp"
#include "ahm/util/vec.hpp"
#include "experiments/comparison.hpp"
#include "measure.hpp"

namespace ahm::bench {
namespace {

constexpr int source_count = 3;
constexpr Index chart_count = 12, largest_mesh = 100'000;
/// Radius of decals, of tool paths, and of the points of a mean, as a share of the largest distance.
constexpr double decal_share = 0.15;
constexpr int lines_per_radius = 10;

class Applications {
 public:
  Applications(const Surface& surface, Table& table)
      : surface_(surface), table_(table), geodesics_(surface.mesh()), heat_(surface.graph()), polar_(surface.mesh()) {
    for (const Triangle& t : surface.faces()) corners_.insert(corners_.end(), t.begin(), t.end());
    for (std::size_t k = 0; k <= surface.faces().size(); ++k) begin_.push_back(static_cast<Offset>(3 * k));
    for (int s = 0; s < source_count; ++s) {
      const Vertex source(surface.size() / 11 + s * (surface.size() / source_count));
      const LogMap exact = geodesics_.log_map(source);
      double farthest = 0;
      for (Index i = 0; i < surface.size(); ++i)
        if (exact.status(Vertex(i)) == Status::ok) farthest = std::max(farthest, exact.distance(Vertex(i)));
      radius_.push_back(decal_share * farthest);
      sources_.push_back(source);
      near_.push_back(vertices_within(exact, radius_.back()));
    }
  }

  void measure() {
    for (const Vertex source : sources_) exact_means_.push_back(mean(geodesics_, source));
    measure(heat_);
    measure(polar_);
    measure(geodesics_);
  }

 private:
  std::vector<Vertex> vertices_within(const LogMap& map, double radius) const {
    std::vector<Vertex> result;
    for (Index i = 0; i < surface_.size(); ++i)
      if (map.status(Vertex(i)) == Status::ok && map.distance(Vertex(i)) <= radius) result.emplace_back(i);
    return result;
  }

  LogMap map_of(const AnySolver& maps, Vertex source) const {
    if (maps.method() == Method::heat) return heat_.solve(Source::at_vertex(source), {.threads = 1, .frames = true});
    return maps.map(source, std::numeric_limits<double>::infinity(), true);
  }

  /// The mean of five points around the source.
  Center mean(const AnySolver& maps, Vertex source) const {
    const std::size_t s = std::ranges::find(sources_, source) - sources_.begin();
    std::vector<Vertex> points;
    for (std::size_t k = 0; k < 5; ++k) points.push_back(near_[s][(2 * k + 1) * near_[s].size() / 10]);
    return karcher_mean(maps, points, {}, {.start = source});
  }

  /// Distortion of the faces around a source.
  DistortionSummary decal(const LogMap& map, std::size_t s) const {
    std::vector<char> is_near(static_cast<std::size_t>(surface_.size()), 0);
    for (const Vertex v : near_[s]) is_near[v.index] = 1;
    std::vector<TriangleDistortion> all = distortion(surface_.points(), surface_.faces(), map.coordinates()), inside;
    for (std::size_t f = 0; f < all.size(); ++f)
      if (std::ranges::all_of(surface_.faces()[f], [&](Index v) { return is_near[v] != 0; })) inside.push_back(all[f]);
    return summary(inside);
  }

  void measure(const AnySolver& maps) {
    std::vector<double> decals, flipped, spacings, covered, offsets, times;
    for (std::size_t s = 0; s < sources_.size(); ++s) {
      std::optional<LogMap> map;
      times.push_back(1e3 * seconds([&] { map = map_of(maps, sources_[s]); }));
      const DistortionSummary found = decal(*map, s);
      decals.push_back(found.percentile_95);
      flipped.push_back(found.flipped_area);
      const double spacing = radius_[s] / lines_per_radius;
      const CoveragePath path =
          coverage_path(geodesics_, inverse_map(surface_.mesh(), *map), {.radius = radius_[s], .spacing = spacing});
      for (const CoveragePoint& p : path.points)
        if (std::isfinite(p.spacing)) spacings.push_back(std::abs(p.spacing / spacing - 1));
      covered.push_back(static_cast<double>(std::ranges::count(path.points, false, &CoveragePoint::between)) /
                        static_cast<double>(path.planned));
      const Center center = mean(maps, sources_[s]), &exact = exact_means_[s];
      offsets.push_back(distance(center_position(surface_.mesh(), center), center_position(surface_.mesh(), exact)) /
                        radius_[s]);
    }
    const Atlas atlas =
        make_atlas(maps, farthest_points(surface_.graph(), sources_[0], chart_count), {begin_, corners_});
    const DistortionSummary charts = distortion(atlas, {begin_, corners_}, surface_.points()).all;
    table_.add({surface_.name(), surface_.size(), std::string(to_string(maps.method())), quantile(decals, 0.5),
                quantile(flipped, 0.5), charts.median, charts.percentile_95, charts.flipped_area,
                spacings.empty() ? Cell() : Cell(quantile(spacings, 0.95)), quantile(covered, 0.5),
                quantile(offsets, 0.5), quantile(times, 0.5)});
  }

  const Surface& surface_;
  Table& table_;
  ExactGeodesics geodesics_;
  LogMapSolver heat_;
  PolarMapSolver polar_;
  std::vector<Offset> begin_;
  std::vector<Index> corners_;
  std::vector<Vertex> sources_;
  std::vector<double> radius_;
  std::vector<std::vector<Vertex>> near_;  ///< vertices near each source, in ascending order
  std::vector<Center> exact_means_;
};

}  // namespace

Table applications(const Settings& settings) {
  Table table({"mesh", "vertices", "method", "decal 95% D", "decal flipped", "atlas median D", "atlas 95% D",
               "atlas flipped", "line spacing off by (95%)", "pattern on the surface", "mean off by", "ms a map"});
  const Index n = settings.toy ? 640 : 10000;
  Applications(Surface("sphere", split_icosphere(n)), table).measure();
  Applications(Surface("torus", torus(n)), table).measure();
  Applications(Surface("bumpy sphere", bumpy_sphere(n)), table).measure();
  for_user_surfaces(settings, largest_mesh, [&](const Surface& surface) { Applications(surface, table).measure(); });
  std::string found;
  for (const char* method : {"heat", "polar", "exact"}) {
    const auto median = [&](const char* column) {
      return quantile(table.where("method", method).numbers(column), 0.5);
    };
    found += fmt::format("{}{}: decals {:.2f}, atlases {:.2f}, means {:.4f}", found.empty() ? "" : "; ", method,
                         median("decal 95% D"), median("atlas 95% D"), median("mean off by"));
  }
  table.seen = fmt::format("95 % of D and how far means are off, in radii, medians over meshes. {}.", found);
  return table;
}

}  // namespace ahm::bench
