/// \file
/// Memory, processor time and library versions of the process, for reports.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace ahm::app {

/// Peak resident memory of the process so far, bytes.
std::int64_t peak_rss_bytes();

/// Processor time of the process so far, over all threads, seconds.
double processor_seconds();

/// Versions of ahm and of the libraries it uses, and the registers of the processor that it uses.
nlohmann::ordered_json versions();

/// The output of `ahm --version`: one version per line.
std::string versions_as_text();

}  // namespace ahm::app
