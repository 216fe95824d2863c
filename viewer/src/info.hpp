// What a session tells of itself.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "ahm/viewer/session.hpp"

namespace ahm::viewer {

/// What is looked at, what can be asked for, and what is asked for unless a request says otherwise.
nlohmann::json session_info(const Surface& surface, const io::Geometry& geometry, const SessionOptions& options);

}  // namespace ahm::viewer
