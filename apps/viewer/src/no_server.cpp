// Replaces server.cpp in builds without cpp-httplib or three.js.
#include "ahm/viewer/server.hpp"

namespace ahm::viewer {

struct Server::Impl {};

bool can_serve() noexcept { return false; }

Server::Server(const Session&, int) {
  throw Error("this build of libahm cannot serve pages; install cpp-httplib and three.js and configure again");
}
Server::~Server() = default;
int Server::port() const { return 0; }
std::string Server::address() const { return {}; }
void Server::run() {}
void Server::stop() {}

}  // namespace ahm::viewer
