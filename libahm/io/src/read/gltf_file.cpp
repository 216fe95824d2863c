#include "read/gltf_file.hpp"

#include <algorithm>
#include <cctype>
#include <limits>
#include <optional>
#include <utility>

#include "ahm/util/text.hpp"
#include "little_endian.hpp"
#include "read/bytes.hpp"

namespace ahm::io {
namespace {

constexpr std::uint32_t json_chunk = 0x4E4F534A, binary_chunk = 0x004E4942;
constexpr std::uint64_t not_there = std::numeric_limits<std::uint64_t>::max();

struct Chunks {
  std::string_view json, binary;
};

/// Finds the chunks of a .glb file: a header of 12 bytes, then chunks, each preceded by its length and kind.
Chunks find_chunks(const Input& in) {
  const std::string_view bytes = in.bytes;
  if (bytes.size() < 20) fail_at_byte(in, bytes.size(), "the file ends within its header");
  if (const auto version = load_at<std::uint32_t>(bytes, 4); version != 2)
    fail_at_byte(in, 4, "glTF " + std::to_string(version) + " is not supported; glTF 2 is");
  const std::uint64_t size = load_at<std::uint32_t>(bytes, 8);
  if (size > bytes.size())
    fail_at_byte(in, 8,
                 "the file should have " + detail::counted(size, "byte") + ", but has " + std::to_string(bytes.size()) +
                     "; it is cut short");
  Chunks chunks;
  for (std::uint64_t at = 12; at + 8 <= size;) {
    const std::uint64_t length = load_at<std::uint32_t>(bytes, at);
    const auto kind = load_at<std::uint32_t>(bytes, at + 4);
    if (length > size - at - 8)
      fail_at_byte(in, at, "a chunk of " + detail::counted(length, "byte") + " does not fit into the file");
    const std::string_view chunk = bytes.substr(at + 8, length);
    if (kind == json_chunk && chunks.json.empty()) chunks.json = chunk;
    if (kind == binary_chunk && chunks.binary.empty()) chunks.binary = chunk;
    at += 8 + length;
  }
  if (chunks.json.empty()) fail_at_byte(in, 12, "the file has no JSON chunk");
  return chunks;
}

std::optional<std::string> from_base64(std::string_view text) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  while (text.ends_with('=')) text.remove_suffix(1);
  std::string bytes;
  std::uint32_t bits = 0;
  for (std::size_t k = 0; k < text.size(); ++k) {
    const std::size_t digit = digits.find(text[k]);
    if (digit == std::string_view::npos) return std::nullopt;
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    if (k % 4 != 0) bytes += static_cast<char>(bits >> (6 - 2 * (k % 4)));
  }
  return bytes;
}

bool is_data(const std::string& uri) { return uri.starts_with("data:"); }

/// Decodes escapes such as %20.
std::string without_escapes(std::string_view uri) {
  std::string result;
  for (std::size_t k = 0; k < uri.size(); ++k) {
    const auto hex = [&](std::size_t at) {
      return std::string_view("0123456789abcdef").find(static_cast<char>(uri[at] | 0x20));
    };
    if (uri[k] == '%' && k + 2 < uri.size() && hex(k + 1) < 16 && hex(k + 2) < 16) {
      result += static_cast<char>(16 * hex(k + 1) + hex(k + 2));
      k += 2;
    } else {
      result += uri[k];
    }
  }
  return result;
}

struct Component {
  std::size_t size;
  double largest;  ///< largest value of the integer type, for normalization
  double (*load)(std::string_view bytes, std::size_t at);
};

template <class T>
Component component() {
  return {sizeof(T), static_cast<double>(std::numeric_limits<T>::max()),
          [](std::string_view bytes, std::size_t at) { return static_cast<double>(load_at<T>(bytes, at)); }};
}

std::optional<Component> find_component(std::uint64_t type) {
  switch (type) {
    case 5120:
      return component<std::int8_t>();
    case 5121:
      return component<std::uint8_t>();
    case 5122:
      return component<std::int16_t>();
    case 5123:
      return component<std::uint16_t>();
    case 5125:
      return component<std::uint32_t>();
    case 5126:
      return component<float>();
    default:
      return std::nullopt;
  }
}

}  // namespace

GltfFile::GltfFile(const Input& in) : in_(in) {
  Chunks chunks{in.bytes, {}};
  if (in.bytes.starts_with("glTF")) chunks = find_chunks(in);
  root_ = Json::parse(chunks.json, nullptr, false);
  if (!root_.is_object()) fail(in, "its JSON is damaged or cut short");
  chunk_ = chunks.binary;
  if (const auto asset = root_.find("asset"); asset == root_.end() || !asset->is_object())
    fail(in, "its JSON is not glTF: it has no 'asset'");
}

const GltfFile::Json& GltfFile::item(const char* list, std::uint64_t index) const {
  const auto found = root_.find(list);
  if (found == root_.end() || !found->is_array() || index >= found->size() || !(*found)[index].is_object())
    fail(in_, "there is no entry " + std::to_string(index) + " in '" + list + "'");
  return (*found)[index];
}

std::uint64_t GltfFile::whole(const Json& object, const char* member, std::uint64_t none) const {
  const auto found = object.find(member);
  if (found == object.end()) return none;
  if (!found->is_number_unsigned())
    fail(in_, "'" + std::string(member) + "' is " +
                  in_quotes(found->dump(-1, ' ', true, Json::error_handler_t::replace)) + ", not a whole number");
  return found->get<std::uint64_t>();
}

std::vector<double> GltfFile::numbers(const Json& object, const char* member, std::size_t count) const {
  std::vector<double> result;
  const auto found = object.find(member);
  if (found == object.end()) return result;
  if (found->is_array())
    for (const Json& entry : *found)
      if (entry.is_number()) result.push_back(entry.get<double>());
  if (!found->is_array() || found->size() != count || result.size() != count)
    fail(in_, "'" + std::string(member) + "' must be " + detail::counted(count, "number"));
  return result;
}

const std::string& GltfFile::buffer(std::uint64_t index) {
  const Json& object = item("buffers", index);
  buffers_.resize(std::max<std::size_t>(buffers_.size(), index + 1));
  std::string& bytes = buffers_[index];
  if (!bytes.empty()) return bytes;
  const auto found = object.find("uri");
  if (found == object.end()) {
    if (index > 0) fail(in_, "buffer " + std::to_string(index) + " has no data");
    bytes = chunk_;
  } else if (const std::string uri = found->is_string() ? found->get<std::string>() : ""; is_data(uri)) {
    const std::size_t comma = uri.find(";base64,");
    const auto data = comma == std::string::npos ? std::nullopt : from_base64(std::string_view(uri).substr(comma + 8));
    if (!data) fail(in_, "buffer " + std::to_string(index) + " is not base64 data");
    bytes = *data;
  } else {
    bytes = load(file(uri)).bytes;
  }
  if (const std::uint64_t length = whole(object, "byteLength", 0); length > bytes.size())
    fail(in_, "buffer " + std::to_string(index) + " should have " + detail::counted(length, "byte") + ", but has " +
                  std::to_string(bytes.size()) + "; the file is cut short");
  return bytes;
}

/// Files written on Windows may have backslashes, or an absolute path, whose file is expected next to this one.
std::filesystem::path GltfFile::file(const std::string& uri) const {
  std::string path = without_escapes(uri);
  std::ranges::replace(path, '\\', '/');
  const bool has_drive =
      path.size() > 2 && std::isalpha(static_cast<unsigned char>(path[0])) && path.substr(1, 2) == ":/";
  return in_.path.parent_path() / (has_drive ? std::filesystem::path(path).filename() : std::filesystem::path(path));
}

std::vector<std::filesystem::path> GltfFile::files() const {
  std::vector<std::filesystem::path> result;
  const auto buffers = root_.find("buffers");
  if (buffers == root_.end() || !buffers->is_array()) return result;
  for (const Json& buffer : *buffers)
    if (const auto uri = buffer.is_object() ? buffer.find("uri") : buffer.end();
        uri != buffer.end() && uri->is_string())
      if (const auto text = uri->get<std::string>(); !is_data(text)) result.push_back(file(text));
  return result;
}

/// Vectors in a buffer: those of an accessor, or the indices or values of a sparse accessor.
struct GltfFile::Elements {
  std::string name;  ///< for messages
  Component component;
  std::uint64_t count = 0;
  std::size_t width = 1;
};

/// @param place  an object with the members bufferView and byteOffset
std::vector<double> GltfFile::read_elements(const Json& place, const Elements& e) {
  const Json& view = item("bufferViews", whole(place, "bufferView", not_there));
  const std::uint64_t number = whole(view, "buffer", not_there);
  const auto extensions = view.find("extensions");
  const bool is_packed = extensions != view.end() && extensions->contains("EXT_meshopt_compression");
  if (is_packed && !item("buffers", number).contains("uri") && (number > 0 || chunk_.empty()))
    fail(in_, "its meshes are compressed (meshopt), which is not supported; save it without compression");
  const std::string& bytes = buffer(number);
  const std::uint64_t begin = whole(view, "byteOffset", 0), length = whole(view, "byteLength", 0);
  const std::uint64_t offset = whole(place, "byteOffset", 0);
  const std::uint64_t element = e.component.size * e.width, given = whole(view, "byteStride", 0),
                      stride = given == 0 ? element : given;
  if (stride < element)
    fail(in_, e.name + " has elements of " + detail::counted(element, "byte") + ", which a byteStride of " +
                  std::to_string(given) + " does not hold");
  if (begin > bytes.size() || length > bytes.size() - begin || offset > length ||
      (e.count > 0 && (length - offset < element || e.count - 1 > (length - offset - element) / stride)))
    fail(in_, e.name + " with " + detail::counted(e.count, "element") + " does not fit into its buffer");
  std::vector<double> values(e.count * e.width);
  for (std::uint64_t k = 0; k < e.count; ++k)
    for (std::size_t c = 0; c < e.width; ++c)
      values[k * e.width + c] = e.component.load(bytes, begin + offset + k * stride + c * e.component.size);
  return values;
}

/// Replaces the values of some elements.
void GltfFile::read_sparse(const Json& sparse, Elements e, std::vector<double>& values) {
  const std::uint64_t count = e.count;
  e.name += " (sparse)";
  const auto part = [&](const char* member) -> const Json& {
    if (!sparse.is_object() || !sparse.contains(member) || !sparse[member].is_object())
      fail(in_, e.name + " has no " + member);
    return sparse[member];
  };
  const std::optional<Component> index = find_component(whole(part("indices"), "componentType", 0));
  if (!index) fail(in_, e.name + " has indices of an unsupported type");
  e.count = whole(sparse, "count", 0);
  const std::vector<double> at = read_elements(part("indices"), {e.name, *index, e.count}),
                            changed = read_elements(part("values"), e);
  for (std::uint64_t k = 0; k < e.count; ++k) {
    if (!(at[k] >= 0 && at[k] < static_cast<double>(count)))
      fail(in_, e.name + " changes element " + detail::number(at[k]) + " of " + std::to_string(count));
    for (std::size_t c = 0; c < e.width; ++c)
      values[static_cast<std::size_t>(at[k]) * e.width + c] = changed[k * e.width + c];
  }
}

GltfArray GltfFile::array(std::uint64_t number) {
  const Json& accessor = item("accessors", number);
  const std::string name = "accessor " + std::to_string(number);
  const std::optional<Component> component = find_component(whole(accessor, "componentType", 0));
  const auto type = accessor.find("type");
  const std::string kind = type != accessor.end() && type->is_string() ? type->get<std::string>() : "";
  const std::size_t width = kind == "SCALAR" ? 1 : kind == "VEC2" ? 2 : kind == "VEC3" ? 3 : kind == "VEC4" ? 4 : 0;
  if (!component || width == 0) fail(in_, name + " has an unsupported type");
  const Elements elements{name, *component, whole(accessor, "count", 0), width};
  GltfArray result{elements.count, width, {}};
  const bool is_sparse = accessor.contains("sparse");
  if (accessor.contains("bufferView")) {
    result.values = read_elements(accessor, elements);
  } else if (!is_sparse) {
    fail(in_, name + " has no data");
  } else {  // zeros, which have no bytes in the file
    if (elements.count > room_for_input() / (sizeof(double) * width)) fail_too_large(in_, name, room_for_input());
    result.values.resize(elements.count * width);
  }
  if (is_sparse) read_sparse(accessor["sparse"], elements, result.values);
  const auto flag = accessor.find("normalized");
  if (flag != accessor.end() && flag->is_boolean() && flag->get<bool>())
    for (double& value : result.values) value = std::max(value / component->largest, -1.0);
  return result;
}

bool GltfFile::lists(const char* list, const char* name) const {
  const auto found = root_.find(list);
  return found != root_.end() && found->is_array() && std::ranges::find(*found, Json(name)) != found->end();
}

namespace {

using Json = GltfFile::Json;
using Columns = std::array<Vec3, 4>;

constexpr std::uint64_t none = std::numeric_limits<std::uint64_t>::max();
constexpr Columns unplaced = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}}};

/// The transformation b followed by a.
Columns product(const Columns& a, const Columns& b) {
  Columns result{};
  for (std::size_t k = 0; k < 4; ++k)
    for (std::size_t r = 0; r < 3; ++r)
      result[k][r] = a[0][r] * b[k][0] + a[1][r] * b[k][1] + a[2][r] * b[k][2] + (k == 3 ? a[3][r] : 0);
  return result;
}

/// The transformation of a node: its matrix, or its scale, followed by its rotation (a unit quaternion x, y, z, w) and translation.
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

/// The numbers in a list of nodes, in reverse order, to be pushed onto a stack.
std::vector<std::uint64_t> reversed_list(const Input& in, const Json& object, const char* member) {
  std::vector<std::uint64_t> result;
  const auto found = object.find(member);
  if (found == object.end()) return result;
  if (!found->is_array()) fail(in, "'" + std::string(member) + "' is not a list");
  for (auto entry = found->rbegin(); entry != found->rend(); ++entry) {
    if (!entry->is_number_unsigned())
      fail(in, "'" + std::string(member) + "' contains a value that is not a whole number");
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
    if (seen[number]) fail(in, "node " + std::to_string(number) + " appears twice in the scene");
    seen[number] = true;
    const Columns columns = product(parent, placement_of(file, node));
    if (const std::uint64_t mesh = file.whole(node, "mesh", none); mesh != none) result.push_back({mesh, columns});
    for (const std::uint64_t child : reversed_list(in, node, "children")) open.push_back({child, columns});
  }
  return result;
}

}  // namespace ahm::io
