// The server as any program on the machine can reach it: over raw sockets.
#include "ahm/viewer/server.hpp"

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <thread>

#include "sessions.hpp"

namespace ahm::viewer::test {
namespace {

struct Response {
  int status = 0;  ///< 0: none
  std::string head, body;
};

class ViewerServer : public testing::Test {
 protected:
  ~ViewerServer() override {
    server.stop();
    serving.join();
  }

  /// A socket; -1: no connection.
  int connected() const {
    const int fd = socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(static_cast<std::uint16_t>(server.port()));
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (fd >= 0 && connect(fd, reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0) return fd;
    if (fd >= 0) close(fd);
    return -1;
  }

  static bool send_all(int fd, const std::string& bytes) {
    for (std::size_t sent = 0; sent < bytes.size();) {
      const ssize_t n = send(fd, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
      if (n <= 0) return false;
      sent += static_cast<std::size_t>(n);
    }
    return true;
  }

  static Response receive(int fd) {
    std::string text;
    char buffer[65536];
    for (ssize_t n = 0; (n = recv(fd, buffer, sizeof buffer, 0)) > 0;) text.append(buffer, static_cast<std::size_t>(n));
    close(fd);
    Response response;
    if (text.rfind("HTTP/1.1 ", 0) != 0) return response;
    response.status = std::stoi(text.substr(9, 3));
    const std::size_t end = text.find("\r\n\r\n");
    response.head = text.substr(0, end);
    if (end != std::string::npos) response.body = text.substr(end + 4);
    return response;
  }

  Response send_raw(const std::string& bytes) const {
    const int fd = connected();
    if (fd < 0) return {};
    send_all(fd, bytes);  // the server may refuse the request before it has read everything
    return receive(fd);
  }

  /// The path of the page, which contains the token.
  std::string base() const { return server.address().substr(server.address().find('/', 8)); }
  std::string host() const { return "127.0.0.1:" + std::to_string(server.port()); }

  /// A request of one line, and more lines of the header.
  std::string request(const std::string& method, const std::string& path, const std::string& header = {}) const {
    return method + " " + path + " HTTP/1.1\r\nHost: " + host() + "\r\n" + header + "\r\n";
  }
  Response get(const std::string& path, const std::string& header = {}) const {
    return send_raw(request("GET", path, header));
  }
  Response post_raw(const std::string& header, const std::string& body) const {
    return send_raw(request("POST", base() + "map", header) + body);
  }
  Response post(const std::string& body, const std::string& header = {},
                const std::string& type = "application/json") const {
    return post_raw("Content-Type: " + type + "\r\nContent-Length: " + std::to_string(body.size()) + "\r\n" + header,
                    body);
  }

  /// The server still answers, at the end of every test.
  void TearDown() override { expect_serving(); }
  void expect_serving() const {
    const Response response = post(good);
    ASSERT_EQ(response.status, 200) << response.body;
    EXPECT_TRUE(Bundle(response.body).meta.contains("spec"));
  }
  /// Refused, with a short answer that does not contain the token.
  void expect_refused(const Response& response, const std::string& what) const {
    EXPECT_TRUE(response.status == 0 || (response.status >= 400 && response.status < 500))
        << what << ": " << response.status;
    EXPECT_EQ((response.head + response.body).find(base().substr(1, 32)), std::string::npos) << what;
    EXPECT_LT(response.body.size(), 200U) << what;
  }

  const std::string good = R"({"client": "a", "source": {"row": 0}})";
  const Sphere sphere{3};
  const Session session{sphere.surface, sphere.geometry, sphere_options()};
  Server server{session};
  std::thread serving{[this] { server.run(); }};
};

TEST_F(ViewerServer, ServesThePageOnThisMachineOnly) {
  EXPECT_EQ(server.address().rfind("http://127.0.0.1:", 0), 0U);
  const Response page = get(base());
  ASSERT_EQ(page.status, 200);
  EXPECT_NE(page.head.find("Content-Security-Policy: default-src 'none';"), std::string::npos);
  EXPECT_NE(page.head.find("X-Content-Type-Options: nosniff"), std::string::npos);
  EXPECT_EQ(page.head.find("Access-Control-Allow"), std::string::npos);
  EXPECT_NE(page.body.find("Ahm.Viewer"), std::string::npos);
  for (const char* name : {"info", "surface"}) EXPECT_EQ(get(base() + name).status, 200) << name;
}

TEST_F(ViewerServer, RefusesPathsWithoutTheToken) {
  const Server other(session);
  EXPECT_NE(other.address().substr(other.address().find('/', 8)), base());
  EXPECT_EQ(base().size(), 34U);
  std::string wrong = base();
  wrong[5] = wrong[5] == '0' ? '1' : '0';
  for (const std::string& path : {std::string("/"), std::string("/info"), wrong, wrong + "info", base().substr(0, 33),
                                  "/" + std::string(32, '0') + "/", std::string("//"), "/" + base()})
    expect_refused(get(path), path);
}

TEST_F(ViewerServer, RefusesOtherHostsAndOrigins) {
  for (const std::string from : {"evil.example", "127.0.0.1", "evil.example:80", "127.0.0.1.evil.example:1"})
    expect_refused(send_raw("GET " + base() + " HTTP/1.1\r\nHost: " + from + "\r\n\r\n"), from);
  expect_refused(send_raw("GET " + base() + " HTTP/1.1\r\n\r\n"), "no host");
  expect_refused(get(base(), "Host: evil.example\r\n"), "two hosts");
  for (const std::string origin : {"http://evil.example", "null", "https://127.0.0.1", "http://127.0.0.1:1"}) {
    expect_refused(get(base(), "Origin: " + origin + "\r\n"), origin);
    expect_refused(post(good, "Origin: " + origin + "\r\n"), origin);
  }
  expect_refused(get(base(), "Sec-Fetch-Site: cross-site\r\n"), "cross-site");
  EXPECT_EQ(post(good, "Origin: http://" + host() + "\r\n").status, 200);
}

TEST_F(ViewerServer, ServesNoFiles) {
  for (const std::string path :
       {"../../../../etc/passwd", "%2e%2e/%2e%2e/etc/passwd", "..%2f..%2fetc%2fpasswd", "viewer.js",
        "./info/../../etc/passwd", "surface/", "info%00", "/etc/passwd", "sphere.ply"})
    expect_refused(get(base() + path), path);
}

TEST_F(ViewerServer, RefusesOtherMethodsAndEncodings) {
  for (const std::string method : {"PUT", "DELETE", "PATCH", "OPTIONS", "TRACE", "CONNECT", "PRI", "HEAD"})
    expect_refused(send_raw(request(method, base() + "info")), method);
  expect_refused(get(base() + "map"), "map by get");
  expect_refused(get(base() + "surface", "Range: bytes=0-1,0-1,0-1\r\n"), "ranges");
  expect_refused(post(good, "Content-Encoding: gzip\r\n"), "gzip");
  for (const char* type : {"text/plain", "multipart/form-data; boundary=x"}) expect_refused(post(good, {}, type), type);
  expect_refused(post_raw("Content-Type: application/json\r\nTransfer-Encoding: chunked\r\n", "ffffffff\r\n"),
                 "chunked");
}

TEST_F(ViewerServer, RefusesOversizedBodiesAndHeads) {
  expect_refused(post(std::string((1 << 20) + 1, 'x')), "a large body");
  for (const std::string length : {"99999999999999999999", "-1", "0x10", "1e3", ""})
    expect_refused(post_raw("Content-Type: application/json\r\nContent-Length: " + length + "\r\n", "{}"), length);
  expect_refused(get(base() + std::string(100'000, 'a')), "a long path");
  expect_refused(get(base(), "X: " + std::string(100'000, 'a') + "\r\n"), "a long header");
}

TEST_F(ViewerServer, RefusesMalformedBodiesAndBytes) {
  for (const std::string& body : {std::string("{"), std::string(5000, '\0'), std::string("\xff\xfe\x00", 3)}) {
    const Response response = post(body);
    EXPECT_EQ(response.status, 400);
    EXPECT_TRUE(json::parse(response.body).contains("error"));
  }
  for (const std::string& bytes : {std::string("\x16\x03\x01\x02\x00", 5), std::string("\r\n\r\n"),
                                   std::string("GET\r\n\r\n"), std::string(2000, '\n') + "\r\n\r\n"}) {
    const int fd = connected();
    ASSERT_GE(fd, 0);
    ASSERT_TRUE(send_all(fd, bytes));
    shutdown(fd, SHUT_WR);
    expect_refused(receive(fd), "noise");
  }
}

TEST_F(ViewerServer, AnswersAThousandRequestsAtOnce) {
  constexpr int count = 1000, threads = 50;
  std::atomic<int> right{0}, wrong{0};
  {
    std::vector<std::jthread> clients;
    for (int t = 0; t < threads; ++t)
      clients.emplace_back([&] {
        std::vector<std::pair<int, int>> open;  // socket and expected status
        for (int k = 0; k < count / threads; ++k) {
          const bool is_good = k % 2 == 0;
          const int fd = connected();
          if (fd >= 0 && send_all(fd, request("GET", is_good ? base() + "info" : "/" + std::string(32, 'f') + "/info")))
            open.emplace_back(fd, is_good ? 200 : 403);
          else
            ++wrong;
        }
        for (const auto& [fd, expected] : open) (receive(fd).status == expected ? right : wrong)++;
      });
  }
  EXPECT_EQ(right, count);
  EXPECT_EQ(wrong, 0);
}

/// The server closes idle connections after five seconds. If it served eight connections at a time, nearly all would be closed
/// before it answers the request after them. Machines so slow that one request takes five seconds get two more tries.
TEST_F(ViewerServer, ServesNextToIdleConnections) {
  int open = 0;
  for (int tries = 0; tries < 3 && open < 200; ++tries) {
    std::vector<int> idle;
    for (int k = 0; k < 300; ++k) {
      idle.push_back(connected());
      ASSERT_GE(idle.back(), 0);
      if (k % 2 == 0) ASSERT_TRUE(send_all(idle.back(), "GET /"));
    }
    expect_serving();
    open = 0;
    for (const int fd : idle) {
      char byte = 0;
      open += recv(fd, &byte, 1, MSG_DONTWAIT) < 0 && errno == EAGAIN;
    }
    for (const int fd : idle) receive(fd);  // until the server closes it
  }
  EXPECT_GE(open, 200);
}

TEST_F(ViewerServer, AnswersMapsOfManyClients) {
  std::atomic<int> maps{0}, busy{0};
  {
    std::vector<std::jthread> clients;
    for (int t = 0; t < 40; ++t)
      clients.emplace_back([&, t] {
        const json body = {{"client", "c" + std::to_string(t)}, {"source", {{"row", t}}}};
        const int status = post(body.dump()).status;
        maps += status == 200, busy += status == 503;
      });
  }
  EXPECT_EQ(maps + busy, 40);
  EXPECT_GT(maps, 0);
}

}  // namespace
}  // namespace ahm::viewer::test
