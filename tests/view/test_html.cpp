#include <gtest/gtest.h>

#include <algorithm>
#include <regex>

#include "patch.hpp"

namespace ahm::view::test {
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

/// Number of bytes; 0 if the text is not base64.
std::size_t decoded_size(const std::string& text) {
  const std::size_t end = text.find_last_not_of('=') + 1, padding = text.size() - end;
  const bool is_base64 =
      text.size() % 4 == 0 && padding <= 2 &&
      text.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/") >= end;
  return is_base64 ? text.size() / 4 * 3 - padding : 0;
}

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
  scene.title = "a</script></title><b> & \"q\" @META@";
  const std::string text = page(scene);
  EXPECT_NE(text.find("a&lt;/script&gt;&lt;/title&gt;&lt;b&gt; &amp; &quot;q&quot; @META@"), std::string::npos);
  EXPECT_EQ(text.find("a</script>"), std::string::npos);
  EXPECT_EQ(data(text, "meta"), data(plain, "meta"));
}

TEST_F(Html, HoldsEveryPointOfACloud) {
  const Patch patch(10, false);
  const std::string text = page(patch.scene());
  EXPECT_EQ(decoded_size(data(text, "positions")), 121U * 12);
  EXPECT_EQ(decoded_size(data(text, "coordinates")), 121U * 8);
  EXPECT_EQ(decoded_size(data(text, "discs")), 121U * 4);
  EXPECT_EQ(decoded_size(data(text, "trust")), 121U);
  EXPECT_EQ(decoded_size(data(text, "slopes")), 121U * 6);
  EXPECT_EQ(data(text, "triangles"), "");
}

TEST_F(Html, HoldsEveryFaceOfAMesh) {
  const Patch patch(10, true);
  const std::string text = page(patch.scene());
  EXPECT_EQ(decoded_size(data(text, "positions")), 121U * 12);
  EXPECT_EQ(decoded_size(data(text, "triangles")), 100U * 2 * 3 * 4);
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
  const std::string meta = data(read(folder / "grid.html"), "meta");
  EXPECT_NE(meta.find("\"pattern\":\"grid\""), std::string::npos);
  const auto triples = [&](const std::string& name) {
    const std::size_t begin = meta.find("\"" + name + "\":[") + name.size() + 4, end = meta.find("]]", begin);
    return std::count(meta.begin() + static_cast<std::ptrdiff_t>(begin),
                      meta.begin() + static_cast<std::ptrdiff_t>(end), '[');
  };
  EXPECT_EQ(triples("curve"), 3);
  EXPECT_EQ(triples("dots"), 2);
  EXPECT_NE(meta.find("\"curve_pieces\":[0,2]"), std::string::npos);
}

TEST_F(Html, LeavesNoPlaceholder) {
  const Patch patch(4, true);
  const std::string text = page(patch.scene());
  EXPECT_FALSE(std::regex_search(text.substr(0, 4000), std::regex("@[A-Z_]+@")));
  EXPECT_EQ(text.find("@VIEWER@"), std::string::npos);
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

TEST_F(Html, TellsWhatTheColoursOfDistanceStandFor) {
  const Patch patch(10, true);
  PictureOptions options;
  options.pattern = Pattern::distance;
  options.ring_width = 0.25;
  write_html(folder / "distance.html", patch.scene(), options);
  const std::string meta = data(read(folder / "distance.html"), "meta");
  EXPECT_NE(meta.find("\"pattern\":\"distance\""), std::string::npos);
  EXPECT_NE(meta.find("\"ring_width\":0.25,"), std::string::npos);
  std::smatch rings;
  ASSERT_TRUE(std::regex_search(meta, rings, std::regex("\"rings\":([0-9.e+-]+)")));
  EXPECT_GT(std::stod(rings[1]), 0);
}

TEST_F(Html, WritesScenesWithoutAMap) {
  Patch patch(10, true);
  patch.forget_map();
  EXPECT_NE(page(patch.scene()).find("\"is_mapped\":false"), std::string::npos);
}

}  // namespace
}  // namespace ahm::view::test
