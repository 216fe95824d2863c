/// \file
/// Polygons glued along their common edges, and oriented alike. Not part of the public interface.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "ahm/surface/half_edges.hpp"
#include "ahm/surface/mesh_topology.hpp"
#include "ahm/types.hpp"

namespace ahm::detail {

/// Sides of the faces as given that lie on each other.
struct Gluing {
  std::vector<Half> partner;           ///< per side of the faces as given, -1: none
  std::vector<std::uint8_t> reversed;  ///< per face: 1 where it must be turned over
  Index reoriented = 0;
  bool orientable = true;
  Index non_manifold_edges = 0;
};

/// "(3, 4), (5, 6)": the first ten items, and how many more there are.
class ItemList {
 public:
  void add(const std::string& item) {
    if (count_++ >= 10) return;
    if (count_ > 1) text_.append(", ");
    text_.append(item);
  }
  Offset count() const { return count_; }
  std::string text() const { return count_ > 10 ? text_ + " and " + std::to_string(count_ - 10) + " more" : text_; }

 private:
  Offset count_ = 0;
  std::string text_;
};

/// Faces that cannot be glued to others, in ascending order.
struct FaceFaults {
  std::vector<Index> outside, small, repeating;  ///< as of `MeshInspection`
};

/// @throws InvalidGeometry (no vertices, no faces, offsets, more than 2^31 - 2 corners)
FaceFaults find_faults(Index vertices, const FaceList& faces);

/// Pairs of equal faces, the later one first, among faces without other faults; sorted.
std::vector<std::pair<Index, Index>> find_duplicates(Index vertices, const FaceList& faces);

/// Checks indices, corners, repeated vertices, duplicate faces and edges with more than two faces, and orients every
/// component like the majority of its faces.
/// @param turned  per face, 1 where it counts as turned over for the majority; empty: none is
/// @throws InvalidGeometry, InvalidArgument (turned: another number of faces)
Gluing glue(Index vertices, const FaceList& faces, NonManifold non_manifold, std::span<const std::uint8_t> turned = {});

/// @throws InvalidGeometry (more than 2^30 positions, a coordinate that is not finite)
void check_positions(std::span<const Vec3> positions);

/// Positions of the vertices of a mesh as numbers of order one.
struct NormalizedPositions {
  std::vector<Vec3> points;      ///< in units, about the middle of the bounding box of their part
  std::vector<double> rounding;  ///< per point, of coordinates as given, in units: that of the largest of its part
  double unit;                   ///< what a length of 1 was before: a power of two
};

/// A part has the same numbers, but for a power of two, whatever lies beside it.
/// @param part  per point, the lowest one of its part
NormalizedPositions normalize_positions(std::vector<Vec3> points, std::span<const Index> part);

}  // namespace ahm::detail
