// The exponential map and shortest paths with their derivatives, for automatic differentiation.
#include "ahm/surface/exact/geodesic_derivatives.hpp"

#include <array>
#include <utility>

#include "body.hpp"
#include "compute.hpp"
#include "errors.hpp"
#include "parts.hpp"

namespace ahm::python {
namespace {

py::array matrices(std::vector<TangentMap>&& maps) {
  const py::ssize_t k = length(maps);
  return owned<TangentMap, double>(std::move(maps), {k, 3, 3});
}

/// Columns of ends: of straightest geodesics or of shortest paths.
struct Ends {
  std::vector<Vec3> first, second;
  std::vector<double> distance;
  std::vector<std::uint8_t> ok;
  std::vector<TangentMap> by_first, by_second;
};

/// @return positions of the ends, whether the geodesics are complete, derivatives by the points and by the vectors
py::tuple exponential(const BodyPtr& body, const py::tuple& points, const Doubles& given, const py::object& report) {
  const Places from = places(points);
  Ends found = compute(report, given, [=, along = vectors(given)](const Progress& progress) {
    Ends ends;
    for (std::size_t k = 0; k < from.size(); ++k) {
      progress.step("trace", static_cast<double>(k) / static_cast<double>(from.size()));
      const ExponentialPoint end = naming(
          from.where(k), [&] { return exponential_point(body->geodesics(), body->point(from.places[k]), along[k]); });
      ends.first.push_back(end.position);
      ends.ok.push_back(end.complete);
      ends.by_first.push_back(end.by_start);
      ends.by_second.push_back(end.by_vector);
    }
    return ends;
  });
  return py::make_tuple(owned(std::move(found.first)), owned(std::move(found.ok)), matrices(std::move(found.by_first)),
                        matrices(std::move(found.by_second)));
}

/// @return whether there is a path from source k to target k, distances, departures, arrivals, derivatives of the log map by
/// the sources and by the targets
py::tuple geodesic_ends_of(const BodyPtr& body, const py::tuple& sources, const py::tuple& targets, unsigned threads,
                           const py::object& report) {
  const Places from = places(sources), to = places(targets);
  Ends found = compute(report, py::none(), [=](const Progress& progress) {
    std::vector<std::array<SurfacePoint, 2>> pairs;
    for (std::size_t k = 0; k < from.size(); ++k)
      pairs.push_back({naming(from.where(k), [&] { return body->point(from.places[k]); }),
                       naming(to.where(k), [&] { return body->point(to.places[k]); })});
    Ends ends;
    for (const GeodesicEnds& one : geodesic_ends(body->geodesics(), pairs, progress, threads)) {
      ends.ok.push_back(one.status == Status::ok);
      ends.distance.push_back(one.distance);
      ends.first.push_back(one.departure);
      ends.second.push_back(one.arrival);
      ends.by_first.push_back(one.log_by_source);
      ends.by_second.push_back(one.log_by_target);
    }
    return ends;
  });
  return py::make_tuple(owned(std::move(found.ok)), owned(std::move(found.distance)), owned(std::move(found.first)),
                        owned(std::move(found.second)), matrices(std::move(found.by_first)),
                        matrices(std::move(found.by_second)));
}

}  // namespace

void add_geodesic_derivatives(py::module_& module) {
  module.def("exponential", &exponential);
  module.def("geodesic_ends", &geodesic_ends_of);
}

}  // namespace ahm::python
