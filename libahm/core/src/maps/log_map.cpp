#include "ahm/maps/log_map.hpp"

#include <algorithm>
#include <utility>

#include "ahm/error.hpp"
#include "ahm/maps/straight_line.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/vec.hpp"

namespace ahm {

std::string_view to_string(Status status) noexcept {
  switch (status) {
    case Status::ok:
      return "ok";
    case Status::disconnected:
      return "disconnected";
    case Status::beyond_radius:
      return "beyond_radius";
    case Status::unreached:
      return "unreached";
    case Status::removed:
      return "removed";
  }
  return "unknown";
}

std::string_view to_string(Method method) noexcept {
  switch (method) {
    case Method::heat:
      return "heat";
    case Method::polar:
      return "polar";
    case Method::exact:
      return "exact";
  }
  return "unknown";
}

std::string_view to_string(Strategy strategy) noexcept {
  switch (strategy) {
    case Strategy::automatic:
      return "auto";
    case Strategy::global:
      return "global";
    case Strategy::march:
      return "march";
  }
  return "unknown";
}

LogMap::LogMap(int dimension, Variant variant, Strategy strategy, Source source, std::vector<double> coordinates,
               std::vector<Status> status, MapExtras extras)
    : dimension_(dimension),
      variant_(variant),
      strategy_(strategy),
      source_(std::move(source)),
      coordinates_(std::move(coordinates)),
      status_(std::move(status)),
      extras_(std::move(extras)) {
  if (!extras_.distances.empty()) return;
  for (Index i = 0; i < size(); ++i) extras_.distances.push_back(length(this->coordinates(Vertex(i))));
}

std::span<const double> LogMap::coordinates(Vertex vertex) const {
  const auto d = static_cast<std::size_t>(dimension_);
  return std::span<const double>(coordinates_).subspan(static_cast<std::size_t>(vertex.index) * d, d);
}

std::vector<double> LogMap::coordinates(const Source& point) const {
  double total = 0, farthest = 0;
  for (double b : point.weights()) total += b;
  if (point.is_curve() || !(total > 0) || point.dimension().value_or(dimension_) != dimension_)
    throw InvalidArgument("LogMap::coordinates: the source is not a point of positive weight in the map's dimension");
  const auto d = static_cast<std::size_t>(dimension_);
  std::vector<double> phi(d, 0.0), rest(d, 0.0), there(d);  // rest: minus the mean offset, in the axes of the point
  const auto heaviest = static_cast<std::size_t>(std::max_element(point.weights().begin(), point.weights().end()) -
                                                 point.weights().begin());
  for (std::size_t k = 0; k < point.vertices().size(); ++k) {
    const double b = point.weights()[k] / total;
    if (!(b > 0)) continue;
    const auto at = coordinates(point.vertices()[k]);
    for (std::size_t a = 0; a < d; ++a) phi[a] += b * at[a];
    if (point.offsets().empty()) continue;
    const auto z = point.offsets().subspan(k * d, d);
    farthest = std::max(farthest, length(z));
    for (std::size_t a = 0; a < d; ++a) rest[a] -= b * z[a];
  }
  if (!(length(rest) > 1e-9 * farthest)) return phi;
  if (frames().empty())
    throw InvalidArgument("map_without_frames", "the map has no frames", "solve with MapOptions::frames");
  const auto U = point.axes().subspan(heaviest * d * d, d * d);
  const auto F = frames().subspan(static_cast<std::size_t>(point.vertices()[heaviest].index) * d * d, d * d);
  for (std::size_t c = 0; c < d; ++c) there[c] = dot(U.subspan(c * d, d), rest);
  for (std::size_t a = 0; a < d; ++a)
    for (std::size_t c = 0; c < d; ++c) phi[a] += F[c * d + a] * there[c];
  return phi;
}

Index LogMap::count(Status status) const noexcept {
  return static_cast<Index>(std::count(status_.begin(), status_.end(), status));
}

std::optional<Vec3> source_position(const TangentGraph& graph, const Source& source) {
  if (source.is_curve() || source.vertices().empty()) return std::nullopt;
  Vec3 sum{};
  double weights = 0;
  for (std::size_t k = 0; k < source.vertices().size(); ++k) {
    if (source.place(k).point != 0) return std::nullopt;
    const auto frame = graph.frame(source.vertices()[k].index);
    if (!frame) return std::nullopt;
    Vec3 place = frame->origin;
    for (std::size_t a = 0; a < 2 && !source.offsets().empty(); ++a) {
      const double z = source.offsets()[2 * k + a];
      place = place - (z * source.axes()[4 * k + a]) * frame->x - (z * source.axes()[4 * k + 2 + a]) * frame->y;
    }
    sum = sum + source.weights()[k] * place;
    weights += source.weights()[k];
  }
  return (1 / weights) * sum;
}

std::optional<Vec3> straight_line_origin(const TangentGraph& graph, const Source& source) {
  const bool at_vertex = source.vertices().size() == 1 && source.offsets().empty();
  return at_vertex || !graph.is_delaunay() ? source_position(graph, source) : std::nullopt;
}

}  // namespace ahm
