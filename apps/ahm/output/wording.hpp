/// \file
/// Converts errors, counts and reports of the libraries to text and JSON.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "ahm/error.hpp"
#include "ahm/report.hpp"
#include "ahm/util/text.hpp"
#include "output/warning_text.hpp"

namespace ahm::app {

using detail::counted, detail::noun_after;

/// The message of an error. The program's options replace the remedy of the library, which names arguments of its functions.
std::string worded(const Error& error);

/// A report as JSON; an id "group.name" becomes the entry `name` of the object `group`.
nlohmann::ordered_json as_json(const Report& report);

/// A number of bytes as text, in powers of 1000: "1.23 GB", "45 MB", "6 kB".
std::string bytes_as_text(std::int64_t bytes);

}  // namespace ahm::app
