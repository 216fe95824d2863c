/// \file
/// The record of all runs, DIR/run.json: experiment, date, machine, time and memory.
///
/// \code
/// RunRecord record(folder);                  // keeps the results of earlier runs in this folder
/// record.run(experiment, settings);          // writes folder/NAME.csv and folder/run.json
/// \endcode
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "experiments/experiment.hpp"

namespace ahm::bench {

class RunRecord {
 public:
  /// Creates the folder if it is missing.
  /// @throws IoError (folder cannot be created, run.json cannot be read)
  explicit RunRecord(std::filesystem::path folder);

  /// Runs an experiment and writes its table and the record.
  /// @throws IoError, and the exceptions of the experiment
  void run(const Experiment& experiment, const Settings& settings);

  /// The record of an experiment: figure, title, paper, seen, seconds, peak_megabytes, toy, meshes, machine. Null if it was
  /// not run.
  const nlohmann::ordered_json* find(std::string_view name) const;
  const std::filesystem::path& folder() const noexcept { return folder_; }

 private:
  /// Reads run.json, which may contain results of other runs.
  void read();

  std::filesystem::path folder_;
  nlohmann::ordered_json json_;
};

}  // namespace ahm::bench
