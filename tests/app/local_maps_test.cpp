// Neighborhoods as NumPy archives.
#include <minizip/unzip.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "program.hpp"
#include "shapes.hpp"

namespace ahm::test {
namespace {

/// The numbers of an array in maps.npz, and its header.
template <class T>
std::vector<T> array(const std::string& name, std::string* header = nullptr) {
  const unzFile zip = unzOpen64("maps.npz");
  EXPECT_NE(zip, nullptr);
  EXPECT_EQ(unzLocateFile(zip, (name + ".npy").c_str(), 1), UNZ_OK) << name;
  unzOpenCurrentFile(zip);
  std::string bytes;
  char buffer[4096];
  for (int count; (count = unzReadCurrentFile(zip, buffer, sizeof buffer)) > 0;) bytes.append(buffer, count);
  unzClose(zip);
  const std::size_t begin = bytes.find('\n') + 1;
  if (header != nullptr) *header = bytes.substr(10, begin - 10);
  std::vector<T> values((bytes.size() - begin) / sizeof(T));
  std::memcpy(values.data(), bytes.data() + begin, values.size() * sizeof(T));
  return values;
}

class LocalMapsCommand : public InFolder {
 protected:
  const Points points = plane(12);

  LocalMapsCommand() { write("plane.xyz", xyz(points)); }
};

TEST_F(LocalMapsCommand, FindsTheNeighborsOnAPlane) {
  run_ok("local-maps plane.xyz --radius 0.2 -o maps.npz");
  const auto indptr = array<std::int64_t>("indptr");
  const auto indices = array<std::int32_t>("indices");
  const auto log = array<double>("log"), lengths = array<double>("distance"), frames = array<double>("frames");
  ASSERT_EQ(indptr.size(), points.size() + 1);
  for (std::size_t s = 0; s < points.size(); ++s) {
    ASSERT_EQ(indices[indptr[s]], s);
    ASSERT_EQ(indptr[s + 1] - indptr[s],
              std::ranges::count_if(points, [&](const Vec3& q) { return distance(q, points[s]) < 0.2; }));
    for (auto e = indptr[s]; e < indptr[s + 1]; ++e) {
      const Vec3& q = points[indices[e]];
      for (int c : {0, 1})  // point = source + u x + v y
        ASSERT_NEAR(points[s][c] + log[2 * e] * frames[9 * s + c] + log[2 * e + 1] * frames[9 * s + 3 + c], q[c],
                    1e-10);
      ASSERT_NEAR(lengths[e], distance(q, points[s]), 1e-10);
    }
  }
}

TEST_F(LocalMapsCommand, WritesTheQualityIfRequested) {
  run_ok("local-maps plane.xyz --k 9 -o maps.npz");
  const auto log = array<double>("log");
  run_ok("local-maps plane.xyz --k 9 --quality -o maps.npz");
  const auto quality = array<double>("quality");
  ASSERT_EQ(2 * quality.size(), log.size());
  EXPECT_EQ(array<double>("log"), log);
  for (const double q : quality) ASSERT_TRUE(q > 0 && q <= 1) << q;
  // Next to the rim quality is too low for some.
  EXPECT_GT(std::ranges::count_if(quality, [](double q) { return q > 0.99; }), 0.9 * quality.size());
  std::string header;
  run_ok("local-maps plane.xyz --k 9 --quality --pad --float32 -o maps.npz");
  array<float>("quality", &header);
  EXPECT_TRUE(has(header, "'<f4'", "'shape': (144, 9)"));
}

TEST_F(LocalMapsCommand, WarnsOfARadiusWithoutNeighbors) {
  const auto warnings = [](const std::string& options) {
    return run_ok("local-maps plane.xyz -o maps.npz " + options).err;
  };
  EXPECT_TRUE(has(warnings("--radius 1e-3 --k 5"), "neighborhoods without neighbors: 144 of 144"));
  EXPECT_EQ(warnings("--radius 1e-3 --k 1"), "");
  EXPECT_EQ(warnings("--radius 0.3 --k 5"), "");
}

TEST_F(LocalMapsCommand, PadsToAFixedCount) {
  write("rows.txt", "# rows\n5\n77\n\n30\n");
  expect_values(summary("local-maps plane.xyz --radius 0.15 --k 20 --pad --float32 --sources rows.txt -o maps.npz"),
                {{"/sources", 3}});
  EXPECT_EQ(array<std::int32_t>("sources"), (std::vector<std::int32_t>{5, 77, 30}));
  std::string header;
  const auto mask = array<std::uint8_t>("mask", &header);
  EXPECT_TRUE(has(header, "'shape': (3, 20)"));
  array<float>("log", &header);
  EXPECT_TRUE(has(header, "'<f4'", "'shape': (3, 20, 2)"));
  array<float>("transport", &header);
  EXPECT_TRUE(has(header, "'<c8'"));
  const auto lengths = array<float>("distance");
  for (std::size_t e = 0; e < mask.size(); ++e) {
    EXPECT_LE(lengths[e], 0.15);
    EXPECT_TRUE(mask[e] || lengths[e] == 0);
    EXPECT_TRUE(e % 20 == 0 || !mask[e] || mask[e - 1]);
  }
}

TEST_F(LocalMapsCommand, FindsTheNearestWithoutARadius) {
  run_ok("local-maps plane.xyz --k 9 --pad -o maps.npz");
  const auto mask = array<std::uint8_t>("mask");
  const auto lengths = array<double>("distance");
  ASSERT_EQ(mask.size(), 9 * points.size());
  for (std::size_t s = 0; s < points.size(); ++s) {
    std::vector<double> expected;
    for (const Vec3& q : points) expected.push_back(distance(q, points[s]));
    std::ranges::sort(expected);
    for (std::size_t k = 0; k < 9; ++k) {
      ASSERT_TRUE(mask[9 * s + k]);
      ASSERT_NEAR(lengths[9 * s + k], expected[k], 1e-10);
    }
  }
}

// Quads are refined by virtual vertices, which are not counted as neighbors.
TEST_F(LocalMapsCommand, FindsAsManyRowsAsThereAre) {
  write("quads.obj", obj(lattice(8), cells(8)));
  run_ok("local-maps quads.obj --k 13 -o maps.npz");
  auto indptr = array<std::int64_t>("indptr");
  for (std::size_t s = 0; s < 64; ++s) ASSERT_EQ(indptr[s + 1] - indptr[s], 13);
  write("cube.obj", obj(cube_sphere(1)));
  run_ok("local-maps cube.obj --k 100 -o maps.npz");
  EXPECT_EQ(array<std::int64_t>("indptr"), (std::vector<std::int64_t>{0, 8, 16, 24, 32, 40, 48, 56, 64}));
}

}  // namespace
}  // namespace ahm::test
