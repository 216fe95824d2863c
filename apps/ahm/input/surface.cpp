#include "input/surface.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "ahm/error.hpp"
#include "ahm/io/read.hpp"
#include "ahm/maps/cost.hpp"
#include "ahm/surface/directions.hpp"
#include "cli/source_list.hpp"
#include "cli/system_info.hpp"
#include "output/output_paths.hpp"
#include "output/run_report.hpp"

namespace ahm::app {
namespace {

io::Geometry read_input(const std::string& path, Journal& journal) {
  journal.start("read");
  io::Geometry input = io::read(path);
  journal.add_warnings(input.warnings);
  if (input.points.empty()) throw InvalidGeometry(path + ": holds no points");
  return input;
}

void comment_on_blas(Journal& journal) {
  const LinearAlgebraInfo info = linear_algebra_info();
  if (!info.blas_optimized)
    journal.add_warning("CHOLMOD runs on a BLAS that is not optimized (" + info.blas +
                        "): several times slower; on Debian install libopenblas0-pthread");
}

/// Better refused than swapped for.
void check_memory(const RunOptions& options, const TangentGraph& graph) {
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

}  // namespace

Surface open_surface(const RunOptions& options, Journal& journal) {
  comment_on_blas(journal);
  Surface surface;
  surface.input = read_input(options.input, journal);
  journal.start("graph");
  surface.backend = choose_backend(surface.input, options.backend);
  surface.model = build_model(surface.backend, surface.input, options, journal.progress());
  journal.add_warnings(surface.model->warnings());
  return surface;
}

ResolvedSource resolve(const Model& model, const SourceSpec& spec, const std::optional<Vec3>& u_axis,
                       const std::string& option) try {
  return model.source(spec, u_axis);
} catch (const InvalidArgument& e) {
  std::string message = e.what();
  const std::string own = "--source";
  if (message.starts_with(own)) message.replace(0, own.size(), option);
  throw InvalidArgument(message);
}

Vertex vertex_at(const Surface& surface, const SourceSpec& spec, const std::string& option) {
  position_in(surface.input, spec, option);
  if (std::holds_alternative<SourceFace>(spec))
    throw InvalidArgument(fmt::format("{} {}: must be a vertex; write its number or x,y,z", option, to_string(spec)));
  return resolve(*surface.model, spec, std::nullopt, option).source.vertices().front();
}

ResolvedSource resolve(const RunOptions& options, const Model& model) {
  const std::optional<UAxis>& axis = options.u_axis;
  if (!axis || !axis->curvature)
    return model.source(options.source, axis ? std::optional(axis->direction) : std::nullopt);
  const Source plain = model.source(options.source, std::nullopt).source;
  // In a face: at the corner that has most of the source.
  const auto most = std::max_element(plain.weights().begin(), plain.weights().end()) - plain.weights().begin();
  const Vertex vertex = plain.vertices()[most];
  try {
    return model.source(options.source, bending_direction(model.graph(), vertex));
  } catch (const InvalidArgument& e) {
    if (e.fault() != "no_bending_direction") throw;
    throw InvalidArgument(fmt::format("--u-axis curvature: {}; give the axis as X,Y,Z", e.problem()));
  }
}

LogMapSolver make_solver(const RunOptions& options, const Model& model, Journal& journal, int maps) {
  check_memory(options, model.graph());
  journal.start("factor");
  OperatorOptions operator_options;
  operator_options.t_coef = options.t_coef;
  operator_options.ordering = options.ordering;
  operator_options.progress = journal.progress();
  SolverOptions solver_options;
  solver_options.strategy = options.strategy;
  solver_options.expected_maps = maps;
  solver_options.order = options.order;
  solver_options.accuracy = options.accuracy;
  return LogMapSolver(model.graph(), operator_options, solver_options);
}

LogMap solve(const RunOptions& options, const LogMapSolver& solver, const Source& source, Journal& journal) {
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

nlohmann::ordered_json summary(const std::string& program, const RunOptions& options, const Surface& surface) {
  return {{"program", program},
          {"input",
           {{"path", options.input},
            {"format", surface.input.format},
            {"points", surface.input.points.size()},
            {"faces", surface.input.face_count()}}},
          {"output", options.output},
          {"backend", surface.backend}};
}

void deliver(nlohmann::ordered_json summary, const std::string& text, const RunOptions& options,
             const Journal& journal) {
  summary["warnings"] = journal.warnings();
  for (const auto& [stage, seconds] : journal.times().seconds()) summary["seconds"][stage] = seconds;
  summary["seconds_total"] = journal.times().total();
  summary["peak_rss_bytes"] = peak_rss_bytes();
  write_json(options.json, summary);
  std::string wrote = options.output.empty() ? "" : "wrote " + options.output;
  if (!options.view.empty()) wrote += (wrote.empty() ? "wrote " : " and ") + options.view;
  if (!wrote.empty()) wrote += "\n";
  const std::string all = fmt::format("{}{:.2f} s, peak memory {}\n{}", text, journal.times().total(),
                                      bytes_as_text(peak_rss_bytes()), wrote);
  options.json == "-" || is_stream(options.output) ? say(all) : print(all);
}

}  // namespace ahm::app
