/// \file
/// What the process runs on, for reports.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace ahm::app {

/// Largest resident memory of the process so far.
std::int64_t peak_rss_bytes();

/// Processor time of the process so far, all threads.
double processor_seconds();

/// "1.23 GB", "45 MB", "6 kB": powers of 1000.
std::string bytes_as_text(std::int64_t bytes);

/// Versions of ahm and the libraries it stands on, and the BLAS in use.
nlohmann::ordered_json versions();

/// The same for people, one line each: what `ahm --version` prints.
std::string versions_as_text();

}  // namespace ahm::app
