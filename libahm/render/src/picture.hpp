// Checks of what the caller passed, shared by all kinds of pictures.
#pragma once

#include "ahm/render/picture.hpp"
#include "drawable.hpp"
#include "film.hpp"
#include "material.hpp"

namespace ahm::render {

/// Size and view. @throws InvalidArgument
void check_picture(const PictureOptions& options);

/// @throws InvalidArgument naming the first bad field.
void check(const Scene& scene, const PictureOptions& options);

struct Painted {
  Drawable drawable;
  Material material;
};

/// Draws the things, transparent ones in the given order over the others. The picture does not depend on the number of
/// threads.
Film render(std::vector<Painted> things, const Camera& camera, const PictureOptions& options);

/// The film as a picture, without marks. `darken` shows relief, which textures show themselves.
Image develop(const Film& film, const PictureOptions& options, bool darken = true);

/// Whether a position in scene coordinates is in the picture with nothing before it by more than `tolerance`.
bool shows(const Film& film, const Camera& camera, const Eigen::Vector3d& position, double tolerance);

}  // namespace ahm::render
