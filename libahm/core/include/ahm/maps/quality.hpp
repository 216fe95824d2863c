/// \file
/// Where a log map can be trusted.
///
/// \code
/// ahm::LogMap map = solver.solve(source);
/// std::vector<double> q = ahm::map_quality(graph, map);
/// if (q[i] < ahm::trusted_quality) ...                          // near a cut locus, behind a hole, or too coarse
/// \endcode
#pragma once

#include <limits>
#include <optional>
#include <stop_token>
#include <vector>

#include "ahm/graph/tangent_graph.hpp"
#include "ahm/maps/log_map.hpp"
#include "ahm/maps/wavefront.hpp"

namespace ahm {

/// Vertices of a lower quality have, as a rule, a vector that is wrong by more than a tenth of its length.
inline constexpr double trusted_quality = 0.5;

/// The quality of each vertex, from the expected relative error e of its vector: q = 1 / (1 + (e / 0.1)^2), where
///
///     e = sqrt(error^2 + (spread / 3)^2) / distance
///
/// and error is 0 for exact maps, `LogMap::error_estimate` for polar maps, and for maps by heat the difference to the polar map psi of
/// the same source and the error that this one expects: sqrt(|phi - psi|^2 + error(psi)^2). In other dimensions than 2 it is
/// the difference of |phi| and the distance. The spread marks the cut locus.
///
/// Curves (d = 2): phi and psi count from the coordinates of the nearest sample. Samples are half an edge apart, so a quarter of an
/// edge is ignored on triangulations, and a whole one elsewhere.
/// @param threads  0: one per core
/// @return n numbers in (0, 1]; NaN where the map is not ok
/// @throws InvalidArgument when the map belongs to another graph, was made without its spread, or is from a curve and d is not 2
std::vector<double> map_quality(const TangentGraph& graph, const LogMap& map, unsigned threads = 0);

/// The front that `map_quality` compares a map by heat with, where the map has none of its own: most of its work, which does not
/// need the map and can be done at the same time.
class ReferenceFront {
 public:
  /// @param radius  of the map
  /// @throws Cancelled
  ReferenceFront(const TangentGraph& graph, const Source& source,
                 double radius = std::numeric_limits<double>::infinity(), const std::stop_token& stop = {});
  /// Null on Delaunay triangulations, whose maps have a front of their own.
  const Wavefront* get() const noexcept { return front_ ? &*front_ : nullptr; }

 private:
  std::optional<Wavefront> front_;
};

/// The same quality. @param front  from the source of the map, with its radius
std::vector<double> map_quality(const TangentGraph& graph, const LogMap& map, const ReferenceFront& front,
                                unsigned threads = 0);

}  // namespace ahm
