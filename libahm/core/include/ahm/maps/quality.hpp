/// \file
/// How reliable the vectors of a log map are.
///
/// \code
/// ahm::LogMap map = solver.solve(source);
/// std::vector<double> q = ahm::map_quality(graph, map);
/// if (q[i] < ahm::reliable_quality) ...                          // near a cut locus, behind a hole, or too coarse
/// \endcode
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "ahm/graph/tangent_graph.hpp"
#include "ahm/maps/log_map.hpp"
#include "ahm/maps/wavefront.hpp"
#include "ahm/stop_token.hpp"

namespace ahm {

/// The vectors of vertices with a lower quality are usually wrong by more than a tenth of their length.
inline constexpr double reliable_quality = 0.5;

/// The quality of each vertex, computed from the expected relative error e of its vector:
///
///     q = 1 / (1 + (e / 0.1)^2),   e = sqrt(error^2 + (spread / 3)^2) / distance
///
/// - Exact maps: error = 0.
/// - Polar maps: error = `LogMap::error_estimate`.
/// - Maps by heat, d = 2: error = sqrt(|phi - psi|^2 + error(psi)^2), with the polar map psi of the same source.
/// - Maps by heat, other dimensions: error = the difference of |phi| and the distance.
///
/// The spread marks the cut locus.
///
/// Curves (d = 2): phi and psi are relative to the coordinates of the nearest sample. Samples are half an edge apart, so a quarter of an
/// edge is ignored on triangulations, and a whole edge on other graphs.
/// @param threads  0: one per core
/// @return n numbers in (0, 1]; NaN where the map is not ok
/// @throws InvalidArgument when the map belongs to another graph, was made without its spread, or is from a curve and d is not 2
std::vector<double> map_quality(const TangentGraph& graph, const LogMap& map, unsigned threads = 0);

/// The distance up to which a map is reliable: the largest R such that at least 95 % of the mapped entries with distance <= R have a
/// quality of at least `reliable_quality`. nullopt if there is no such R with at least 20 entries (or all, if there are fewer).
/// @param distances, quality  one number per vertex or row; NaN: not mapped
std::optional<double> reliable_distance(std::span<const double> distances, std::span<const double> quality);

/// The front with which `map_quality` compares a map by heat. It is most of the work of `map_quality` and does not need the map, so it can
/// run at the same time as the solve.
class ReferenceFront {
 public:
  /// @param radius  radius of the map, world units
  /// @throws Cancelled
  ReferenceFront(const TangentGraph& graph, const Source& source,
                 double radius = std::numeric_limits<double>::infinity(), const StopToken& stop = {});
  /// The front; null on Delaunay triangulations, where maps by heat contain the result of a front (`LogMap::directions`).
  const Wavefront* get() const noexcept { return front_ ? &*front_ : nullptr; }

 private:
  std::optional<Wavefront> front_;
};

/// Quality of each vertex as above, with a front computed before.
/// @param front  made with the source and the radius of the map
std::vector<double> map_quality(const TangentGraph& graph, const LogMap& map, const ReferenceFront& front,
                                unsigned threads = 0);

}  // namespace ahm
