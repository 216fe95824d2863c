#include <nlohmann/json.hpp>

#include "ahm/io/read.hpp"
#include "commands.hpp"
#include "console.hpp"
#include "output_paths.hpp"
#include "progress_display.hpp"
#include "run_report.hpp"
#include "survey.hpp"

namespace ahm::app {

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

}  // namespace ahm::app
