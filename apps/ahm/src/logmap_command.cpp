#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "ahm/cost.hpp"
#include "ahm/error.hpp"
#include "ahm/io/write.hpp"
#include "ahm/log_map_solver.hpp"
#include "ahm/view/picture.hpp"
#include "backend.hpp"
#include "commands.hpp"
#include "journal.hpp"
#include "map_rows.hpp"
#include "output_paths.hpp"
#include "run_report.hpp"

namespace ahm::app {
namespace {

void check_view(const std::string& path) {
  if (path.empty()) return;
  const std::string extension = extension_of(path);
  const bool html = extension == ".html" || extension == ".htm";
  if (!html && extension != ".png")
    throw InvalidArgument(fmt::format("--view {}: the name must end in .png or .html", path));
  if (html ? !view::can_write_html() : !view::can_write_png())
    throw InvalidArgument(fmt::format("--view {}: this build of ahm cannot write {} files", path, extension));
}

double distance(const Vec3& a, const Vec3& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

/// Something the user should know about where the source ended up.
void comment_on_source(const LogmapOptions& options, const Model& model, const ResolvedSource& source,
                       Journal& journal) {
  const auto* wanted = std::get_if<SourcePosition>(&options.source);
  if (wanted == nullptr) return;
  const double away = distance(wanted->position, source.position);
  const double edge = model.graph().mean_edge_length() * model.graph().length_unit();
  if (away > 10 * edge)
    journal.add_warning(
        fmt::format("the vertex nearest to {} is {:.4g} away, at {:.6g} {:.6g} {:.6g}: {:.0f} mean edge lengths",
                    to_string(*wanted), away, source.position[0], source.position[1], source.position[2], away / edge));
}

void comment_on_statuses(const MapRows& rows, const std::string& input, Journal& journal) {
  const auto count = [&](Status s) { return std::count(rows.status.begin(), rows.status.end(), s); };
  const auto total = static_cast<double>(rows.status.size());
  if (const auto apart = count(Status::component); static_cast<double>(apart) > 0.1 * total)
    journal.add_warning(
        fmt::format("{:.0f} % of the vertices are not connected to the source; 'ahm info {}' tells about components",
                    100.0 * static_cast<double>(apart) / total, input));
  if (const auto unreached = count(Status::unreached); unreached > 0)
    journal.add_warning(
        fmt::format("no heat reaches {} vertices: with --strategy global they are too far away (the "
                    "march has no such limit), else the weights around them are too bad",
                    unreached));
}

/// What was left out because it is farther than the radius in a straight line already.
void mark_beyond(const std::vector<Vec3>& points, const Vec3& source, double radius, MapRows& rows) {
  for (std::size_t i = 0; i < points.size(); ++i)
    if (rows.status[i] == Status::removed && distance(points[i], source) > radius) rows.status[i] = Status::radius;
}

void write_view(const LogmapOptions& options, const io::Geometry& input, const ResolvedSource& source,
                const MapRows& rows, const std::vector<Vec3>& normals) {
  view::Scene scene;
  scene.points = input.points;
  scene.normals = normals;
  scene.face_begin = input.face_begin;
  scene.face_vertices = input.face_vertices;
  scene.u = rows.u;
  scene.v = rows.v;
  scene.source = source.position;
  if (source.frame) scene.source_axes = {source.frame->x, source.frame->y, source.frame->normal};
  scene.title = std::filesystem::path(options.input).filename().string();
  view::write_picture(options.view, scene);
}

/// What this run has written: all of it or, after a failure, nothing.
class Written {
 public:
  ~Written() {
    std::error_code ignored;
    for (const std::string& path : paths_)
      if (!is_stream(path)) std::filesystem::remove(path, ignored);
  }
  void add(const std::string& path) { paths_.push_back(path); }
  void keep() { paths_.clear(); }

 private:
  std::vector<std::string> paths_;
};

void write_results(const LogmapOptions& options, const io::Geometry& input, const Model& model,
                   const ResolvedSource& source, const MapRows& rows, Written& written, Journal& journal) {
  const std::vector<Vec3> normals = model.normals();
  if (!options.view.empty()) {
    journal.start("view");
    write_view(options, input, source, rows, normals);
    written.add(options.view);
  }
  journal.start("write");
  io::Table table;
  table.points = input.points;
  table.normals = normals;
  table.u = rows.u;
  table.v = rows.v;
  table.distance = rows.distance;
  table.angle = rows.angle;
  table.status = rows.status;
  table.further.push_back({"quality", rows.quality});
  if (!rows.error_estimate.empty()) table.further.push_back({"error_estimate", rows.error_estimate});
  table.face_begin = input.face_begin;
  table.face_vertices = input.face_vertices;
  io::write(options.output, table);
  written.add(options.output);
  journal.finish();
  journal.clear_display();
}

/// Better refused than swapped for.
void check_memory(const LogmapOptions& options, const TangentGraph& graph) {
  if (options.strategy != Strategy::global) return;
  const GraphSize size{graph.size(), graph.dimension(), graph.transport_kind()};
  const double factors = options.order == 1 ? 1 : 3;
  const double wanted = factors * estimate_cost(size, Strategy::global).bytes, memory = machine_memory();
  if (memory > 0 && wanted > memory)
    throw ResourceExhausted(fmt::format(
        "--strategy global: the factors would take about {}, this machine has {}; leave the choice to auto, which "
        "marches",
        bytes_as_text(static_cast<std::int64_t>(wanted)), bytes_as_text(static_cast<std::int64_t>(memory))));
}

LogMapSolver factor(const LogmapOptions& options, const Model& model, Journal& journal) {
  check_memory(options, model.graph());
  journal.start("factor");
  OperatorOptions operator_options;
  operator_options.t_coef = options.t_coef;
  operator_options.ordering = options.ordering;
  operator_options.progress = journal.progress();
  SolverOptions solver_options;
  solver_options.strategy = options.strategy;
  solver_options.expected_maps = 1;
  solver_options.order = options.order;
  solver_options.accuracy = options.accuracy;
  return LogMapSolver(model.graph(), operator_options, solver_options);
}

LogMap solve(const LogmapOptions& options, const LogMapSolver& solver, const Source& source, Journal& journal) {
  journal.start("solve");
  MapOptions map_options;
  map_options.variant = options.variant;
  if (options.radius) map_options.radius = *options.radius;
  map_options.threads = options.threads;
  map_options.frames = true;
  map_options.progress = journal.progress();
  LogMap map = solver.solve(source, map_options);
  journal.tell(strategy_as_text(map));
  return map;
}

}  // namespace

void run_logmap(const LogmapOptions& options) {
  if (options.estimate) return run_estimate(options);
  check_outputs(options.input, {{"--output", options.output}, {"--json", options.json}, {"--view", options.view}});
  io::check_writable(options.output);
  check_view(options.view);
  Journal journal(options.verbose);
  comment_on_blas(journal);
  const io::Geometry input = read_input(options.input, journal);

  journal.start("graph");
  const std::string backend = choose_backend(input, options.backend);
  const std::unique_ptr<Model> model = build_model(backend, input, options, journal.progress());
  journal.add_warnings(model->warnings());
  const ResolvedSource source = model->source(options.source, options.u_axis);
  comment_on_source(options, *model, source, journal);

  const LogMapSolver solver = factor(options, *model, journal);
  const LogMap map = solve(options, solver, source.source, journal);
  MapRows rows = rows_of(map, *model, input.points.size());
  if (options.local) mark_beyond(input.points, source.position, *options.radius, rows);
  comment_on_statuses(rows, options.input, journal);
  Written written;
  write_results(options, input, *model, source, rows, written, journal);
  const Run run{options, input, backend, *model, solver, source, map, rows, journal.times(), journal.warnings()};
  write_json(options.json, run_as_json(run));
  written.keep();
  const bool stdout_taken = options.json == "-" || is_stream(options.output);
  stdout_taken ? say(run_as_text(run)) : print(run_as_text(run));
}

}  // namespace ahm::app
