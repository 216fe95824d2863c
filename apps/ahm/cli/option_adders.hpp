/// \file
/// The options that subcommands share, each written once.
#pragma once

#include <CLI/App.hpp>
#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "cli/manual.hpp"
#include "cli/options.hpp"

namespace ahm::app {

/// Adds an option with its own parser. CLI11's parser accepts nan, inf and hexadecimal numbers.
template <class Value, class Parse>
CLI::Option* add_parsed(CLI::App& app, const std::string& name, Value& value, const Parse& parse,
                        const std::string& type, const std::string& help) {
  const std::string label = name.substr(name.find("--"));
  CLI::Option* option = app.add_option_function<std::string>(
                               name,
                               [&value, parse, label](const std::string& text) {
                                 try {
                                   value = parse(text);
                                 } catch (const std::invalid_argument& e) {
                                   throw CLI::ValidationError(label, e.what());
                                 }
                               },
                               help)
                            ->type_name(type);
  if constexpr (requires { parse.words; }) set_choices(*option, parse.words);
  return option;
}

/// Parsers for `add_parsed`. @throws std::invalid_argument when they are called
std::function<Index(const std::string&)> integer_parser(std::int64_t low,
                                                        std::int64_t high = std::numeric_limits<Index>::max());
std::string non_empty(const std::string& text);

/// A parser that accepts one of several words.
struct Choice {
  std::vector<std::string> words;
  std::string operator()(const std::string& text) const;
};

/// A parser that turns words into values.
template <class Value>
struct ChoiceOf {
  std::vector<std::string> words;
  std::vector<Value> values;
  explicit ChoiceOf(const std::vector<std::pair<std::string, Value>>& allowed) {
    for (const auto& [word, value] : allowed) words.push_back(word), values.push_back(value);
  }
  Value operator()(const std::string& text) const {
    Choice{words}(text);
    return values[static_cast<std::size_t>(std::ranges::find(words, text) - words.begin())];
  }
};

inline Choice choice(std::vector<std::string> words) { return {std::move(words)}; }
template <class Value>
ChoiceOf<Value> choice_of(const std::vector<std::pair<std::string, Value>>& allowed) {
  return ChoiceOf<Value>(allowed);
}

CLI::Option* add_source(CLI::App& app, SourceOptions& o, const std::string& help);
/// Adds --source, which may be repeated, and --sources. Both append to one list.
void add_sources(CLI::App& app, std::vector<SourceSpec>& sources);
CLI::Option* add_u_axis(CLI::App& app, SourceOptions& o);
CLI::Option* add_min_quality(CLI::App& app, double& min_quality);

/// Adds INPUT and --input-format.
void add_input(CLI::App& app, InputOptions& o);
/// Adds INPUT for several files, and --input-format.
void add_inputs(CLI::App& app, InputOptions& o, std::vector<std::string>& paths);
CLI::Option* add_backend(CLI::App& app, InputOptions& o);
CLI::Option* add_drop_nan(CLI::App& app, InputOptions& o);
CLI::Option* add_non_manifold(CLI::App& app, InputOptions& o);
/// Adds the options for building a graph from points: --voxel, --outliers, --drop-nan, --k, --knn, --normals, --smooth.
void add_cloud_options(CLI::App& app, InputOptions& o);
CLI::Option* add_normals(CLI::App& app, InputOptions& o);
CLI::Option* add_smooth(CLI::App& app, InputOptions& o);
/// Adds --local.
/// @param radius  start of the help text, how far the graph reaches: "Up to --radius"
void add_local(CLI::App& app, InputOptions& o, const std::string& radius);
/// Adds --repair, --weld, --drop-degenerate, --drop-duplicates, --orient.
void add_repair_options(CLI::App& app, InputOptions& o);
/// Adds --no-flips, --non-manifold, --discretization, and the options of repairs.
void add_mesh_options(CLI::App& app, InputOptions& o);

/// Adds --method. Options of heat are errors with other methods.
/// @param methods  methods of the subcommand in addition to heat
/// @param chosen   the default is the method that suits the surface, and options of heat select heat; otherwise the default is heat
CLI::Option* add_method(CLI::App& app, SolveOptions& o, std::vector<Method> methods = {Method::polar, Method::exact},
                        bool chosen = false);
CLI::Option* add_variant(CLI::App& app, SolveOptions& o);
CLI::Option* add_strategy(CLI::App& app, SolveOptions& o);
CLI::Option* add_t_coef(CLI::App& app, SolveOptions& o);
/// Adds --threads, for the graph and, unless null, for maps on it.
CLI::Option* add_threads(CLI::App& app, InputOptions& graph, SolveOptions* maps = nullptr);
/// Adds --variant, --backend, --t-coef, --threads, the options of clouds and those of meshes.
void add_graph_options(CLI::App& app, InputOptions& input, SolveOptions& solve);

/// Adds --output and --no-overwrite.
CLI::Option* add_output(CLI::App& app, OutputOptions& o);
/// Adds --output, --no-overwrite and --format for tables (`io::write`).
/// @param more  extensions of other files that the subcommand writes
CLI::Option* add_table_output(CLI::App& app, OutputOptions& o, const std::vector<std::string>& more = {});
CLI::Option* add_json(CLI::App& app, OutputOptions& o);
CLI::Option* add_view(CLI::App& app, OutputOptions& o);
/// Adds --verbose and --quiet.
void add_verbosity(CLI::App& app, Verbosity& verbosity, const std::string& group = "Options");
/// Adds --json, --view, the options of pictures of a map, --verbose and --quiet.
void add_map_results(CLI::App& app, OutputOptions& o);
/// Adds the options of `add_graph_options` and `add_map_results`, which end the help of a subcommand.
void add_graph_and_results(CLI::App& app, InputOptions& input, SolveOptions& solve, OutputOptions& output);

}  // namespace ahm::app
