// HTML pages: self-contained, escaped, and with all data of the scene.
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>

#include "pictures.hpp"

namespace ahm::render::test {
namespace {

/// Text of the element with this id.
std::string element(const std::string& page, const std::string& id) {
  const std::size_t tag = page.find("id=\"" + id + "\">"), begin = page.find('>', tag) + 1;
  return page.substr(begin, page.find("</script>", begin) - begin);
}

/// Bytes of a text in base64; empty if it is none.
std::string decoded(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned word = 0, bits = 0;
  for (const char c : text.substr(0, text.find('='))) {
    const std::size_t digit = digits.find(c);
    if (digit == std::string::npos) return {};
    word = word << 6U | static_cast<unsigned>(digit), bits += 6;
    if (bits >= 8) bytes += static_cast<char>(word >> (bits -= 8) & 255U);
  }
  return bytes;
}

/// The JSON text of a bundle in the page (ahm/render/page.hpp).
nlohmann::json bundle(const std::string& page, const std::string& id) {
  const std::string bytes = decoded(element(page, id));
  if (bytes.substr(0, 4) != "AHM1") return {};
  std::uint32_t length = 0;
  std::memcpy(&length, bytes.data() + 4, sizeof length);
  auto meta = nlohmann::json::parse(bytes.substr(8, length));
  for (const auto& array : meta["arrays"]) {
    const std::string type = array["type"];
    const std::size_t width = type == "u8" ? 1 : type == "u16" ? 2 : 4;
    EXPECT_LE(array["at"].get<std::size_t>() + width * array["count"].get<std::size_t>(), bytes.size() - 8 - length);
  }
  return meta;
}

void expect_counts(const nlohmann::json& bundle, const std::map<std::string, std::size_t>& counts) {
  for (const auto& [name, count] : counts) EXPECT_EQ(bundle["arrays"][name]["count"], count) << name;
}

class Html : public testing::Test {
 protected:
  void SetUp() override {
    if (!can_write_html()) GTEST_SKIP() << "built without three.js";
  }
  std::string page(const Scene& scene, const PictureOptions& options = {}) const {
    write_html(folder / "page.html", scene, options);
    return read(folder / "page.html");
  }

  const Folder folder{};
  Patch mesh{10, true}, cloud{10, false};  // 121 points, 100 faces
  Scene scene = mesh.scene();
};

TEST_F(Html, IsOneFileThatIsTheSameEveryTime) {
  const std::string text = page(scene);
  EXPECT_EQ(page(scene), text);
  EXPECT_EQ(folder.files(), 1U);
  EXPECT_FALSE(std::regex_search(text, std::regex(R"((src|href)\s*=\s*["']?\s*(https?:)?//)")));
  EXPECT_EQ(text.find("@import"), std::string::npos);
  EXPECT_FALSE(std::regex_search(text.substr(0, 4000), std::regex("@[A-Z_]+@")));  // placeholders
  EXPECT_EQ(text.find("@MAIN_JS@"), std::string::npos);
}

TEST_F(Html, EscapesTheTitle) {
  const std::string plain = page(scene);
  scene.title = "a</script></title><b> & \"q\" @MAP@";
  const std::string text = page(scene);
  EXPECT_NE(text.find("a&lt;/script&gt;&lt;/title&gt;&lt;b&gt; &amp; &quot;q&quot; @MAP@"), std::string::npos);
  EXPECT_EQ(text.find("a</script>"), std::string::npos);
  EXPECT_EQ(element(text, "map_data"), element(plain, "map_data"));
  EXPECT_EQ(bundle(text, "surface_data")["title"], scene.title);
}

TEST_F(Html, HasEveryElementThatItsScriptUses) {
  const std::string text = page(scene);
  const std::regex use("element\\(\"([a-z_]+)\"\\)");
  std::size_t count = 0;
  for (std::sregex_iterator match(text.begin(), text.end(), use), end; match != end; ++match, ++count)
    EXPECT_NE(text.find("id=\"" + (*match)[1].str() + "\""), std::string::npos) << (*match)[1];
  EXPECT_GT(count, 5U);
}

TEST_F(Html, ContainsEveryPointAndFace) {
  expect_counts(bundle(page(scene), "surface_data"),
                {{"positions", 121 * 3}, {"triangles", 100 * 2 * 3}, {"faces", 100 * 2}, {"corners", 100 * 2 * 4}});
  const std::string text = page(cloud.scene());
  expect_counts(bundle(text, "surface_data"),
                {{"positions", 121 * 3}, {"discs", 121 * 4}, {"points", 121}, {"triangles", 0}});
  expect_counts(bundle(text, "map_data"), {{"uv", 121 * 2}, {"slopes", 121 * 6}});
  mesh.remove_map();
  expect_counts(bundle(page(mesh.scene()), "map_data"), {{"uv", 121 * 2}});
}

/// Gradients are stored in bytes, 127 for zero.
TEST_F(Html, ContainsTheGradientsOfEveryDisc) {
  const std::string text = page(cloud.scene()), bytes = decoded(element(text, "map_data"));
  const auto map = bundle(text, "map_data");
  std::uint32_t length = 0;
  std::memcpy(&length, bytes.data() + 4, sizeof length);
  const std::size_t begin = 8 + length + map["arrays"]["slopes"]["at"].get<std::size_t>();
  const double steepest = map["steepest"];
  const auto slope = [&](std::size_t k) {
    return steepest * (2.0 * static_cast<unsigned char>(bytes.at(begin + k)) - 254) / 255;
  };
  for (std::size_t k = 0; k < 6 * 121; k += 6)
    for (std::size_t c = 0; c < 6; ++c) EXPECT_NEAR(slope(k + c), c == 0 || c == 4 ? 1 : 0, steepest * 2 / 255) << k;
}

TEST_F(Html, FramesTheMapBesideAMuchLargerPart) {
  const double alone = bundle(page(scene), "surface_data")["scale"];
  for (const Vec3& corner : {Vec3{0, 0, 0}, Vec3{1000, 0, 0}, Vec3{1000, 1000, 0}, Vec3{0, 1000, 0}}) {
    mesh.points.push_back({corner[0] + 3, corner[1], corner[2]});
    mesh.normals.push_back({0, 0, 1});
    mesh.u.push_back(NAN), mesh.v.push_back(NAN);
  }
  mesh.add_face({121, 122, 123, 124});
  EXPECT_EQ(bundle(page(mesh.scene()), "surface_data")["scale"], alone);
}

TEST_F(Html, ContainsValuesOfThePointUnderThePointer) {
  const std::vector<double> distance(121, 2.0), spread(121, 0.5);
  const std::vector<Status> status(121, Status::ok);
  scene.details = {distance, spread, status, "face:7:0.2,0.3,0.5"};
  const auto map = bundle(page(scene), "map_data");
  expect_counts(map, {{"distance", 121}, {"spread", 121}, {"status", 121}});
  EXPECT_EQ(map["spec"], "face:7:0.2,0.3,0.5");
  scene.details.spread = std::span(spread).first(7);
  EXPECT_THROW(page(scene), InvalidArgument);
}

TEST_F(Html, ContainsThePatternTheCurveAndTheDots) {
  const std::vector<Vec3> curve{{0, 0, 0}, {0.5, 0, 0}, {0.5, 0.5, 0}}, dots{{0, 0, 0}, {1, 1, 0}};
  const std::vector<Index> pieces{2};
  scene.curve = curve;
  scene.curve_pieces = pieces;
  scene.dots = dots;
  PictureOptions options;
  options.pattern = Pattern::grid;
  const auto grid = bundle(page(scene, options), "map_data");
  EXPECT_EQ(grid["pattern"], "grid");
  EXPECT_EQ(grid["curve"].size(), 3U);
  EXPECT_EQ(grid["dots"].size(), 2U);
  EXPECT_EQ(grid["pieces"], (std::vector<int>{0, 2}));
  options.pattern = Pattern::distance;
  options.ring_width = 0.25;
  const std::string text = page(scene, options);
  const auto distance = bundle(text, "map_data");
  EXPECT_EQ(distance["pattern"], "distance");
  EXPECT_NEAR(distance["ring_width"].get<double>() * bundle(text, "surface_data")["scale"].get<double>(), 0.25, 1e-12);
}

}  // namespace
}  // namespace ahm::render::test
