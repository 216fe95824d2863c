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

/// Adds an option whose text a parser of ours turns into a value: CLI11's own takes nan, inf and hexadecimal for
/// numbers.
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

/// A parser of one of some words.
struct Choice {
  std::vector<std::string> words;
  std::string operator()(const std::string& text) const;
};

/// Words that stand for values.
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
/// --source, which may be repeated, and --sources, which fill one list.
void add_sources(CLI::App& app, std::vector<SourceSpec>& sources);
CLI::Option* add_u_axis(CLI::App& app, SourceOptions& o);
CLI::Option* add_min_quality(CLI::App& app, double& min_quality);

/// INPUT, --input-format
void add_input(CLI::App& app, InputOptions& o);
/// The same for several files.
void add_inputs(CLI::App& app, InputOptions& o, std::vector<std::string>& paths);
CLI::Option* add_backend(CLI::App& app, InputOptions& o);
CLI::Option* add_drop_nan(CLI::App& app, InputOptions& o);
CLI::Option* add_non_manifold(CLI::App& app, InputOptions& o);
/// How points become a graph: --voxel, --outliers, --drop-nan, --k, --knn, --normals, --smooth.
void add_cloud_options(CLI::App& app, InputOptions& o);
CLI::Option* add_normals(CLI::App& app, InputOptions& o);
/// --local. @param radius  how far they reach, at the beginning of the help: "With --radius"
void add_local(CLI::App& app, InputOptions& o, const std::string& radius);
/// --repair, --weld, --drop-degenerate, --drop-duplicates, --orient
void add_repair_options(CLI::App& app, InputOptions& o);
/// --no-flips, --non-manifold, --discretization, and those of repairs
void add_mesh_options(CLI::App& app, InputOptions& o);

/// --method; options of heat are refused with another one.
/// @param methods  that the subcommand offers besides heat
/// @param chosen   whether the method that suits the surface is the default; options of heat choose heat. Else heat is
CLI::Option* add_method(CLI::App& app, SolveOptions& o, std::vector<Method> methods = {Method::polar, Method::exact},
                        bool chosen = false);
CLI::Option* add_tolerance(CLI::App& app, SolveOptions& o);
CLI::Option* add_variant(CLI::App& app, SolveOptions& o);
CLI::Option* add_strategy(CLI::App& app, SolveOptions& o);
CLI::Option* add_t_coef(CLI::App& app, SolveOptions& o);
/// For the graph, and for maps on it where there are any.
CLI::Option* add_threads(CLI::App& app, InputOptions& graph, SolveOptions* maps = nullptr);
/// --variant, --backend, --t-coef, --threads, those of clouds and those of meshes.
void add_graph_options(CLI::App& app, InputOptions& input, SolveOptions& solve);

/// --output, --no-overwrite
CLI::Option* add_output(CLI::App& app, OutputOptions& o);
/// The same for what `io::write` writes, with --format.
CLI::Option* add_table_output(CLI::App& app, OutputOptions& o);
CLI::Option* add_json(CLI::App& app, OutputOptions& o);
CLI::Option* add_view(CLI::App& app, OutputOptions& o);
/// --verbose, --quiet
void add_verbosity(CLI::App& app, Verbosity& verbosity, const std::string& group = "Options");
/// --json, --view with what goes with a map's picture, --verbose, --quiet
void add_map_results(CLI::App& app, OutputOptions& o);

}  // namespace ahm::app
