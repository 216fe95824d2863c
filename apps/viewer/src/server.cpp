#include "ahm/viewer/server.hpp"

#include <httplib.h>
#include <sys/socket.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <chrono>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

#include "token.hpp"
#include "workers.hpp"

namespace ahm::viewer {
namespace {

constexpr std::size_t largest_body = 1 << 20, largest_export = 32 << 20;  // exports may include an image
constexpr std::size_t most_workers = 1000;                                // one per open connection, even if idle
constexpr int backlog = 1024;  // number of connections that can wait for a worker

constexpr const char* gets[] = {"surface", "info"};
constexpr const char* posts[] = {"map", "stroke", "path", "coverage", "whole", "isolines", "export"};

/// The server of httplib, with a longer queue of waiting connections.
class Listener : public httplib::Server {
 public:
  bool wait_longer() { return ::listen(svr_sock_, backlog) == 0; }
};

/// Replaces httplib's task queue, which has a fixed number of threads.
class Queue final : public httplib::TaskQueue {
 public:
  void enqueue(std::function<void()> task) override { workers_.enqueue(std::move(task)); }
  void shutdown() override { workers_.end(); }

 private:
  Workers workers_{most_workers};
};

void send(const Answer& answer, httplib::Response& response) {
  response.status = answer.status;
  response.set_content(answer.body, answer.type);
}

/// Sends an error. No body if the request has ranges, because httplib would split the body into them.
void refuse(const httplib::Request& request, httplib::Response& response, int status, const std::string& text) {
  response.status = status;
  if (request.ranges.empty()) send({status, "application/json", R"({"error": ")" + text + "\"}"}, response);
}

/// Whether a header has exactly one value, which is allowed. Several values could be interpreted differently by different readers.
bool is_only(const httplib::Request& request, const char* header, const std::vector<std::string>& allowed) {
  return request.get_header_value_count(header) == 1 &&
         std::find(allowed.begin(), allowed.end(), request.get_header_value(header)) != allowed.end();
}

bool has_small_json(const httplib::Request& request, std::size_t most) {
  if (request.get_header_value_count("Content-Length") != 1) return false;
  const std::string length = request.get_header_value("Content-Length");
  std::size_t bytes = 0;
  const auto [end, error] = std::from_chars(length.data(), length.data() + length.size(), bytes);
  return error == std::errc() && end == length.data() + length.size() && bytes <= most &&
         is_only(request, "Content-Type", {"application/json", "application/json; charset=utf-8"});
}

}  // namespace

struct Server::Impl {
  const Session& session;
  std::string token = random_token();
  Listener listener;
  int port = 0;
  std::mutex mutex;
  bool is_stopped = false, is_started = false;  ///< guarded by the mutex
  std::atomic<bool> is_finished{false};

  Impl(const Session& given, int wanted) : session(given) {
    listener.new_task_queue = [] { return new Queue; };  // NOLINT: httplib deletes it
    listener.set_keep_alive_max_count(1);
    listener.set_keep_alive_timeout(5);  // seconds until the first byte
    listener.set_read_timeout(5);
    listener.set_write_timeout(30);
    listener.set_payload_max_length(largest_export);
    listener.set_tcp_nodelay(true);
    listener.set_socket_options([](socket_t socket) {
      const int yes = 1;  // no SO_REUSEPORT, so that no other process can listen on this port
      setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
    bind(wanted);
    set_routes();
  }

  void bind(int wanted) {
    constexpr const char* here = "127.0.0.1";
    if (wanted == 0)
      port = listener.bind_to_any_port(here);
    else if (listener.bind_to_port(here, wanted))
      port = wanted;
    if (port <= 0 || !listener.wait_longer())
      throw Error(wanted == 0
                      ? "cannot listen on any port of 127.0.0.1"
                      : "cannot listen on port " + std::to_string(wanted) + " of 127.0.0.1; choose another port");
  }

  std::vector<std::string> hosts(const std::string& before) const {
    const std::string after = ":" + std::to_string(port);
    return {before + "127.0.0.1" + after, before + "localhost" + after};
  }

  /// Checks a request before its body is read. @return HTTP status of the error; 0 if the request is valid
  int fault(const httplib::Request& request) const {
    if (!is_only(request, "Host", hosts(""))) return 403;
    if (request.has_header("Origin") && !is_only(request, "Origin", hosts("http://"))) return 403;
    const std::string site = request.get_header_value("Sec-Fetch-Site");
    if (!site.empty() && site != "same-origin" && site != "none") return 403;
    const std::string_view path = request.path;
    if (path.size() < 34 || path[0] != '/' || path[33] != '/' || !same_secret(path.substr(1, 32), token)) return 403;
    for (const char* header : {"Transfer-Encoding", "Content-Encoding", "Range", "Expect", "Upgrade"})
      if (request.has_header(header)) return 400;
    if (request.method != "GET" && request.method != "POST") return 405;
    if (request.method == "GET" && request.has_header("Content-Length") &&
        request.get_header_value("Content-Length") != "0")
      return 400;
    const bool is_export = path.substr(34) == "export";
    if (request.method == "POST" && !has_small_json(request, is_export ? largest_export : largest_body)) return 413;
    return 0;
  }

  void set_routes() {
    listener.set_default_headers({{"Cache-Control", "no-store"},
                                  {"X-Content-Type-Options", "nosniff"},
                                  {"X-Frame-Options", "DENY"},
                                  {"Referrer-Policy", "no-referrer"},
                                  {"Cross-Origin-Resource-Policy", "same-origin"},
                                  {"Cross-Origin-Opener-Policy", "same-origin"}});
    listener.set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
      const int status = fault(request);
      if (status == 0) return httplib::Server::HandlerResponse::Unhandled;
      refuse(request, response, status,
             status == 413 ? "the body must be JSON of at most 1 MiB, or 32 MiB for exports" : "refused");
      return httplib::Server::HandlerResponse::Handled;
    });
    listener.set_error_handler([](const httplib::Request& request, httplib::Response& response) {
      if (response.body.empty()) refuse(request, response, response.status, "refused");
    });
    listener.set_exception_handler([](const httplib::Request& request, httplib::Response& response,
                                      const std::exception_ptr&) { refuse(request, response, 500, "failed"); });
    const std::string base = "/" + token + "/";
    listener.Get(base, [this](const httplib::Request&, httplib::Response& response) { send_page(response); });
    for (const std::string name : gets)
      listener.Get(base + name, [this, name](const httplib::Request&, httplib::Response& response) {
        send(session.answer(name, {}), response);
      });
    for (const std::string name : posts)
      listener.Post(base + name, [this, name](const httplib::Request& request, httplib::Response& response) {
        send(session.answer(name, request.body), response);
      });
  }

  void send_page(httplib::Response& response) const {
    const std::string nonce = random_token();
    response.set_header("Content-Security-Policy",
                        "default-src 'none'; connect-src 'self'; img-src 'self' blob: data:; script-src 'nonce-" +
                            nonce + "'; style-src 'nonce-" + nonce +
                            "'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'");
    send({200, "text/html; charset=utf-8", session.page(nonce)}, response);
  }
};

bool can_serve() noexcept { return true; }

Server::Server(const Session& session, int port) : impl_(std::make_unique<Impl>(session, port)) {}
Server::~Server() { stop(); }
int Server::port() const { return impl_->port; }
std::string Server::address() const {
  return "http://127.0.0.1:" + std::to_string(impl_->port) + "/" + impl_->token + "/";
}

void Server::run() {
  {
    const std::lock_guard lock(impl_->mutex);
    if (impl_->is_stopped) return;
    impl_->is_started = true;
  }
  impl_->listener.listen_after_bind();
  impl_->is_finished = true;
}

// httplib ignores a stop before it listens, so repeat it until `run` has finished.
void Server::stop() {
  {
    const std::lock_guard lock(impl_->mutex);
    impl_->is_stopped = true;
    if (!impl_->is_started) return;
  }
  while (!impl_->is_finished) {
    impl_->listener.stop();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

}  // namespace ahm::viewer
