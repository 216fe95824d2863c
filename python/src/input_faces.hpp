/// \file
/// Converts points of the flat triangles, over which exact geodesics run, to points of the faces of the input.
#pragma once

#include <array>
#include <vector>

#include "ahm/surface/exact/exact_geodesics.hpp"

namespace ahm::python {

/// Converts points of the flat triangles. If all faces are triangles, the conversion is a permutation of the corners.
/// Otherwise, on refined polygons, the result is the nearest point of the surface.
class InputFaces {
 public:
  explicit InputFaces(const ExactGeodesics& geodesics);

  /// The point of a face of the input.
  FacePoint point(const exact::MeshPoint& on) const;

 private:
  /// The face of a flat triangle. place[s]: position of corner s of the triangle in the face.
  struct Corners {
    Index face;
    std::array<int, 3> place;
  };
  const ExactGeodesics& geodesics_;
  std::vector<Corners> corners_;  ///< one per flat triangle; empty: not all faces are triangles
};

}  // namespace ahm::python
