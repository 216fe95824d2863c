/// \file
/// The subcommands.
#pragma once

#include "options.hpp"

namespace ahm::app {

/// `ahm logmap`. @throws ahm::Error and its kin; the caller reports them
void run_logmap(const LogmapOptions& options);

/// `ahm logmap --estimate`: time and memory of the run by either strategy. @throws as `run_logmap`
void run_estimate(const LogmapOptions& options);

/// `ahm local-maps`. @throws as `run_logmap`
void run_local_maps(const LocalMapsOptions& options);

/// `ahm coverage`. @throws as `run_logmap`
void run_coverage(const CoverageCommandOptions& options);

/// `ahm info`. @throws as `run_logmap`
void run_info(const InfoOptions& options);

}  // namespace ahm::app
