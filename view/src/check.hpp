// Checks of what the caller passed, shared by all kinds of pictures.
#pragma once

#include "ahm/view/picture.hpp"

namespace ahm::view {

/// Size and view. @throws InvalidArgument
void check_picture(const PictureOptions& options);

/// @throws InvalidArgument naming the first bad field.
void check(const Scene& scene, const PictureOptions& options);

}  // namespace ahm::view
