#include "triangle.hpp"

namespace ahm::view {

bool TileTriangle::set(const Layer& from, std::uint32_t triangle, float tile_x, float tile_y) {
  layer = &from;
  std::array<double, 3> x, y;
  for (std::size_t k = 0; k < 3; ++k) {
    corner[k] = from.drawable().triangles[3 * std::size_t{triangle} + k];
    const Eigen::Vector3f& pixel = from.pixel(corner[k]);
    x[k] = static_cast<double>(pixel.x()) - tile_x, y[k] = static_cast<double>(pixel.y()) - tile_y;
    nearness[k] = pixel.z();
  }
  const double area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
  if (!(std::abs(area) > 1e-9)) return false;
  const double sign = area < 0 ? -1 : 1;
  double slope_x = 0, slope_y = 0, constant = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    // Two triangles at a common edge get coefficients that differ in sign alone: no sample falls between them.
    const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
    const double p = sign * (y[i] - y[j]), q = sign * (x[j] - x[i]), r = sign * (x[i] * y[j] - x[j] * y[i]);
    a[k] = static_cast<float>(p), b[k] = static_cast<float>(q), c[k] = static_cast<float>(r);
    const double share = static_cast<double>(nearness[k]) / (sign * area);
    slope_x += p * share, slope_y += q * share, constant += r * share;
  }
  near_x = static_cast<float>(slope_x), near_y = static_cast<float>(slope_y), near_0 = static_cast<float>(constant);
  left = static_cast<float>(std::min({x[0], x[1], x[2]})), right = static_cast<float>(std::max({x[0], x[1], x[2]}));
  top = static_cast<float>(std::min({y[0], y[1], y[2]})), bottom = static_cast<float>(std::max({y[0], y[1], y[2]}));
  return true;
}

std::array<float, 3> TileTriangle::weights(float x, float y) const {
  std::array<float, 3> w;
  float sum = 0;
  for (std::size_t k = 0; k < 3; ++k) sum += w[k] = (a[k] * x + b[k] * y + c[k]) * nearness[k];
  for (float& weight : w) weight /= sum;
  return w;
}

glsl::vec3 TileTriangle::value(const std::array<float, 3>& w) const {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (std::size_t k = 0; k < 3; ++k) sum += w[k] * layer->drawable().values[corner[k]];
  return {sum.x(), sum.y(), sum.z()};
}

Fragment TileTriangle::at(float x, float y, const Lens& lens) const {
  const std::array<float, 3> w = weights(x, y);
  Fragment f;
  f.value = value(w);
  const glsl::vec3 right = value(weights(x + 1, y)) - f.value, below = value(weights(x, y + 1)) - f.value;
  f.dx = {right.x, right.y}, f.dy = {below.x, below.y};
  float known = 0;
  Eigen::Vector3f normal = Eigen::Vector3f::Zero(), place = Eigen::Vector3f::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    known += w[k] * layer->drawable().known[corner[k]];
    normal += w[k] * layer->drawable().normals[corner[k]];
    place += w[k] * layer->drawable().positions[corner[k]];
  }
  f.known = known > 0.999F;
  if (normal.dot(place - lens.eye) > 0) normal = -normal;
  normal = lens.axes * normal;
  normal = normal.squaredNorm() > 0 ? normal.normalized().eval() : Eigen::Vector3f::UnitZ().eval();
  f.normal = {normal.x(), normal.y(), normal.z()};
  return f;
}

}  // namespace ahm::view
