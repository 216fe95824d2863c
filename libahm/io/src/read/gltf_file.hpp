/// \file
/// What a glTF file is made of: its JSON, its buffers, and arrays of numbers in these.
#pragma once

#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "ahm/types.hpp"
#include "read/input.hpp"

namespace ahm::io {

/// An array of vectors of `width` numbers.
struct GltfArray {
  std::uint64_t count = 0;
  std::size_t width = 0;
  std::vector<double> values;  ///< count x width
};

/// A .gltf or .glb with its buffers: in the file, in its JSON, or in files beside it.
class GltfFile {
 public:
  using Json = nlohmann::json;

  /// @throws IoError
  explicit GltfFile(const Input& in);

  const Json& root() const noexcept { return root_; }
  /// Number `index` of a list of the root. @throws IoError
  const Json& item(const char* list, std::uint64_t index) const;
  /// A whole number >= 0, `none` when there is no such member. @throws IoError when it is something else
  std::uint64_t whole(const Json& object, const char* member, std::uint64_t none) const;
  /// `count` numbers; empty when there is no such member. @throws IoError when it is something else
  std::vector<double> numbers(const Json& object, const char* member, std::size_t count) const;
  /// The files beside it that its buffers are in, whether they exist or not.
  std::vector<std::filesystem::path> files() const;
  /// The numbers of an accessor, normalized ones in [0, 1] or [-1, 1]. @throws IoError
  GltfArray array(std::uint64_t accessor);

 private:
  const std::string& buffer(std::uint64_t index);
  std::filesystem::path file(const std::string& uri) const;

  const Input& in_;
  Json root_;
  std::string chunk_;                 ///< the binary chunk of a .glb
  std::vector<std::string> buffers_;  ///< empty: not loaded yet
};

struct GltfPlacement {
  std::uint64_t mesh = 0;
  std::array<Vec3, 4> columns{};  ///< of the matrix that places it: x, y, z, translation
};

/// The meshes of the file's scene, in the order of its nodes; of all meshes, each once, where there is no scene.
/// @throws IoError also when a node is its own descendant or has two parents
std::vector<GltfPlacement> placed_meshes(const Input& in, const GltfFile& file);

}  // namespace ahm::io
