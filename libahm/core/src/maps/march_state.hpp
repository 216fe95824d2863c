/// \file
/// What a march knows at the end of a band: all that it takes to go on from there, in another process.
#pragma once

#include <optional>
#include <vector>

#include "ahm/maps/log_map_solver.hpp"
#include "maps/known_values.hpp"

namespace ahm {

/// Of one member of a team, halo included.
struct MarchState {
  MarchStatistics statistics;
  double depth = 0;                      ///< of bands
  Offset accepted = 0;                   ///< own vertices
  std::vector<Index> front;              ///< vertices from which the march goes on, in its order
  std::vector<Index> vertices;           ///< accepted ones that the front has not passed, ascending
  std::vector<double> values;            ///< of each of these as many, as `KnownValues` has them, and what was found
  std::vector<HeatExponents> exponents;  ///< of each of these
  std::vector<Index> passed;             ///< begin and end of each run of vertices that the front has passed, ascending
};

class March;

/// Keeps a march's state where it is to survive the process.
class MarchKeeper {
 public:
  virtual ~MarchKeeper() = default;
  /// Where to go on; none: from the source.
  virtual std::optional<MarchState> begin() = 0;
  /// Called after each band, by all members of a team: `march.state()` is what `begin` may return.
  virtual void end_band(const March& march) = 0;
};

}  // namespace ahm
