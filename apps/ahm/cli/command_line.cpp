// Only this file includes all of CLI11: every file that includes CLI.hpp compiles the implementation of CLI11's help and
// configuration again. The other files include App.hpp.
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
    "  ahm info scan.ply                                    what the file contains, and what to run\n"
    "  ahm logmap scan.ply --source 0 -o map.csv            coordinates u, v of every point relative to point 0\n"
    "  ahm logmap scan.ply --source 0 -o map.ply --view map.png\n"
    "\n"
    "A logarithmic map flattens a surface around a source point: each point gets the direction and the length of the\n"
    "shortest path from the source to it. Polar maps (the usual default) and exact maps go around holes. Maps by heat\n"
    "(--method heat) go straight across the holes of flat surfaces.\n"
    "\n"
    "'ahm manual [SUBCOMMAND]' prints a manual page, 'ahm completion bash|zsh|fish' a script for the shell.\n"
    "\n"
    "Exit status: 0 success; 1 the command failed; 2 the command line is wrong; 129, 130 or 143 interrupted.";

std::function<void()> print_later(std::string text) {
  return [text = std::move(text)] { print(text); };
}

/// The action of `ahm completion SHELL` or `ahm manual [SUBCOMMAND]`; null for other command lines.
std::function<void()> about_the_program(CLI::App& app, int argc, const char* const* argv) {
  const std::string_view word = argc > 1 ? argv[1] : "", what = argc > 2 ? argv[2] : "";
  if (argc > 3) return nullptr;
  if (word == "completion") {
    if (const auto text = completion(app, what)) return print_later(*text);
    throw UsageError{"ahm completion: name a shell: bash, zsh or fish"};
  }
  if (word == "manual") {
    if (const auto text = manual(app, what, AHM_VERSION)) return print_later(*text);
    throw UsageError{fmt::format("ahm manual: there is no subcommand '{}'", what)};
  }
  return nullptr;
}

/// Checks that the command line starts with a subcommand. CLI11 would report a missing one as an unknown option.
void check_first_word(const std::string& first, const std::vector<Subcommand>& commands) {
  std::vector<std::string> names;
  for (const Subcommand& command : commands) names.push_back(command.app->get_name());
  if (first.starts_with("-") || std::find(names.begin(), names.end(), first) != names.end()) return;
  const std::string last = names.back();
  names.pop_back();
  throw UsageError{fmt::format("{}; use {} or {}\nRun 'ahm --help' for help.",
                               first.empty() ? "a subcommand is required" : "'" + first + "' is not a subcommand",
                               fmt::join(names, ", "), last)};
}

}  // namespace

std::function<void()> parse_command_line(int argc, const char* const* argv) {
  const auto app = std::make_shared<CLI::App>("Logarithmic maps, paths and textures on meshes and point clouds", "ahm");
  app->get_formatter()->column_width(26);
  app->footer(main_footer);
  app->require_subcommand(1);
  bool version = false;
  app->add_flag("--version", version, "Print the versions of ahm and its libraries");
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
