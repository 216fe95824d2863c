/// \file
/// A common interface to the results of a march and of a global solve.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include "ahm/maps/log_map.hpp"
#include "maps/affine_heat.hpp"
#include "maps/march.hpp"

namespace ahm {

/// The result of a solve at a vertex, without its coordinates; world units.
struct SolvedValue {
  Status status;
  double root_mean_square = 0;  ///< sqrt(q / lambda)
  double distance = 0;          ///< distance by heat
};

/// The results of a march.
class MarchedValues {
 public:
  MarchedValues(const March& front, double radius) : front_(front), radius_(radius) {}

  SolvedValue read(Index vertex, std::span<double> phi) const {
    const auto found = front_.coordinates(vertex);
    std::copy(found.begin(), found.end(), phi.begin());
    if (front_.accepted(vertex)) return {Status::ok, front_.root_mean_square(vertex), front_.distance(vertex)};
    return {std::isinf(radius_) ? Status::unreached : Status::beyond_radius};
  }
  void axes(Index vertex, double* out) const { front_.axes(vertex, out); }

 private:
  const March& front_;
  double radius_;
};

/// The results of a global solve for source number s of a block.
class GlobalValues {
 public:
  GlobalValues(const AffineHeat& heat, std::size_t s) : heat_(heat), s_(s), frames_(heat.frames(s)) {}

  SolvedValue read(Index vertex, std::span<double> phi) const {
    heat_.coordinates_at(s_, vertex, phi.data());
    return {heat_.reached(s_, vertex) ? Status::ok : Status::unreached, heat_.root_mean_square_at(s_, vertex),
            heat_.distance_at(s_, vertex)};
  }
  void axes(Index vertex, double* out) const { frames_.axes(vertex, out); }

 private:
  const AffineHeat& heat_;
  std::size_t s_;
  FrameField frames_;
};

}  // namespace ahm
