#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>

#include "ahm/io/read.hpp"
#include "ahm/maps/cost.hpp"
#include "cli/console.hpp"
#include "cli/system_info.hpp"
#include "commands/commands.hpp"
#include "input/backend.hpp"
#include "output/output_paths.hpp"
#include "output/run_report.hpp"

namespace ahm::app {
namespace {

/// Of reading the input and building the graph, per vertex.
struct GraphCost {
  double bytes, seconds;
};

GraphCost graph_cost(const std::string& backend) {
  if (backend == "pointcloud") return {800, 5.5e-6};
  return {800, 3e-6};
}

struct Estimate {
  Strategy strategy;
  double bytes, seconds;
};

Estimate estimate(const GraphSize& size, Strategy strategy, const GraphCost& graph, int times) {
  const Cost cost = estimate_cost(size, strategy);
  const double n = size.vertices;
  const double kept = strategy == Strategy::global ? times : 1;  // the factors of every diffusion time stay in memory
  return {strategy, graph.bytes * n + kept * cost.bytes, graph.seconds * n + times * cost.first_map_seconds};
}

}  // namespace

void run_estimate(const RunOptions& options) {
  check_outputs(options.input, {{"--json", options.json}});
  const io::Geometry input = io::read(options.input);
  const std::string backend = choose_backend(input, options.backend);
  const GraphSize size{static_cast<Index>(input.points.size())};
  const SolverOptions solver{.strategy = options.strategy, .expected_maps = 1};
  const Strategy chosen = choose_strategy(size, solver);

  nlohmann::ordered_json j{{"program", "ahm logmap --estimate"},
                           {"n", size.vertices},
                           {"backend", backend},
                           {"strategy", to_string(chosen)}};
  std::string text = fmt::format("{} vertices, backend {}\n", size.vertices, backend);
  for (Strategy strategy : {Strategy::global, Strategy::march}) {
    const Estimate e = estimate(size, strategy, graph_cost(backend), options.order == 1 ? 1 : 3);
    j[std::string(to_string(strategy))] = {{"seconds", e.seconds}, {"peak_bytes", e.bytes}};
    text += fmt::format("{:<7} about {:.2g} s, {}{}\n", to_string(strategy), e.seconds,
                        bytes_as_text(static_cast<std::int64_t>(e.bytes)), strategy == chosen ? "  (chosen)" : "");
  }
  const double memory = machine_memory();
  j["machine_bytes"] = memory;
  text += fmt::format("this machine has {}\n", bytes_as_text(static_cast<std::int64_t>(memory)));
  write_json(options.json, j);
  if (options.json != "-") print(text);
}

}  // namespace ahm::app
