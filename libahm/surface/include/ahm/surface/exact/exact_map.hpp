/// \file
/// Exact geodesic distances and log maps on polyhedral surfaces.
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
  /// The propagation also ends after this many windows; 0: no limit. Vertices and targets beyond the completed distance get
  /// `Status::beyond_radius`. That distance does not depend on the machine.
  Offset max_windows = 0;
  /// The propagation also ends as soon as this many vertices lie within the completed distance; 0: no limit.
  Index max_vertices = 0;
  /// Points for which distance and direction are computed, in addition to the vertices.
  std::vector<MeshPoint> targets;
  /// End when the distances of all targets are final. Vertices beyond the farthest target get `Status::beyond_radius`.
  bool only_targets = false;
  Progress progress;  ///< the fraction is the share of vertices reached; reported between buckets of windows
};

/// The last straight piece of a shortest path.
struct Arrival {
  /// Half-edge whose face the piece ends in. For a vertex, the vertex is the apex of this half-edge. For a target, this is side
  /// 0 of the target's face. -1: none (a source, or not reached).
  Half half = -1;
  /// Start of the piece: index into `ExactMap::origins()`; -1: not reached.
  Index origin = -1;
  /// Position of that origin, unfolded into the frame of the half-edge.
  Vec2 from{};
};

/// An origin of straight pieces: a source, or a vertex at which paths bend.
struct Origin {
  Index vertex = -1;     ///< -1: a source inside a face or an edge
  Index source = 0;      ///< number of the source that its paths come from
  double distance = 0;   ///< distance from that source
  double direction = 0;  ///< direction at that source, as in `ExactMap::direction`; 0 for a source itself
  /// Whether the face in which paths arrive at the vertex has the opposite orientation of the source's directions.
  bool mirrored = false;
};

/// Statistics of the propagation.
struct ExactStatistics {
  Offset windows = 0;     ///< windows made and queued
  std::size_t bytes = 0;  ///< maximum memory of the windows and results, without the surface
};

/// Distances and directions from the nearest of several sources, for all vertices and for the targets.
class ExactMap {
 public:
  Index size() const noexcept { return static_cast<Index>(vertices_); }
  Status status(Vertex vertex) const { return status_[vertex.index]; }
  std::span<const Status> status() const noexcept { return std::span(status_).first(vertices_); }

  /// Length of the shortest path from the nearest source; NaN where the status is not ok. World units.
  double distance(Vertex vertex) const { return distance_[vertex.index]; }
  std::span<const double> distances() const noexcept { return std::span(distance_).first(vertices_); }
  /// The angle at which that path leaves its source. At a vertex it is measured from the right side of the vertex's first
  /// corner (`PolyhedralSurface::first_corner`) and scaled by `angle_scale`. At other sources it is measured from side 0 of the
  /// face.
  double direction(Vertex vertex) const { return direction_[vertex.index]; }
  std::span<const double> directions() const noexcept { return std::span(direction_).first(vertices_); }
  /// (u, v): the distance times (cos, sin) of the direction.
  Vec2 coordinates(Vertex vertex) const { return coordinates_at(vertex.index); }
  /// Number of the nearest source; -1 where not reached.
  Index source(Vertex vertex) const;

  /// Status, distance, direction and coordinates of target k, as for vertices.
  Status target_status(std::size_t k) const { return status_[target_row(k)]; }
  double target_distance(std::size_t k) const { return distance_[target_row(k)]; }
  double target_direction(std::size_t k) const { return direction_[target_row(k)]; }
  Vec2 target_coordinates(std::size_t k) const { return coordinates_at(target_row(k)); }
  std::size_t targets() const noexcept { return targets_.size(); }

  /// For paths: the last piece of the shortest path to a vertex or target, and the origins of all pieces.
  const Arrival& arrival(Vertex vertex) const { return arrival_[vertex.index]; }
  const Arrival& target_arrival(std::size_t k) const { return arrival_[target_row(k)]; }
  std::span<const Origin> origins() const noexcept { return origins_; }
  std::span<const MeshPoint> sources() const noexcept { return sources_; }
  const MeshPoint& target(std::size_t k) const { return targets_[k]; }

  const ExactStatistics& statistics() const noexcept { return statistics_; }

 private:
  friend class MapBuilder;
  std::size_t target_row(std::size_t k) const { return vertices_ + k; }
  Vec2 coordinates_at(std::size_t row) const;

  std::size_t vertices_ = 0;
  std::vector<double> distance_, direction_;  ///< first the vertices, then the targets
  std::vector<Status> status_;
  std::vector<Arrival> arrival_;
  std::vector<Origin> origins_;
  std::vector<MeshPoint> sources_, targets_;
  ExactStatistics statistics_;
};

/// Shortest paths on the polyhedral surface, exact up to rounding, by the improved Chen-Han algorithm. Windows are unfolded
/// from face to face [CH90], discarded where a vertex is nearer [XW09], and processed in the order of buckets.
/// @param sources  one or more points; each has its own axes
/// @throws InvalidArgument (no source, a point outside its face, radius), InvalidGeometry (fault
/// windows_without_end: lengths below the rounding error of distances; fault windows_lost: needles with angles below the
/// rounding error), ResourceExhausted, Cancelled
ExactMap exact_map(const PolyhedralSurface& surface, std::span<const MeshPoint> sources,
                   const ExactOptions& options = {});
ExactMap exact_map(const PolyhedralSurface& surface, const MeshPoint& source, const ExactOptions& options = {});

/// One map per source, computed on several threads. The result does not depend on the number of threads.
/// @param threads  0: one per core
/// @throws as `exact_map`
std::vector<ExactMap> exact_maps(const PolyhedralSurface& surface, std::span<const MeshPoint> sources,
                                 const ExactOptions& options = {}, unsigned threads = 0);

}  // namespace ahm::exact
