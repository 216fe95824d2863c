#include "ahm/maps/source.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "ahm/error.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/text.hpp"

namespace ahm {
namespace {

bool is_orthogonal(std::span<const double> axes, std::size_t d) {
  for (std::size_t a = 0; a < d; ++a)
    for (std::size_t b = 0; b < d; ++b) {
      double sum = a == b ? -1.0 : 0.0;
      for (std::size_t c = 0; c < d; ++c) sum += axes[c * d + a] * axes[c * d + b];
      if (!(std::abs(sum) <= 1e-8)) return false;
    }
  return true;
}

}  // namespace

Source::Source(int dimension) : dimension_(dimension) {
  if (dimension < 1) throw InvalidArgument("Source: dimension " + std::to_string(dimension) + " must be at least 1");
}

Source Source::at_vertex(Vertex vertex) { return at_vertices({&vertex, 1}); }

Source Source::at_vertices(std::span<const Vertex> vertices) {
  Source source;
  source.vertices_.assign(vertices.begin(), vertices.end());
  source.weights_.assign(vertices.size(), 1.0);
  for (std::size_t k = 0; k < vertices.size(); ++k) source.places_.push_back({static_cast<Index>(k), 0});
  return source;
}

Source Source::joined(std::span<const Source> points) {
  std::optional<int> dimension;
  std::vector<Vertex> plain;
  for (const Source& point : points) {
    const bool one =
        std::all_of(point.places_.begin(), point.places_.end(), [](const Place& p) { return p.point == 0; });
    if (point.is_curve_ || !one) throw InvalidArgument("Source::joined: a source is not a point");
    plain.insert(plain.end(), point.vertices_.begin(), point.vertices_.end());
    if (point.dimension_ && point.dimension_ != dimension.value_or(*point.dimension_))
      throw InvalidArgument("Source::joined: the sources have different dimensions, " + std::to_string(*dimension) +
                            " and " + std::to_string(*point.dimension_));
    if (point.dimension_) dimension = point.dimension_;
  }
  if (!dimension) return at_vertices(plain);
  Source result(*dimension);
  const auto d = static_cast<std::size_t>(*dimension);
  const std::vector<double> zero(d, 0.0);
  for (std::size_t p = 0; p < points.size(); ++p)
    for (std::size_t k = 0; k < points[p].vertices_.size(); ++k) {
      const Source& point = points[p];
      const bool placed = point.dimension_.has_value();
      const auto z = placed ? point.offsets().subspan(k * *point.dimension_, *point.dimension_) : zero;
      const auto U = placed ? point.axes().subspan(k * d * d, d * d) : std::span<const double>();
      result.append(point.vertices_[k], point.weights_[k], z, U, {static_cast<Index>(p), length(z)});
    }
  return result;
}

Source Source::at_vertex(Vertex vertex, std::span<const double> direction) {
  const double length = direction.size() == 2 ? std::hypot(direction[0], direction[1]) : 0.0;
  if (!(length > 0) || !std::isfinite(length))
    throw InvalidArgument("Source::at_vertex: 'direction' must be 2 finite numbers, not both zero");
  const double c = direction[0] / length, s = direction[1] / length;
  const double axes[] = {c, -s, s, c}, offset[] = {0.0, 0.0};
  Source source(2);
  source.add(vertex, 1.0, offset, axes);
  return source;
}

Source& Source::add(Vertex vertex, double weight, std::span<const double> offset, std::span<const double> axes) {
  append(vertex, weight, offset, axes, {0, length(offset)});
  return *this;
}

Source& Source::add(Vertex vertex, double weight, std::span<const double> offset, std::span<const double> axes,
                    const Place& place) {
  append(vertex, weight, offset, axes, place);
  is_curve_ = true;
  return *this;
}

Source Source::renumbered(const std::function<Vertex(Vertex)>& number) const {
  Source result = *this;
  for (Vertex& vertex : result.vertices_) vertex = number(vertex);
  return result;
}

void Source::append(Vertex vertex, double weight, std::span<const double> offset, std::span<const double> axes,
                    const Place& place) {
  const auto d = static_cast<std::size_t>(dimension_.value_or(0));
  const std::string where = "Source::add, vertex " + std::to_string(vertex.index) + ": ";
  if (d == 0) throw InvalidArgument(where + "a source made by at_vertex(vertex) accepts no more samples");
  if (!(weight >= 0) || !std::isfinite(weight))
    throw InvalidArgument(where + "weight " + detail::number(weight) + " must be finite and >= 0");
  if (offset.size() != d || !all_finite(offset))
    throw InvalidArgument(where + "'offset' must be " + std::to_string(d) + " finite numbers");
  if (!axes.empty() && (axes.size() != d * d || !all_finite(axes) || !is_orthogonal(axes, d)))
    throw InvalidArgument(where + "'axes' must be an orthogonal " + std::to_string(d) + " x " + std::to_string(d) +
                          " matrix");
  if (place.point < 0 || !(place.distance >= 0) || !std::isfinite(place.distance))
    throw InvalidArgument(where + "'place' must have a point >= 0 and a finite distance >= 0");
  if (d == 2) {
    const double away = std::hypot(offset[0] - place.position[0], offset[1] - place.position[1]);
    if (!(std::abs(away - place.distance) <= 1e-6 * (away + length(offset))))
      throw InvalidArgument(where + "'offset' is " + detail::number(away) +
                            " from the position of 'place', but its distance is " + detail::number(place.distance));
  }
  places_.push_back(place);
  vertices_.push_back(vertex);
  weights_.push_back(weight);
  offsets_.insert(offsets_.end(), offset.begin(), offset.end());
  axes_.insert(axes_.end(), axes.begin(), axes.end());
  for (std::size_t k = 0; axes.empty() && k < d * d; ++k) axes_.push_back(k % (d + 1) == 0 ? 1.0 : 0.0);
}

}  // namespace ahm
