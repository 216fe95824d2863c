#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "ahm/util/srgb.hpp"
#include "ahm/util/text.hpp"
#include "formats/format.hpp"
#include "formats/gltf.hpp"
#include "little_endian.hpp"
#include "write/textured_mesh.hpp"

namespace ahm::io {
namespace {

using Json = nlohmann::ordered_json;

// Constants of the glTF 2.0 specification.
constexpr std::uint32_t glb_magic = 0x46546C67, glb_version = 2, json_chunk = 0x4E4F534A, binary_chunk = 0x004E4942;
constexpr int float32 = 5126, uint32 = 5125, array_buffer = 34962, element_array_buffer = 34963, clamp_to_edge = 33071;

/// Smaller models lose digits in single precision.
constexpr double least_size = 1e-30;

Vec3 middle_of(std::span<const MeshPart> parts) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Vec3 low{infinity, infinity, infinity}, high{-infinity, -infinity, -infinity};
  for (const MeshPart& part : parts)
    for (Index v : part.faces.vertices)
      for (std::size_t c = 0; c < 3; ++c) {
        low[c] = std::min(low[c], part.points[v][c]);
        high[c] = std::max(high[c], part.points[v][c]);
      }
  Vec3 middle{};
  for (std::size_t c = 0; c < 3 && low[c] <= high[c]; ++c) middle[c] = low[c] / 2 + high[c] / 2;
  return middle;
}

class GlbFile {
 public:
  explicit GlbFile(const Vec3& middle) : middle_(middle) {
    json_["asset"] = {{"version", "2.0"}, {"generator", "libahm"}};
    json_["scene"] = 0;
    json_["scenes"] = Json::array({Json{{"nodes", Json::array()}}});
  }

  void add(const MeshPart& part) {
    const PartVertices vertices = vertices_of(part);
    const bool has_texture = !vertices.textures.empty();
    // One vertex per point, or per distinct pair of texture coordinates: a point on a seam has several pairs.
    std::vector<Index> point_of = vertices.texture_point, own = vertices.points;
    if (!has_texture)
      for (std::size_t k = 0; k < own.size(); ++k) point_of.push_back(static_cast<Index>(k));
    const std::vector<Index>& corner = has_texture ? vertices.texture : vertices.point;
    std::vector<Index> triangles;
    for (std::size_t f = 0; f < part.faces.size(); ++f)
      for (Offset c = part.faces.begin[f] + 1; c + 1 < part.faces.begin[f + 1]; ++c)
        for (Offset k : {part.faces.begin[f], c, c + 1}) triangles.push_back(corner[k]);
    if (triangles.empty()) return;

    Json attributes;
    attributes["POSITION"] = add_positions(part, own, point_of);
    if (!part.normals.empty())
      attributes["NORMAL"] = add_floats(
          "VEC3", 3, point_of.size(), [&](std::size_t k, std::size_t c) { return part.normals[own[point_of[k]]][c]; });
    if (has_texture)  // in glTF, v = 0 is at the top
      attributes["TEXCOORD_0"] = add_floats("VEC2", 2, point_of.size(), [&](std::size_t k, std::size_t c) {
        return c == 0 ? vertices.textures[2 * k] : 1 - vertices.textures[2 * k + 1];
      });
    if (!part.colors.empty())
      attributes["COLOR_0"] = add_floats("VEC3", 3, point_of.size(), [&](std::size_t k, std::size_t c) {
        return detail::light_of(part.colors[own[point_of[k]]][c] / 255.);
      });
    const std::size_t begin = bytes_.size();
    for (Index vertex : triangles) append(bytes_, static_cast<std::uint32_t>(vertex));
    const int indices = add_accessor(begin, element_array_buffer,
                                     {{"componentType", uint32}, {"count", triangles.size()}, {"type", "SCALAR"}});
    json_["scenes"][0]["nodes"].push_back(
        push("nodes", {{"name", part.name}, {"mesh", count("meshes")}, {"translation", middle_}}));
    const int material = add_material(part);
    push("meshes", {{"name", part.name},
                    {"primitives",
                     Json::array({Json{{"attributes", attributes}, {"indices", indices}, {"material", material}}})}});
  }

  void write(AtomicFile& file) {
    json_["buffers"] = Json::array({Json{{"byteLength", bytes_.size()}}});
    std::string text = json_.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const std::size_t total = 12 + 8 + text.size() + 8 + bytes_.size();
    if (total > std::numeric_limits<std::uint32_t>::max())
      throw IoError("a .glb file cannot hold more than 4 GB; write .obj");
    std::string head;
    const auto append_all = [&](std::initializer_list<std::size_t> numbers) {
      for (std::size_t number : numbers) append(head, static_cast<std::uint32_t>(number));
    };
    append_all({glb_magic, glb_version, total, text.size(), json_chunk});
    file.write(head + text);
    head.clear();
    append_all({bytes_.size(), binary_chunk});
    file.write(head);
    file.write(bytes_);
  }

 private:
  int count(const char* list) const { return json_.contains(list) ? static_cast<int>(json_[list].size()) : 0; }
  int push(const char* list, Json value) {
    json_[list].push_back(std::move(value));
    return count(list) - 1;
  }

  /// Adds a view of the bytes since `begin`, and pads the buffer to a multiple of four bytes. @return its index
  int add_view(std::size_t begin, int target) {
    Json view = {{"buffer", 0}, {"byteOffset", begin}, {"byteLength", bytes_.size() - begin}};
    if (target != 0) view["target"] = target;
    bytes_.resize((bytes_.size() + 3) / 4 * 4, '\0');
    return push("bufferViews", std::move(view));
  }
  int add_accessor(std::size_t begin, int target, Json accessor) {
    accessor["bufferView"] = add_view(begin, target);
    return push("accessors", std::move(accessor));
  }

  template <class Value>
  int add_floats(const char* type, std::size_t width, std::size_t size, const Value& value) {
    const std::size_t begin = bytes_.size();
    for (std::size_t k = 0; k < size; ++k)
      for (std::size_t c = 0; c < width; ++c) append(bytes_, static_cast<float>(value(k, c)));
    return add_accessor(begin, array_buffer, {{"componentType", float32}, {"count", size}, {"type", type}});
  }

  /// Adds the positions, with the bounds that glTF requires. @return the index of the accessor
  int add_positions(const MeshPart& part, const std::vector<Index>& own, const std::vector<Index>& point_of) {
    double largest = 0;
    std::array<float, 3> low, high;
    low.fill(std::numeric_limits<float>::infinity());
    high.fill(-std::numeric_limits<float>::infinity());
    const int accessor = add_floats("VEC3", 3, point_of.size(), [&](std::size_t k, std::size_t c) {
      const double x = part.points[own[point_of[k]]][c] - middle_[c];
      low[c] = std::min(low[c], static_cast<float>(x));
      high[c] = std::max(high[c], static_cast<float>(x));
      largest = std::max(largest, std::abs(x));
      return x;
    });
    if (largest > std::numeric_limits<float>::max() || (largest > 0 && largest < least_size))
      throw InvalidArgument("a .glb file has single precision, but the mesh has a length of " +
                            detail::number(largest) + "; write .obj");
    json_["accessors"][accessor]["min"] = low;
    json_["accessors"][accessor]["max"] = high;
    return accessor;
  }

  int add_material(const MeshPart& part) {
    Json surface = {{"metallicFactor", 0}, {"roughnessFactor", 1}};
    if (part.texture) {
      const std::size_t begin = bytes_.size();
      bytes_ += png_bytes(*part.texture);
      push("images", {{"mimeType", "image/png"}, {"bufferView", add_view(begin, 0)}});
      if (count("samplers") == 0) push("samplers", {{"wrapS", clamp_to_edge}, {"wrapT", clamp_to_edge}});
      surface["baseColorTexture"] = {{"index", push("textures", {{"source", count("images") - 1}, {"sampler", 0}})}};
    } else {
      const std::array<double, 3> color = part.colors.empty() ? part.color : std::array{1., 1., 1.};  // times COLOR_0
      surface["baseColorFactor"] = {color[0], color[1], color[2], 1};
    }
    Json material = {{"name", part.name}, {"pbrMetallicRoughness", surface}, {"doubleSided", true}};
    if (part.transparent) material["alphaMode"] = "BLEND";
    return push("materials", std::move(material));
  }

  Vec3 middle_;
  Json json_;
  std::string bytes_;
};

void write(const std::filesystem::path& path, std::span<const MeshPart> parts) {
  GlbFile glb(middle_of(parts));
  for (const MeshPart& part : parts) glb.add(part);
  AtomicFile file(path);
  glb.write(file);
  file.commit();
}

}  // namespace

Format glb_format() {
  return {.extensions = {".glb"}, .signatures = {"glTF"}, .read = read_gltf, .write_textured = write};
}

}  // namespace ahm::io
