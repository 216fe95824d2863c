/// \file
/// Which meshes of a glTF file stand where.
#pragma once

#include <vector>

#include "ahm/types.hpp"
#include "read/gltf_file.hpp"

namespace ahm::io {

struct GltfPlacement {
  std::uint64_t mesh = 0;
  std::array<Vec3, 4> columns{};  ///< of the matrix that places it: x, y, z, translation
};

/// The meshes of the file's scene, in the order of its nodes; of all meshes, each once, where there is no scene.
/// @throws IoError also when a node is its own descendant or has two parents
std::vector<GltfPlacement> placed_meshes(const Input& in, const GltfFile& file);

}  // namespace ahm::io
