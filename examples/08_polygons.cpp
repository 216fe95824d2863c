// A floor of hexagonal tiles, and the map from the center of one of them.
#include <ahm/ahm.hpp>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>

int main() {
  const int rows = 8, columns = 10;
  const double pi = std::acos(-1.0);
  std::vector<ahm::Vec3> positions;
  std::vector<ahm::Offset> begin{0};
  std::vector<ahm::Index> corners;
  std::map<std::array<long, 2>, ahm::Index> number;  // rounded position -> vertex
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      for (int k = 0; k < 6; ++k) {
        const double x = std::sqrt(3.0) * (c + 0.5 * (r % 2)) + std::sin(k * pi / 3),
                     y = 1.5 * r - std::cos(k * pi / 3);
        const auto [at, is_new] = number.try_emplace({std::lround(1e6 * x), std::lround(1e6 * y)}, positions.size());
        if (is_new) positions.push_back({x, y, 0});
        corners.push_back(at->second);
      }
      begin.push_back(static_cast<ahm::Offset>(corners.size()));
    }

  const auto floor = ahm::polymesh::PolygonMeshSurface::build(
      positions, begin, corners, {.discretization = ahm::polymesh::Discretization::polygons});
  const ahm::SurfaceSolver solver(floor, ahm::HeatOptions{});
  const ahm::Index tile = 4 * columns + 4;
  const std::vector<double> middle(6, 1.0 / 6);
  const ahm::SurfaceLogMap map = solver.log_map(ahm::FacePoint{tile, middle}, {.u_axis = ahm::Vec3{1, 0, 0}});

  double error = 0;  // on the plane the map is exact
  const ahm::Vec3 origin = floor.position(ahm::FacePoint{tile, middle});
  for (std::size_t i = 0; i < positions.size(); ++i)
    error =
        std::max(error, std::hypot(map.u[i] - (positions[i][0] - origin[0]), map.v[i] - (positions[i][1] - origin[1])));
  std::printf("%zu corners of %d tiles, largest error %.1e\n", positions.size(), rows * columns, error);
  return error < 1e-12 ? 0 : 1;
}
