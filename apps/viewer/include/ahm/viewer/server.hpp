/// \file
/// Serves a session to a browser on this machine, and to nobody else.
///
/// \code
/// ahm::viewer::Server server(session);
/// std::cout << server.address() << '\n';   // http://127.0.0.1:40123/2f1c.../
/// server.run();                              // until stop() from another thread
/// \endcode
#pragma once

#include <memory>
#include <string>

#include "ahm/viewer/session.hpp"

namespace ahm::viewer {

/// Whether this build can serve (needs cpp-httplib and three.js).
bool can_serve() noexcept;

/// Listens on 127.0.0.1 only. All of its addresses begin with a token of 128 bits from the system's random numbers; the
/// rest of what a request tells has to fit too: Host (so that no other name leads here), Origin where there is one, JSON
/// bodies of a stated length of at most 1 MiB, no encodings, no ranges. Whatever does not is refused before its body is read.
/// There are no files to be reached: every answer comes from the session.
class Server {
 public:
  /// @param session  must outlive the server
  /// @param port     0: any that is free
  /// @throws Error (the port is taken; this build cannot serve)
  explicit Server(const Session& session, int port = 0);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  int port() const;
  /// With the token, and a slash at the end.
  std::string address() const;
  /// Serves until `stop`; once.
  void run();
  /// Before `run` or from another thread; returns when nothing is served any more.
  void stop();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ahm::viewer
