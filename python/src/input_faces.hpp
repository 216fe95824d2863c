/// \file
/// From points of the flat triangles, where exact geodesics run, to points of the input's faces.
#pragma once

#include <array>
#include <vector>

#include "ahm/surface/exact/exact_geodesics.hpp"

namespace ahm::python {

/// The faces of the input that are flat triangles as they are. Of others, polygons that were refined, the nearest point of
/// the face is taken.
class InputFaces {
 public:
  explicit InputFaces(const ExactGeodesics& geodesics);

  FacePoint point(const exact::MeshPoint& on) const;

 private:
  /// The face of a flat triangle, and the places of its corners in it.
  struct Corners {
    Index face;
    std::array<int, 3> place;
  };
  const ExactGeodesics& geodesics_;
  std::vector<Corners> corners_;  ///< one per flat triangle; empty: the input has other faces
};

}  // namespace ahm::python
