/// \file
/// What the writers of textured meshes share.
#pragma once

#include <string>
#include <vector>

#include "ahm/io/atomic_file.hpp"
#include "ahm/io/textured_mesh.hpp"

namespace ahm::io {

/// The vertices of a part as files want them.
struct PartVertices {
  std::vector<Index> points;         ///< those in use, in ascending order
  std::vector<Index> point;          ///< per corner: position in `points`
  std::vector<double> textures;      ///< pairs (u, v), each different for its point; empty without a texture
  std::vector<Index> texture;        ///< per corner: position in `textures`
  std::vector<Index> texture_point;  ///< per pair: position of its point in `points`
};

PartVertices vertices_of(const MeshPart& part);

}  // namespace ahm::io
