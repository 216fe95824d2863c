#include "ahm/maps/log_map.hpp"

#include <algorithm>
#include <utility>

#include "ahm/util/small_math.hpp"

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

std::string_view to_string(Method method) noexcept { return method == Method::heat ? "heat" : "exact"; }

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

MarchStatistics& MarchStatistics::operator+=(const MarchStatistics& other) {
  bands += other.bands;
  largest_band = std::max(largest_band, other.largest_band);
  solved += other.solved;
  return *this;
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

Index LogMap::count(Status status) const noexcept {
  return static_cast<Index>(std::count(status_.begin(), status_.end(), status));
}

}  // namespace ahm
