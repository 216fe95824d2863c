/// \file
/// The interface of subcommands. Each subcommand is a file commands/NAME.cpp with a function `add_NAME`; apps/ahm/CMakeLists.txt lists
/// them.
#pragma once

#include <CLI/App.hpp>
#include <functional>
#include <memory>
#include <span>

#include "ahm/io/atomic_file.hpp"

namespace ahm::app {

/// A subcommand: its options and its work.
struct Subcommand {
  CLI::App* app;              ///< owned by the program's CLI::App
  std::function<void()> run;  ///< does the work after the command line was read; the caller reports what it throws
};

/// Makes a subcommand.
/// @param offer  adds the options of the subcommand to the command line
/// @param run    does the work. Its output files appear under their names when `deliver` reports them, otherwise at the end
template <class Options>
Subcommand subcommand(CLI::App& program, const char* name, const char* purpose, const char* footer,
                      void (*offer)(CLI::App&, Options&), void (*run)(const Options&)) {
  const auto options = std::make_shared<Options>();
  CLI::App& app = *program.add_subcommand(name, purpose);
  offer(app, *options);
  app.footer(footer);
  return {&app, [options, run] {
            io::FileSet files;
            run(*options);
            io::FileSet::commit();
          }};
}

/// Adds a subcommand to the program's command line.
using AddSubcommand = Subcommand (*)(CLI::App& program);

/// All subcommands, in the order of `ahm --help`.
std::span<const AddSubcommand> subcommands();

}  // namespace ahm::app
