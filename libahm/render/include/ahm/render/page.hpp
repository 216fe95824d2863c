/// \file
/// The HTML page of a surface and its maps, and the data it draws: what `write_html` embeds and a server sends.
///
/// \code
/// const ahm::render::PageSurface surface(scene);              // positions, faces, normals: made once
/// send(surface.bundle());
/// send(surface.map_bundle(scene_with_u_and_v));             // then one per map
/// \endcode
///
/// A bundle is "AHM1", the length of a JSON text as little-endian u32, that text, and arrays. The text's "arrays" tells of
/// each by its name the type (f32, u8, u16, i32, u32), where it begins, counted from the end of the text, and how many
/// numbers it has. Both are multiples of four bytes. Lengths are in units of the surface's "scale", positions relative to
/// its "center".
///
/// Of a surface: positions (3), discs (normal as 255ths of [-1, 1], radius as 255ths of "largest_radius"), points (the
/// row of each vertex), colors (4), triangles, faces (the face of each triangle), corners (of that face, three, and how many
/// it has; where they have more than three).
/// Of a map, by row: uv (2), distance, spread, quality, status; by vertex of a cloud: slopes (6 bytes, 127 for zero).
#pragma once

#include <memory>
#include <string>

#include "ahm/render/picture.hpp"

namespace ahm::render {

/// A surface made ready to be drawn by the page. Immutable; safe to use from many threads.
class PageSurface {
 public:
  /// @param scene  its points, normals, faces, colors and title; if it has a map, the camera shows that
  /// @throws as `draw_picture`
  explicit PageSurface(const Scene& scene, const PictureOptions& options = {});
  ~PageSurface();
  PageSurface(const PageSurface&) = delete;
  PageSurface& operator=(const PageSurface&) = delete;

  /// The surface as a bundle.
  const std::string& bundle() const noexcept;
  /// A map on it as a bundle.
  /// @param scene  of the same points
  /// @param more   further entries of the JSON text: an object, as text
  /// @throws as `draw_picture`
  std::string map_bundle(const Scene& scene, const PictureOptions& options, const std::string& more = "{}") const;
  /// World units in one of the page's.
  double scale() const noexcept;
  /// A position in the page's units.
  Vec3 to_page(const Vec3& position) const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

/// The page that asks a server for all data, at addresses beside its own. Empty without three.js.
/// @param nonce  of the content security policy, for its scripts and its style
std::string live_page(const std::string& title, const std::string& nonce);

}  // namespace ahm::render
