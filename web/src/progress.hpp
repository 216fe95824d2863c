// Progress for the page.
#pragma once

#include <string_view>

namespace ahm::web {

/// Calls the function `progress` of web/site/worker.js.
void show_progress(std::string_view stage, double fraction);

}  // namespace ahm::web
