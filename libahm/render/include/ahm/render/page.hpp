/// \file
/// The HTML page of a surface and its maps, and the data that the page draws. `write_html` embeds the data; a server sends it.
///
/// \code
/// const ahm::render::PageSurface surface(scene);              // positions, faces, normals: computed once
/// send(surface.bundle());
/// send(surface.map_bundle(scene_with_u_and_v));             // then one per map
/// \endcode
///
/// A bundle consists of "AHM1", the length of a JSON text as little-endian u32, the text, and arrays. The JSON object "arrays" contains
/// for each array its type (f32, u8, u16, i32, u32), its position in bytes after the text, and its number of elements. The text and the
/// arrays are padded to multiples of four bytes. Lengths are in units of the surface's "scale"; positions are relative to "center".
///
/// Arrays of a surface; numbers of elements in parentheses:
/// - positions (3), discs (4: normal as 255ths of [-1, 1], radius as 255ths of "largest_radius"), points (row of each vertex), colors (4)
/// - triangles (3), faces (face of each triangle)
/// - corners (4: three corners of the face, and the number of its corners), if there are faces with more than three corners
///
/// Arrays of a map: uv (2), distance, spread, quality, bounded, status by row; for clouds slopes (6 bytes, 127 for zero) by vertex.
#pragma once

#include <memory>
#include <string>

#include "ahm/render/picture.hpp"

namespace ahm::render {

/// A surface prepared for drawing by the page. Immutable; safe to use from many threads.
class PageSurface {
 public:
  /// @param scene  uses the points, normals, faces, colors and title; if there is a map, the camera shows its region
  /// @throws as `draw_picture`
  explicit PageSurface(const Scene& scene, const PictureOptions& options = {});
  ~PageSurface();
  PageSurface(const PageSurface&) = delete;
  PageSurface& operator=(const PageSurface&) = delete;

  /// The surface as a bundle.
  const std::string& bundle() const noexcept;
  /// A map on the surface as a bundle.
  /// @param scene  map of the same points
  /// @param more   additional entries of the JSON text: an object, as text
  /// @throws as `draw_picture`
  std::string map_bundle(const Scene& scene, const PictureOptions& options, const std::string& more = "{}") const;
  /// World units per unit of the page.
  double scale() const noexcept;
  /// A position in the page's units.
  Vec3 to_page(const Vec3& position) const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

/// The page that requests its data from a server, at addresses relative to its own. Empty if this build has no three.js.
/// @param nonce  nonce of the content security policy, for the scripts and the style of the page
std::string live_page(const std::string& title, const std::string& nonce);

}  // namespace ahm::render
