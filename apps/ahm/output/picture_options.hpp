/// \file
/// The options of pictures (--view).
#pragma once

#include <array>
#include <optional>
#include <string>

#include "ahm/render/picture.hpp"

namespace CLI {
class App;
}

namespace ahm::app {

/// The options of --view. Empty: the default of the picture.
struct PictureChoice {
  std::optional<std::array<int, 2>> size;
  std::optional<Vec3> from;
  std::optional<double> rings;
  std::optional<int> sectors;
  std::string color = "polar";
};

/// Adds --size, --view-from, --rings, --sectors and --color.
void add_map_picture(CLI::App& app, PictureChoice& choice);
/// Adds --view-size and --view-from, for subcommands with a --size of their own.
void add_texture_picture(CLI::App& app, PictureChoice& choice);

/// The options in the form of the renderer. @param threads  0: one per core
render::PictureOptions picture_options(const PictureChoice& choice, unsigned threads);

/// Writes the picture of a map. @param usual  pattern of the subcommand, for `color` "polar"
void draw(const std::string& path, const render::Scene& scene, render::Pattern usual, const PictureChoice& choice,
          unsigned threads);

}  // namespace ahm::app
