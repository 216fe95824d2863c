/// \file
/// Generated parts with sharp edges and holes, as triangle meshes in space (`Mesh::plane` is empty).
#pragma once

#include "ahm/conformance/triangle_meshes.hpp"

namespace ahm::test {

/// A box with a corner at the origin: two triangles per side, counterclockwise from outside.
Mesh box(const Vec3& size);
/// A prism over a regular polygon of 48 corners on the unit circle: needles along the axis, and fans as lids if closed.
Mesh cylinder(double height, bool closed);
/// A plate of 6 x 4 in the plane z = 0 with three holes, cut out of a grid of 61 x 41 points. Row 61 j + i is at
/// (0.1 i, 0.1 j, 0).
Mesh holed_plate();

}  // namespace ahm::test
