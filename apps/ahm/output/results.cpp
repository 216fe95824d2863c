#include "output/results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <new>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "ahm/error.hpp"
#include "ahm/io/formats.hpp"
#include "ahm/maps/quality.hpp"
#include "ahm/surface/surface_triangles.hpp"
#include "output/output_paths.hpp"

namespace ahm::app {
namespace {

void check_view(const std::string& path) {
  if (path.empty()) return;
  const std::string extension = io::lower_extension(path);
  const bool html = extension == ".html" || extension == ".htm";
  if (!html && extension != ".png")
    throw InvalidArgument(fmt::format("--view {}: the name must end in .png or .html", path));
  if (html ? !render::can_write_html() : !render::can_write_png())
    throw InvalidArgument(fmt::format("--view {}: this build of ahm cannot write {} files", path, extension));
}

std::ptrdiff_t count_mapped(const std::vector<double>& quality) {
  return std::count_if(quality.begin(), quality.end(), [](double q) { return std::isfinite(q); });
}

}  // namespace

void check_results(const std::string& input, const OutputOptions& output, const std::vector<std::string>& endings,
                   const std::vector<OutputPath>& more) {
  const OutputPath file{"--output", output.output};
  if (output.output == standard_output && output.json == "-")
    throw InvalidArgument("--output - and --json -: both are for standard output; write one of them to a file");
  std::vector<OutputPath> files{file, {"--json", output.json}, {"--view", output.view}};
  files.insert(files.end(), more.begin(), more.end());
  check_outputs({input}, files, output.keep_existing);
  if (!endings.empty()) check_ending(file, endings, output.format);
  if (endings.empty() && !output.output.empty()) io::check_writable(output.output, output.format);
  check_view(output.view);
}

void comment_on_statuses(const std::vector<Status>& status, const std::string& input, Journal& journal) {
  const auto count = [&](Status s) { return std::count(status.begin(), status.end(), s); };
  const auto total = static_cast<double>(status.size());
  if (const auto apart = count(Status::disconnected); static_cast<double>(apart) > 0.1 * total)
    journal.add_warning(fmt::format("{} of {} are not connected to the source; 'ahm info {}' lists the components",
                                    apart, counted(status.size(), "vertex"), input));
  if (const auto unreached = count(Status::unreached); unreached > 0)
    journal.add_warning(fmt::format(
        "vertices that no heat reaches: {}; with --strategy global they are too far away (use --strategy march), "
        "otherwise the weights around them are too irregular",
        unreached));
}

std::ptrdiff_t count_low_quality(const std::vector<double>& quality) {
  return std::count_if(quality.begin(), quality.end(), [](double q) { return q < reliable_quality; });
}

void add_quality(nlohmann::ordered_json& summary, const std::vector<double>& quality, std::optional<double> reliable) {
  summary["low_quality"] = count_low_quality(quality);
  summary["reliable_distance"] = reliable ? nlohmann::ordered_json(*reliable) : nlohmann::ordered_json(nullptr);
}

std::string quality_as_text(const std::vector<double>& distances, const std::vector<double>& quality,
                            std::optional<double> reliable) {
  const auto mapped = static_cast<double>(count_mapped(quality));
  const std::string share =
      fmt::format("quality above {} at {:.2f} % of the mapped vertices", reliable_quality,
                  mapped > 0 ? 100 - 100 * static_cast<double>(count_low_quality(quality)) / mapped : 0.0);
  double farthest = 0;
  for (std::size_t i = 0; i < quality.size(); ++i)
    if (!std::isnan(quality[i])) farthest = std::max(farthest, distances[i]);
  if (!reliable) return fmt::format("not reliable ({})", share);
  if (*reliable == farthest) return fmt::format("reliable up to the farthest vertex ({})", share);
  return fmt::format("reliable up to distance {:.4g} of {:.4g} ({})", *reliable, farthest, share);
}

void comment_on_quality(const std::vector<double>& quality, std::string_view advice, Journal& journal) {
  const std::ptrdiff_t mapped = count_mapped(quality), poor = count_low_quality(quality);
  if (5 * poor <= mapped) return;
  journal.add_warning(fmt::format(
      "the map is not reliable at {:.0f} % of the mapped vertices (quality below {}): they lie beyond a cut locus, in "
      "folds, or where the sampling is too coarse or too noisy; {}",
      100.0 * static_cast<double>(poor) / static_cast<double>(mapped), reliable_quality, advice));
}

namespace {

/// Whether an output contains normals. They are for viewers, and take long on large surfaces.
bool shows_normals(const OutputOptions& output) {
  return !output.view.empty() || io::writes_for_viewers(output.output, output.format);
}

}  // namespace

std::vector<Vec3> drawn_points(const Input& input, const InputOptions& options) {
  const bool is_thinned = options.voxel || options.outliers;
  const bool shows_all = options.around_source || input.geometry.face_count() > 0;
  if (input.surface().faces().size() > 0 || (shows_all && !is_thinned)) return {};
  return mapped_positions(input.surface());
}

Results::Results(const OutputOptions& output, const Input& input, const InputOptions& options)
    : output_(output),
      input_(input.geometry),
      title_(std::filesystem::path(options.path).filename().string()),
      threads_(options.threads),
      normals_(shows_normals(output) ? input.normals(options.threads) : std::vector<Vec3>()),
      drawn_(output.view.empty() ? std::vector<Vec3>() : drawn_points(input, options)),
      is_cloud_(input.surface().faces().size() == 0) {
  if (!drawn_.empty()) triangles_ = mapped_triangles(input.surface());
}

std::string input_column(const std::string& name) {
  constexpr std::string_view own[] = {
      "index",   "x",  "y",  "z",  "nx",       "ny",    "nz",     "red",     "green",  "blue",
      "u",       "v",  "s",  "t",  "distance", "angle", "status", "quality", "spread", "error_estimate",
      "bounded", "gx", "gy", "gz", "label",    "point"};
  return std::ranges::find(own, name) == std::end(own) ? name : "input_" + name;
}

io::Table table_of(const io::Geometry& input, const std::vector<Vec3>& normals,
                   const std::vector<std::array<std::uint8_t, 3>>& colors) {
  io::Table table{.title = "logarithmic map by libahm"};
  table.add({"x", "y", "z"}, input.points);
  if (!normals.empty()) table.add({"nx", "ny", "nz"}, normals).for_viewers = true;
  if (!colors.empty()) table.add({"red", "green", "blue"}, colors).for_viewers = true;
  for (const io::Property& property : input.properties) table.add(input_column(property.name), property.values);
  table.faces = input.faces();
  table.acquisition = input.acquisition;
  return table;
}

void add_map(io::Table& table, const RowLogMap& rows, const std::vector<double>& quality) {
  table.add("u", rows.u);
  table.add("v", rows.v);
  table.add("distance", rows.distance);
  if (!rows.angle.empty()) table.add("angle", rows.angle);
  table.add("status", rows.status);
  table.add("quality", quality);
  table.add("spread", rows.spread);
  if (!rows.error_estimate.empty()) table.add("error_estimate", rows.error_estimate);
  if (!rows.bounded.empty()) table.add("bounded", rows.bounded);
}

io::Table Results::table() const {
  io::Table table = table_of(input_, normals_, input_.colors);
  table.threads = threads_;
  return table;
}

render::Scene Results::scene() const {
  render::Scene scene;
  scene.points = drawn_.empty() ? input_.points : drawn_;
  scene.normals = normals_;
  scene.face_begin = drawn_.empty() ? input_.face_begin : triangles_.begin;
  scene.face_vertices = drawn_.empty() ? input_.face_vertices : triangles_.rows;
  scene.is_cloud = is_cloud_;
  scene.title = title_;
  scene.colors = input_.colors;
  return scene;
}

render::Scene Results::scene(const RowLogMap& rows, const std::vector<double>& quality,
                             const SurfaceSource& source) const {
  render::Scene result = scene();
  result.u = rows.u;
  result.v = rows.v;
  result.quality = quality;
  result.bounded = rows.bounded;
  result.source = source.position;
  result.details = {rows.distance, rows.spread, rows.status, {}};
  if (source.frame) result.source_axes = {source.frame->x, source.frame->y, source.frame->normal};
  return result;
}

void Results::write_view(const render::Scene& scene, Journal& journal, const render::PictureOptions& picture) {
  if (output_.view.empty()) return;
  journal.start("view");
  const auto fail = [&](std::string_view reason) {
    journal.add_view_failure(fmt::format("--view {}: not written, {}", output_.view, reason));
  };
  try {
    draw(output_.view, scene, picture.pattern, output_.picture, threads_);
  } catch (const Cancelled&) {
    throw;
  } catch (const std::bad_alloc&) {
    fail("out of memory");
  } catch (const std::length_error&) {  // an array too long for any memory
    fail("out of memory");
  } catch (const Error& error) {
    fail(worded(error));
  }
}

void Results::write(const io::Table& table, const render::Scene& scene, Journal& journal,
                    const render::PictureOptions& picture) {
  write_view(scene, journal, picture);
  journal.start("write");
  if (!output_.output.empty()) io::write(output_.output, table, output_.format);
  journal.finish();
  journal.clear_display();
}

}  // namespace ahm::app
