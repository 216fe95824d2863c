#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "ahm/applications/atlas.hpp"
#include "ahm/error.hpp"

namespace ahm::test {
namespace {

/// Charts of one turned rectangle each, as two triangles, all sizes from 0.02 to 1.
struct Charts {
  Atlas atlas;
  std::vector<Offset> begin{0};
  std::vector<Index> vertices;
  std::vector<std::array<double, 2>> sides;  ///< of the rectangles

  explicit Charts(Index count) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (Index k = 0; k < count; ++k) {
      const double a = 0.02 + 0.98 * uniform(random), b = 0.02 + 0.5 * uniform(random),
                   turn = std::numbers::pi * uniform(random), c = std::cos(turn), s = std::sin(turn),
                   x = 10 * uniform(random), y = 10 * uniform(random);
      sides.push_back({std::max(a, b), std::min(a, b)});
      const std::array<std::array<double, 2>, 4> corner{{{0, 0}, {a, 0}, {a, b}, {0, b}}};
      atlas.charts.push_back({k, {2 * k, 2 * k + 1}});
      for (int which : {0, 1, 2, 0, 2, 3}) {
        const auto [p, q] = corner[which];
        atlas.coordinates.insert(atlas.coordinates.end(), {x + c * p - s * q, y + s * p + c * q});
        vertices.push_back(4 * k + which);
      }
      for (int face = 0; face < 2; ++face) {
        begin.push_back(begin.back() + 3);
        atlas.chart_of_face.push_back(k);
      }
    }
  }
  FaceList faces() const { return {begin, vertices}; }
};

class Packed : public ::testing::TestWithParam<int> {
 protected:
  void SetUp() override {
    if (!can_pack()) GTEST_SKIP() << "this build has no stb";
  }
};

TEST_P(Packed, ChartsKeepApartInTheSquareAtOneScale) {
  const Charts charts(GetParam());
  const PackOptions options{.size = 1024, .margin = 5};
  const TextureAtlas packed = pack(charts.atlas, charts.faces(), options);
  ASSERT_EQ(packed.boxes.size(), charts.sides.size());
  double area = 0;
  for (std::size_t k = 0; k < packed.boxes.size(); ++k) {
    const TextureBox& a = packed.boxes[k];
    EXPECT_GE(std::min(a.x, a.y), options.margin);
    EXPECT_LE(std::max(a.x + a.width, a.y + a.height), options.size - options.margin);
    for (std::size_t l = 0; l < k; ++l) {
      const TextureBox& b = packed.boxes[l];
      const int gap = std::max(std::max(a.x - b.x - b.width, b.x - a.x - a.width),
                               std::max(a.y - b.y - b.height, b.y - a.y - a.height));
      EXPECT_GE(gap, options.margin) << "charts " << k << " and " << l;
    }
    for (std::size_t c = 6 * k; c < 6 * k + 6; ++c) {  // corners lie in their box
      const double x = packed.coordinates[2 * c] * options.size, y = packed.coordinates[2 * c + 1] * options.size;
      EXPECT_GE(x, a.x - 1e-9);
      EXPECT_LE(x, a.x + a.width + 1e-9);
      EXPECT_GE(y, a.y - 1e-9);
      EXPECT_LE(y, a.y + a.height + 1e-9);
    }
    for (std::size_t c = 6 * k; c < 6 * k + 5; ++c) {  // sides have the scale, whatever the chart
      const double* q = packed.coordinates.data() + 2 * c;
      const double* p = charts.atlas.coordinates.data() + 2 * c;
      EXPECT_NEAR(std::hypot(q[2] - q[0], q[3] - q[1]) * options.size,
                  packed.scale * std::hypot(p[2] - p[0], p[3] - p[1]), 1e-9);
    }
    area += packed.scale * packed.scale * charts.sides[k][0] * charts.sides[k][1];
  }
  EXPECT_NEAR(packed.filled, area / (1024 * 1024), 0.1);  // boxes are whole texels
  EXPECT_GT(packed.filled, packed.boxes.size() > 2 ? 0.5 : 0.1);
  int reach = 0;  // nothing is left of the square in one direction at least
  for (const TextureBox& box : packed.boxes) reach = std::max({reach, box.x + box.width, box.y + box.height});
  EXPECT_GT(reach, 0.97 * (options.size - options.margin));
}

INSTANTIATE_TEST_SUITE_P(Counts, Packed, ::testing::Values(1, 2, 17, 150));

TEST_F(Packed, KeepsTheHandednessOfCharts) {
  const Charts charts(9);
  const TextureAtlas packed = pack(charts.atlas, charts.faces());
  for (std::size_t f = 0; f < charts.faces().size(); ++f) {
    const auto area = [&](const std::vector<double>& q) {
      const double* p = q.data() + 6 * f;
      return (p[2] - p[0]) * (p[5] - p[1]) - (p[4] - p[0]) * (p[3] - p[1]);
    };
    EXPECT_GT(area(charts.atlas.coordinates) * area(packed.coordinates), 0);
  }
}

TEST_F(Packed, PaintsEveryChartInItsOwnColor) {
  const Charts charts(20);
  const TextureAtlas packed = pack(charts.atlas, charts.faces(), {.size = 512, .margin = 4});
  const Image image = checkerboard(packed, 8);
  ASSERT_EQ(image.width, 512);
  std::vector<std::array<int, 3>> colors;
  for (const TextureBox& box : packed.boxes) {
    const std::uint8_t* pixel = image.pixel(box.x, 511 - box.y);
    colors.push_back({pixel[0], pixel[1], pixel[2]});
    EXPECT_EQ(pixel[3], 255);
    EXPECT_TRUE(std::equal(pixel, pixel + 3, image.pixel(box.x, 511 - box.y - 1)));
    const std::uint8_t* below = image.pixel(box.x, 511 - box.y + 1);  // in the margin
    EXPECT_LT(below[0] + below[1] + below[2], 3 * 255);
  }
  for (std::size_t k = 0; k < colors.size(); ++k)
    for (std::size_t l = 0; l < k; ++l) EXPECT_NE(colors[k], colors[l]);
}

TEST_F(Packed, RefusesWhatDoesNotFit) {
  const Charts charts(150);
  EXPECT_THROW(pack(charts.atlas, charts.faces(), {.size = 32, .margin = 4}), InvalidArgument);
  EXPECT_THROW(pack(charts.atlas, charts.faces(), {.size = 8}), InvalidArgument);
  EXPECT_THROW(pack(charts.atlas, charts.faces(), {.margin = -1}), InvalidArgument);
  EXPECT_EQ(pack(Atlas{}, {charts.faces().begin.first(1), {}}).boxes.size(), 0U);
}

}  // namespace
}  // namespace ahm::test
