// Files of pictures: their formats, and the scenes and options that are errors.
#include "ahm/io/image.hpp"
#include "pictures.hpp"

namespace ahm::render::test {
namespace {

/// File names of the formats of this build.
std::vector<std::string> names() {
  std::vector<std::string> names;
  if (can_write_png()) names.emplace_back("picture.png");
  if (can_write_html()) names.emplace_back("picture.html");
  return names;
}

void expect_written(const Scene& scene, const PictureOptions& options = {}) {
  const Folder folder{};
  for (const std::string& name : names()) EXPECT_NO_THROW(write_picture(folder / name, scene, options)) << name;
}

template <class Exception>
void expect_refused(const Scene& scene, const PictureOptions& options = {}) {
  const Folder folder{};
  for (const std::string& name : names()) EXPECT_THROW(write_picture(folder / name, scene, options), Exception) << name;
  EXPECT_EQ(folder.files(), 0U);
}

class Picture : public testing::Test {
 protected:
  Patch patch{4, true};
  const Folder folder{};
};

TEST_F(Picture, TheExtensionDeterminesTheFormat) {
  for (const std::string& name : names()) {
    write_picture(folder / name, patch.scene());
    EXPECT_EQ(read(folder / name).substr(0, 4), name == "picture.png" ? "\x89PNG" : "<!DO");
  }
  if (can_write_png()) EXPECT_NO_THROW(write_picture(folder / "LOUD.PNG", patch.scene()));
  for (const char* name : {"picture.jpg", "picture", ".png"})
    EXPECT_THROW(write_picture(folder / name, patch.scene()), InvalidArgument) << name;
}

TEST_F(Picture, AFormatThatThisBuildLacksIsAnError) {
  if (!can_write_png()) EXPECT_THROW(write_png(folder / "picture.png", patch.scene()), Error);
  if (!can_write_html()) EXPECT_THROW(write_html(folder / "picture.html", patch.scene()), Error);
  EXPECT_EQ(folder.files(), 0U);
}

TEST_F(Picture, PngFilesContainTheDrawing) {
  if (!can_write_png()) GTEST_SKIP() << "built without stb";
  const auto file = folder / "picture.png";
  write_png(file, patch.scene(), from_above());
  const Image found = io::read_image(file);
  EXPECT_EQ(found.width, 400);
  EXPECT_EQ(found.rgba, draw_picture(patch.scene(), from_above()).rgba);
  const std::string bytes = read(file);
  write_png(file, patch.scene(), from_above());
  EXPECT_EQ(read(file), bytes);
  EXPECT_THROW(write_png(folder / "missing/picture.png", patch.scene(), from_above()), IoError);
  EXPECT_EQ(folder.files(), 1U);
}

TEST_F(Picture, ScenesWithoutFinitePointsAreErrors) {
  expect_refused<InvalidGeometry>(Scene{});
  for (Vec3& point : patch.points) point[1] = INFINITY;
  expect_refused<InvalidGeometry>(patch.scene());
}

TEST_F(Picture, ArraysMustMatch) {
  Scene u = patch.scene(), normals = u, faces = u;
  u.u = u.u.first(3);
  normals.normals = normals.normals.first(3);
  faces.face_begin = faces.face_begin.first(3);
  for (const Scene& scene : {u, normals, faces}) expect_refused<InvalidArgument>(scene);
  for (const Index corner : {-1, 25}) {
    patch.face_vertices[7] = corner;
    expect_refused<InvalidArgument>(patch.scene());
  }
}

TEST_F(Picture, CellsNeedLabelsAndMapsNeedCoordinates) {
  PictureOptions options;
  options.pattern = Pattern::cells;
  expect_refused<InvalidArgument>(patch.scene(), options);
  const std::vector<Index> labels(patch.points.size(), 0);
  Scene scene = patch.scene();
  scene.labels = labels;
  scene.distance = patch.u;
  expect_refused<InvalidArgument>(scene);
  scene.u = scene.v = {};
  expect_refused<InvalidArgument>(scene);
  expect_written(scene, options);
}

TEST_F(Picture, OptionsMustBeInRange) {
  std::vector<PictureOptions> wrong(8);
  wrong[0].sectors = 0, wrong[1].sectors = 7, wrong[2].sectors = -2;
  wrong[3].ring_width = 0.0, wrong[4].ring_width = -1.0, wrong[5].ring_width = INFINITY;
  wrong[6].view_direction = {{0, 0, 0}};
  wrong[7].width = 0;
  for (std::size_t k = 0; k < wrong.size(); ++k) {
    SCOPED_TRACE(k);
    expect_refused<InvalidArgument>(patch.scene(), wrong[k]);
  }
}

TEST_F(Picture, DegenerateFacesAreAllowed) {
  for (std::size_t k = 0; k < 4; ++k) patch.face_vertices[k] = 0;
  patch.points[12][0] = NAN;
  expect_written(patch.scene());
}

}  // namespace
}  // namespace ahm::render::test
