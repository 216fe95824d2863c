// The published contract, on clouds.
#include "ahm/conformance/clouds.hpp"
#include "ahm/conformance/graph_contract.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"

namespace ahm::test {
namespace {

struct CloudGraphs {
  static std::unique_ptr<TangentGraph> make(const Cloud& cloud) {
    const auto built = pointcloud::PointCloudSurface::build(cloud.points);
    return std::make_unique<CsrGraph>(built.graph().data());
  }
  static std::unique_ptr<TangentGraph> surface() { return make(random_sphere(300)); }
  static std::unique_ptr<TangentGraph> flat() { return make(flat_cloud(600)); }
};

struct ReflectingCloudGraphs {
  static std::unique_ptr<TangentGraph> surface() { return CloudGraphs::make(moebius_cloud(900)); }
  static std::unique_ptr<TangentGraph> flat() { return CloudGraphs::make(flat_cloud(300, 2)); }
};

INSTANTIATE_TYPED_TEST_SUITE_P(Clouds, GraphContract, CloudGraphs);
INSTANTIATE_TYPED_TEST_SUITE_P(ReflectingClouds, GraphContract, ReflectingCloudGraphs);

}  // namespace
}  // namespace ahm::test
