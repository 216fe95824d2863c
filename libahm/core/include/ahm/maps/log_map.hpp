/// \file
/// The result of a solve: coordinates and a status for every vertex.
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

/// What a march did.
struct MarchStatistics {
  Index bands = 0;         ///< factorizations
  Index largest_band = 0;  ///< vertices
  Offset solved = 0;       ///< vertices of all bands
};

/// How a map was made.
enum class Method {
  heat,   ///< by diffusion (`LogMapSolver`)
  polar,  ///< geodesic polar coordinates of a front (`PolarMapSolver`, `polar_map`)
  exact,  ///< by straight lines over the flat triangles of a mesh (`ExactGeodesics`)
};

/// What a map may hold besides coordinates.
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

/// Why a vertex has coordinates, or has none.
enum class Status : std::uint8_t {
  ok,
  disconnected,   ///< in a component of the graph without a source
  beyond_radius,  ///< farther from the source than the requested radius
  /// Strategy::global: so far (about 700 edges at t_coef = 1) that the heat has left the range of double precision. Any
  /// strategy: the heat cancels (negative weights).
  unreached,
  removed,  ///< an input point that is no vertex of the graph (set by backends, never by the solver)
};

/// The word used in files: "ok", "disconnected", "beyond_radius", "unreached", "removed".
std::string_view to_string(Status status) noexcept;
std::string_view to_string(Method method) noexcept;
std::string_view to_string(Variant variant) noexcept;
std::string_view to_string(Strategy strategy) noexcept;

/// A logarithmic map: for every vertex i its coordinates phi_i in the source's frame, NaN exactly where the status is
/// not `ok`.
class LogMap {
 public:
  /// Without distances in `extras` they are |phi_i|.
  LogMap(int dimension, Variant variant, Strategy strategy, Source source, std::vector<double> coordinates,
         std::vector<Status> status, MapExtras extras = {});

  Index size() const noexcept { return static_cast<Index>(status_.size()); }
  int dimension() const noexcept { return dimension_; }
  /// Variant and strategy mean nothing of an exact map.
  Method method() const noexcept { return extras_.method; }
  Variant variant() const noexcept { return variant_; }
  /// How it was solved: `global`, or `march` where any part was marched.
  Strategy strategy() const noexcept { return strategy_; }
  /// Zero for a global solve.
  const MarchStatistics& march() const noexcept { return extras_.march; }
  /// With MapOptions::frames: the source's axes carried to every vertex (Eq. 11 and 12), n x d x d, row major: column a is
  /// source axis a in the frame of the vertex. Identity where no heat arrived.
  std::span<const double> frames() const noexcept { return extras_.frames; }
  /// An estimate of |error of phi_i| of a polar map in world units; NaN where not ok (docs/concepts/accuracy.md): the distance
  /// times the expected error of the direction (`Wavefront::direction_error`). Empty for heat and exact maps.
  std::span<const double> error_estimate() const noexcept { return extras_.error_estimate; }
  /// That was asked for, world units; infinite: none.
  double radius() const noexcept { return extras_.radius; }
  /// The source whose frame the coordinates refer to.
  const Source& source() const noexcept { return source_; }

  /// n x d, row major, world units (graph units times `length_unit`).
  std::span<const double> coordinates() const noexcept { return coordinates_; }
  /// phi_i, d numbers.
  std::span<const double> coordinates(Vertex vertex) const;
  /// Where a point lies that is given as a source: linear between its vertices and, where their weighted offsets leave
  /// something (a point beside its only vertex), moved on by that along `frames`. NaN where a vertex of it is not ok.
  /// @throws InvalidArgument (a curve; offsets that leave something, and no frames)
  std::vector<double> coordinates(const Source& point) const;
  std::span<const Status> status() const noexcept { return status_; }
  Status status(Vertex vertex) const { return status_[vertex.index]; }
  /// The geodesic distance from the source, world units; NaN where not ok. It is not |phi_i|, which is too short wherever
  /// several paths reach a vertex: on triangulations it is unfolded (`Wavefront`), elsewhere sqrt(q_i / lambda_i), the
  /// root mean square of what heat brings (docs/concepts/accuracy.md). Both are |phi_i| on flat graphs. From a curve: to its nearest
  /// sample. Of an exact map it is |phi_i|.
  double distance(Vertex vertex) const { return extras_.distances[vertex.index]; }
  std::span<const double> distances() const noexcept { return extras_.distances; }
  /// sqrt(q_i / lambda_i - |phi_i|^2), the standard deviation of the coordinates over the ways by which heat arrives, world
  /// units: 0 on flat graphs, small inside the cut locus, about the distance on it. NaN where not ok; of polar and exact maps half
  /// of the longest jump to a neighbor, beyond the length of the side; empty without MapOptions::spread. From a curve it is over its
  /// points, too: 0 on flat graphs beside a straight one, about the distance where a bent one's normals meet.
  std::span<const double> spread() const noexcept { return extras_.spread; }
  /// Where distances are unfolded, the unit vectors in which the ways to the vertices leave the source (`Wavefront`), n x 2 in
  /// its frame: beside phi, which `map_quality` compares with them; from a curve, of the ways from its nearest sample. NaN at the
  /// source itself. Empty elsewhere and without MapOptions::spread.
  std::span<const double> directions() const noexcept { return extras_.directions; }
  /// The expected errors of these directions, radians (`Wavefront::direction_error`); empty where there are none.
  std::span<const double> direction_errors() const noexcept { return extras_.direction_errors; }
  /// From a curve, the number of the sample nearest to each vertex (`Source::Place::point`), -1 where none is; empty of other
  /// sources.
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
