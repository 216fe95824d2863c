/// \file
/// Balls that touch a surface from one side. Lengths are in spacings.
#pragma once

#include <optional>
#include <span>

#include "tool_path/fine_mesh.hpp"

namespace ahm {

/// An axis, turned until it points away from all faces at a point by six degrees or more. Mean normals do not always, at sharp edges
/// and in grooves. Where no direction does, as in the most acute grooves and edges, the last one of some steps.
/// @param normals  unit normals of the faces, at least one
Vec3 turned_away(std::span<const Vec3> normals, Vec3 axis);

/// Finds the center of a ball that touches a surface from above.
class BallPlacer {
 public:
  /// The center is known up to this share of the radius.
  static constexpr double tolerance = 1e-4;

  /// @param part  the surface; must outlive the placer
  BallPlacer(const MeshTree& part, double radius) : part_(part), radius_(radius) {}

  /// A center near the one in a direction; none: no place was found where the ball fits, and that the surface does not separate from
  /// the contact.
  /// @param direction  unit vector that points away from all faces at the contact
  std::optional<Vec3> center(const Vec3& contact, const Vec3& direction) const;

 private:
  std::optional<Vec3> cut(const Vec3& center, double radius) const;
  std::optional<Vec3> grown(const Vec3& contact, const Vec3& direction) const;
  bool are_connected(const Vec3& from, const Vec3& to) const;

  const MeshTree& part_;
  double radius_;
};

}  // namespace ahm
