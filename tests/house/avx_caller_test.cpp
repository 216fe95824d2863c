// Compiled with -mavx and without inlining, against the plainly compiled library. Eigen aligns memory differently in the two.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "ahm/eigen.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"

TEST(AvxCaller, SeesResultsAsEigenMatrices) {
  std::vector<ahm::Vec3> points;
  for (int x = 0; x < 30; ++x)
    for (int y = 0; y < 30; ++y) points.push_back({1.0 * x, 1.0 * y, 0});
  const auto cloud = ahm::pointcloud::PointCloudSurface::build(points);
  const ahm::LogMapSolver solver(cloud.graph());
  const ahm::LogMap map = solver.solve(cloud.source(ahm::Row{0}).source);
  const Eigen::VectorXd distance = ahm::coordinates(map).rowwise().norm();
  EXPECT_NEAR(distance.maxCoeff(), 29 * std::sqrt(2.0), 1e-10);
  const ahm::VertexField field = ahm::radial_field(solver, cloud.source(ahm::Row{0}).source);
  const Eigen::MatrixXd copy = ahm::values(field);
  EXPECT_EQ(copy.rows(), 900);
  EXPECT_NEAR((copy.rowwise().norm() - distance).cwiseAbs().maxCoeff(), 0, 1e-10);
}

// The linker keeps one of several functions of the same name. If libahm shared names with the caller, it would free memory that the
// caller's functions have aligned, and abort.
TEST(AvxCaller, SharesNoFunctionOfEigenWithTheLibrary) {
  for (int d = 3; d < 12; ++d) {
    Eigen::MatrixXd mirror;
    mirror.resize(d, d);
    mirror.setIdentity();
    mirror(1, 1) = -1;
    EXPECT_EQ(mirror.partialPivLu().determinant(), -1);
    const ahm::TransportLayout layout{ahm::TransportKind::block, d};
    layout.make_orthogonal(mirror.data());
    EXPECT_TRUE(ahm::Transport(layout, mirror.data()).reflects());
  }
}
