#include <cmath>
#include <cstring>
#include <filesystem>

#include "ahm/io/write.hpp"
#include "files.hpp"
#include "table.hpp"

namespace ahm::io::test {
namespace {

using WritePcd = Files;

TEST_F(WritePcd, ReadsBackExactlyWithDoublesWhereFloatsWouldLose) {
  const Result result;
  write(path("a.pcd"), result.table());
  const Geometry g = read(path("a.pcd"));
  EXPECT_EQ(g.points, result.points);
  EXPECT_EQ(g.normals[3], result.normals[3]);
  EXPECT_TRUE(std::isnan(g.normals[2][1]));
  EXPECT_EQ(g.format, "PCD binary");
}

TEST_F(WritePcd, StoresFloatsWhereTheyLoseNothing) {
  Result result;
  result.points[0] = {0.5, 1, 2};
  result.points[1] = {Result::nan, Result::nan, Result::nan};
  write(path("f.pcd"), result.table());
  const std::string text = contents(path("f.pcd"));
  EXPECT_NE(text.find("SIZE 4 4 4 4 4 4 8 8 8 8 1"), std::string::npos) << text.substr(0, 300);
  EXPECT_EQ(read(path("f.pcd")).points[0], result.points[0]);
}

TEST_F(WritePcd, HoldsTheResult) {
  const Result result;
  write(path("a.pcd"), result.table());
  const std::string text = contents(path("a.pcd"));
  EXPECT_NE(text.find("FIELDS x y z normal_x normal_y normal_z u v distance angle status\n"), std::string::npos)
      << text.substr(0, 300);
  const std::size_t body = text.find("DATA binary\n") + 12;
  const std::size_t row = 3 * 8 + 3 * 4 + 4 * 8 + 1;
  ASSERT_EQ(text.size(), body + 4 * row);
  for (std::size_t i = 0; i < 4; ++i) {
    std::array<double, 4> values{};
    std::memcpy(values.data(), text.data() + body + i * row + 36, sizeof values);
    EXPECT_EQ(text[body + i * row + row - 1], static_cast<char>(result.status[i]));
    EXPECT_EQ(std::isnan(values[0]), result.status[i] != Status::ok);
    if (result.status[i] != Status::ok) continue;
    EXPECT_EQ(values[1], result.v[i]);
  }
}

TEST_F(WritePcd, GivesThePictureAndTheViewpointBack) {
  const Result result;
  Table table = result.table();
  table.acquisition = {2, 2, {431234.567891, -2, 0.1}, {0.5, 0.5, -0.5, 0.5}};
  write(path("a.pcd"), table);
  const Geometry g = read(path("a.pcd"));
  ASSERT_TRUE(g.acquisition.has_value());
  EXPECT_EQ(g.acquisition->width, 2u);
  EXPECT_EQ(g.acquisition->height, 2u);
  EXPECT_EQ(g.acquisition->position, table.acquisition->position);
  EXPECT_EQ(g.acquisition->orientation, table.acquisition->orientation);
}

TEST_F(WritePcd, PacksColorsAsPclDoesAndStoresIntensityAsFloats) {
  const Result result;
  const std::vector<std::array<std::uint8_t, 3>> colors = {{255, 0, 1}, {1, 2, 3}, {0, 0, 0}, {9, 8, 255}};
  const std::vector<double> intensity = {0.5, 1, 2, 3};
  Table table = result.rows();
  table.add({"red", "green", "blue"}, colors);
  table.add("intensity", intensity);
  write(path("a.pcd"), table);
  const std::string text = contents(path("a.pcd"));
  EXPECT_NE(text.find("normal_z rgb intensity\nSIZE 8 8 8 4 4 4 4 4\n"), std::string::npos) << text.substr(0, 300);
  const Geometry g = read(path("a.pcd"));
  EXPECT_EQ(g.colors, colors);
  ASSERT_EQ(g.properties.size(), 1u);
  EXPECT_EQ(g.properties[0].values, intensity);
}

TEST_F(WritePcd, ReportsAFullDisk) {
  std::filesystem::create_symlink("/dev/full", path("a.pcd"));
  EXPECT_THROW(write(path("a.pcd"), Result().table()), IoError);
}

}  // namespace
}  // namespace ahm::io::test
