/// \file
/// Serves a session to browsers on this machine only.
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

/// Whether this build can serve pages (requires cpp-httplib and three.js).
bool can_serve() noexcept;

/// An HTTP server on 127.0.0.1. All of its addresses begin with a random token of 128 bits. It rejects the following requests before it
/// reads their bodies:
/// - without the token, with another Host than this machine and port, or with another Origin
/// - with a body that is not JSON, has no Content-Length, or exceeds 1 MiB (32 MiB for exports)
/// - with encodings or ranges
///
/// The server does not serve files. The session computes all answers.
class Server {
 public:
  /// @param session  must outlive the server
  /// @param port     0: any free port
  /// @throws Error (the port is in use; this build cannot serve pages)
  explicit Server(const Session& session, int port = 0);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  int port() const;
  /// URL of the page, with the token and a trailing slash.
  std::string address() const;
  /// Serves requests until `stop` is called. May be called once.
  void run();
  /// Stops the server, and returns when `run` has finished. May be called before `run`, or from another thread.
  void stop();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ahm::viewer
