/// \file
/// Shared by the writers of textured meshes.
#pragma once

#include <string>
#include <vector>

#include "ahm/io/atomic_file.hpp"
#include "ahm/io/textured_mesh.hpp"

namespace ahm::io {

/// The vertices of a part, numbered as in a file.
struct PartVertices {
  std::vector<Index> points;         ///< points that faces use, ascending
  std::vector<Index> point;          ///< per corner: index into `points`
  std::vector<double> textures;      ///< pairs (u, v), distinct for each point; empty without texture coordinates
  std::vector<Index> texture;        ///< per corner: index of its pair in `textures`
  std::vector<Index> texture_point;  ///< per pair: index of its point in `points`
};

PartVertices vertices_of(const MeshPart& part);

}  // namespace ahm::io
