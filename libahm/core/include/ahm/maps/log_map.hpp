/// \file
/// A logarithmic map: coordinates and a status for every vertex.
///
/// \code
/// ahm::LogMap map = solver.solve(ahm::Source::at_vertex(ahm::Vertex{0}));
/// if (map.status(v) == ahm::Status::ok) std::cout << map.coordinates(v)[0] << ' ' << map.distance(v);   // ahm::Vertex v
/// \endcode
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

#include "ahm/heat/heat_options.hpp"
#include "ahm/maps/source.hpp"
#include "ahm/types.hpp"

namespace ahm {

/// Work of a march.
struct MarchStatistics {
  Index bands = 0;         ///< number of bands; each has its own factorization
  Index largest_band = 0;  ///< number of vertices of the largest band
  Offset solved = 0;       ///< sum of the numbers of vertices of all bands
};

/// The method that computed a map.
enum class Method {
  heat,   ///< diffusion (`LogMapSolver`)
  polar,  ///< geodesic polar coordinates of a front (`PolarMapSolver`, `polar_map`)
  exact,  ///< exact geodesics of the flat triangles of a mesh (`ExactGeodesics`)
};

/// Optional data of a map; `LogMap` has an accessor of the same name for each.
struct MapExtras {
  MarchStatistics march;
  std::vector<double> distances;
  std::vector<double> spread;
  std::vector<double> directions;
  std::vector<double> direction_errors;
  std::vector<Index> nearest;
  std::vector<double> frames;
  std::vector<double> error_estimate;
  Method method = Method::heat;
  double radius = std::numeric_limits<double>::infinity();
};

/// Whether a vertex has coordinates, and if not why.
enum class Status : std::uint8_t {
  ok,
  disconnected,   ///< in a component of the graph without a source
  beyond_radius,  ///< farther from the source than the requested radius
  /// Strategy::global: so far from the source (about 700 edges at t_coef = 1) that the heat is below the range of double precision. Any
  /// strategy: the heat cancels (negative weights).
  unreached,
  removed,  ///< an input point that is not a vertex of the graph (set by backends, never by the solver)
};

/// The word used in files: "ok", "disconnected", "beyond_radius", "unreached", "removed".
std::string_view to_string(Status status) noexcept;
std::string_view to_string(Method method) noexcept;
std::string_view to_string(Variant variant) noexcept;
std::string_view to_string(Strategy strategy) noexcept;

/// A logarithmic map: the coordinates phi_i of every vertex i in the source's frame. They are NaN exactly where the status is not `ok`.
class LogMap {
 public:
  /// If `extras` has no distances, they are |phi_i|.
  LogMap(int dimension, Variant variant, Strategy strategy, Source source, std::vector<double> coordinates,
         std::vector<Status> status, MapExtras extras = {});

  Index size() const noexcept { return static_cast<Index>(status_.size()); }
  int dimension() const noexcept { return dimension_; }
  /// `variant` and `strategy` apply to maps by heat only.
  Method method() const noexcept { return extras_.method; }
  Variant variant() const noexcept { return variant_; }
  /// The strategy of the solve: `global`, or `march` if any part was solved by a march.
  Strategy strategy() const noexcept { return strategy_; }
  /// Work of the march; zero for a global solve.
  const MarchStatistics& march() const noexcept { return extras_.march; }
  /// With MapOptions::frames: the source's axes, parallel transported to every vertex (Eq. 11 and 12), n x d x d, row major. Column a is
  /// source axis a in the frame of the vertex. Identity where no heat arrived.
  std::span<const double> frames() const noexcept { return extras_.frames; }
  /// Polar maps: estimated |error of phi_i|, world units; NaN where not ok. It is the distance times the expected error of the direction
  /// (`Wavefront::direction_error`, docs/concepts/accuracy.md). Empty for heat and exact maps.
  std::span<const double> error_estimate() const noexcept { return extras_.error_estimate; }
  /// The requested radius, world units; infinite: none.
  double radius() const noexcept { return extras_.radius; }
  /// The source whose frame the coordinates refer to.
  const Source& source() const noexcept { return source_; }

  /// n x d, row major, world units (graph units times `length_unit`).
  std::span<const double> coordinates() const noexcept { return coordinates_; }
  /// phi_i, d numbers.
  std::span<const double> coordinates(Vertex vertex) const;
  /// Coordinates of a point that is described by a source. The map is interpolated linearly between the vertices of the point. If the
  /// weighted mean of their offsets is not zero (a point near its only vertex), the remaining displacement is added, transported by
  /// `frames`. NaN if a vertex of the point is not ok.
  /// @throws InvalidArgument (a curve; a map without frames if the mean offset is not zero)
  std::vector<double> coordinates(const Source& point) const;
  std::span<const Status> status() const noexcept { return status_; }
  Status status(Vertex vertex) const { return status_[vertex.index]; }
  /// Geodesic distance from the source, world units; NaN where not ok. For a curve it is the distance to the nearest sample.
  ///
  /// Maps by heat: |phi_i| is too short wherever several paths reach a vertex, so the distance is computed separately
  /// (docs/concepts/accuracy.md). On triangulations and from curves it is unfolded (`Wavefront`). Elsewhere it is sqrt(q_i / lambda_i), the
  /// root mean square over the paths of the heat. Both are equal to |phi_i| on flat graphs. Exact maps: the distance is |phi_i|.
  double distance(Vertex vertex) const { return extras_.distances[vertex.index]; }
  std::span<const double> distances() const noexcept { return extras_.distances; }
  /// Uncertainty of the coordinates, world units; NaN where not ok. Empty without MapOptions::spread.
  ///
  /// Maps by heat: sqrt(q_i / lambda_i - |phi_i|^2), the standard deviation of the coordinates over the paths of the heat. It is 0 on
  /// flat graphs, small inside the cut locus and about the distance on it. For a curve it includes the deviation over the points of the
  /// curve: on flat graphs it is 0 near a straight curve, and about the distance where the normals of a bent curve meet.
  ///
  /// Polar and exact maps: half of the largest excess of a neighbor's distance in the map over the edge length.
  std::span<const double> spread() const noexcept { return extras_.spread; }
  /// Unit vectors in which the geodesic paths leave the source (`Wavefront`), n x 2, in the source's frame; for a curve, the paths from the
  /// nearest sample. NaN at the source. `map_quality` compares phi with them. Only maps by heat on Delaunay triangulations have them, with
  /// MapOptions::spread; otherwise empty.
  std::span<const double> directions() const noexcept { return extras_.directions; }
  /// Expected errors of `directions`, radians (`Wavefront::direction_error`); empty if `directions` is.
  std::span<const double> direction_errors() const noexcept { return extras_.direction_errors; }
  /// Number of the source point nearest to each vertex (`Source::Place::point`), -1: none. Maps from a curve and polar maps from several
  /// points have it; otherwise empty.
  std::span<const Index> nearest() const noexcept { return extras_.nearest; }
  /// Number of vertices with this status.
  Index count(Status status) const noexcept;

 private:
  int dimension_;
  Variant variant_;
  Strategy strategy_;
  Source source_;
  std::vector<double> coordinates_;
  std::vector<Status> status_;
  MapExtras extras_;
};

}  // namespace ahm
