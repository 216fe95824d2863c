#include <nlohmann/json.hpp>

#include "ahm/io/textured_mesh.hpp"
#include "files.hpp"

namespace ahm::io::test {
namespace {

using Json = nlohmann::json;
using ReadGltf = Files;

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

std::string glb(const Json& json, const std::string& binary = square_bytes()) {
  std::string text = json.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const auto size = static_cast<std::uint32_t>(text.size()), all = static_cast<std::uint32_t>(binary.size());
  return "glTF" + bytes_of(std::uint32_t{2}) + bytes_of(28 + size + all) + bytes_of(size) + "JSON" + text +
         bytes_of(all) + std::string("BIN\0", 4) + binary;
}

TEST_F(ReadGltf, ReadsTheSameFromABinaryFileAnotherFileAndData) {
  make("square one.bin", square_bytes());
  Json beside = square(), within = square();
  beside["buffers"][0]["uri"] = "square%20one.bin";
  within["buffers"][0]["uri"] =
      "data:application/"
      "octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAACAPwAAgD8AAAAAAAAAAAAAgD8AAAAAAAABAAIAAAACAAMA";
  for (const Geometry& g :
       {read_bytes("s.glb", glb(square())), read_bytes("s.gltf", beside.dump()), read_bytes("s.gltf", within.dump())}) {
    EXPECT_EQ(g.points, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
    EXPECT_EQ(g.face_vertices, (std::vector<Index>{0, 1, 2, 0, 2, 3}));
    EXPECT_EQ(g.face_begin, (std::vector<Offset>{0, 3, 6}));
    EXPECT_TRUE(g.warnings.empty());
  }
}

TEST_F(ReadGltf, ReadsWhatIsWritten) {
  const std::vector<Vec3> points = {{1e6, 0, 0}, {1e6 + 1, 0, 0}, {1e6 + 1, 2, 0}, {1e6, 2, 0.5}};
  const std::vector<Offset> begin = {0, 3, 6};
  const std::vector<Index> vertices = {0, 1, 2, 0, 2, 3};
  MeshPart part;
  part.name = "part";
  part.points = points;
  part.faces = {begin, vertices};
  write_textured(path("w.glb"), std::span(&part, 1));
  const Geometry g = read(path("w.glb"));
  EXPECT_EQ(g.points, points);
  EXPECT_EQ(g.face_vertices, vertices);
}

TEST_F(ReadGltf, PlacesMeshesByTheirNodes) {
  Json json = square();
  json["nodes"] = Json::parse(R"([{"children": [1, 2], "translation": [10, 0, 0]},
    {"mesh": 0, "rotation": [0, 0, 0.7071067811865476, 0.7071067811865476], "scale": [2, 3, 4]},
    {"mesh": 0, "matrix": [-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 5, 1]}])");
  const Geometry g = read_bytes("n.glb", glb(json));
  ASSERT_EQ(g.points.size(), 8u);
  const Vec3 turned{10 - 3, 2, 0};  // (1, 1, 0) scaled, turned by 90 degrees about z, moved
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(g.points[2][c], turned[c], 1e-14);
  EXPECT_EQ(g.points[6], (Vec3{9, 1, 5}));
  EXPECT_EQ(g.face(2)[1], 6) << "a mirrored face is turned over";
  EXPECT_EQ(g.face(2)[2], 5);
}

TEST_F(ReadGltf, JoinsSeamsAndPrimitivesAtEqualPositions) {
  Json json = square();
  json["meshes"][0]["primitives"].push_back(json["meshes"][0]["primitives"][0]);
  const Geometry g = read_bytes("j.glb", glb(json));
  EXPECT_EQ(g.points.size(), 4u);
  EXPECT_EQ(g.face_vertices, (std::vector<Index>{0, 1, 2, 0, 2, 3, 0, 1, 2, 0, 2, 3}));
}

TEST_F(ReadGltf, UnfoldsStripsAndFansAndReadsPoints) {
  Json json = square();
  Json& primitive = json["meshes"][0]["primitives"][0];
  primitive.erase("indices");
  const auto faces = [&](int mode) {
    primitive["mode"] = mode;
    return read_bytes("m.glb", glb(json)).face_vertices;
  };
  EXPECT_EQ(faces(5), (std::vector<Index>{0, 1, 2, 2, 1, 3}));
  EXPECT_EQ(faces(6), (std::vector<Index>{0, 1, 2, 0, 2, 3}));
  EXPECT_TRUE(faces(0).empty());
  EXPECT_EQ(read_bytes("m.glb", glb(json)).points.size(), 4u);
  EXPECT_THROW(faces(4), IoError) << "four corners are no triangles";
  EXPECT_THROW(faces(1), IoError) << "nothing but lines";
  EXPECT_THROW(faces(7), IoError);
}

TEST_F(ReadGltf, ReadsColorsOfVertices) {
  Json json = square();
  json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = 2;
  json["accessors"].push_back(
      {{"bufferView", 2}, {"componentType", 5121}, {"normalized", true}, {"count", 4}, {"type", "VEC4"}});
  json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", 60}, {"byteLength", 16}});
  const Geometry g =
      read_bytes("c.glb", glb(json, square_bytes() + std::string("\xff\x80\x40\xff", 4) + std::string(12, '\0')));
  EXPECT_EQ(g.colors[0], (std::array<std::uint8_t, 3>{255, 188, 137})) << "linear light: half of it is no middle gray";
  EXPECT_EQ(g.colors[3], (std::array<std::uint8_t, 3>{0, 0, 0}));
}

TEST_F(ReadGltf, TakesTheColorOfTheMaterialTimesThatOfVertices) {
  Json json = square();
  json["materials"] = Json::parse(R"([{"pbrMetallicRoughness": {"baseColorFactor": [0.5, 1, 0.25, 1]}}])");
  json["meshes"][0]["primitives"][0]["material"] = 0;
  EXPECT_EQ(read_bytes("m.glb", glb(json)).colors[2], (std::array<std::uint8_t, 3>{188, 255, 137}));
  json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = Json::parse("[1, 1, 1]");
  EXPECT_THROW(read_bytes("m.glb", glb(json)), IoError) << "four numbers";
  json["materials"] = Json::array();
  EXPECT_THROW(read_bytes("m.glb", glb(json)), IoError);
}

TEST_F(ReadGltf, GivesTheColorsBackThatWereWritten) {
  std::vector<Vec3> points;
  std::vector<std::array<std::uint8_t, 3>> colors;
  std::vector<Offset> begin{0};
  std::vector<Index> vertices;
  for (int level = 0; level < 256; ++level) {
    points.push_back({static_cast<double>(level), static_cast<double>(level % 2), 0});
    colors.push_back({static_cast<std::uint8_t>(level), static_cast<std::uint8_t>(255 - level), 128});
    if (level < 2) continue;
    for (const int corner : {level - 2, level - 1, level}) vertices.push_back(corner);
    begin.push_back(static_cast<Offset>(vertices.size()));
  }
  MeshPart part;
  part.name = "part", part.points = points, part.faces = {begin, vertices}, part.colors = colors;
  write_textured(path("w.glb"), std::span(&part, 1));
  EXPECT_EQ(read(path("w.glb")).colors, colors);
}

TEST_F(ReadGltf, RefusesEveryTruncation) {
  const std::string whole = glb(square());
  for (std::size_t size = 1; size < whole.size(); ++size)
    EXPECT_THROW(read_bytes("t.glb", whole.substr(0, size)), IoError) << size;
}

TEST_F(ReadGltf, RefusesArraysBeyondTheirBuffers) {
  const std::pair<const char*, std::uint64_t> lies[] = {{"/accessors/0/count", 5},
                                                        {"/accessors/0/count", std::uint64_t{1} << 62},
                                                        {"/accessors/0/byteOffset", 4},
                                                        {"/accessors/0/byteOffset", ~std::uint64_t{0}},
                                                        {"/accessors/0/componentType", 5124},
                                                        {"/accessors/0/bufferView", 2},
                                                        {"/bufferViews/0/byteLength", 61},
                                                        {"/bufferViews/0/byteOffset", 13},
                                                        {"/bufferViews/0/byteStride", 13},
                                                        {"/bufferViews/0/byteStride", 8},
                                                        {"/bufferViews/0/byteStride", ~std::uint64_t{0}},
                                                        {"/bufferViews/0/buffer", 1},
                                                        {"/buffers/0/byteLength", 61},
                                                        {"/accessors/1/count", 5},
                                                        {"/nodes/0/mesh", 1},
                                                        {"/scenes/0/nodes/0", 1},
                                                        {"/scene", 1},
                                                        {"/meshes/0/primitives/0/indices", 2},
                                                        {"/meshes/0/primitives/0/attributes/POSITION", 1}};
  for (const auto& [where, value] : lies) {
    Json json = square();
    json[Json::json_pointer(where)] = value;
    EXPECT_THROW(read_bytes("l.glb", glb(json)), IoError) << where << " = " << value;
  }
}

TEST_F(ReadGltf, RefusesVertexNumbersOutOfRange) {
  std::string bytes = square_bytes();
  bytes[48] = 4;
  expect_refused("i.glb", glb(square(), bytes), {"vertex number 4", "4 vertices"});
}

TEST_F(ReadGltf, RefusesVertexNumbersThatNoIntegerHolds) {
  for (const float number : {1e29F, -1e29F, std::numeric_limits<float>::quiet_NaN()}) {
    Json json = square();
    json["accessors"][1]["componentType"] = 5126;
    json["accessors"][1]["count"] = 3;
    std::string bytes = square_bytes();
    bytes.replace(48, 4, bytes_of(number));
    expect_refused("f.glb", glb(json, bytes), {"vertex number", "4 vertices"});
  }
}

TEST_F(ReadGltf, RefusesNodesThatAreTheirOwnDescendants) {
  Json json = square();
  json["nodes"][0]["children"] = {0};
  expect_refused("r.glb", glb(json), {"node 0"});
}

TEST_F(ReadGltf, RefusesCompressionByName) {
  Json json = square();
  json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  expect_refused("d.glb", glb(json), {"Draco", "without compression"});
  json = square();
  json["extensionsRequired"] = {"EXT_meshopt_compression"};
  expect_refused("d.glb", glb(json), {"meshopt"});
  json = square();
  json["accessors"][0]["sparse"] = {{"count", 1}};
  expect_refused("d.glb", glb(json), {"sparse"});
}

TEST_F(ReadGltf, RefusesMembersOfAnotherKind) {
  for (const char* where : {"/accessors",
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
    for (const Json& other : {Json("x"), Json(-1), Json(1.5), Json(nullptr), Json::array({1, "x"}), Json(true)}) {
      Json json = square();
      json[Json::json_pointer(where)] = other;
      EXPECT_THROW(read_bytes("k.glb", glb(json)), IoError) << where << " = " << other;
    }
}

}  // namespace
}  // namespace ahm::io::test
