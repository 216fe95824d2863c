/// \file
/// Converts errors, counts and reports of the libraries to text and JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "ahm/error.hpp"
#include "ahm/report.hpp"
#include "output/warning_text.hpp"

namespace ahm::app {

/// A count with its noun: "1 point", "3 points". @param noun  singular; its plural ends in s
std::string counted(std::size_t count, std::string_view noun);

/// The message of an error. The program's options replace the remedy of the library, which names arguments of its functions.
std::string worded(const Error& error);

/// A report as JSON; an id "group.name" becomes the entry `name` of the object `group`.
nlohmann::ordered_json as_json(const Report& report);

}  // namespace ahm::app
