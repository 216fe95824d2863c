/// \file
/// One page of all that was run.
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
  std::string problem;  ///< why there are no plots, and what to do; empty: all were drawn
};

/// Draws a plot of every table in the folder with plots.py (python3-matplotlib) and writes index.html: the plots, the
/// tables, and on each experiment what the paper shows and what is seen. Without plots the page says why.
/// @throws IoError (nothing was run in this folder, page cannot be written)
Report write_report(const std::filesystem::path& folder);

}  // namespace ahm::bench
