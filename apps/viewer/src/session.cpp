#include "ahm/viewer/session.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <exception>
#include <limits>
#include <list>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <string>
#ifndef AHM_NO_THREADS
#include <thread>
#endif

#include "ahm/applications/isolines.hpp"
#include "ahm/applications/stroke.hpp"
#include "ahm/applications/tool_path_text.hpp"
#include "ahm/error.hpp"
#include "ahm/io/atomic_file.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/maps/quality.hpp"
#include "ahm/render/page.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"
#include "ahm/surface/polar_map_solver.hpp"
#include "ahm/surface/surface_paths.hpp"
#include "ahm/surface/surface_triangles.hpp"
#include "ahm/types.hpp"
#include "ahm/util/mutex.hpp"
#include "requests.hpp"

namespace ahm::viewer {

class Channels {
 public:
  enum class Kind { map, path, coverage };

  /// Cancels the previous request of this client and kind.
  /// @param number  number of the request, if the client numbers them. If a request with a greater number has arrived before, this
  ///                request is cancelled instead
  StopToken begin(const std::string& client, Kind kind, std::optional<Index> number) {
    const detail::Lock lock(mutex_);
    const std::pair key(client, kind);
    if (newest_.size() >= most && !newest_.contains(key)) forget_oldest();
    Entry& entry = newest_[key];
    StopSource own;
    if (number && entry.number && *number < *entry.number) {
      own.request_stop();
      return own.get_token();
    }
    entry.stop.request_stop();
    entry = {std::move(own), ++count_, number};
    return entry.stop.get_token();
  }

  /// A token for requests that only `stop_all` cancels.
  StopToken until_the_end() const { return end_.get_token(); }

  void stop_all() {
    const detail::Lock lock(mutex_);
    end_.request_stop();
    for (auto& [key, entry] : newest_) entry.stop.request_stop();
  }

 private:
  static constexpr std::size_t most = 192;
  struct Entry {
    StopSource stop;
    std::uint64_t begun = 0;      ///< sequence number among all requests
    std::optional<Index> number;  ///< number from the client
  };

  void forget_oldest() {
    auto oldest = newest_.begin();
    for (auto it = newest_.begin(); it != newest_.end(); ++it)
      if (it->second.begun < oldest->second.begun) oldest = it;
    newest_.erase(oldest);
  }

  detail::Mutex mutex_;
  StopSource end_;
  std::map<std::pair<std::string, Kind>, Entry> newest_;
  std::uint64_t count_ = 0;
};

/// The solvers of the session, created on first use. Not thread-safe.
class Makers {
 public:
  Makers(const Surface& surface, unsigned threads) : surface_(surface), threads_(threads) {}

  /// Whether the factorization of the whole graph takes long.
  bool is_large() const { return surface_.graph().size() > 200'000; }

  /// The heat solver for the settings: one of the last two, or a new one. On large surfaces, maps with a radius use the march, which
  /// requires no factorization of the whole graph; its time is proportional to the reached part.
  const LogMapSolver& solver(const Settings& settings, const Progress& progress) {
    const bool marched = settings.radius && is_large();
    const auto fits = [&](const Kept& kept) { return kept.t_coef == settings.t_coef && kept.marched == marched; };
    const auto found = std::find_if(kept_.begin(), kept_.end(), fits);
    if (found != kept_.end()) {
      kept_.splice(kept_.begin(), kept_, found);
    } else {
      if (kept_.size() >= 2) kept_.pop_back();
      HeatOptions heat;
      heat.t_coef = settings.t_coef;
      heat.strategy = marched ? Strategy::march : Strategy::automatic;
      heat.threads = threads_;
      heat.progress = progress;
      kept_.push_front({settings.t_coef, marched, LogMapSolver(surface_.graph(), heat)});
    }
    return kept_.front().solver;
  }

  const PolarMapSolver& polar() {
    if (!polar_) polar_.emplace(surface_, PolarSolverOptions{.threads = threads_});
    return *polar_;
  }

  /// @throws InvalidArgument: no faces
  const ExactGeodesics& geodesics() {
    if (surface_.faces().size() == 0)
      throw InvalidArgument("paths and exact maps require faces, but the input has none");
    if (refusal_) std::rethrow_exception(refusal_);
    try {
      if (!geodesics_) geodesics_.emplace(surface_);
    } catch (const InvalidArgument&) {
      refusal_ = std::current_exception();
      throw;
    } catch (const InvalidGeometry&) {
      refusal_ = std::current_exception();
      throw;
    }
    return *geodesics_;
  }

  /// `geodesics`, or null if the surface has no flat faces.
  const ExactGeodesics* flat_faces() try { return &geodesics(); } catch (const Error&) {
    return nullptr;
  }

 private:
  struct Kept {
    double t_coef;
    bool marched;
    LogMapSolver solver;
  };
  const Surface& surface_;
  unsigned threads_;
  std::list<Kept> kept_;
  std::optional<PolarMapSolver> polar_;
  std::optional<ExactGeodesics> geodesics_;
  std::exception_ptr refusal_;  ///< error of the construction of `geodesics_`
};

/// The settings for decals and tool paths: without the radius, which they do not have or define differently.
inline Settings of_patch(Settings settings) {
  settings.radius.reset();
  return settings;
}

/// The settings for curves: without polar maps and the u axis, which curves do not support.
inline Settings of_curve(Settings settings) {
  if (settings.method == Method::polar) settings.method = Method::heat;
  settings.u_axis.reset();
  return settings;
}

inline double radius_of(const Settings& settings) {
  return settings.radius.value_or(std::numeric_limits<double>::infinity());
}

inline MapOptions heat_options(const Settings& settings, double radius, const Progress& progress) {
  MapOptions options;
  options.variant = settings.variant;
  options.radius = radius;
  options.progress = progress;
  return options;
}

namespace {

using nlohmann::json;

constexpr int most_waiting = 64;

Answer refusal(int status, const std::string& text) {
  const json body = {{"error", text}};
  return {status, "application/json", body.dump(-1, ' ', true, json::error_handler_t::replace)};
}

Answer answer_of(const json& body) { return {200, "application/json", body.dump()}; }

/// Thrown if too many requests are waiting.
struct Busy {};

/// @param drawn  points of a cloud that are drawn and can be picked; empty for meshes
render::Scene scene_of(const Surface& surface, const io::Geometry& geometry, const std::vector<Vec3>& drawn,
                       const RowFaces& triangles, const std::vector<Vec3>& normals) {
  const FaceList faces = surface.faces();
  render::Scene scene;
  scene.is_cloud = faces.size() == 0;
  scene.points = drawn.empty() ? geometry.points : drawn;
  scene.normals = normals;
  scene.face_begin = scene.is_cloud ? triangles.begin : faces.begin;
  scene.face_vertices = scene.is_cloud ? triangles.rows : faces.vertices;
  return scene;
}

json positions(const render::PageSurface& page, std::span<const Vec3> points) {
  json out = json::array();
  for (const Vec3& x : points) out.push_back(page.to_page(x));
  return out;
}

}  // namespace

struct Session::Impl {
  const Surface& surface;
  const io::Geometry& geometry;
  SessionOptions options;
  std::vector<Vec3> drawn;  ///< for clouds: positions of rows with a vertex, which can be sources
  RowFaces triangles;       ///< for clouds: triangles between `drawn`; empty: discs are drawn
  std::vector<Vec3> normals;
  render::Scene scene;
  render::PageSurface page;
  Channels channels;
  detail::Mutex work;  ///< guards `makers`; one map at a time
  std::atomic<int> waiting{0};
  Makers makers;
#ifndef AHM_NO_THREADS
  std::jthread warm_up;
#endif

  Impl(const Surface& given, const io::Geometry& read, SessionOptions wanted)
      : surface(given),
        geometry(read),
        options(std::move(wanted)),
        drawn(given.faces().size() > 0 ? std::vector<Vec3>() : mapped_positions(given)),
        triangles(mapped_triangles(given)),
        normals(given.normals()),
        scene(scene_of(given, read, drawn, triangles, normals)),
        page(titled(), picture()),
        makers(given, options.threads) {
#ifndef AHM_NO_THREADS
    warm_up = std::jthread([this](const std::stop_token& stop) { prepare(stop); });
#endif
  }

  ~Impl() {
    channels.stop_all();
#ifndef AHM_NO_THREADS
    warm_up.request_stop();
#endif
  }

  Progress until(const StopToken& stop) const { return {options.progress, stop}; }

  SurfacePoint point_in(const Request& request, const char* name) const {
    return standing_for(surface, request.point(name));
  }

  std::vector<SurfacePoint> curve_points(const Request& request) const {
    std::vector<SurfacePoint> points = request.points("points");
    for (SurfacePoint& each : points) each = standing_for(surface, each);
    return points;
  }

  render::Scene titled() const {
    render::Scene out = scene;
    out.title = options.title;
    out.colors = geometry.colors;
    return out;
  }

  render::PictureOptions picture(render::Pattern pattern = render::Pattern::none) const {
    render::PictureOptions out;
    out.pattern = pattern;
    out.threads = options.threads;
    return out;
  }

  /// Creates the solver for the first click. Ignores errors, because the first request repeats and reports them.
  void prepare(const StopToken& stop) {
    const detail::Lock lock(work);
    try {
      switch (options.settings.method) {
        case Method::heat:
          makers.solver(options.settings, until(stop));
          break;
        case Method::polar:
          makers.polar();
          break;
        case Method::exact:
          makers.geodesics();
          break;
      }
    } catch (const std::exception&) {  // NOLINT(bugprone-empty-catch)
    }
  }

  /// Calls `make` when earlier requests have finished.
  template <class Make>
  auto in_turn(const StopToken& stop, const Make& make) {
    struct Place {
      std::atomic<int>& count;
      explicit Place(std::atomic<int>& waiting) : count(waiting) { ++count; }
      ~Place() { --count; }
    } const place(waiting);
    if (place.count > most_waiting) throw Busy{};
    const detail::Lock lock(work);
    if (stop.stop_requested()) throw Cancelled("superseded by a newer request");
    return make();
  }

  /// Computes a map. @param placed  the source with the u axis of the settings
  LogMap map(const SurfacePoint& source, const SurfaceSource& placed, const Settings& settings, const StopToken& stop,
             bool frames = false) {
    const double radius = radius_of(settings);
    const auto u_axis = placed.frame ? std::optional(placed.frame->x) : std::nullopt;
    if (settings.method == Method::polar)
      return makers.polar().log_map(source, u_axis, {.radius = radius, .frames = frames, .progress = until(stop)});
    if (settings.method == Method::exact)
      return makers.geodesics().log_map(source, u_axis, {.radius = radius, .frames = frames, .progress = until(stop)});
    MapOptions heat = heat_options(settings, radius, until(stop));
    heat.frames = frames;
    return makers.solver(settings, until(stop)).solve(placed.source, heat);
  }

  std::vector<double> quality_of(const LogMap& map, const RowLogMap& rows) const {
    return to_rows(rows, map_quality(surface.graph(), map, options.threads));
  }

  /// The bundle of a map, by row. @param more  additional members of its JSON text
  std::string bundle(const LogMap& map, const RowLogMap& rows, const Vec3& source, const std::optional<Frame>& frame,
                     render::Scene shown, render::Pattern pattern, const json& more) const {
    const std::vector<double> quality = quality_of(map, rows);
    shown.u = rows.u, shown.v = rows.v;
    shown.quality = quality;
    shown.bounded = rows.bounded;
    shown.source = source;
    if (frame) shown.source_axes = {frame->x, frame->y, frame->normal};
    shown.details.distance = rows.distance;
    shown.details.spread = rows.spread;
    shown.details.status = rows.status;
    return page.map_bundle(shown, picture(pattern), more.dump());
  }

  Answer answer_map(const Request& request) {
    const StopToken stop = channels.begin(request.client(), Channels::Kind::map, request.number());
    const SurfacePoint source = point_in(request, "source");
    const Settings settings = request.settings(options.settings);
    const SurfaceSource placed = surface.source(source, settings.u_axis);
    const LogMap made = in_turn(stop, [&] { return map(source, placed, settings, stop); });
    const std::string where = spec(surface, source);
    const json more = {{"spec", where},
                       {"command", command(options, "logmap", {"--source", where, "-o", "map.csv"}, settings)},
                       {"decal", decal_command(where, settings)}};
    return {200, "application/octet-stream",
            bundle(made, surface.to_rows(made), placed.position, placed.frame, scene, render::Pattern::polar, more)};
  }

  /// The command line of a decal, with placeholders that the page replaces by the image, its size and its angle.
  std::string decal_command(const std::string& where, const Settings& settings) const {
    return command(options, "decal",
                   {"--source", where, "--image", "@IMAGE@", "--size", "@SIZE@", "--angle=@ANGLE@", "-o", "decal.glb"},
                   of_patch(settings));
  }

  SurfaceCurve curve_of(const Request& request) const {
    const std::vector<SurfacePoint> points = curve_points(request);
    return draw_curve(surface, std::vector<CurvePoint>(points.begin(), points.end()));
  }

  /// Computes the map of a curve, up to the radius that its distances require.
  LogMap stroke(const SurfaceCurve& curve, const Settings& settings, const StopToken& stop) {
    const double radius = map_radius_of_curve(curve, radius_of(settings));
    if (settings.method == Method::exact)
      return makers.geodesics().log_map(curve.samples, {.radius = radius, .progress = until(stop)}).map;
    return makers.solver(settings, until(stop)).solve(curve.source, heat_options(settings, radius, until(stop)));
  }

  Answer answer_stroke(const Request& request) {
    const StopToken stop = channels.begin(request.client(), Channels::Kind::map, request.number());
    const Settings settings = of_curve(request.settings(options.settings));
    const SurfaceCurve curve = curve_of(request);
    const LogMap made = in_turn(stop, [&] { return stroke(curve, settings, stop); });
    std::string list;
    for (const SurfacePoint& each : curve_points(request))
      list.append(list.empty() ? "" : " ").append(spec(surface, each));
    render::Scene shown = scene;
    shown.curve = curve.points;
    return {200, "application/octet-stream",
            bundle(made, rows_from_curve(surface, made, curve, radius_of(settings)), curve.points.front(), curve.first,
                   shown, render::Pattern::grid,
                   {{"command", command(options, "stroke", {"--curve", list, "-o", "stroke.csv"}, settings)}})};
  }

  SurfacePath path_between(const std::array<SurfacePoint, 2>& ends, const StopToken& stop) {
    if (surface.faces().size() == 0) return shortest_line(surface, ends[0], ends[1]);
    const ExactGeodesics& geodesics = makers.geodesics();
    const exact::GeodesicPath path = geodesics.paths(std::span(&ends, 1), until(stop), 1).front();
    SurfacePath line{path.status, {}, path.length};
    for (const exact::MeshPoint& point : path.points) line.points.push_back(geodesics.position(point));
    return line;
  }

  struct Ends {
    SurfacePoint from, to;
  };

  SurfacePath path(const Ends& ends, const StopToken& stop) {
    for (const SurfacePoint& end : {ends.from, ends.to}) surface.source(end);  // checks the point
    SurfacePath path = in_turn(stop, [&] { return path_between({ends.from, ends.to}, stop); });
    if (path.status != Status::ok)
      throw InvalidArgument("there is no path: the surface does not connect the two points");
    return path;
  }

  Answer answer_path(const Request& request) {
    const StopToken stop = channels.begin(request.client(), Channels::Kind::path, request.number());
    const Ends ends{point_in(request, "from"), point_in(request, "to")};
    const SurfacePath made = path(ends, stop);
    return answer_of(
        {{"points", positions(page, made.points)},
         {"length", made.length / page.scale()},
         {"command",
          command(options, "path",
                  {"--from", spec(surface, ends.from), "--to", spec(surface, ends.to), "-o", "path.obj"}, {})}});
  }

  /// @param settings  result of `of_patch`
  CoveragePath tool_path(const SurfacePoint& source, const CoverageOptions& wanted, const Settings& settings,
                         const StopToken& stop) {
    const SurfaceSource placed = surface.source(source, settings.u_axis);
    Settings reach = settings;  // the whole map is not required, and its factorization takes long
    if (makers.is_large()) reach.radius = 1.5 * wanted.radius;
    const ExactGeodesics* flat = nullptr;
    const LogMap made = in_turn(stop, [&] {
      flat = makers.flat_faces();
      return map(source, placed, reach, stop, true);
    });
    const InverseMap inverse = inverse_map(surface, made, {.threads = options.threads});
    CoveragePath path = flat ? coverage_path(*flat, inverse, wanted) : coverage_path(inverse, wanted);
    if (path.points.empty()) throw InvalidArgument("no line of the pattern reaches a reliable part of the map");
    return path;
  }

  Answer answer_coverage(const Request& request) {
    const StopToken stop = channels.begin(request.client(), Channels::Kind::coverage, request.number());
    const SurfacePoint source = point_in(request, "source");
    const Settings settings = of_patch(request.settings(options.settings));
    const CoverageOptions wanted = request.coverage();
    const CoveragePath path = tool_path(source, wanted, settings, stop);
    std::vector<Vec3> points;
    json pieces = {0};
    double length = 0;
    std::size_t carried = 0;
    for (std::size_t k = 0; k < path.points.size(); ++k) {
      const CoveragePoint& point = path.points[k];
      if (!point.between) ++carried;
      if (k > 0 && point.piece != path.points[k - 1].piece) pieces.push_back(k);
      if (k + 1 == path.points.size() || path.points[k + 1].piece != point.piece) length += point.arclength;
      points.push_back(point.position);
    }
    return answer_of(
        {{"points", positions(page, points)},
         {"pieces", pieces},
         {"length", length / page.scale()},
         {"covered", static_cast<double>(carried) / static_cast<double>(path.planned)},
         {"command", command(options, "coverage",
                             {"--source", spec(surface, source), "--radius", number(wanted.radius), "--spacing",
                              number(wanted.spacing), "--pattern",
                              wanted.pattern == CoveragePattern::raster ? "raster" : "spiral", "-o", "path.csv"},
                             settings)}});
  }

  static bool is_spiral(const Request& request) {
    return request.has("pattern") && request.word("pattern", {"raster", "spiral"}) == "spiral";
  }

  /// The tool path over the whole surface.
  ToolPath whole_path(const Request& request, const StopToken& stop) const {
    ToolPathOptions wanted{.spacing = request.positive("spacing"), .progress = until(stop), .threads = options.threads};
    constexpr double most_passes = 500;
    if (page.scale() / wanted.spacing > most_passes)
      throw InvalidArgument("request: more than 500 passes; choose a larger \"spacing\"");
    wanted.spiral = is_spiral(request);
    if (request.has("curve")) {
      CurveSeed seed;
      for (const SurfacePoint& point : request.points("curve"))
        seed.points.push_back(surface.position(standing_for(surface, point)));
      wanted.seed = std::move(seed);
    }
    return ahm::tool_path(surface, wanted);
  }

  Answer answer_whole(const Request& request) {
    const StopToken stop = channels.begin(request.client(), Channels::Kind::coverage, request.number());
    const ToolPath path = whole_path(request, stop);
    const ToolPathMeasures measures = tool_path_measures(surface, path);
    json curves;
    for (const bool on_passes : {true, false}) {
      json points = json::array(), pieces = json::array();
      for (const ToolRun& run : tool_runs(path)) {
        if ((run.kind == ToolMotion::pass) != on_passes || run.kind == ToolMotion::missing) continue;
        pieces.push_back(points.size());
        for (std::size_t k = run.from; k < run.end; ++k) points.push_back(page.to_page(path.poses[k].position));
      }
      curves.push_back({{"points", points}, {"pieces", pieces}});
    }
    std::vector<std::string> words{"--whole", "--spacing", number(path.spacing)};
    if (is_spiral(request)) words.insert(words.end(), {"--pattern", "spiral"});
    if (request.has("curve")) {
      std::string list;
      for (const SurfacePoint& point : request.points("curve"))
        list.append(list.empty() ? "" : " ").append(spec(surface, standing_for(surface, point)));
      words.insert(words.end(), {"--seed-curve", list});
    }
    words.insert(words.end(), {"-o", "whole.csv"});
    return answer_of({{"passes", curves[0]},
                      {"links", curves[1]},
                      {"length", path.pass_length / page.scale()},
                      {"link_length", path.link_length / page.scale()},
                      {"area", measures.area / (page.scale() * page.scale())},
                      {"covered", measures.covered},
                      {"command", command(options, "coverage", words, {})}});
  }

  std::vector<Isoline> isolines_of(const Request& request) const {
    constexpr std::size_t most_levels = 1000;
    const auto values = io::column(geometry, request.word("column", io::column_names(geometry)));
    const std::vector<double> levels = level_multiples(*values, request.positive("every"));
    if (levels.size() > most_levels) throw InvalidArgument("request: more than 1000 levels; choose a larger \"every\"");
    std::vector<Isoline> lines = isolines(surface, *values, levels);
    if (lines.empty()) throw InvalidArgument("no triangle contains a level; choose a smaller step");
    return lines;
  }

  Answer answer_isolines(const Request& request) {
    const StopToken stop = channels.begin(request.client(), Channels::Kind::coverage, request.number());
    const std::vector<Isoline> lines = in_turn(stop, [&] { return isolines_of(request); });
    json points = json::array(), pieces = json::array();
    double length = 0;
    for (const Isoline& line : lines) {
      pieces.push_back(points.size());
      for (const Vec3& x : line.points) points.push_back(page.to_page(x));
      if (line.closed) points.push_back(page.to_page(line.points.front()));
      length += line.length;
    }
    return answer_of({{"points", points},
                      {"pieces", pieces},
                      {"lines", lines.size()},
                      {"length", length / page.scale()},
                      {"command", command(options, "isolines",
                                          {"--column", request.text("column"), "--every",
                                           number(request.positive("every")), "-o", "isolines.obj"},
                                          {})}});
  }

  void write_map(const Request& request, const std::filesystem::path& file, const StopToken& stop) {
    const Settings settings = request.settings(options.settings);
    const SurfacePoint source = point_in(request, "source");
    const SurfaceSource placed = surface.source(source, settings.u_axis);
    const LogMap made = in_turn(stop, [&] { return map(source, placed, settings, stop); });
    const RowLogMap rows = surface.to_rows(made);
    options.write(file, rows, quality_of(made, rows));
  }

  void write_stroke(const Request& request, const std::filesystem::path& file, const StopToken& stop) {
    const Settings settings = of_curve(request.settings(options.settings));
    const SurfaceCurve curve = curve_of(request);
    const LogMap made = in_turn(stop, [&] { return stroke(curve, settings, stop); });
    const RowLogMap rows = rows_from_curve(surface, made, curve, radius_of(settings));
    options.write(file, rows, quality_of(made, rows));
  }

  void write_decal(const Request& request, const std::filesystem::path& file, const StopToken& stop) {
    const Image image = image_of(request.text("image"));
    DecalOptions decal = decal_of(image, request.positive("size"));
    decal.angle = request.finite("angle") * std::numbers::pi / 180;
    Settings settings = of_patch(request.settings(options.settings));
    settings.radius = map_radius(decal, surface.graph());
    const SurfacePoint source = point_in(request, "source");
    const SurfaceSource placed = surface.source(source, settings.u_axis);
    const LogMap made = in_turn(stop, [&] { return map(source, placed, settings, stop, true); });
    options.write_decal(file, inverse_map(surface, made, {.threads = options.threads}), decal, image);
  }

  Answer answer_export(const Request& request) {
    std::vector<std::string> kinds;
    for (const auto& [kind, formats] : options.formats) kinds.push_back(kind);
    if (kinds.empty()) throw InvalidArgument("request: this session has no export formats");
    const std::string what = request.word("what", kinds);
    const std::string format = request.word("format", options.formats.at(what));
    const StopToken stop = channels.until_the_end();
    const auto write = [&](const std::filesystem::path& file) {
      if (what == "map") return write_map(request, file, stop);
      if (what == "stroke") return write_stroke(request, file, stop);
      if (what == "decal") return write_decal(request, file, stop);
      if (what == "path")
        return options.write_path(file, path({point_in(request, "from"), point_in(request, "to")}, stop).points);
      if (what == "whole") return options.write_whole(file, whole_path(request, stop));
      if (what == "isolines") return options.write_isolines(file, isolines_of(request));
      options.write_coverage(file, tool_path(point_in(request, "source"), request.coverage(),
                                             of_patch(request.settings(options.settings)), stop));
    };
    return {200, "application/octet-stream", io::written_bytes("map." + format, write)};
  }

  Answer answer(std::string_view name, std::string_view body) {
    if (name == "surface") return {200, "application/octet-stream", page.bundle()};
    if (name == "info") return answer_of(session_info(surface, geometry, options));
    const Request request(body);
    if (name == "map") return answer_map(request);
    if (name == "stroke") return answer_stroke(request);
    if (name == "path") return answer_path(request);
    if (name == "coverage") return answer_coverage(request);
    if (name == "whole") return answer_whole(request);
    if (name == "isolines") return answer_isolines(request);
    if (name == "export") return answer_export(request);
    return refusal(404, "there is no request of this name");
  }
};

Session::Session(const Surface& surface, const io::Geometry& geometry, SessionOptions options)
    : impl_(std::make_unique<Impl>(surface, geometry, std::move(options))) {}

Session::~Session() = default;

std::string Session::page(const std::string& nonce) const { return render::live_page(impl_->options.title, nonce); }

Answer Session::answer(std::string_view name, std::string_view body) const try {
  return impl_->answer(name, body);
} catch (const Cancelled& e) {
  return refusal(409, e.what());
} catch (const ResourceExhausted& e) {
  return refusal(503, e.what());
} catch (const Error& e) {
  return refusal(400, impl_->options.worded ? impl_->options.worded(e) : e.what());
} catch (const Busy&) {
  return refusal(503, "too many requests at once; try again");
} catch (const std::bad_alloc&) {
  return refusal(503, "out of memory");
} catch (const std::exception& e) {
  return refusal(500, e.what());
}

}  // namespace ahm::viewer
