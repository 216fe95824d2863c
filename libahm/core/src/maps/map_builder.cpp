#include "maps/map_builder.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "ahm/error.hpp"
#include "ahm/util/parallel.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/text.hpp"
#include "maps/affine_heat.hpp"

namespace ahm {
namespace {

/// The result of a solve at a vertex, without its coordinates; world units.
struct SolvedValue {
  Status status;
  double root_mean_square = 0;  ///< sqrt(q / lambda)
  double distance = 0;          ///< distance by heat
};

/// The values of a march.
class MarchValues {
 public:
  MarchValues(const March& march, double radius) : march_(march), radius_(radius) {}

  SolvedValue read(Index vertex, std::span<double> phi) const {
    const auto found = march_.coordinates(vertex);
    std::copy(found.begin(), found.end(), phi.begin());
    if (march_.accepted(vertex)) return {Status::ok, march_.root_mean_square(vertex), march_.distance(vertex)};
    return {std::isinf(radius_) ? Status::unreached : Status::beyond_radius};
  }
  void axes(Index vertex, double* out) const { march_.axes(vertex, out); }

 private:
  const March& march_;
  double radius_;
};

/// The values of a global solve for source number s.
class GlobalValues {
 public:
  GlobalValues(const AffineHeat& heat, std::size_t s) : heat_(heat), s_(s), frames_(heat.frames(s)) {}

  SolvedValue read(Index vertex, std::span<double> phi) const {
    heat_.coordinates_at(s_, vertex, phi.data());
    return {heat_.reached(s_, vertex) ? Status::ok : Status::unreached, heat_.root_mean_square_at(s_, vertex),
            heat_.distance_at(s_, vertex)};
  }
  void axes(Index vertex, double* out) const { frames_.axes(vertex, out); }

 private:
  const AffineHeat& heat_;
  std::size_t s_;
  FrameField frames_;
};

}  // namespace

MapSettings::MapSettings(const MapOptions& map, const HeatOptions& options)
    : variant(map.variant.value_or(options.variant)),
      radius(map.radius),
      frames(map.frames),
      spread(map.spread && map.distances),
      distances(map.distances),
      progress(map.progress.value_or(options.progress)) {
  if (!(radius > 0))
    throw InvalidArgument("radius is " + detail::number(radius) + "; it must be > 0 (infinity: the whole graph)");
}

MarchGoal MapSettings::goal() const {
  return distances || std::isfinite(radius) ? MarchGoal::map : MarchGoal::coordinates;
}

LogMap MapBuilder::build(const AffineHeat& heat, std::size_t s, const Source& source, const FrontDistances& front,
                         const MapSettings& map, unsigned threads) const {
  return build(GlobalValues(heat, s), Strategy::global, {}, source, front, map, threads);
}

LogMap MapBuilder::build(const March& march, const Source& source, const FrontDistances& front, const MapSettings& map,
                         unsigned threads) const {
  return build(MarchValues(march, map.radius), Strategy::march, march.statistics(), source, front, map, threads);
}

template <class Values>
LogMap MapBuilder::build(const Values& values, Strategy strategy, const MarchStatistics& march, const Source& source,
                         const FrontDistances& front, const MapSettings& map, unsigned threads) const {
  const auto n = static_cast<std::size_t>(graph_.size()), d = static_cast<std::size_t>(graph_.dimension());
  const SourceComponents components(source, component_);
  std::vector<double> coordinates(n * d);
  std::vector<Status> status(n);
  MapExtras extras;
  extras.march = march;
  if (map.distances) extras.distances.resize(n);
  if (map.spread) extras.spread.resize(n);
  extras.directions = front.directions;
  extras.direction_errors = front.direction_errors;
  extras.nearest = front.nearest;
  extras.radius = map.radius;
  if (map.frames) extras.frames.resize(n * d * d);
  detail::for_each_index(n, threads, [&](std::size_t i) {
    const auto vertex = static_cast<Index>(i);
    const std::span phi = std::span(coordinates).subspan(i * d, d);
    const SolvedValue value = values.read(vertex, phi);
    const VertexRow row = vertex_row({phi, value.root_mean_square, value.distance});
    status[i] = !components.hold(vertex)     ? Status::disconnected
                : value.status == Status::ok ? row.status
                                             : value.status;
    if (map.distances) extras.distances[i] = front.distances.empty() ? row.distance : front.distances[i];
    if (!extras.spread.empty()) extras.spread[i] = row.spread;
    if (map.frames) values.axes(vertex, extras.frames.data() + i * d * d);
  });
  if (map.distances && front.distances.empty()) set_source_distances(source, extras.distances);
  for (const auto& [vertex, known] : SourceVertices(source, graph_.dimension())) {
    if (known.vector.empty()) continue;
    std::copy(known.vector.begin(), known.vector.end(), coordinates.begin() + static_cast<std::ptrdiff_t>(vertex * d));
    if (!extras.spread.empty()) extras.spread[vertex] = 0;
  }
  for (std::size_t i = 0; i < n; ++i) {
    const std::span phi = std::span(coordinates).subspan(i * d, d);
    const double distance = map.distances ? extras.distances[i] : length(phi);
    if (status[i] == Status::ok && distance > map.radius) status[i] = Status::beyond_radius;
    if (status[i] == Status::ok) continue;
    std::ranges::fill(phi, NAN);
    if (map.distances) extras.distances[i] = NAN;
    if (!extras.spread.empty()) extras.spread[i] = NAN;
    if (!extras.directions.empty()) extras.directions[2 * i] = extras.directions[2 * i + 1] = NAN;
  }
  return LogMap(static_cast<int>(d), map.variant, strategy, source, std::move(coordinates), std::move(status),
                std::move(extras));
}

}  // namespace ahm
