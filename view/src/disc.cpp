#include "disc.hpp"

namespace ahm::view {

bool TileDisc::set(const Layer& from, std::uint32_t point, const Lens& lens, float tile_x, float tile_y) {
  const Drawable& d = from.drawable();
  const Eigen::Vector3f view = lens.to_view(d.positions[point]);
  if (-view.z() < lens.near_plane) return false;
  layer = &from;
  const Eigen::Vector3f pixel = lens.to_pixels(view);
  x = pixel.x() - tile_x, y = pixel.y() - tile_y, nearness = pixel.z();

  Eigen::Vector3f normal = lens.axes * d.normals[point];
  normal = normal.squaredNorm() > 0 ? normal.normalized().eval() : Eigen::Vector3f::UnitZ().eval();
  if (normal.dot(view) > 0) normal = -normal;
  normal_x = normal.x(), normal_y = normal.y();
  // Seen edge on, it stays wide enough to be seen. i to the right, j downwards.
  const float steepness = 1 / std::max(normal.z(), 0.25F);
  const float rise_i = -normal.x() * steepness, rise_j = normal.y() * steepness;
  const float radius = drawn_radius(d.radii[point], nearness, lens), sample = 1 / (lens.focal * nearness);
  const float scale = sample * sample / (radius * radius);
  t_ii = scale * (1 + rise_i * rise_i), t_ij = scale * rise_i * rise_j, t_jj = scale * (1 + rise_j * rise_j);
  const float determinant = t_ii * t_jj - t_ij * t_ij;
  half_width = std::sqrt(t_jj / determinant), half_height = std::sqrt(t_ii / determinant);
  near_i = nearness * nearness * sample * rise_i, near_j = nearness * nearness * sample * rise_j;
  thickness = nearness * nearness * radius;

  const Eigen::Vector3f& v = d.values[point];
  value = {v.x(), v.y(), v.z()};
  value_i = value_j = {};
  if (!d.gradients.empty()) {
    const Eigen::Vector3f first = lens.axes * d.gradients[point][0], second = lens.axes * d.gradients[point][1];
    value_i = {sample * (first.x() + rise_i * first.z()), sample * (second.x() + rise_i * second.z())};
    value_j = {sample * (-first.y() + rise_j * first.z()), sample * (-second.y() + rise_j * second.z())};
  }
  tolerance = d.values_per_length * radius;
  if (from.material().kind == Material::Kind::pattern && from.material().pattern == Pattern::cells)
    tolerance = std::min(tolerance, 0.9F);  // the first value is a number
  known = d.known[point] > 0;
  return true;
}

}  // namespace ahm::view
