// The newest request of a kind of each client counts; its older ones are told to stop.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>

#include "ahm/types.hpp"

namespace ahm::viewer {

class Channels {
 public:
  enum class Kind { map, path, coverage };

  /// Stops what this client asked for before, of this kind.
  /// @param number  of the request, where the client counts them: requests may overtake each other on their way, and one that
  ///                comes after a newer one is stopped itself
  std::stop_token begin(const std::string& client, Kind kind, std::optional<Index> number) {
    const std::lock_guard lock(mutex_);
    const std::pair key(client, kind);
    if (newest_.size() >= most && !newest_.contains(key)) forget_oldest();
    Entry& entry = newest_[key];
    std::stop_source own;
    if (number && entry.number && *number < *entry.number) {
      own.request_stop();
      return own.get_token();
    }
    entry.stop.request_stop();
    entry = {std::move(own), ++count_, number};
    return entry.stop.get_token();
  }

  /// For what only `stop_all` ends.
  std::stop_token until_the_end() const { return end_.get_token(); }

  void stop_all() {
    const std::lock_guard lock(mutex_);
    end_.request_stop();
    for (auto& [key, entry] : newest_) entry.stop.request_stop();
  }

 private:
  static constexpr std::size_t most = 192;
  struct Entry {
    std::stop_source stop;
    std::uint64_t begun = 0;      ///< in the order of all
    std::optional<Index> number;  ///< the client's own
  };

  void forget_oldest() {
    auto oldest = newest_.begin();
    for (auto it = newest_.begin(); it != newest_.end(); ++it)
      if (it->second.begun < oldest->second.begun) oldest = it;
    newest_.erase(oldest);
  }

  std::mutex mutex_;
  std::stop_source end_;
  std::map<std::pair<std::string, Kind>, Entry> newest_;
  std::uint64_t count_ = 0;
};

}  // namespace ahm::viewer
