/// \file
/// The user's browser.
#pragma once

#include <string>

namespace ahm::app {

/// Asks the desktop (xdg-open) to show an address. Whether it does is not known: not where there is no desktop.
/// @return whether it could be asked
bool open_browser(const std::string& address);

}  // namespace ahm::app
