#include "output/picture_options.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "cli/option_adders.hpp"
#include "cli/source_list.hpp"

namespace ahm::app {
namespace {

constexpr const char* group = "Pictures";

std::array<int, 2> parse_size(const std::string& text) {
  const std::size_t cross = text.find('x');
  if (cross == std::string::npos)
    throw std::invalid_argument("'" + text + "' is not of the form WxH, such as 1600x1200");
  const auto side = [](const std::string& part) { return static_cast<int>(parse_integer(part, 16, 8192)); };
  return {side(text.substr(0, cross)), side(text.substr(cross + 1))};
}

int parse_sectors(const std::string& text) {
  const auto sectors = static_cast<int>(parse_integer(text, 2, 720));
  if (sectors % 2 != 0) throw std::invalid_argument("'" + text + "' is odd; the checkerboard requires an even number");
  return sectors;
}

void add_size(CLI::App& app, const std::string& name, PictureChoice& choice) {
  add_parsed(app, name, choice.size, parse_size, "WxH", "Size of a .png picture in pixels (default 1600x1200)")
      ->group(group)
      ->needs("--view");
}

void add_view_from(CLI::App& app, PictureChoice& choice) {
  add_parsed(app, "--view-from", choice.from, parse_direction, "X,Y,Z",
             "Direction from the surface to the viewer (default: one from which the source is visible)")
      ->group(group)
      ->needs("--view");
}

}  // namespace

void add_map_picture(CLI::App& app, PictureChoice& choice) {
  add_size(app, "--size", choice);
  add_view_from(app, choice);
  add_parsed(app, "--rings", choice.rings, parse_positive, "R",
             "Width of a ring or square in the unit of INPUT (default: a round number)")
      ->group(group)
      ->needs("--view");
  add_parsed(app, "--sectors", choice.sectors, parse_sectors, "N",
             "Number of sectors of the polar pattern, even (default 24)")
      ->group(group)
      ->needs("--view");
  add_parsed(app, "--color", choice.color, ahm::app::choice({"polar", "distance", "none"}), "BY",
             "polar (default): rings and sectors; for curves squares, for cells one color per cell.\n"
             "distance: colors by distance, with a color bar. none: only the surface")
      ->group(group)
      ->needs("--view");
}

void add_texture_picture(CLI::App& app, PictureChoice& choice) {
  add_size(app, "--view-size", choice);
  add_view_from(app, choice);
}

render::PictureOptions picture_options(const PictureChoice& choice, unsigned threads) {
  render::PictureOptions options;
  options.threads = threads;
  if (choice.size) options.width = (*choice.size)[0], options.height = (*choice.size)[1];
  options.view_direction = choice.from;
  options.ring_width = choice.rings;
  if (choice.sectors) options.sectors = *choice.sectors;
  return options;
}

void draw(const std::string& path, const render::Scene& scene, render::Pattern usual, const PictureChoice& choice,
          unsigned threads) {
  render::PictureOptions options = picture_options(choice, threads);
  options.pattern = choice.color == "distance" ? render::Pattern::distance
                    : choice.color == "none"   ? render::Pattern::none
                                               : usual;
  render::Scene shown = scene;
  if (options.pattern != render::Pattern::cells) shown.labels = {};
  render::write_picture(path, shown, options);
}

}  // namespace ahm::app
