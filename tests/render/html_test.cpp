#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <regex>

#include "patch.hpp"

namespace ahm::render::test {
namespace {

class Html : public testing::Test {
 protected:
  void SetUp() override {
    if (!can_write_html()) GTEST_SKIP() << "built without three.js";
  }

  std::string page(const Scene& scene) const {
    write_html(folder / "page.html", scene);
    return read(folder / "page.html");
  }

  Folder folder;
};

/// Text of the element with this id.
std::string data(const std::string& page, const std::string& id) {
  const std::size_t tag = page.find("id=\"" + id + "\">"), begin = page.find('>', tag) + 1;
  return page.substr(begin, page.find("</script>", begin) - begin);
}

/// Bytes; empty if the text is not base64.
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
  const std::string bytes = decoded(data(page, id));
  if (bytes.substr(0, 4) != "AHM1") return {};
  std::uint32_t length = 0;
  std::memcpy(&length, bytes.data() + 4, sizeof length);
  auto meta = nlohmann::json::parse(bytes.substr(8, length));
  for (const auto& array : meta["arrays"]) {  // all of them lie within
    const std::string type = array["type"];
    const std::size_t width = type == "u8" ? 1 : type == "u16" ? 2 : 4;
    EXPECT_LE(array["at"].get<std::size_t>() + width * array["count"].get<std::size_t>(), bytes.size() - 8 - length);
  }
  return meta;
}

std::size_t count(const nlohmann::json& bundle, const std::string& array) { return bundle["arrays"][array]["count"]; }

TEST_F(Html, NeedsNothingFromElsewhere) {
  const Patch patch(10, true);
  const std::string text = page(patch.scene());
  EXPECT_FALSE(std::regex_search(text, std::regex(R"((src|href)\s*=\s*["']?\s*(https?:)?//)")));
  EXPECT_EQ(text.find("@import"), std::string::npos);
  EXPECT_EQ(folder.files(), 1U);
}

TEST_F(Html, EscapesTheTitle) {
  const Patch patch(10, true);
  const std::string plain = page(patch.scene());
  Scene scene = patch.scene();
  scene.title = "a</script></title><b> & \"q\" @MAP@";
  const std::string text = page(scene);
  EXPECT_NE(text.find("a&lt;/script&gt;&lt;/title&gt;&lt;b&gt; &amp; &quot;q&quot; @MAP@"), std::string::npos);
  EXPECT_EQ(text.find("a</script>"), std::string::npos);
  EXPECT_EQ(data(text, "map_data"), data(plain, "map_data"));
  EXPECT_EQ(bundle(text, "surface_data")["title"], scene.title);
}

TEST_F(Html, HoldsEveryPointOfACloud) {
  const Patch patch(10, false);
  const std::string text = page(patch.scene());
  const auto surface = bundle(text, "surface_data"), map = bundle(text, "map_data");
  EXPECT_EQ(count(surface, "positions"), 121U * 3);
  EXPECT_EQ(count(surface, "discs"), 121U * 4);
  EXPECT_EQ(count(surface, "points"), 121U);
  EXPECT_EQ(count(surface, "triangles"), 0U);
  EXPECT_EQ(count(map, "uv"), 121U * 2);
  EXPECT_EQ(count(map, "slopes"), 121U * 6);
}

TEST_F(Html, HoldsEveryFaceOfAMesh) {
  const Patch patch(10, true);
  const auto surface = bundle(page(patch.scene()), "surface_data");
  EXPECT_EQ(count(surface, "positions"), 121U * 3);
  EXPECT_EQ(count(surface, "triangles"), 100U * 2 * 3);
  EXPECT_EQ(count(surface, "faces"), 100U * 2);
  EXPECT_EQ(count(surface, "corners"), 100U * 2 * 4);  // of quadrilaterals
}

TEST_F(Html, HoldsWhatIsToldUnderThePointer) {
  const Patch patch(10, true);
  const std::vector<double> distance(121, 2.0), spread(121, 0.5);
  const std::vector<Status> status(121, Status::ok);
  Scene scene = patch.scene();
  scene.told = {distance, spread, status, "face:7:0.2,0.3,0.5"};
  const auto map = bundle(page(scene), "map_data");
  for (const char* name : {"distance", "spread", "status"}) EXPECT_EQ(count(map, name), 121U) << name;
  EXPECT_EQ(map["spec"], "face:7:0.2,0.3,0.5");
  scene.told.spread = std::span(spread).first(7);
  EXPECT_THROW(page(scene), InvalidArgument);
}

TEST_F(Html, IsTheSameEveryTime) {
  const Patch patch(40, false);
  EXPECT_EQ(page(patch.scene()), page(patch.scene()));
}

TEST_F(Html, HoldsThePatternTheCurveAndTheDots) {
  const Patch patch(10, true);
  const std::vector<Vec3> curve{{0, 0, 0}, {0.5, 0, 0}, {0.5, 0.5, 0}}, dots{{0, 0, 0}, {1, 1, 0}};
  Scene scene = patch.scene();
  const std::vector<Index> pieces{2};
  scene.curve = curve;
  scene.curve_pieces = pieces;
  scene.dots = dots;
  PictureOptions options;
  options.pattern = Pattern::grid;
  write_html(folder / "grid.html", scene, options);
  const auto map = bundle(read(folder / "grid.html"), "map_data");
  EXPECT_EQ(map["pattern"], "grid");
  EXPECT_EQ(map["curve"].size(), 3U);
  EXPECT_EQ(map["dots"].size(), 2U);
  EXPECT_EQ(map["pieces"], (std::vector<int>{0, 2}));
}

TEST_F(Html, LeavesNoPlaceholder) {
  const Patch patch(4, true);
  const std::string text = page(patch.scene());
  EXPECT_FALSE(std::regex_search(text.substr(0, 4000), std::regex("@[A-Z_]+@")));
  EXPECT_EQ(text.find("@MAIN_JS@"), std::string::npos);
}

TEST_F(Html, HasEveryElementThatItsScriptAsksFor) {
  const Patch patch(4, true);
  const std::string text = page(patch.scene());
  const std::regex asked("element\\(\"([a-z_]+)\"\\)");
  std::size_t count = 0;
  for (std::sregex_iterator match(text.begin(), text.end(), asked), end; match != end; ++match, ++count)
    EXPECT_NE(text.find("id=\"" + (*match)[1].str() + "\""), std::string::npos) << (*match)[1];
  EXPECT_GT(count, 5U);
}

TEST_F(Html, TellsWhatTheColorsOfDistanceStandFor) {
  const Patch patch(10, true);
  PictureOptions options;
  options.pattern = Pattern::distance;
  options.ring_width = 0.25;
  write_html(folder / "distance.html", patch.scene(), options);
  const std::string text = read(folder / "distance.html");
  const auto map = bundle(text, "map_data");
  EXPECT_EQ(map["pattern"], "distance");
  EXPECT_NEAR(map["ring_width"].get<double>() * bundle(text, "surface_data")["scale"].get<double>(), 0.25, 1e-12);
}

TEST_F(Html, WritesScenesWithoutAMap) {
  Patch patch(10, true);
  patch.forget_map();
  const auto map = bundle(page(patch.scene()), "map_data");
  EXPECT_EQ(count(map, "uv"), 121U * 2);
}

}  // namespace
}  // namespace ahm::render::test
