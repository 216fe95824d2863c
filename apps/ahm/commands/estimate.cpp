#include "commands/estimate.hpp"

#include <fmt/format.h>

#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <string_view>

#include "ahm/maps/cost.hpp"
#include "cli/console.hpp"
#include "cli/journal.hpp"
#include "cli/system_info.hpp"
#include "input/open.hpp"
#include "output/output_paths.hpp"
#include "output/summary.hpp"

namespace ahm::app {
namespace {

struct Estimate {
  Strategy strategy;
  double bytes, seconds;
};

/// Memory and time of the program itself, without any input.
constexpr BuildCost base{.bytes = 17e6, .seconds = 0.01};

Estimate estimate(const GraphSize& size, Strategy strategy, const Backend& graph, const HeatOptions& heat) {
  const Cost cost = estimate_cost(size, strategy, heat.threads);
  const double n = size.vertices;
  return {strategy, base.bytes + graph.cost.bytes * n + cost.bytes,
          base.seconds + graph.cost.seconds * n + cost.first_map_seconds};
}

/// Number of vertices that the graph will have.
Index vertices_of(const io::Geometry& input, const Backend& backend, const InputOptions& options) {
  return static_cast<Index>(input.points.size() + (backend.more_vertices ? backend.more_vertices(input, options) : 0));
}

HeatOptions heat_options(const SolveOptions& solve) {
  HeatOptions heat = solve;
  heat.expected_maps = 1;
  return heat;
}

/// The estimate for one strategy, as text and for programs.
struct EstimateText {
  std::string text;
  nlohmann::ordered_json json;
};

EstimateText text_of(Estimate e) {
  return {fmt::format("about {:.2g} s, {}", e.seconds, bytes_as_text(static_cast<std::int64_t>(e.bytes))),
          {{"seconds", e.seconds}, {"peak_bytes", e.bytes}}};
}

void print_estimates(const GraphSize& size, const std::string& backend, Strategy chosen, const std::string& json,
                     const std::function<EstimateText(Strategy)>& of_strategy) {
  nlohmann::ordered_json j{{"program", "ahm logmap --estimate"},
                           {"n", size.vertices},
                           {"backend", backend},
                           {"method", to_string(Method::heat)},
                           {"strategy", to_string(chosen)}};
  std::string text = fmt::format("vertices: {}, backend {}, method heat\n", size.vertices, backend);
  for (Strategy strategy : {Strategy::global, Strategy::march}) {
    const EstimateText one = of_strategy(strategy);
    j[std::string(to_string(strategy))] = one.json;
    text += fmt::format("{:<7} {}{}\n", to_string(strategy), one.text, strategy == chosen ? "  (chosen)" : "");
  }
  const double memory = machine_memory();
  j["machine_bytes"] = memory;
  text += fmt::format("memory available on this machine: {}\n", bytes_as_text(static_cast<std::int64_t>(memory)));
  write_json(json, j);
  text +=
      "polar maps, the default on meshes and on clouds with little noise, are not estimated; they need no factors\n";
  if (json != "-") print(text);
}

void estimate_from_size(const LogmapOptions& options) {
  const io::Geometry input = read_input(options.input);
  const Backend& backend = choose_backend(input, options.input);
  const GraphSize size{vertices_of(input, backend, options.input)};
  const HeatOptions heat = heat_options(options.solve);
  print_estimates(size, std::string(backend.name), choose_strategy(size, heat), options.output.json,
                  [&](Strategy strategy) { return text_of(estimate(size, strategy, backend, heat)); });
}

/// Estimates from the graph of the map, which is built for that. Time and memory up to then are measured.
void estimate_from_graph(const LogmapOptions& options) {
  Journal journal(Verbosity::quiet);
  const Input input = options.input.around_source
                          ? open_around(options.input, options.solve.radius, journal, options.source.spec)
                          : open_input(options.input, journal, options.source.spec);
  const Source source = resolve(options.source, input, options.solve.threads).source;
  const Estimate so_far{{}, static_cast<double>(peak_rss_bytes()), processor_seconds()};
  const TangentGraph& graph = input.graph();
  const GraphSize size{graph.size(), graph.dimension(), graph.transport_kind()};
  const HeatOptions heat = heat_options(options.solve);
  const auto within = [&](Strategy strategy, double radius) {
    const Cost cost = estimate_cost(graph, source, strategy, heat, radius);
    return Estimate{strategy, so_far.bytes + cost.bytes, so_far.seconds + cost.first_map_seconds};
  };
  print_estimates(size, std::string(input.backend->name), choose_strategy(size, heat), options.output.json,
                  [&](Strategy strategy) {
                    constexpr double everywhere = std::numeric_limits<double>::infinity();
                    if (strategy == Strategy::global || !options.solve.radius)
                      return text_of(within(strategy, everywhere));
                    EstimateText one = text_of(within(strategy, *options.solve.radius));
                    if (graph.is_delaunay()) return one;
                    const EstimateText most = text_of(within(strategy, everywhere));
                    one.text += "; at most " + most.text.substr(std::string_view("about ").size());
                    one.json["at_most"] = most.json;
                    return one;
                  });
}

}  // namespace

void run_estimate(const LogmapOptions& options, bool has_source) {
  check_outputs({options.input.path}, {{"--json", options.output.json}}, false);
  has_source ? estimate_from_graph(options) : estimate_from_size(options);
}

}  // namespace ahm::app
