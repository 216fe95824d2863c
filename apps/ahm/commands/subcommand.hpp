/// \file
/// What a subcommand is. Each has a file of its own, commands/NAME.cpp, with a function `add_NAME`; the list of all is in
/// apps/ahm/CMakeLists.txt.
#pragma once

#include <CLI/App.hpp>
#include <functional>
#include <memory>
#include <span>

#include "ahm/io/atomic_file.hpp"

namespace ahm::app {

/// A part of the command line and what it asks for.
struct Subcommand {
  CLI::App* app;              ///< owned by the program's
  std::function<void()> run;  ///< once the command line is read; throws ahm::Error and its kin, the caller reports them
};

/// @param offer  adds the options of the subcommand to the command line
/// @param run    does the work, once they are read. Its files get their names when `deliver` tells of them, else at its end
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

/// All of them, in the order of 'ahm --help'.
std::span<const AddSubcommand> subcommands();

}  // namespace ahm::app
