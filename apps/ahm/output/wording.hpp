/// \file
/// What the libraries report as data, in the program's words.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "ahm/error.hpp"
#include "ahm/report.hpp"
#include "output/warning_text.hpp"

namespace ahm::app {

/// "1 point", "3 points".
std::string counted(std::size_t count, std::string_view noun);

/// An error's message, with the options of the program as its remedy where the libraries name one of their own.
std::string worded(const Error& error);

/// "group.name" becomes an entry of an object.
nlohmann::ordered_json as_json(const Report& report);

}  // namespace ahm::app
