// What a page's settings mean for the maps that are made.
#pragma once

#include <limits>
#include <stop_token>

#include "ahm/maps/log_map_solver.hpp"
#include "ahm/viewer/session.hpp"

namespace ahm::viewer {

/// Without what decals and tool paths have no option for, or one of another meaning.
inline Settings of_patch(Settings settings) {
  settings.radius.reset();
  return settings;
}

/// Without what curves have no option for.
inline Settings of_curve(Settings settings) {
  if (settings.method == Method::polar) settings.method = Method::heat;
  settings.u_axis.reset();
  return settings;
}

inline double radius_of(const Settings& settings) {
  return settings.radius.value_or(std::numeric_limits<double>::infinity());
}

inline Progress until(const std::stop_token& stop) {
  Progress progress;
  progress.stop = stop;
  return progress;
}

inline MapOptions heat_options(const Settings& settings, double radius, const std::stop_token& stop) {
  MapOptions options;
  options.variant = settings.variant;
  options.radius = radius;
  options.progress = until(stop);
  return options;
}

}  // namespace ahm::viewer
