// One thing to draw, projected and sorted into tiles.
#pragma once

#include "bins.hpp"
#include "drawable.hpp"
#include "lens.hpp"
#include "material.hpp"

namespace ahm::view {

class Layer {
 public:
  /// Triangles that reach behind the camera are cut there.
  Layer(Drawable drawable, const Material& material, const Lens& lens, const Tiles& tiles);

  const Drawable& drawable() const { return drawable_; }
  const Material& material() const { return material_; }
  /// (x, y, nearness) of a mesh's vertex; nearness 0 behind the camera.
  const Eigen::Vector3f& pixel(std::uint32_t vertex) const { return pixels_[vertex]; }
  std::span<const std::uint32_t> in_tile(int tile) const { return bins_[tile]; }

 private:
  bool box_of(std::size_t primitive, const Lens& lens, Box& box) const;

  Drawable drawable_;
  Material material_;
  std::vector<Eigen::Vector3f> pixels_;
  Bins bins_;
};

/// Radius of a disc as it is drawn, at least a sample, at this nearness.
inline float drawn_radius(float radius, float nearness, const Lens& lens) {
  return std::max(radius, 1 / (lens.focal * nearness));
}

}  // namespace ahm::view
