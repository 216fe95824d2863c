// The console of the page: replaces apps/ahm/cli/console.cpp. Progress goes to the function `progress` of web/site/worker.js, and warnings
// stay in the journal.
#include "cli/console.hpp"

#include "cli/system_info.hpp"
#include "progress.hpp"

namespace ahm::app {

void print_to_stderr(std::string_view) {}
void warn(std::string_view) {}

struct ProgressDisplay::Painter {};
ProgressDisplay::ProgressDisplay(bool) {}
ProgressDisplay::~ProgressDisplay() = default;
void ProgressDisplay::update(std::string_view stage, double fraction) { web::show_progress(stage, fraction); }
Progress ProgressDisplay::progress() { return {web::show_progress, {}}; }
void ProgressDisplay::clear() {}

std::int64_t peak_rss_bytes() { return static_cast<std::int64_t>(__builtin_wasm_memory_size(0)) << 16; }

}  // namespace ahm::app
