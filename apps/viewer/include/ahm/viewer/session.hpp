/// \file
/// A surface and the maps on it that somebody asks for one after the other: what the viewer's page talks to. Knows nothing
/// of sockets; `Server` is the way to it.
///
/// \code
/// const ahm::viewer::Session session(surface, geometry, {.title = "scan.ply", .input = "scan.ply"});
/// auto answer = session.answer("map", R"({"client": "a", "source": {"row": 42}})");     // a bundle (ahm/render/page.hpp)
/// \endcode
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ahm/applications/coverage.hpp"
#include "ahm/applications/decal.hpp"
#include "ahm/error.hpp"
#include "ahm/image.hpp"
#include "ahm/io/geometry.hpp"
#include "ahm/surface/surface.hpp"

namespace ahm::viewer {

/// How maps are made.
struct Settings {
  Method method = Method::heat;
  Variant variant = Variant::adaptive;
  double t_coef = 1;             ///< > 0
  std::optional<double> radius;  ///< world units, > 0
  std::optional<Vec3> u_axis;    ///< a vector of space
  double tolerance = 0;          ///< of exact maps (`ExactMapOptions`)
};

struct SessionOptions {
  std::string title;  ///< of the page
  /// INPUT and the options with which it was opened, as they stand in a command line.
  std::string input, input_options;
  Settings settings;                        ///< that the page starts with
  std::optional<SurfacePoint> source = {};  ///< that it starts from; none: what lies in the middle of the picture
  unsigned threads = 0;                     ///< 0: one per core
  /// Writes a map, from a point or a curve, by row to a file, by its ending; none: nothing is exported.
  std::function<void(const std::filesystem::path&, const RowLogMap&, const std::vector<double>& quality)> write = {};
  /// Likewise a path, a tool path, and a decal.
  std::function<void(const std::filesystem::path&, const std::vector<Vec3>&)> write_path = {};
  std::function<void(const std::filesystem::path&, const CoveragePath&)> write_coverage = {};
  std::function<void(const std::filesystem::path&, const InverseMap&, const DecalOptions&, const Image&)> write_decal =
      {};
  /// Endings that these know, without the dot, by what is written: map, stroke, path, coverage, decal.
  std::map<std::string, std::vector<std::string>> formats = {};
  std::function<std::string(const Error&)> worded = {};  ///< messages in the caller's words; none: what()
};

/// What is sent back.
struct Answer {
  int status = 200;  ///< of HTTP
  std::string type;  ///< of the body
  std::string body;
};

/// A point as SPEC of a command: 42, face:7:0.2,0.3,0.5, or x,y,z.
std::string spec(const Surface& surface, const SurfacePoint& point);

/// Immutable but for what is kept of solvers; all members may be called from many threads at once. Maps are made one after
/// the other, each on all threads.
///
/// Requests are JSON objects. A point is {"row": 42} or {"face": 7, "weights": [0.2, 0.3, 0.5]}. With a map go, each by
/// choice, "method", "variant", "t_coef", "radius" (null: none), "u_axis". Rows of a cloud that were left out before
/// its graph was built are not drawn; for such a row the nearest one that was not stands.
///
/// | name     | request, besides "client"                              | answer                                        |
/// |----------|--------------------------------------------------------|-----------------------------------------------|
/// | surface  | none                                                   | bundle of the surface                         |
/// | info     | none                                                   | JSON: counts, choices, what to start with     |
/// | map      | "source"                                               | bundle of the map, with "spec", "command"     |
/// | stroke   | "points": along a curve                                | bundle of the map, with the curve             |
/// | path     | "from", "to" (meshes)                                  | JSON: "points", "length", "command"           |
/// | coverage | "source", "cover": radius, "spacing", "pattern"        | JSON: "points", "pieces", "length", "covered" |
/// | export   | "what" of these it is, "format", and what it asks for  | the file that the command writes              |
///
/// "what" is "map", "stroke", "path", "coverage", or "decal", which asks for "source", "image": a PNG or JPEG file in base64, "size":
/// its longer side, and "angle" in degrees.
///
/// A newer request for a map or a stroke by the same client cancels the older one, and so does one for a path or a tool path
/// those of its kind; what is cancelled is answered with status 409. The end of the session cancels all. Newer is what comes later; of a client that
/// counts its requests, by choice, with "number", what has the greater one, since requests may overtake each other.
/// What cannot be answered has the status 400, 404 or 503 and a JSON object with "error".
class Session {
 public:
  /// Makes the page's data, and the default solver in the background.
  /// @param surface, geometry  must outlive the session
  /// @throws InvalidGeometry (nothing to show)
  Session(const Surface& surface, const io::Geometry& geometry, SessionOptions options);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// The page itself. @param nonce  as of `render::live_page`
  std::string page(const std::string& nonce) const;
  /// Never throws but for memory. @param body  empty for surface and info
  Answer answer(std::string_view name, std::string_view body) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ahm::viewer
