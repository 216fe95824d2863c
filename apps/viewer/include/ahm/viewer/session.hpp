/// \file
/// A session of the viewer: answers requests for maps, paths and exports on one surface. Independent of sockets; `Server` makes it
/// accessible to browsers.
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
#include "ahm/applications/isolines.hpp"
#include "ahm/applications/tool_path.hpp"
#include "ahm/error.hpp"
#include "ahm/image.hpp"
#include "ahm/io/geometry.hpp"
#include "ahm/surface/surface.hpp"

namespace ahm::viewer {

/// Options of maps.
struct Settings {
  Method method = Method::heat;
  Variant variant = Variant::adaptive;
  double t_coef = 1;             ///< > 0
  std::optional<double> radius;  ///< world units, > 0
  std::optional<Vec3> u_axis;    ///< direction in world coordinates
};

struct SessionOptions {
  std::string title;  ///< title of the page
  /// The argument INPUT and its options, in the form of a command line.
  std::string input, input_options;
  Settings settings;                        ///< initial settings of the page
  std::optional<SurfacePoint> source = {};  ///< initial source; nullopt: the center of the picture
  unsigned threads = 0;                     ///< 0: one per core
  /// Writes a map from a point or a curve to a file, by row; the extension selects the format. Empty: no export.
  std::function<void(const std::filesystem::path&, const RowLogMap&, const std::vector<double>& quality)> write = {};
  /// Writes a path, a tool path, isolines, or a decal to a file.
  std::function<void(const std::filesystem::path&, const std::vector<Vec3>&)> write_path = {};
  std::function<void(const std::filesystem::path&, const CoveragePath&)> write_coverage = {};
  std::function<void(const std::filesystem::path&, const ToolPath&)> write_whole = {};
  std::function<void(const std::filesystem::path&, const std::vector<Isoline>&)> write_isolines = {};
  std::function<void(const std::filesystem::path&, const InverseMap&, const DecalOptions&, const Image&)> write_decal =
      {};
  /// Extensions that these functions support, without the dot, for each kind of result: map, stroke, path, coverage, whole,
  /// isolines, decal.
  std::map<std::string, std::vector<std::string>> formats = {};
  std::function<std::string(const Error&)> worded = {};  ///< formats error messages; empty: what()
  /// Receives the progress of requests: `Progress::report`. Empty: no reports.
  std::function<void(std::string_view stage, double fraction)> progress = {};
};

/// The answer to a request.
struct Answer {
  int status = 200;  ///< HTTP status
  std::string type;  ///< content type of the body
  std::string body;
};

/// A point in the format SPEC of the command line: 42, face:7:0.2,0.3,0.5, or x,y,z.
std::string spec(const Surface& surface, const SurfacePoint& point);

/// Answers requests on a surface. All members may be called from many threads at once. Maps are computed one at a time, each with all
/// threads. The session keeps solvers for later requests. Builds without threads do not create the default solver in the background.
///
/// Requests are JSON objects. A point is {"row": 42} or {"face": 7, "weights": [0.2, 0.3, 0.5]}. Requests for maps have the optional
/// members "method", "variant", "t_coef", "radius" (null: none), "u_axis". Rows of a cloud that were removed before its graph was built
/// are not drawn. Such a row in a request is replaced by the nearest row with a vertex.
///
/// | name     | request, besides "client"                              | answer                                        |
/// |----------|--------------------------------------------------------|-----------------------------------------------|
/// | surface  | none                                                   | bundle of the surface                         |
/// | info     | none                                                   | JSON: counts, choices, initial settings       |
/// | map      | "source"                                               | bundle of the map, with "spec", "command"     |
/// | stroke   | "points": along a curve                                | bundle of the map, with the curve             |
/// | path     | "from", "to"                                           | JSON: "points", "length", "command"           |
/// | coverage | "source", "coverage_radius", "spacing", "pattern"      | JSON: "points", "pieces", "length", "covered" |
/// | whole    | "spacing", optional "pattern" and "curve" (the seed)   | JSON: "passes", "links", lengths, "covered"   |
/// | isolines | "column", "every": step between levels                 | JSON: "points", "pieces", "lines", "length"   |
/// | export   | "what", "format", and the members of such a request    | the file that the command writes              |
///
/// "what" is "map", "stroke", "path", "coverage", "whole", "isolines" or "decal". A decal requires "source", "image" (a PNG or JPEG file in base64), "size" (of
/// the longer side) and "angle" (degrees).
///
/// A newer request of the same client cancels an older one of the same kind. Maps and strokes are one kind, tool paths and isolines
/// another one, paths the third. Cancelled requests return status 409. The end of the session cancels all requests. Requests may arrive in a different order, so
/// clients may number them with "number"; the greater number is newer. Without numbers, the later request is newer.
/// Requests that fail return status 400, 404, 500 or 503, and a JSON object with "error".
class Session {
 public:
  /// Computes the data of the page, and in the background the default solver.
  /// @param surface, geometry  must outlive the session
  /// @throws InvalidGeometry (no point to show)
  Session(const Surface& surface, const io::Geometry& geometry, SessionOptions options);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// The HTML page. @param nonce  as in `render::live_page`
  std::string page(const std::string& nonce) const;
  /// Answers a request. Throws only if memory is exhausted. @param body  empty for surface and info
  Answer answer(std::string_view name, std::string_view body) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ahm::viewer
