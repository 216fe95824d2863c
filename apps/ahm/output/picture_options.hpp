/// \file
/// How --view draws, and what a picture would not say by itself.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>

#include "ahm/view/picture.hpp"

namespace CLI {
class App;
}

namespace ahm::app {

class Journal;

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

view::PictureOptions picture_options(const PictureChoice& choice);

/// Writes the picture of a map. @param usual  the subcommand's own pattern, where the colours are not chosen
void draw(const std::string& path, const view::Scene& scene, view::Pattern usual, const PictureChoice& choice);

/// Warns where more than a fifth of the mapped rows lie below `trusted_quality`.
void comment_on_quality(std::span<const double> quality, Journal& journal);

}  // namespace ahm::app
