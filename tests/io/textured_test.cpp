#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <sstream>

#include "ahm/io/textured_mesh.hpp"
#include "files.hpp"

namespace ahm::io::test {
namespace {

class Textured : public Files {};

/// A quadrilateral and a triangle with a common edge, which is a seam.
struct Shape {
  std::vector<Vec3> points{{0, 0, 0}, {1, 0, 0}, {9, 9, 9}, {1, 1, 0.25}, {0, 1, 0}, {2, 0.1, 1e-9}};  // 2: unused
  std::vector<Vec3> normals = std::vector<Vec3>(6, Vec3{0, 0, 1});
  std::vector<Offset> begin{0, 4, 7};
  std::vector<Index> vertices{0, 1, 3, 4, 1, 5, 3};
  std::vector<double> uv{0, 0, 0.5, 0, 0.5, 0.5, 0, 0.5, 0.75, 0.75, 1, 1, 0.75, 1};

  MeshPart part(const Image* image) const {
    return {.name = "shape",
            .points = points,
            .normals = normals,
            .faces = {begin, vertices},
            .texture_coordinates = uv,
            .texture = image};
  }
};

Image gradient(int width, int height) {
  Image image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 4; ++c) image.pixel(x, y)[c] = static_cast<std::uint8_t>(16 * x + 5 * y + 40 * c);
  return image;
}

TEST_F(Textured, ImagesReadBackAsWritten) {
  if (!has_images()) GTEST_SKIP() << "this build has no stb";
  const Image image = gradient(7, 5);
  write_png(path("a.png"), image);
  const Image back = read_image(path("a.png"));
  EXPECT_EQ(back.width, 7);
  EXPECT_EQ(back.height, 5);
  EXPECT_EQ(back.rgba, image.rgba);
  EXPECT_THROW(read_image(path("none.png")), IoError);
  EXPECT_THROW(read_image(make("text.png", "no image")), IoError);
  EXPECT_THROW(read_image(make("cut.png", png_bytes(image).substr(0, 60))), IoError);
}

TEST(ImageSample, IsTheMiddleOfAPixelAndLinearBetween) {
  Image image(4, 2);
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 4; ++x)
      for (int c = 0; c < 4; ++c) image.pixel(x, y)[c] = static_cast<std::uint8_t>(c == 3 ? 255 : 40 * x + 10 * y + c);
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 4; ++x)
      for (int c = 0; c < 4; ++c)
        EXPECT_NEAR(image.sample((x + 0.5) / 4, 1 - (y + 0.5) / 2)[c], image.pixel(x, y)[c] / 255.0, 1e-12);
  EXPECT_NEAR(image.sample(0.4, 0.6)[0] * 255, 40 * (0.4 * 4 - 0.5) + 10 * (0.4 * 2 - 0.5), 1e-12);
  EXPECT_EQ(image.sample(-3, 5), image.sample(0, 1));
  // Transparent pixels do not contribute their color.
  image.pixel(1, 0)[3] = 0;
  EXPECT_NEAR(image.sample(0.25, 0.75)[0] * 255, 0, 1e-12);
  EXPECT_NEAR(image.sample(0.25, 0.75)[3], 0.5, 1e-12);
}

TEST_F(Textured, ObjReadsBackWithItsMaterialsAndTexture) {
  if (!has_images()) GTEST_SKIP() << "this build has no stb";
  const Shape shape;
  const Image image = gradient(8, 8);
  MeshPart base = shape.part(nullptr);
  base.name = "base", base.texture_coordinates = {}, base.color = {0.25, 0.5, 0.125};
  MeshPart decal = shape.part(&image);
  decal.transparent = true;
  write_textured(path("out.obj"), std::array{base, decal});
  EXPECT_EQ(files_left(), 3U);
  EXPECT_EQ(read_image(path("out_shape.png")).rgba, image.rgba);
  const std::string materials = contents(path("out.mtl"));
  EXPECT_NE(materials.find("newmtl base\n"), std::string::npos);
  EXPECT_NE(materials.find("Kd 0.25 0.5 0.125\n"), std::string::npos);
  EXPECT_NE(materials.find("map_Kd out_shape.png\nmap_d out_shape.png\n"), std::string::npos);

  const Geometry back = read(path("out.obj"));
  ASSERT_EQ(back.points.size(), 10U);
  ASSERT_EQ(back.face_count(), 4U);
  // Texture coordinates of the corners of the second part.
  std::vector<std::array<double, 2>> vt;
  std::vector<double> uv;
  std::vector<Index> corners;
  std::istringstream text(contents(path("out.obj")));
  for (std::string word; text >> word;) {
    if (word == "vt") vt.emplace_back(), text >> vt.back()[0] >> vt.back()[1];
    if (word.find('/') == std::string::npos || word.find("//") != std::string::npos) continue;
    std::size_t slash = word.find('/');
    corners.push_back(std::stoi(word) - 1);
    for (double x : vt.at(std::stoul(word.substr(slash + 1)) - 1)) uv.push_back(x);
  }
  EXPECT_EQ(uv, shape.uv);
  ASSERT_EQ(corners.size(), shape.vertices.size());
  for (std::size_t c = 0; c < corners.size(); ++c) {
    EXPECT_EQ(back.points[corners[c]], shape.points[shape.vertices[c]]);
    EXPECT_EQ(back.points[back.face_vertices[c]], shape.points[shape.vertices[c]]);
  }
}

/// The two chunks of a .glb file.
struct Glb {
  nlohmann::json json;
  std::string bytes;

  explicit Glb(const std::string& file) {
    const auto word = [&](std::size_t at) {
      std::uint32_t value;
      std::memcpy(&value, file.data() + at, 4);
      return value;
    };
    EXPECT_EQ(file.substr(0, 4), "glTF");
    EXPECT_EQ(word(4), 2U);
    EXPECT_EQ(word(8), file.size());
    EXPECT_EQ(word(12) % 4, 0U);
    EXPECT_EQ(file.substr(16, 4), "JSON");
    json = nlohmann::json::parse(file.substr(20, word(12)));
    const std::size_t binary = 20 + word(12);
    EXPECT_EQ(file.substr(binary + 4, 4), std::string("BIN\0", 4));
    bytes = file.substr(binary + 8);
    EXPECT_EQ(bytes.size(), word(binary));
    EXPECT_EQ(json["buffers"].at(0)["byteLength"], bytes.size());
  }

  template <class T>
  std::vector<T> accessor(int index) const {
    const auto& a = json.at("accessors").at(static_cast<std::size_t>(index));
    const auto& view = json.at("bufferViews").at(a.at("bufferView").get<std::size_t>());
    const std::size_t width = a.at("type") == "SCALAR" ? 1 : a.at("type") == "VEC2" ? 2 : 3;
    EXPECT_EQ(view.at("byteLength"), a.at("count").get<std::size_t>() * width * sizeof(T));
    EXPECT_EQ(view.at("byteOffset").get<std::size_t>() % 4, 0U);
    std::vector<T> values(a.at("count").get<std::size_t>() * width);
    std::memcpy(values.data(), bytes.data() + view.at("byteOffset").get<std::size_t>(), values.size() * sizeof(T));
    return values;
  }
};

TEST_F(Textured, GlbReadsBackFarFromTheOriginToo) {
  if (!has_images()) GTEST_SKIP() << "this build has no stb";
  for (double away : {0.0, 4e6}) {
    Shape shape;
    for (Vec3& p : shape.points)
      for (double& x : p) x += away;
    const Image image = gradient(8, 8);
    MeshPart part = shape.part(&image);
    part.transparent = true;
    write_textured(path("out.glb"), std::array{part});
    const Glb glb(contents(path("out.glb")));
    EXPECT_EQ(glb.json["asset"]["version"], "2.0");
    const auto& primitive = glb.json["meshes"].at(0)["primitives"].at(0);
    const auto positions = glb.accessor<float>(primitive["attributes"]["POSITION"]),
               uv = glb.accessor<float>(primitive["attributes"]["TEXCOORD_0"]),
               normals = glb.accessor<float>(primitive["attributes"]["NORMAL"]);
    const auto indices = glb.accessor<std::uint32_t>(primitive["indices"]);
    const auto& node = glb.json["nodes"].at(glb.json["scenes"].at(0)["nodes"].at(0).get<std::size_t>());
    EXPECT_EQ(node["mesh"], 0);
    const int corners[] = {0, 1, 2, 0, 2, 3, 4, 5, 6};  // of the fans
    ASSERT_EQ(indices.size(), 9U);
    for (std::size_t k = 0; k < 9; ++k) {
      const auto c = static_cast<std::size_t>(corners[k]);
      for (std::size_t a = 0; a < 3; ++a) {
        EXPECT_NEAR(positions[3 * indices[k] + a] + node["translation"].at(a).get<double>(),
                    shape.points[shape.vertices[c]][a], 2e-7);
        EXPECT_EQ(normals[3 * indices[k] + a], a == 2 ? 1.f : 0.f);
      }
      EXPECT_EQ(uv[2 * indices[k]], static_cast<float>(shape.uv[2 * c]));
      EXPECT_EQ(uv[2 * indices[k] + 1], static_cast<float>(1 - shape.uv[2 * c + 1]));
    }
    const auto& material = glb.json["materials"].at(primitive["material"].get<std::size_t>());
    EXPECT_EQ(material["alphaMode"], "BLEND");
    const auto& view = glb.json["bufferViews"].at(glb.json["images"].at(0)["bufferView"].get<std::size_t>());
    make("inside.png", glb.bytes.substr(view["byteOffset"], view["byteLength"]));
    EXPECT_EQ(read_image(path("inside.png")).rgba, image.rgba);
  }
}

TEST_F(Textured, PlyHasAVertexForEveryPairOfCoordinatesOfAPoint) {
  const Shape shape;
  MeshPart plain = shape.part(nullptr);
  plain.name = "rest", plain.texture_coordinates = {};
  write_textured(path("a.ply"), std::array{shape.part(nullptr), plain});
  const Geometry back = read(path("a.ply"));
  // Points 1 and 3 lie on the seam: 5 + 2 vertices with coordinates, 5 without.
  ASSERT_EQ(back.points.size(), 12u);
  ASSERT_EQ(back.face_count(), 4u);
  for (std::size_t c = 0; c < 14; ++c)
    EXPECT_EQ(back.points[back.face_vertices[c]], shape.points[shape.vertices[c % 7]]) << c;
  const std::string bytes = contents(path("a.ply"));
  for (const char* line : {"property double s\nproperty double t\nproperty int point\n", "element vertex 12\n"})
    EXPECT_NE(bytes.find(line), std::string::npos) << line;
  // x y z nx ny nz s t point: the values of each corner.
  const std::size_t stride = 8 * sizeof(double) + sizeof(std::int32_t), body = bytes.find("end_header\n") + 11;
  for (std::size_t c = 0; c < 7; ++c) {
    std::array<double, 2> st{};
    std::int32_t point = -1;
    const std::size_t at = body + stride * static_cast<std::size_t>(back.face_vertices[c]) + 6 * sizeof(double);
    std::memcpy(st.data(), bytes.data() + at, sizeof st);
    std::memcpy(&point, bytes.data() + at + sizeof st, sizeof point);
    EXPECT_EQ(st[0], shape.uv[2 * c]);
    EXPECT_EQ(st[1], shape.uv[2 * c + 1]);
    EXPECT_EQ(point, shape.vertices[c]);
  }
  const Image image = gradient(4, 4);
  EXPECT_THROW(write_textured(path("b.ply"), std::array{shape.part(&image)}), InvalidArgument);
  EXPECT_FALSE(std::filesystem::exists(path("b.ply")));
}

TEST_F(Textured, ColorsAndPropertiesGoWithThePoints) {
  const Shape shape;
  std::vector<std::array<std::uint8_t, 3>> colors;
  std::vector<Property> properties{{"heat", {}}, {"area", {}}};
  for (std::size_t v = 0; v < shape.points.size(); ++v) {
    colors.push_back({static_cast<std::uint8_t>(40 * v), 200, static_cast<std::uint8_t>(255 - v)});
    properties[0].values.push_back(0.5 * static_cast<double>(v));
    properties[1].values.push_back(1e-30);
  }
  MeshPart mapped = shape.part(nullptr), rest = mapped;
  rest.name = "rest", rest.texture_coordinates = {};
  mapped.colors = rest.colors = colors;
  mapped.properties = properties;
  rest.properties = std::span(properties).first(1);  // properties that only some parts have are omitted
  write_textured(path("a.ply"), std::array{mapped, rest});
  write_textured(path("a.obj"), std::array{mapped});
  const Geometry ply = read(path("a.ply")), obj = read(path("a.obj"));
  const auto named = [&](const char* name) {
    return std::find_if(ply.properties.begin(), ply.properties.end(),
                        [&](const Property& p) { return p.name == name; });
  };
  ASSERT_NE(named("heat"), ply.properties.end());
  EXPECT_EQ(named("area"), ply.properties.end());
  for (std::size_t c = 0; c < ply.face_vertices.size(); ++c) {
    const Index v = shape.vertices[c % shape.vertices.size()];
    EXPECT_EQ(ply.colors[ply.face_vertices[c]], colors[v]);
    EXPECT_EQ(named("heat")->values[ply.face_vertices[c]], 0.5 * v);
  }
  ASSERT_EQ(obj.face_vertices.size(), shape.vertices.size());
  for (std::size_t c = 0; c < obj.face_vertices.size(); ++c)
    EXPECT_EQ(obj.colors[obj.face_vertices[c]], colors[shape.vertices[c]]);

  write_textured(path("a.glb"), std::array{mapped});
  const Glb glb(contents(path("a.glb")));
  const auto& attributes = glb.json["meshes"][0]["primitives"][0]["attributes"];
  const auto light = glb.accessor<float>(attributes.at("COLOR_0"));
  EXPECT_EQ(light[0], 0);
  EXPECT_NEAR(light[1], 0.57758, 1e-5);  // of level 200
  EXPECT_EQ(light[2], 1);
  EXPECT_EQ(glb.json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"], (std::vector<double>{1, 1, 1, 1}));

  properties[0].name = "s";
  EXPECT_THROW(write_textured(path("b.ply"), std::array{mapped}), InvalidArgument);
  colors.pop_back();
  mapped.colors = colors;
  EXPECT_THROW(write_textured(path("b.obj"), std::array{mapped}), InvalidArgument);
}

/// A strip of triangles with all levels of red and green, far from the origin.
TEST_F(Textured, GlbReadsBackWithItsColors) {
  std::vector<Vec3> points;
  std::vector<std::array<std::uint8_t, 3>> colors;
  std::vector<Offset> begin{0};
  std::vector<Index> vertices;
  for (int level = 0; level < 256; ++level) {
    points.push_back({1e6 + level, static_cast<double>(level % 2), 0.5});
    colors.push_back({static_cast<std::uint8_t>(level), static_cast<std::uint8_t>(255 - level), 128});
    if (level < 2) continue;
    for (const int corner : {level - 2, level - 1, level}) vertices.push_back(corner);
    begin.push_back(static_cast<Offset>(vertices.size()));
  }
  MeshPart part{.name = "part", .points = points, .faces = {begin, vertices}};
  part.colors = colors;
  write_textured(path("w.glb"), std::array{part});
  const Geometry back = read(path("w.glb"));
  EXPECT_EQ(back.points, points);
  EXPECT_EQ(back.face_vertices, vertices);
  EXPECT_EQ(back.colors, colors);
  part.colors = {};
  write_textured(path("w.glb"), std::array{part});
  EXPECT_EQ(read(path("w.glb")).points, points);
}

TEST_F(Textured, RefusesPartsThatDoNotFitTogetherAndLeavesNothing) {
  const Image image = gradient(2, 2);
  const std::pair<const char*, void (*)(Shape&)> faults[] = {
      {"too few texture coordinates", [](Shape& shape) { shape.uv.resize(12); }},
      {"NaN in texture coordinates", [](Shape& shape) { shape.uv[3] = std::nan(""); }},
      {"vertex 6 of 6", [](Shape& shape) { shape.vertices[2] = 6; }},
      {"NaN in points", [](Shape& shape) { shape.points[3][1] = std::nan(""); }}};
  const auto expect_refused = [&](const MeshPart& part, const char* fault) {
    for (const char* name : {"x.obj", "x.glb"})
      EXPECT_THROW(write_textured(path(name), std::array{part}), InvalidArgument) << fault;
  };
  for (const auto& [fault, add_fault] : faults) {
    Shape shape;
    add_fault(shape);
    expect_refused(shape.part(&image), fault);
  }
  const Shape shape;
  MeshPart part = shape.part(&image);
  part.name = "two words";
  expect_refused(part, "two words");
  EXPECT_THROW(write_textured(path("x.stl"), std::array{shape.part(nullptr)}), IoError);
  EXPECT_EQ(files_left(), 0U);
}

}  // namespace
}  // namespace ahm::io::test
