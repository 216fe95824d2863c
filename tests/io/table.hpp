/// \file
/// A small result to write: awkward numbers, a removed point, two polygons.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "ahm/io/read.hpp"
#include "ahm/io/write.hpp"

namespace ahm::io::test {

struct Result {
  static constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<Vec3> points = {{0.1, 1.0 / 3.0, 431234.567891}, {1e-310, -1e300, 0}, {1, 2, 3}, {4, 5, 6}};
  std::vector<Vec3> normals = {{0, 0, 1}, {0, 1, 0}, {nan, nan, nan}, {1, 0, 0}};
  std::vector<double> u = {0.1, 1.0 / 3.0, nan, nan};
  std::vector<double> v = {-0.0, 2e-17, nan, nan};
  std::vector<double> distance = {0.1, 1.0 / 3.0, nan, nan};
  std::vector<double> angle = {0, 3.14159, nan, nan};
  std::vector<Status> status = {Status::ok, Status::ok, Status::removed, Status::disconnected};
  std::vector<Offset> face_begin = {0, 3, 7};
  std::vector<Index> face_vertices = {0, 1, 2, 3, 2, 1, 0};

  Table table() const {
    Table result = rows();
    result.add("u", u), result.add("v", v), result.add("distance", distance), result.add("angle", angle);
    result.add("status", status);
    return result;
  }
  /// Points, normals and faces alone.
  Table rows() const {
    Table result{.title = "a result"};
    result.add({"x", "y", "z"}, points);
    result.add({"nx", "ny", "nz"}, normals).for_viewers = true;
    result.faces = {face_begin, face_vertices};
    return result;
  }
};

/// Expects the points, normals and faces of the result, bit for bit.
inline void expect_geometry_of(const Result& result, const Geometry& g) {
  EXPECT_EQ(g.points, result.points);
  ASSERT_EQ(g.normals.size(), 4u);
  EXPECT_EQ(g.normals[1], result.normals[1]);
  EXPECT_EQ(g.normals[3], result.normals[3]);
  EXPECT_TRUE(std::isnan(g.normals[2][0]));
  EXPECT_EQ(g.face_begin, result.face_begin);
  EXPECT_EQ(g.face_vertices, result.face_vertices);
}

}  // namespace ahm::io::test
