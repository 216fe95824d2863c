/// \file
/// Exact geodesic distances and log maps of polyhedral surfaces.
///
/// \code
/// ahm::exact::ExactMap map = ahm::exact::exact_map(surface, surface.vertex_point(ahm::Vertex{42}));
/// if (map.status(v) == ahm::Status::ok) std::cout << map.distance(v) << ' ' << map.coordinates(v)[0] << '\n';
/// \endcode
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "ahm/maps/log_map.hpp"
#include "ahm/progress.hpp"
#include "ahm/surface/exact/polyhedral_surface.hpp"

namespace ahm::exact {

struct ExactOptions {
  /// Vertices and targets farther than this get `Status::beyond_radius`, and the propagation ends there. World units; > 0.
  double radius = std::numeric_limits<double>::infinity();
  /// How far distances may be off, relative to the true ones. 0: exact up to rounding. Above, windows side by side are
  /// merged: time is nearly linear in the number of vertices; directions blend where they are. Paths need exact maps. In
  /// [0, 0.1].
  double tolerance = 0;
  /// The propagation ends when it has made this many windows, too; 0: no limit. Vertices and targets beyond the distance that it has
  /// completed get `Status::beyond_radius`. The distance does not depend on the machine.
  Offset max_windows = 0;
  /// Points whose distance and direction are asked for besides those of the vertices.
  std::vector<MeshPoint> targets;
  /// End when the distances of all targets are final; vertices beyond the farthest of them get `Status::beyond_radius`.
  bool only_targets = false;
  Progress progress;  ///< the fraction is that of the vertices met; asked between bands of windows
};

/// How the last straight piece of a shortest path comes in.
struct Arrival {
  /// The half-edge whose face the piece ends in: of a vertex, it is the apex of this half-edge; of a target, side 0 of its
  /// face. -1: none (a source, or not reached).
  Half half = -1;
  /// Where the piece comes from: `ExactMap::origins()`; -1: not reached.
  Index origin = -1;
  /// That origin unfolded into the frame of the half-edge.
  Vec2 from{};
};

/// Where straight pieces start: a source, or a vertex at which paths bend.
struct Origin {
  Index vertex = -1;     ///< -1: a source inside a face or an edge
  Index source = 0;      ///< number of the source that its paths come from
  double distance = 0;   ///< from that source
  double direction = 0;  ///< at that source, as in `ExactMap::direction`; of a source itself 0
};

/// What the propagation did.
struct ExactStatistics {
  Offset windows = 0;     ///< made and queued
  std::size_t bytes = 0;  ///< held by windows and what they reach, at most; the surface apart
};

/// Distances and directions from the nearest of several sources, for all vertices and for the targets asked for.
class ExactMap {
 public:
  Index size() const noexcept { return static_cast<Index>(vertices_); }
  Status status(Vertex vertex) const { return status_[vertex.index]; }
  std::span<const Status> status() const noexcept { return std::span(status_).first(vertices_); }

  /// Length of the shortest path from the nearest source; NaN where the status is not ok. World units.
  double distance(Vertex vertex) const { return distance_[vertex.index]; }
  std::span<const double> distances() const noexcept { return std::span(distance_).first(vertices_); }
  /// The angle at which that path leaves its source: from the right side of the vertex's first corner
  /// (`PolyhedralSurface::first_corner`), scaled by `angle_scale`; from side 0 of the face for other sources.
  double direction(Vertex vertex) const { return direction_[vertex.index]; }
  std::span<const double> directions() const noexcept { return std::span(direction_).first(vertices_); }
  /// distance (cos, sin) of the direction.
  Vec2 coordinates(Vertex vertex) const { return coordinates_at(vertex.index); }
  /// Number of the nearest source, -1 where not reached.
  Index source(Vertex vertex) const;

  /// The same for target k.
  Status target_status(std::size_t k) const { return status_[target_row(k)]; }
  double target_distance(std::size_t k) const { return distance_[target_row(k)]; }
  double target_direction(std::size_t k) const { return direction_[target_row(k)]; }
  Vec2 target_coordinates(std::size_t k) const { return coordinates_at(target_row(k)); }
  std::size_t targets() const noexcept { return targets_.size(); }

  /// For paths: how the shortest path comes in, and where its pieces start.
  const Arrival& arrival(Vertex vertex) const { return arrival_[vertex.index]; }
  const Arrival& target_arrival(std::size_t k) const { return arrival_[target_row(k)]; }
  std::span<const Origin> origins() const noexcept { return origins_; }
  std::span<const MeshPoint> sources() const noexcept { return sources_; }
  const MeshPoint& target(std::size_t k) const { return targets_[k]; }

  const ExactStatistics& statistics() const noexcept { return statistics_; }
  double tolerance() const noexcept { return tolerance_; }  ///< of the distances; above 0, `arrival` is approximate

 private:
  friend class MapBuilder;
  std::size_t target_row(std::size_t k) const { return vertices_ + k; }
  Vec2 coordinates_at(std::size_t row) const;

  std::size_t vertices_ = 0;
  std::vector<double> distance_, direction_;  ///< vertices, then targets
  std::vector<Status> status_;
  std::vector<Arrival> arrival_;
  std::vector<Origin> origins_;
  std::vector<MeshPoint> sources_, targets_;
  ExactStatistics statistics_;
  double tolerance_ = 0;
};

/// Shortest paths on the polyhedral surface, exact up to rounding, by the improved algorithm of Chen and Han: windows,
/// unfolded from face to face [CH90], discarded where a vertex is known to be nearer [XW09], in the order of buckets.
/// @param sources  one or more points; each keeps its own axes
/// @throws InvalidArgument (no source, a point outside its face, radius, tolerance), InvalidGeometry (faults
/// windows_without_end: lengths below the rounding of distances; windows_lost: needles whose angles are), ResourceExhausted,
/// Cancelled
ExactMap exact_map(const PolyhedralSurface& surface, std::span<const MeshPoint> sources,
                   const ExactOptions& options = {});
ExactMap exact_map(const PolyhedralSurface& surface, const MeshPoint& source, const ExactOptions& options = {});

/// One map for each source, on several threads; the result does not depend on their number.
/// @param threads  0: one per core
/// @throws as above
std::vector<ExactMap> exact_maps(const PolyhedralSurface& surface, std::span<const MeshPoint> sources,
                                 const ExactOptions& options = {}, unsigned threads = 0);

}  // namespace ahm::exact
