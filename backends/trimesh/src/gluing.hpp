/// \file
/// Faces glued along their common edges, and oriented alike.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "ahm/trimesh/triangle_mesh.hpp"

namespace ahm::trimesh {

/// Sides of the faces as given that lie on each other.
struct Gluing {
  std::vector<Half> partner;           ///< per half-edge of the faces as given, -1: none
  std::vector<std::uint8_t> reversed;  ///< per face: 1 where it must be turned over
  Index reoriented = 0;
  bool orientable = true;
};

/// "2 <what>: (3, 4), (5, 6)": the count, and the first ten items.
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

/// Checks indices, repeated vertices, duplicate faces and edges with more than two faces, and orients every component
/// like the majority of its faces.
/// @throws InvalidGeometry
Gluing glue(Index vertices, std::span<const Triangle> faces, NonManifold non_manifold, TopologyReport& report);

}  // namespace ahm::trimesh
