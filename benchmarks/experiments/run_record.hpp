/// \file
/// What was run, when, on what, how long, with how much memory: DIR/run.json.
///
/// \code
/// RunRecord record(folder);                  // takes up what an earlier run left there
/// record.run(experiment, settings);          // writes folder/NAME.csv and folder/run.json
/// \endcode
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "experiments/experiment.hpp"

namespace ahm::bench {

class RunRecord {
 public:
  /// Creates the folder where it is missing.
  /// @throws IoError (folder cannot be made, run.json cannot be read)
  explicit RunRecord(std::filesystem::path folder);

  /// Runs the experiment and writes its table and the record.
  /// @throws IoError, and what the experiment throws
  void run(const Experiment& experiment, const Settings& settings);

  /// Of an experiment that was run: figure, title, paper, seen, seconds, peak_megabytes, toy, meshes, machine.
  const nlohmann::ordered_json* find(std::string_view name) const;
  const std::filesystem::path& folder() const noexcept { return folder_; }

 private:
  /// What run.json holds, also from other runs.
  void read();

  std::filesystem::path folder_;
  nlohmann::ordered_json json_;
};

}  // namespace ahm::bench
