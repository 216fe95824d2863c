#include "commands/estimate.hpp"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>

#include "ahm/maps/cost.hpp"
#include "cli/console.hpp"
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

/// Of the program itself.
constexpr BuildCost base{.bytes = 17e6, .seconds = 0.01};

Estimate estimate(const GraphSize& size, Strategy strategy, const Backend& graph, int order) {
  const Cost cost = estimate_cost(size, strategy, order);
  const double n = size.vertices;
  return {strategy, base.bytes + graph.cost.bytes * n + cost.bytes,
          base.seconds + graph.cost.seconds * n + cost.first_map_seconds};
}

/// Of the graph.
Index vertices_of(const io::Geometry& input, const Backend& backend, const InputOptions& options) {
  return static_cast<Index>(input.points.size() + (backend.more_vertices ? backend.more_vertices(input, options) : 0));
}

}  // namespace

void run_estimate(const InputOptions& options, const SolveOptions& solve, const std::string& json) {
  check_outputs({options.path}, {{"--json", json}}, false);
  const io::Geometry input = read_input(options);
  const Backend& backend = choose_backend(input, options.backend);
  const GraphSize size{vertices_of(input, backend, options)};
  const HeatOptions solver{.order = solve.order, .strategy = solve.strategy, .expected_maps = 1};
  const Strategy chosen = choose_strategy(size, solver);

  nlohmann::ordered_json j{{"program", "ahm logmap --estimate"},
                           {"n", size.vertices},
                           {"backend", backend.name},
                           {"strategy", to_string(chosen)}};
  std::string text = fmt::format("{} vertices, backend {}\n", size.vertices, backend.name);
  for (Strategy strategy : {Strategy::global, Strategy::march}) {
    const Estimate e = estimate(size, strategy, backend, solve.order);
    j[std::string(to_string(strategy))] = {{"seconds", e.seconds}, {"peak_bytes", e.bytes}};
    text += fmt::format("{:<7} about {:.2g} s, {}{}\n", to_string(strategy), e.seconds,
                        bytes_as_text(static_cast<std::int64_t>(e.bytes)), strategy == chosen ? "  (chosen)" : "");
  }
  const double memory = machine_memory();
  j["machine_bytes"] = memory;
  text += fmt::format("this machine lets it take {}\n", bytes_as_text(static_cast<std::int64_t>(memory)));
  write_json(json, j);
  if (json != "-") print(text);
}

}  // namespace ahm::app
