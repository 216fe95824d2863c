#include <limits>
#include <nlohmann/json.hpp>

#include "io/cases.hpp"
#include "io/files.hpp"

namespace ahm::io::test {
namespace gltf_files {

using Json = nlohmann::json;

/// Four corners of a square as floats, then two triangles of 16-bit indices.
std::string square_bytes() {
  std::string bytes;
  for (const float x : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 1.f, 1.f, 0.f, 0.f, 1.f, 0.f}) bytes += bytes_of(x);
  for (const std::uint16_t index : {0, 1, 2, 0, 2, 3}) bytes += bytes_of(index);
  return bytes;
}

Json square() {
  return Json::parse(R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
                  {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}],
    "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 12}],
    "buffers": [{"byteLength": 60}]})");
}

/// The square with one value of another kind or size.
Json square_with(const std::string& pointer, const Json& value) {
  Json json = square();
  json[Json::json_pointer(pointer)] = value;
  return json;
}

std::string glb(const Json& json, const std::string& binary = square_bytes()) {
  std::string text = json.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const auto size = static_cast<std::uint32_t>(text.size()), all = static_cast<std::uint32_t>(binary.size());
  return "glTF" + bytes_of(std::uint32_t{2}) + bytes_of(28 + size + all) + bytes_of(size) + "JSON" + text +
         bytes_of(all) + std::string("BIN\0", 4) + binary;
}

const std::string corners = "0 0 0, 1 0 0, 1 1 0, 0 1 0", faces = "; faces 0 1 2, 0 2 3";

void add_good(Cases& c) {
  c.good("square.glb", glb(square()), corners + faces, Cases::all);
  c.good(
      "data.gltf",
      square_with("/buffers/0/uri",
                  "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAACAPwAAgD8AAAAAAAAAAAAAgD8AAA"
                  "AAAAABAAIAAAACAAMA")
          .dump(),
      corners + faces);
  // The first mesh is scaled, rotated by 120 degrees about (1, 1, 1) and moved; the second is mirrored and moved.
  c.good("nodes.glb", glb(square_with("/nodes", Json::parse(R"([{"children": [1, 2], "translation": [10, 0, 0]},
           {"mesh": 0, "rotation": [0.5, 0.5, 0.5, 0.5], "scale": [2, 3, 4]},
           {"mesh": 0, "matrix": [-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 5, 1]}])"))),
         "10 0 0, 10 2 0, 10 2 3, 10 0 3, 10 0 5, 9 0 5, 9 1 5, 10 1 5; faces 0 1 2, 0 2 3, 4 6 5, 4 7 6");
  const Json primitive = square()["meshes"][0]["primitives"][0];
  c.good("seams.glb", glb(square_with("/meshes/0/primitives", {primitive, primitive})),
         corners + faces + ", 0 1 2, 0 2 3");

  for (const auto& [mode, expected] : {std::pair{5, "; faces 0 1 2, 2 1 3"}, {6, "; faces 0 1 2, 0 2 3"}, {0, ""}}) {
    Json json = square_with("/meshes/0/primitives/0/mode", mode);
    json["meshes"][0]["primitives"][0].erase("indices");
    c.good("modes.glb", glb(json), corners + expected);
  }
  for (const int mode : {4, 1, 7}) {  // four corners are not triangles; lines; unknown
    Json json = square_with("/meshes/0/primitives/0/mode", mode);
    json["meshes"][0]["primitives"][0].erase("indices");
    c.bad("modes.glb", glb(json));
  }

  Json json = square_with("/meshes/0/primitives/0/attributes/COLOR_0", 2);
  json["accessors"].push_back(
      {{"bufferView", 2}, {"componentType", 5121}, {"normalized", true}, {"count", 4}, {"type", "VEC4"}});
  json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", 60}, {"byteLength", 16}});
  json["buffers"][0]["byteLength"] = 76;
  c.good("colors.glb", glb(json, square_bytes() + std::string("\xff\x80\x40\xff", 4) + std::string(12, '\0')),
         corners + faces + "; colors 255 188 137, 0 0 0, 0 0 0, 0 0 0");  // linear light

  json = square_with("/meshes/0/primitives/0/material", 0);
  const auto with_color = [&](const std::vector<double>& color) {
    json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorFactor", color}}}}};
    return glb(json);
  };
  c.good("material.glb", with_color({0.5, 1, 0.25, 1}),
         corners + faces + "; colors 188 255 137, 188 255 137, 188 255 137, 188 255 137");
  c.bad("material.glb", with_color({1, 1, 1}));
  json["materials"] = Json::array();
  c.bad("material.glb", glb(json));
}

void add_bad(Cases& c) {
  for (const std::string lie :
       {"/accessors/0/count 5", "/accessors/0/count 4611686018427387904", "/accessors/0/byteOffset 4",
        "/accessors/0/byteOffset 18446744073709551615", "/accessors/0/componentType 5124", "/accessors/0/bufferView 2",
        "/accessors/1/count 5", "/bufferViews/0/byteLength 61", "/bufferViews/0/byteOffset 13",
        "/bufferViews/0/byteStride 13", "/bufferViews/0/byteStride 8", "/bufferViews/0/byteStride 18446744073709551615",
        "/bufferViews/0/buffer 1", "/buffers/0/byteLength 61", "/nodes/0/mesh 1", "/scenes/0/nodes/0 1", "/scene 1",
        "/meshes/0/primitives/0/indices 2", "/meshes/0/primitives/0/attributes/POSITION 1"}) {
    const std::size_t blank = lie.find(' ');
    c.bad("lie.glb", glb(square_with(lie.substr(0, blank), Json::parse(lie.substr(blank)))));
  }
  for (const std::string pointer : {"/accessors",
                                    "/accessors/0",
                                    "/accessors/0/count",
                                    "/accessors/0/type",
                                    "/bufferViews",
                                    "/bufferViews/0/buffer",
                                    "/buffers",
                                    "/buffers/0/byteLength",
                                    "/meshes",
                                    "/meshes/0",
                                    "/meshes/0/primitives",
                                    "/meshes/0/primitives/0",
                                    "/meshes/0/primitives/0/attributes",
                                    "/meshes/0/primitives/0/attributes/POSITION",
                                    "/nodes",
                                    "/nodes/0/mesh",
                                    "/scenes/0",
                                    "/scenes/0/nodes",
                                    "/scenes/0/nodes/0",
                                    "/asset"})
    for (const Json& value : {Json("x"), Json(-1), Json(1.5), Json(nullptr), Json::array({1, "x"}), Json(true)})
      c.bad("kind.glb", glb(square_with(pointer, value)));

  std::string bytes = square_bytes();
  bytes[48] = 4;
  c.bad("index.glb", glb(square(), bytes), {"vertex number 4", "4 vertices"});
  for (const float number : {1e29F, -1e29F, std::numeric_limits<float>::quiet_NaN()}) {
    Json json = square_with("/accessors/1/componentType", 5126);
    json["accessors"][1]["count"] = 3;
    c.bad("float.glb", glb(json, square_bytes().replace(48, 4, bytes_of(number))), {"vertex number", "4 vertices"});
  }
  c.bad("cycle.glb", glb(square_with("/nodes/0/children", {0})), {"node 0"});
  c.good("draco.glb",
         glb(square_with("/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression", {{"bufferView", 0}})),
         corners + faces);
  c.bad("meshopt.glb", glb(square_with("/extensionsRequired", {"EXT_meshopt_compression"})), {"meshopt"});
  c.bad("sparse.glb", glb(square_with("/accessors/0/sparse", {{"count", 1}})), {"sparse"});
}

class ReadGltf : public Files {};

TEST_F(ReadGltf, ReadsBuffersInOtherFiles) {
  make("square one.bin", square_bytes());
  const std::string gltf = square_with("/buffers/0/uri", "square%20one.bin").dump();
  EXPECT_EQ(contents_of(read_bytes("square.gltf", gltf)), corners + faces);
}

}  // namespace gltf_files

Cases gltf_cases() {
  using namespace gltf_files;
  Cases c;
  add_good(c), add_bad(c);
  return c;
}

}  // namespace ahm::io::test
