/// \file
/// The parts of a glTF file: JSON, buffers, and arrays of numbers in the buffers.
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
  std::vector<double> values;  ///< values of shape count x width
};

/// A .gltf or .glb file with its buffers, which are in the file, in its JSON, or in other files.
class GltfFile {
 public:
  using Json = nlohmann::json;

  /// @throws IoError
  explicit GltfFile(const Input& in);

  const Json& root() const noexcept { return root_; }
  /// Element `index` of a list of the root object. @throws IoError
  const Json& item(const char* list, std::uint64_t index) const;
  /// The value of a member, a whole number >= 0; `none` if the member is missing. @throws IoError if it has another type
  std::uint64_t whole(const Json& object, const char* member, std::uint64_t none) const;
  /// The value of a member, `count` numbers; empty if the member is missing. @throws IoError if it has another type
  std::vector<double> numbers(const Json& object, const char* member, std::size_t count) const;
  /// The other files that contain its buffers, whether they exist or not.
  std::vector<std::filesystem::path> files() const;
  /// The numbers of an accessor, also a sparse one; normalized integers become numbers in [0, 1] or [-1, 1]. @throws IoError
  GltfArray array(std::uint64_t accessor);
  /// Whether a list of the root object ("extensionsUsed", "extensionsRequired") contains the name.
  bool lists(const char* list, const char* name) const;

 private:
  struct Elements;
  std::vector<double> read_elements(const Json& place, const Elements& elements);
  void read_sparse(const Json& sparse, Elements elements, std::vector<double>& values);
  const std::string& buffer(std::uint64_t index);
  std::filesystem::path file(const std::string& uri) const;

  const Input& in_;
  Json root_;
  std::string chunk_;                 ///< the binary chunk of a .glb
  std::vector<std::string> buffers_;  ///< buffers that have been loaded; others are empty
};

struct GltfPlacement {
  std::uint64_t mesh = 0;
  std::array<Vec3, 4> columns{};  ///< columns of its transformation: x, y, z, translation
};

/// The meshes of the file's scene with their transformations, in the order of the nodes. Without a scene: every mesh once.
/// @throws IoError, also when a node is its own descendant or has two parents
std::vector<GltfPlacement> placed_meshes(const Input& in, const GltfFile& file);

}  // namespace ahm::io
