/// \file
/// The subcommands.
#pragma once

#include <functional>

#include "cli/options.hpp"

namespace CLI {
class App;
}

namespace ahm::app {

/// A part of the command line and what it asks for.
struct Subcommand {
  CLI::App* app;              ///< owned by the program's
  std::function<void()> run;  ///< once the command line is read; throws ahm::Error and its kin, the caller reports them
};

Subcommand add_info(CLI::App& program);
Subcommand add_logmap(CLI::App& program);
Subcommand add_local_maps(CLI::App& program);
Subcommand add_inverse(CLI::App& program);
Subcommand add_coverage(CLI::App& program);
Subcommand add_stroke(CLI::App& program);
Subcommand add_cells(CLI::App& program);
Subcommand add_center(CLI::App& program);
Subcommand add_atlas(CLI::App& program);
Subcommand add_decal(CLI::App& program);

/// `ahm logmap --estimate`: time and memory of the run by either strategy.
void run_estimate(const RunOptions& options);

}  // namespace ahm::app
