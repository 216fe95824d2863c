// The newest request of each client counts; its older ones are told to stop.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <stop_token>
#include <string>

namespace ahm::viewer {

class Channels {
 public:
  /// Stops what this client asked for before.
  std::stop_token begin(const std::string& client) {
    const std::lock_guard lock(mutex_);
    if (newest_.size() >= most && !newest_.contains(client)) forget_oldest();
    Entry& entry = newest_[client];
    entry.stop.request_stop();
    entry = {std::stop_source(), ++count_};
    return entry.stop.get_token();
  }

  void stop_all() {
    const std::lock_guard lock(mutex_);
    for (auto& [client, entry] : newest_) entry.stop.request_stop();
  }

 private:
  static constexpr std::size_t most = 64;
  struct Entry {
    std::stop_source stop;
    std::uint64_t number = 0;
  };

  void forget_oldest() {
    auto oldest = newest_.begin();
    for (auto it = newest_.begin(); it != newest_.end(); ++it)
      if (it->second.number < oldest->second.number) oldest = it;
    newest_.erase(oldest);
  }

  std::mutex mutex_;
  std::map<std::string, Entry> newest_;
  std::uint64_t count_ = 0;
};

}  // namespace ahm::viewer
