#include <gtest/gtest.h>

#include "ahm/error.hpp"
#include "patch.hpp"

namespace ahm::render::test {
namespace {

/// The kinds of picture this build can write.
std::vector<std::string> names() {
  std::vector<std::string> out;
  if (can_write_png()) out.emplace_back("picture.png");
  if (can_write_html()) out.emplace_back("picture.html");
  return out;
}

template <class Exception>
void expect_throw(const Scene& scene, const PictureOptions& options = {}) {
  const Folder folder;
  for (const std::string& name : names()) EXPECT_THROW(write_picture(folder / name, scene, options), Exception) << name;
  EXPECT_EQ(folder.files(), 0U);
}

TEST(Picture, TheEndingDecidesTheKind) {
  const Patch patch(4, true);
  const Folder folder;
  for (const std::string& name : names()) {
    write_picture(folder / name, patch.scene());
    EXPECT_EQ(read(folder / name).substr(0, 4), name == "picture.png" ? "\x89PNG" : "<!DO");
  }
  if (can_write_png()) {
    EXPECT_NO_THROW(write_picture(folder / "LOUD.PNG", patch.scene()));
  }
  for (const char* name : {"picture.jpg", "picture", ".png"})
    EXPECT_THROW(write_picture(folder / name, patch.scene()), InvalidArgument) << name;
}

TEST(Picture, AKindThisBuildLacksIsAnError) {
  const Patch patch(4, true);
  const Folder folder;
  if (!can_write_png()) {
    EXPECT_THROW(write_png(folder / "picture.png", patch.scene()), Error);
  }
  if (!can_write_html()) {
    EXPECT_THROW(write_html(folder / "picture.html", patch.scene()), Error);
  }
  EXPECT_EQ(folder.files(), 0U);
}

TEST(Picture, NothingToShowIsAnError) {
  expect_throw<InvalidGeometry>(Scene{});
  Patch patch(4, false);
  for (Vec3& point : patch.points) point[1] = std::numeric_limits<double>::infinity();
  expect_throw<InvalidGeometry>(patch.scene());
}

TEST(Picture, ArraysMustMatch) {
  const Patch patch(4, true);
  Scene scene = patch.scene();
  scene.u = scene.u.first(3);
  expect_throw<InvalidArgument>(scene);
  scene = patch.scene();
  scene.normals = scene.normals.first(3);
  expect_throw<InvalidArgument>(scene);
  scene = patch.scene();
  scene.face_begin = scene.face_begin.first(3);
  expect_throw<InvalidArgument>(scene);
}

TEST(Picture, CellsNeedLabelsAndMapsNeedCoordinates) {
  const Patch patch(4, true);
  PictureOptions options;
  options.pattern = Pattern::cells;
  expect_throw<InvalidArgument>(patch.scene(), options);
  const std::vector<Index> labels(patch.points.size(), 0);
  Scene scene = patch.scene();
  scene.labels = labels;
  scene.distance = patch.u;
  expect_throw<InvalidArgument>(scene);
  scene.u = scene.v = {};
  expect_throw<InvalidArgument>(scene);
  const Folder folder;
  for (const std::string& name : names()) EXPECT_NO_THROW(write_picture(folder / name, scene, options));
}

TEST(Picture, FacesMustNamePoints) {
  for (const Index bad : {-1, 25}) {
    Patch patch(4, true);
    patch.face_vertices[7] = bad;
    expect_throw<InvalidArgument>(patch.scene());
  }
}

TEST(Picture, OptionsMustBeInRange) {
  const Patch patch(4, true);
  for (const int sectors : {0, 7, -2}) {
    PictureOptions options;
    options.sectors = sectors;
    expect_throw<InvalidArgument>(patch.scene(), options);
  }
  for (const double width : {0.0, -1.0, std::numeric_limits<double>::infinity()}) {
    PictureOptions options;
    options.ring_width = width;
    expect_throw<InvalidArgument>(patch.scene(), options);
  }
  PictureOptions options;
  options.view_direction = {{0, 0, 0}};
  expect_throw<InvalidArgument>(patch.scene(), options);
  options = {};
  options.width = 0;
  expect_throw<InvalidArgument>(patch.scene(), options);
}

TEST(Picture, DegenerateFacesDoNoHarm) {
  Patch patch(4, true);
  for (std::size_t k = 0; k < 4; ++k) patch.face_vertices[k] = 0;
  patch.points[12][0] = std::numeric_limits<double>::quiet_NaN();
  const Folder folder;
  for (const std::string& name : names()) EXPECT_NO_THROW(write_picture(folder / name, patch.scene()));
}

}  // namespace
}  // namespace ahm::render::test
