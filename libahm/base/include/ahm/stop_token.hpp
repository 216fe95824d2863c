/// \file
/// Stop tokens: those of the standard library where it has them, otherwise a minimal replacement (libc++ before 20, or without threads).
///
/// \code
/// ahm::StopSource stop;
/// ahm::Progress progress{.stop = stop.get_token()};
/// stop.request_stop();                       // from any thread
/// \endcode
#pragma once

#include <version>

#ifdef __cpp_lib_jthread
#include <stop_token>

namespace ahm {

using StopToken = std::stop_token;
using StopSource = std::stop_source;

}  // namespace ahm
#else
#include <atomic>
#include <memory>

namespace ahm {

/// Reports whether a stop was requested. A token without a source never reports one.
class StopToken {
 public:
  StopToken() = default;
  bool stop_requested() const noexcept { return requested_ && *requested_; }
  bool stop_possible() const noexcept { return requested_ != nullptr; }

 private:
  friend class StopSource;
  std::shared_ptr<const std::atomic<bool> > requested_;
};

/// Requests a stop of all calls that have one of its tokens.
class StopSource {
 public:
  StopToken get_token() const noexcept {
    StopToken token;
    token.requested_ = requested_;
    return token;
  }
  bool request_stop() noexcept { return !requested_->exchange(true); }
  bool stop_requested() const noexcept { return *requested_; }

 private:
  std::shared_ptr<std::atomic<bool> > requested_ = std::make_shared<std::atomic<bool> >(false);
};

}  // namespace ahm
#endif
