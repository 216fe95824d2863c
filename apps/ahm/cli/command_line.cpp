// The one source that includes all of CLI11: CLI.hpp makes every file that includes it compile CLI11's help and configuration
// anew, App.hpp does not.
#include "cli/command_line.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <string_view>
#include <vector>

#include "cli/console.hpp"
#include "cli/manual.hpp"
#include "cli/system_info.hpp"
#include "commands/subcommand.hpp"

namespace ahm::app {
namespace {

constexpr const char* main_footer =
    "Examples:\n"
    "  ahm info scan.ply                                    what is in the file, and what to run\n"
    "  ahm logmap scan.ply --source 0 -o map.csv            coordinates u, v of every point, seen from point 0\n"
    "  ahm logmap scan.ply --source 0 -o map.ply --view map.png\n"
    "\n"
    "A logarithmic map flattens a surface around a source point: each point gets the direction and the length\n"
    "of the shortest path that leads to it from the source. With --method heat coordinates behind holes\n"
    "go straight on, as in the plane; polar and exact maps go around.\n"
    "\n"
    "ahm manual [SUBCOMMAND] prints a manual page, ahm completion bash|zsh|fish a script for the shell.\n"
    "\n"
    "Exit status: 0 success, 1 the work failed, 2 the command line is wrong, 129, 130 or 143 interrupted.";

std::function<void()> print_later(std::string text) {
  return [text = std::move(text)] { print(text); };
}

/// `ahm completion SHELL` and `ahm manual [SUBCOMMAND]`, for those who install the program; null where neither is asked for.
std::function<void()> about_the_program(CLI::App& app, int argc, const char* const* argv) {
  const std::string_view word = argc > 1 ? argv[1] : "", what = argc > 2 ? argv[2] : "";
  if (argc > 3) return nullptr;
  if (word == "completion") {
    if (const auto text = completion(app, what)) return print_later(*text);
    throw UsageError{"write ahm completion bash, zsh or fish"};
  }
  if (word == "manual") {
    if (const auto text = manual(app, what, AHM_VERSION)) return print_later(*text);
    throw UsageError{fmt::format("ahm manual: '{}' is no subcommand", what)};
  }
  return nullptr;
}

/// CLI11 would take a forgotten subcommand for an unknown option.
void check_first_word(const std::string& first, const std::vector<Subcommand>& commands) {
  std::vector<std::string> names;
  for (const Subcommand& command : commands) names.push_back(command.app->get_name());
  if (first.starts_with("-") || std::find(names.begin(), names.end(), first) != names.end()) return;
  const std::string last = names.back();
  names.pop_back();
  throw UsageError{fmt::format("{}: write {} or {}\nRun 'ahm --help' for help.",
                               first.empty() ? "a subcommand is needed" : "'" + first + "' is no subcommand",
                               fmt::join(names, ", "), last)};
}

}  // namespace

std::function<void()> parse_command_line(int argc, const char* const* argv) {
  const auto app =
      std::make_shared<CLI::App>("Logarithmic maps on meshes and point clouds by the affine heat method", "ahm");
  app->get_formatter()->column_width(26);
  app->footer(main_footer);
  app->require_subcommand(1);
  bool version = false;
  app->add_flag("--version", version, "Print the versions of ahm, its libraries and the BLAS in use");
  std::vector<Subcommand> commands;
  for (const AddSubcommand add : subcommands()) commands.push_back(add(*app));
  if (argc == 2 && std::string_view(argv[1]) == "--version") return print_later(versions_as_text());
  if (auto about = about_the_program(*app, argc, argv)) return about;
  check_first_word(argc > 1 ? argv[1] : "", commands);
  const auto chosen = [&] { return app->get_subcommands().empty() ? nullptr : app->get_subcommands().front(); };
  try {
    app->parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    return print_later(chosen() ? chosen()->help("ahm") : app->help());
  } catch (const CLI::ParseError& e) {
    throw UsageError{
        fmt::format("{}\nRun 'ahm {}--help' for help.", e.what(), chosen() ? chosen()->get_name() + " " : "")};
  }
  return std::find_if(commands.begin(), commands.end(), [](const Subcommand& c) { return c.app->parsed(); })->run;
}

}  // namespace ahm::app
