// This reader does not use a library. tinygltf reads only the JSON (with nlohmann/json, as here), and does not decode or check
// accessors, which is most of the work. Assimp has single precision and adds 10 MB.
#include "formats/gltf.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "ahm/error.hpp"
#include "ahm/util/srgb.hpp"
#include "ahm/util/text.hpp"
#include "ahm/util/weld.hpp"
#include "formats/format.hpp"
#include "read/bytes.hpp"
#include "read/gltf_file.hpp"
#include "read/input.hpp"

namespace ahm::io {
namespace {

using Json = GltfFile::Json;

constexpr std::uint64_t none = std::numeric_limits<std::uint64_t>::max();
constexpr Vec3 white{1, 1, 1};
enum Mode : std::uint64_t { points = 0, lines = 1, line_strip = 3, triangles = 4, strip = 5, fan = 6 };

class GltfReader {
 public:
  explicit GltfReader(const Input& in) : in_(in), file_(in) {}

  Geometry read() {
    g_.format = in_.bytes.starts_with("glTF") ? "glTF binary" : "glTF text";
    for (const GltfPlacement& placed : placed_meshes(in_, file_)) read_mesh(placed);
    if (const char* instances = "EXT_mesh_gpu_instancing"; file_.lists("extensionsUsed", instances))
      g_.warnings.push_back({"element_ignored", {}, {}, instances});
    if (g_.points.empty()) fail(in_, "it contains no vertex");
    if (lines_ > 0) g_.warnings.push_back({"lines_ignored", {static_cast<double>(lines_)}, {}});
    if (has_colors_ && lights_.size() == g_.points.size()) keep_colors();
    if (!g_.face_begin.empty()) join_seams();
    return std::move(g_);
  }

 private:
  void read_mesh(const GltfPlacement& placed) {
    const Json& mesh = file_.item("meshes", placed.mesh);
    const auto found = mesh.find("primitives");
    if (found == mesh.end() || !found->is_array())
      fail(in_, "mesh " + std::to_string(placed.mesh) + " has no primitives");
    for (const Json& primitive : *found) {
      if (!primitive.is_object())
        fail(in_, "mesh " + std::to_string(placed.mesh) + " has a primitive that is not an object");
      read_primitive(primitive, placed.columns);
    }
  }

  void read_primitive(const Json& primitive, const std::array<Vec3, 4>& columns) {
    const std::uint64_t mode = file_.whole(primitive, "mode", triangles);
    if (mode > fan) fail(in_, "a primitive has the mode " + std::to_string(mode) + "; modes 0 to 6 are supported");
    if (mode >= lines && mode <= line_strip) {
      ++lines_;
      return;
    }
    const auto attributes = primitive.find("attributes");
    if (attributes == primitive.end() || !attributes->is_object()) fail(in_, "a primitive has no attributes");
    const std::uint64_t position = file_.whole(*attributes, "POSITION", none);
    if (position == none) fail(in_, "a primitive has no POSITION");
    refuse_compression(primitive, position);
    const std::size_t first = g_.points.size(), count = add_points(position, columns);
    add_lights(file_.whole(*attributes, "COLOR_0", none), base_color(primitive), first, count);
    if (mode != points)
      add_faces(mode, corners(file_.whole(primitive, "indices", none), count), first, mirrors(columns));
  }

  /// Compressed primitives may also have uncompressed data, if the file does not require the extension.
  void refuse_compression(const Json& primitive, std::uint64_t position) const {
    const auto extensions = primitive.find("extensions");
    const bool has_draco = extensions != primitive.end() && extensions->contains("KHR_draco_mesh_compression");
    const auto refuse = [&](const char* name) {
      fail(in_, std::string("its meshes are compressed (") + name +
                    "), which is not supported; save it without compression");
    };
    if (file_.lists("extensionsRequired", "KHR_draco_mesh_compression") ||
        (has_draco && !file_.item("accessors", position).contains("bufferView")))
      refuse("Draco");
    if (file_.lists("extensionsRequired", "EXT_meshopt_compression")) refuse("meshopt");
  }

  GltfArray vectors(std::uint64_t accessor, std::size_t least_width) {
    GltfArray array = file_.array(accessor);
    if (array.width < least_width)
      fail(in_, "accessor " + std::to_string(accessor) + " has vectors of " + detail::counted(array.width, "number") +
                    ", not " + std::to_string(least_width));
    return array;
  }

  /// Checks the memory: nodes may place the same mesh any number of times, so the file size does not limit the number of points.
  void check_size(std::uint64_t more) const {
    constexpr std::uint64_t bytes_per_point = 128;
    check_vertex_count(in_, g_.points.size() + more);
    if (more > free_memory() / 2 / bytes_per_point)
      throw ResourceExhausted("not enough memory to read " + quoted_path(in_.path) +
                              ", which places its meshes many times");
  }

  std::size_t add_points(std::uint64_t accessor, const std::array<Vec3, 4>& columns) {
    const GltfArray array = vectors(accessor, 3);
    check_size(array.count);
    for (std::uint64_t k = 0; k < array.count; ++k) {
      const double* p = &array.values[k * array.width];
      Vec3 placed;
      for (std::size_t c = 0; c < 3; ++c)
        placed[c] = columns[0][c] * p[0] + columns[1][c] * p[1] + columns[2][c] * p[2] + columns[3][c];
      g_.points.push_back(placed);
    }
    return array.count;
  }

  /// Base color of the primitive's material, linear; white by default.
  Vec3 base_color(const Json& primitive) const {
    const std::uint64_t number = file_.whole(primitive, "material", none);
    if (number == none) return white;
    const Json& material = file_.item("materials", number);
    const auto surface = material.find("pbrMetallicRoughness");
    if (surface == material.end() || !surface->is_object()) return white;
    const std::vector<double> factor = file_.numbers(*surface, "baseColorFactor", 4);
    return factor.empty() ? white : Vec3{factor[0], factor[1], factor[2]};
  }

  /// Adds the colors of the vertices, multiplied by the base color of their material.
  void add_lights(std::uint64_t accessor, const Vec3& base, std::size_t first, std::size_t count) {
    lights_.resize(first + count, base);
    has_colors_ = has_colors_ || base != white;
    if (accessor == none) return;
    const GltfArray array = vectors(accessor, 3);
    if (array.count != count)
      fail(in_,
           "a primitive has " + std::to_string(count) + " positions and " + std::to_string(array.count) + " colors");
    has_colors_ = true;
    for (std::uint64_t k = 0; k < count; ++k)
      for (std::size_t c = 0; c < 3; ++c) lights_[first + k][c] *= array.values[k * array.width + c];
  }

  void keep_colors() {
    for (const Vec3& light : lights_) {
      auto& color = g_.colors.emplace_back();
      for (std::size_t c = 0; c < 3; ++c)
        color[c] = static_cast<std::uint8_t>(
            std::lround(255 * detail::tone_of(light[c] > 0 ? std::min(light[c], 1.0) : 0.0)));  // NaN becomes black
    }
  }

  std::vector<std::size_t> corners(std::uint64_t accessor, std::size_t count) {
    std::vector<std::size_t> result;
    if (accessor == none) {
      for (std::size_t k = 0; k < count; ++k) result.push_back(k);
      return result;
    }
    for (const double index : vectors(accessor, 1).values) {
      if (!(index >= 0 && index < static_cast<double>(count)))
        fail(in_, "a face has vertex number " + detail::number(index) + ", but there are " +
                      detail::counted(count, "vertex") + ", counted from 0");
      result.push_back(static_cast<std::size_t>(index));
    }
    return result;
  }

  static bool mirrors(const std::array<Vec3, 4>& m) {
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) + m[0][1] * (m[1][2] * m[2][0] - m[1][0] * m[2][2]) +
               m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]) <
           0;
  }

  /// @param turned  whether the placement mirrors the faces: they are reversed, so that their front sides stay outside
  void add_faces(std::uint64_t mode, const std::vector<std::size_t>& corners, std::size_t first, bool turned) {
    if (mode == triangles && corners.size() % 3 != 0)
      fail(in_, "a primitive of triangles has " + detail::counted(corners.size(), "corner"));
    if (g_.face_begin.empty()) g_.face_begin.push_back(0);
    const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
      if (mode == strip && (a == b || b == c || c == a)) return;  // connects two parts of the strip
      if (turned) std::swap(b, c);
      for (const std::size_t corner : {a, b, c}) g_.face_vertices.push_back(static_cast<Index>(first + corner));
      g_.face_begin.push_back(static_cast<Offset>(g_.face_vertices.size()));
    };
    for (std::size_t k = 2; k < corners.size(); k += mode == triangles ? 3 : 1) {
      if (mode == fan)
        add(corners[0], corners[k - 1], corners[k]);
      else if (mode == strip && k % 2 == 1)
        add(corners[k - 1], corners[k - 2], corners[k]);
      else
        add(corners[k - 2], corners[k - 1], corners[k]);
    }
  }

  /// Merges vertices at equal positions: glTF has a separate vertex for every texture coordinate and normal of a point.
  void join_seams() {
    const detail::MergedPoints welded = detail::weld(g_.points);
    for (std::size_t k = 0; k < welded.first.size(); ++k) {
      g_.points[k] = g_.points[welded.first[k]];
      if (!g_.colors.empty()) g_.colors[k] = g_.colors[welded.first[k]];
    }
    g_.points.resize(welded.first.size());
    if (!g_.colors.empty()) g_.colors.resize(welded.first.size());
    for (Index& vertex : g_.face_vertices) vertex = welded.number[vertex];
  }

  const Input& in_;
  GltfFile file_;
  Geometry g_;
  std::vector<Vec3> lights_;  ///< colors, linear
  bool has_colors_ = false;
  std::size_t lines_ = 0;
};

}  // namespace

Geometry read_gltf(const Input& in) { return GltfReader(in).read(); }

Format gltf_format() {
  return {
      .extensions = {".gltf"}, .read = read_gltf, .files_beside = [](const Input& in) { return GltfFile(in).files(); }};
}

}  // namespace ahm::io
