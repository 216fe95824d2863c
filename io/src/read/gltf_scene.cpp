#include "read/gltf_scene.hpp"

#include <limits>

namespace ahm::io {
namespace {

using Json = GltfFile::Json;
using Columns = std::array<Vec3, 4>;

constexpr std::uint64_t none = std::numeric_limits<std::uint64_t>::max();
constexpr Columns unplaced = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}}};

/// a after b.
Columns product(const Columns& a, const Columns& b) {
  Columns result{};
  for (std::size_t k = 0; k < 4; ++k)
    for (std::size_t r = 0; r < 3; ++r)
      result[k][r] = a[0][r] * b[k][0] + a[1][r] * b[k][1] + a[2][r] * b[k][2] + (k == 3 ? a[3][r] : 0);
  return result;
}

/// The matrix of a node, or its translation after its rotation (a unit quaternion x, y, z, w) after its scale.
Columns placement_of(const GltfFile& file, const Json& node) {
  Columns columns = unplaced;
  if (const std::vector<double> m = file.numbers(node, "matrix", 16); !m.empty()) {
    for (std::size_t k = 0; k < 4; ++k) columns[k] = {m[4 * k], m[4 * k + 1], m[4 * k + 2]};
    return columns;
  }
  if (const std::vector<double> q = file.numbers(node, "rotation", 4); !q.empty()) {
    const double x = q[0], y = q[1], z = q[2], w = q[3];
    columns[0] = {1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)};
    columns[1] = {2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)};
    columns[2] = {2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)};
  }
  if (const std::vector<double> s = file.numbers(node, "scale", 3); !s.empty())
    for (std::size_t k = 0; k < 3; ++k)
      for (double& entry : columns[k]) entry *= s[k];
  if (const std::vector<double> t = file.numbers(node, "translation", 3); !t.empty()) columns[3] = {t[0], t[1], t[2]};
  return columns;
}

/// The whole numbers of a list of nodes, last first, for a stack.
std::vector<std::uint64_t> reversed_list(const Input& in, const Json& object, const char* member) {
  std::vector<std::uint64_t> result;
  const auto found = object.find(member);
  if (found == object.end()) return result;
  if (!found->is_array()) fail(in, "'" + std::string(member) + "' is no list");
  for (auto entry = found->rbegin(); entry != found->rend(); ++entry) {
    if (!entry->is_number_unsigned()) fail(in, "'" + std::string(member) + "' holds something else than whole numbers");
    result.push_back(entry->get<std::uint64_t>());
  }
  return result;
}

std::size_t length_of(const GltfFile& file, const char* list) {
  const auto found = file.root().find(list);
  return found != file.root().end() && found->is_array() ? found->size() : 0;
}

}  // namespace

std::vector<GltfPlacement> placed_meshes(const Input& in, const GltfFile& file) {
  std::vector<GltfPlacement> result;
  if (length_of(file, "scenes") == 0) {
    for (std::uint64_t mesh = 0; mesh < length_of(file, "meshes"); ++mesh) result.push_back({mesh, unplaced});
    return result;
  }
  struct Open {
    std::uint64_t node;
    Columns parent;
  };
  std::vector<Open> open;
  for (const std::uint64_t node : reversed_list(in, file.item("scenes", file.whole(file.root(), "scene", 0)), "nodes"))
    open.push_back({node, unplaced});
  std::vector<bool> seen(length_of(file, "nodes"));
  while (!open.empty()) {
    const auto [number, parent] = open.back();
    open.pop_back();
    const Json& node = file.item("nodes", number);
    if (seen[number]) fail(in, "node " + std::to_string(number) + " is there twice in the scene");
    seen[number] = true;
    const Columns columns = product(parent, placement_of(file, node));
    if (const std::uint64_t mesh = file.whole(node, "mesh", none); mesh != none) result.push_back({mesh, columns});
    for (const std::uint64_t child : reversed_list(in, node, "children")) open.push_back({child, columns});
  }
  return result;
}

}  // namespace ahm::io
