/// \file
/// Keeps PCL from printing.
#pragma once

#include <pcl/console/print.h>

#include <mutex>

namespace ahm::io {

/// Silences PCL's console while it lives. The level is one for the whole process, so only one thread may change it at a
/// time.
class PclQuiet {
 public:
  PclQuiet() : lock_(mutex()), level_(pcl::console::getVerbosityLevel()) {
    pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  }
  ~PclQuiet() { pcl::console::setVerbosityLevel(level_); }
  PclQuiet(const PclQuiet&) = delete;
  PclQuiet& operator=(const PclQuiet&) = delete;

 private:
  static std::mutex& mutex() {
    static std::mutex one;
    return one;
  }
  std::lock_guard<std::mutex> lock_;
  pcl::console::VERBOSITY_LEVEL level_;
};

}  // namespace ahm::io
