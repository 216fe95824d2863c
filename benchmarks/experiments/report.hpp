/// \file
/// One page with the results of all experiments.
///
/// \code
/// const Report report = write_report("results");
/// std::cout << "wrote " << report.page.string() << '\n' << report.problem;   // results/index.html
/// \endcode
#pragma once

#include <filesystem>
#include <string>

namespace ahm::bench {

struct Report {
  std::filesystem::path page;
  std::string problem;  ///< why there are no plots, and what to do; empty: all plots were drawn
};

/// Draws a plot of every table in the folder with plots.py (python3-matplotlib) and writes index.html: for every experiment
/// the paper's result, the result of the run, the plot and the table. If there are no plots, the page contains the reason.
/// @throws IoError (a folder without results, page cannot be written)
Report write_report(const std::filesystem::path& folder);

}  // namespace ahm::bench
