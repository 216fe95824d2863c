#include "ahm/surface/exact/exact_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "ahm/error.hpp"
#include "ahm/util/memory.hpp"
#include "ahm/util/parallel.hpp"
#include "ahm/util/text.hpp"
#include "exact/propagation.hpp"

namespace ahm::exact {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

void check(const PolyhedralSurface& surface, std::span<const MeshPoint> sources, const ExactOptions& options) {
  if (sources.empty()) throw InvalidArgument("'sources' is empty; an exact map needs a source");
  if (!(options.radius > 0))
    throw InvalidArgument("'radius' is " + detail::number(options.radius) + "; it must be > 0");
  if (options.only_targets && options.targets.empty()) throw InvalidArgument("'only_targets' needs 'targets'");
  for (const MeshPoint& p : sources) checked(surface, p, "source");
}

/// Propagates windows from all sources. The memory of the windows is freed on return.
PropagationResult propagate(const PolyhedralSurface& surface, std::span<const MeshPoint> sources,
                            std::span<const MeshPoint> targets, const ExactOptions& options) {
  Propagation windows(surface, options, targets);
  windows.add_sources(sources);
  windows.run(options.progress);
  windows.check_reached();
  return std::move(windows).found();
}

}  // namespace

/// Converts the result of a propagation to a map.
class MapBuilder {
 public:
  MapBuilder(const PolyhedralSurface& surface, std::vector<MeshPoint> sources, std::vector<MeshPoint> targets)
      : surface_(surface) {
    map_.sources_ = std::move(sources);
    map_.targets_ = std::move(targets);
    map_.vertices_ = static_cast<std::size_t>(surface.vertex_count());
    has_source_.assign(map_.vertices_, 0);
    for (const MeshPoint& p : map_.sources_) has_source_[surface.component(p)] = 1;
  }

  ExactMap build(PropagationResult found) {
    map_.origins_ = std::move(found.origins);
    map_.statistics_ = found.statistics;
    const std::size_t rows = map_.vertices_ + map_.targets_.size();
    map_.distance_.reserve(rows);
    map_.direction_.reserve(rows);
    map_.status_.reserve(rows);
    map_.arrival_.reserve(rows);
    for (std::size_t v = 0; v < map_.vertices_; ++v)
      add(found.distance[v], surface_.component(static_cast<Index>(v)), found.horizon, found.reached[v]);
    for (std::size_t k = 0; k < map_.targets_.size(); ++k)
      add(found.target_distance[k], surface_.component(map_.targets_[k]), found.horizon,
          found.reached[map_.vertices_ + k]);
    for (Origin& origin : map_.origins_) origin.direction = scaled(origin.direction, origin.source);
    return std::move(map_);
  }

 private:
  void add(double distance, Index component, double horizon, const ArrivalRecord& reached) {
    const bool ok = distance <= horizon && distance < infinity;
    map_.status_.push_back(ok ? Status::ok : has_source_[component] ? Status::beyond_radius : Status::disconnected);
    map_.distance_.push_back(ok ? distance : nan);
    const Index source = ok ? map_.origins_[reached.origin].source : -1;
    map_.direction_.push_back(ok ? scaled(reached.direction, source) : nan);
    map_.arrival_.push_back(ok ? Arrival{reached.half, reached.origin, reached.from} : Arrival{});
  }
  double scaled(double direction, Index source) const {
    const Index vertex = map_.origins_[source].vertex;
    if (vertex >= 0) return direction * surface_.angle_scale(vertex);
    constexpr double turn = 2 * std::numbers::pi;
    return direction - turn * std::floor(direction / turn);
  }

  const PolyhedralSurface& surface_;
  std::vector<std::uint8_t> has_source_;  ///< per component: whether it contains a source
  ExactMap map_;
};

Vec2 ExactMap::coordinates_at(std::size_t row) const {
  return {distance_[row] * std::cos(direction_[row]), distance_[row] * std::sin(direction_[row])};
}

Index ExactMap::source(Vertex vertex) const {
  const Index origin = arrival_[vertex.index].origin;
  return origin < 0 ? -1 : origins_[origin].source;
}

ExactMap exact_map(const PolyhedralSurface& surface, std::span<const MeshPoint> sources, const ExactOptions& options) {
  check(surface, sources, options);
  return detail::with_memory_check("tracing windows", [&] {
    std::vector<MeshPoint> from, to;
    for (const MeshPoint& p : sources) from.push_back(checked(surface, p, "source"));
    for (const MeshPoint& p : options.targets) to.push_back(checked(surface, p, "target"));
    PropagationResult found = propagate(surface, from, to, options);
    return MapBuilder(surface, std::move(from), std::move(to)).build(std::move(found));
  });
}

ExactMap exact_map(const PolyhedralSurface& surface, const MeshPoint& source, const ExactOptions& options) {
  return exact_map(surface, std::span(&source, 1), options);
}

std::vector<ExactMap> exact_maps(const PolyhedralSurface& surface, std::span<const MeshPoint> sources,
                                 const ExactOptions& options, unsigned threads) {
  std::vector<ExactMap> maps(sources.size());
  detail::parallel_chunks(static_cast<Offset>(sources.size()), 1, threads,
                          [&](Offset begin, Offset) { maps[begin] = exact_map(surface, sources[begin], options); });
  return maps;
}

}  // namespace ahm::exact
