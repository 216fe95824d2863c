/// \file
/// How --view draws, and what a picture would not say by itself.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "ahm/render/picture.hpp"

namespace CLI {
class App;
}

namespace ahm::app {

/// The options that go with --view. Empty: as the picture chooses.
struct PictureChoice {
  std::optional<std::array<int, 2>> size;
  std::optional<Vec3> from;
  std::optional<double> rings;
  std::optional<int> sectors;
  std::string color = "polar";
};

/// --size, --view-from, --rings, --sectors, --color
void add_map_picture(CLI::App& app, PictureChoice& choice);
/// --view-size, --view-from: for subcommands with a --size of their own
void add_texture_picture(CLI::App& app, PictureChoice& choice);

/// @param threads  0: one per core
render::PictureOptions picture_options(const PictureChoice& choice, unsigned threads);

/// Writes the picture of a map. @param usual  the subcommand's own pattern, where the colors are not chosen
void draw(const std::string& path, const render::Scene& scene, render::Pattern usual, const PictureChoice& choice,
          unsigned threads);

}  // namespace ahm::app
