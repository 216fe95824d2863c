/// \file
/// Links between passes that do not cut the surface. Lengths are in spacings.
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "ahm/util/vec.hpp"
#include "tool_path/track.hpp"

namespace ahm {

/// A unit vector perpendicular to another one.
Vec3 any_perpendicular(const Vec3& axis);

/// Finds links.
class Linker {
 public:
  /// @param part       the surface that links must not cut. @param domain  of the passes
  /// @param clearance  height of lifted links
  Linker(const MeshTree& part, const PathDomain& domain, const ToolPlacer& placer, double clearance);

  Vec3 lifted(const Spot& spot) const { return spot.position + clearance_ * spot.axis; }
  /// Whether the tool can rise from the surface to a share of the clearance.
  bool can_rise(const Spot& spot, double share = 1) const;

  /// The path on the surface, with both ends; none if it is longer than `longest`, if the surface does not connect the ends, or
  /// where the tool does not fit.
  std::optional<Track> on_surface(const Spot& from, const Spot& to,
                                  double longest = std::numeric_limits<double>::infinity()) const;
  /// Positions from the clearance over one spot to the clearance over another, with both ends; none if there is no free path.
  std::optional<std::vector<Vec3>> through_space(const Spot& from, const Spot& to) const;
  /// Positions as of `through_space`, away from the surface to a sphere around it, along the sphere, and back.
  std::optional<std::vector<Vec3>> around(const Spot& from, const Spot& to) const;

 private:
  double least_height(double share) const;
  std::optional<std::vector<Vec3>> path_to_sphere(const Spot& spot) const;
  bool is_free(const Vec3& from, const Vec3& to, double share_from = 1, double share_to = 1) const;
  bool is_free(const std::vector<Vec3>& points) const;

  const MeshTree& part_;
  const PathDomain& domain_;
  const ToolPlacer& placer_;
  double clearance_;
  double extent_ = 0;   ///< diagonal of the bounding box of the region
  Vec3 center_{};       ///< of the bounding box of the surface
  double outside_ = 0;  ///< radius of a sphere around the surface
};

}  // namespace ahm
