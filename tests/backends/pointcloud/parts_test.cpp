// A part of a cloud has the same map alone, among others and with its rows in another order, also where distances tie and
// neighbours lie on a circle, as on lattices.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "ahm/util/vec.hpp"
#include "solved_cloud.hpp"

namespace ahm::test {
namespace {

constexpr double spacing = 0.1;  // no power of two: equal distances of the lattice are so up to rounding only

std::vector<Vec3> flat_lattice(int side) {
  std::vector<Vec3> points;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) points.push_back({spacing * i, spacing * j, 0});
  return points;
}

/// The points of a lattice on the surface of a cube around the origin.
std::vector<Vec3> cube_lattice(int side) {
  std::vector<Vec3> points;
  for (int i = 0; i <= side; ++i)
    for (int j = 0; j <= side; ++j)
      for (int k = 0; k <= side; ++k)
        if (i % side == 0 || j % side == 0 || k % side == 0)
          points.push_back({spacing * (i - 0.5 * side), spacing * (j - 0.5 * side), spacing * (k - 0.5 * side)});
  return points;
}

std::vector<Vec3> moved(std::vector<Vec3> points, const Vec3& by) {
  for (Vec3& p : points) p = p + by;
  return points;
}

struct Part {
  const char* name;
  std::vector<Vec3> points;
};

std::vector<Part> parts() {
  return {{"flat lattice", flat_lattice(30)},
          {"moved lattice", moved(flat_lattice(30), {200.3, -57.1, 3.7})},
          {"cube", cube_lattice(14)},
          {"even sphere", even_sphere(1000).points},
          {"random sphere", random_sphere(1000).points}};
}

/// The part's rows in the file come in the order `rows`, from row `first` on.
void expect_same_maps(const Part& part, const std::vector<Vec3>& file, Index first, const std::vector<Index>& rows,
                      std::span<const Vec3> normals = {}, std::span<const Vec3> file_normals = {}) {
  const Solved alone({part.points, {normals.begin(), normals.end()}}, !normals.empty()),
      together({file, {file_normals.begin(), file_normals.end()}}, !normals.empty());
  for (const Index source : {0, 317}) {
    const auto at = static_cast<Index>(std::find(rows.begin(), rows.end(), source) - rows.begin());
    const RowLogMap a = alone.map(source), b = together.map(first + at);
    const double size = *std::max_element(a.distance.begin(), a.distance.end());
    for (std::size_t r = 0; r < rows.size(); ++r) {
      const std::size_t i = static_cast<std::size_t>(rows[r]), j = static_cast<std::size_t>(first) + r;
      ASSERT_EQ(a.status[i], b.status[j]) << part.name;
      ASSERT_NEAR(a.distance[i], b.distance[j], 1e-9 * size) << part.name << ", row " << i;
      ASSERT_NEAR(a.u[i], b.u[j], 1e-9 * size) << part.name << ", row " << i;
      ASSERT_NEAR(a.v[i], b.v[j], 1e-9 * size) << part.name << ", row " << i;
    }
  }
}

std::vector<Index> in_order(const Part& part) {
  std::vector<Index> rows(part.points.size());
  std::iota(rows.begin(), rows.end(), Index{0});
  return rows;
}

TEST(Parts, HaveTheSameMapBesideOthers) {
  std::vector<Vec3> random = random_sphere(700).points;
  for (Vec3& p : random) p = 3.3 * p + Vec3{41.7, -13.1, 9.9};
  for (const Part& part : parts()) {
    std::vector<Vec3> file = random;
    file.insert(file.end(), part.points.begin(), part.points.end());
    expect_same_maps(part, file, 700, in_order(part));
  }
}

TEST(Parts, HaveTheSameMapBesideTheirCopy) {
  for (const Part& part : parts()) {
    std::vector<Vec3> file = part.points;
    for (const Vec3& p : part.points) file.push_back(p + Vec3{1000.3, 17.7, -333.3});
    expect_same_maps(part, file, 0, in_order(part));
  }
}

TEST(Parts, HaveTheSameMapWhateverTheOrderOfRows) {
  std::mt19937_64 random(5);
  for (const Part& part : parts()) {
    std::vector<Index> rows = in_order(part);
    std::shuffle(rows.begin(), rows.end(), random);
    std::vector<Vec3> file;
    for (const Index row : rows) file.push_back(part.points[row]);
    expect_same_maps(part, file, 0, rows);
  }
}

/// Two flat sheets, one close behind the other, with normals that point away from each other.
Cloud thin_wall() {
  Cloud wall;
  for (double side : {-1.0, 1.0})
    for (const Vec3& p : flat_lattice(24)) {
      wall.points.push_back({p[0], p[1], 0.3 * side * spacing});
      wall.normals.push_back({0, 0, side});
    }
  return wall;
}

// Whether signs of normals tell sheets apart or are wrong is asked of each part.
TEST(Parts, HaveTheirOwnThinWalls) {
  const Cloud wall = thin_wall();
  Cloud wrong = random_sphere(1500);
  for (std::size_t i = 0; i < wrong.normals.size(); i += 2) wrong.normals[i] = -1.0 * wrong.normals[i];
  Cloud file = wrong;
  for (std::size_t i = 0; i < wall.points.size(); ++i) {
    file.points.push_back(wall.points[i] + Vec3{50.3, 0, 0});
    file.normals.push_back(wall.normals[i]);
  }
  expect_same_maps({"wrong signs", wrong.points}, file.points, 0, in_order({"", wrong.points}), wrong.normals,
                   file.normals);
  const Solved solved(file, true);
  for (const Index side : {0, 576}) {
    const RowLogMap map = solved.map(1500 + side);
    for (Index i = 0; i < 1152; ++i) {
      const bool same_sheet = (i < 576) == (side == 0);
      ASSERT_EQ(map.status[1500 + i] == Status::ok, same_sheet);
      if (same_sheet) ASSERT_NEAR(map.distance[1500 + i], norm(wall.points[i] - wall.points[side]), 1e-9);
    }
  }
}

}  // namespace
}  // namespace ahm::test
