#include "output/view.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>

#include "ahm/error.hpp"
#include "ahm/io/image.hpp"
#include "ahm/util/shell.hpp"
#include "cli/source_list.hpp"
#include "output/lines.hpp"
#include "output/results.hpp"
#include "output/texture_output.hpp"
#include "output/tool_paths.hpp"

namespace ahm::app {
namespace {

/// Radius of the first maps, where a map of the whole surface would take long. None: no limit.
std::optional<double> first_radius_of(const ViewOptions& options, const TangentGraph& graph) {
  constexpr Index large = 500'000;
  constexpr double edges = 64;  // about 20,000 vertices
  if (options.solve.radius || options.solve.method == Method::exact) return options.solve.radius;
  if (!options.local && graph.size() <= large) return std::nullopt;
  return std::stod(fmt::format("{:.2g}", edges * graph.mean_edge_length() * graph.length_unit()));
}

}  // namespace

View::View(const ViewOptions& options, Journal& journal) : input_(open_input(options.input, journal, options.source)) {
  if (options.source) place(input_, *options.source);  // checks the source
  journal.start("page");
  normals_ = input_.surface().normals();
  first_radius_ = first_radius_of(options, input_.graph());
  session_.emplace(input_.surface(), input_.geometry, session_options(options));
}

viewer::SessionOptions View::session_options(const ViewOptions& options) const {
  viewer::SessionOptions session;
  session.title = std::filesystem::path(options.input.path).filename().string();
  session.input = detail::shell_word(options.input.path);
  session.input_options = fmt::format("{}", fmt::join(option_words(options.input), " "));
  session.settings = {options.solve.method.value_or(input_.surface().suggested_method()),
                      options.solve.variant,
                      options.solve.t_coef,
                      first_radius_,
                      {}};
  if (options.source) session.source = point_of(input_, *options.source);
  session.threads = options.input.threads;
  session.progress = options.progress;
  session.formats = {{"map", {"csv", "ply", "vtp", "jsonl", "pcd"}},
                     {"stroke", {"csv", "ply", "vtp", "jsonl", "pcd"}},
                     {"path", {"obj", "csv", "ply", "vtp", "jsonl"}},
                     {"coverage", {"csv", "ply", "vtp", "jsonl"}},
                     {"whole", {"csv", "ply", "vtp", "jsonl", "obj", "json", "yaml"}},
                     {"isolines", {"obj", "csv", "ply", "vtp", "jsonl"}}};
  if (io::has_images()) session.formats["decal"] = {"glb", "ply"};
  session.worded = [](const Error& error) { return worded(error); };
  session.write = [this](const std::filesystem::path& file, const RowLogMap& rows, const std::vector<double>& quality) {
    io::Table table = table_of(input_.geometry, normals_, input_.geometry.colors);
    add_map(table, rows, quality);
    io::write(file, table);
  };
  session.write_path = [](const std::filesystem::path& file, const std::vector<Vec3>& points) {
    Polylines path;
    path.add(points);
    write_polylines(file.string(), "", path);
  };
  session.write_coverage = [](const std::filesystem::path& file, const CoveragePath& path) {
    write_coverage(file.string(), "", path);
  };
  session.write_whole = [](const std::filesystem::path& file, const ToolPath& path) {
    write_tool_path(file.string(), "", {}, {.spacing = path.spacing}, path);
  };
  session.write_isolines = [](const std::filesystem::path& file, const std::vector<Isoline>& lines) {
    write_polylines(file.string(), "", polylines_of(lines));
  };
  session.write_decal = [this](const std::filesystem::path& file, const InverseMap& inverse, const DecalOptions& decal,
                               const Image& image) {
    if (file.extension() == ".ply") {
      const Colors colors = painted(input_, image_coordinates_of_vertices(inverse, decal), image);
      return io::write(file, painted_table(input_, colors));
    }
    const Decal made = make_decal(inverse, decal);
    if (made.face_begin.size() < 2)
      throw InvalidArgument("the image covers no part of the surface where the map is reliable; choose another source");
    io::write_textured(file, DecalMesh(all_faces(input_), made, image).parts());
  };
  return session;
}

}  // namespace ahm::app
