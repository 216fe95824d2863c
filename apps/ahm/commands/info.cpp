#include <memory>
#include <nlohmann/json.hpp>

#include "ahm/io/read.hpp"
#include "cli/console.hpp"
#include "cli/option_adders.hpp"
#include "cli/progress_display.hpp"
#include "commands/commands.hpp"
#include "input/survey.hpp"
#include "output/output_paths.hpp"
#include "output/run_report.hpp"

namespace ahm::app {
namespace {

void run_info(const InfoOptions& options) {
  check_outputs(options.input, {{"--json", options.json}});
  Survey result;
  {
    ProgressDisplay display;
    display.update("read", 0);
    const io::Geometry input = io::read(options.input);
    result = survey(input, options, display.progress());
  }
  write_json(options.json, as_json(result, options.input));
  if (options.json != "-") print(as_text(result, options.input));
}

}  // namespace

Subcommand add_info(CLI::App& program) {
  const auto options = std::make_shared<InfoOptions>();
  InfoOptions& o = *options;
  CLI::App& info = *program.add_subcommand("info", "What is in a file, what is wrong with it, what to run on it");
  add_input(info, o.input);
  add_parsed(info, "--json", o.json, non_empty, "FILE|-", "Write the same for programs; -: to standard output");
  add_parsed(info, "--k", o.k, integer_parser(3), "N", "Neighbours per point when looking for components (default 30)");
  add_threads(info, o.threads);
  info.footer("Example:\n  ahm info scan.pcd");
  return {&info, [options] { run_info(*options); }};
}

}  // namespace ahm::app
