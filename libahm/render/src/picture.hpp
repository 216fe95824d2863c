// Functions shared by all kinds of pictures: checks of arguments, rendering.
#pragma once

#include "ahm/render/picture.hpp"
#include "drawable.hpp"
#include "film.hpp"
#include "material.hpp"

namespace ahm::render {

/// Checks size and view directions. @throws InvalidArgument
void check_picture(const PictureOptions& options);

/// @throws InvalidArgument with the name of the first invalid field
void check(const Scene& scene, const PictureOptions& options);

struct Painted {
  Drawable drawable;
  Material material;
};

/// Draws objects. Transparent objects are drawn over the others, in the order of the list. The picture does not depend on the number of
/// threads.
Film render(std::vector<Painted> things, const Camera& camera, const PictureOptions& options);

/// Converts the film to an image, without marks.
/// @param darken  darkens crevices to show the relief; false for textures
Image develop(const Film& film, const PictureOptions& options, bool darken = true);

/// Whether a position is inside the picture and visible: nothing is in front of it by more than `tolerance`. Scene coordinates.
bool shows(const Film& film, const Camera& camera, const Eigen::Vector3d& position, double tolerance);

}  // namespace ahm::render
