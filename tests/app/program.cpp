#include "program.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <random>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "ahm/conformance/clouds.hpp"

extern char** environ;

namespace ahm::test {
namespace {

/// Reads both pipes until they end, in turn, so that neither fills up.
void drain(const Running& running, Outcome& outcome) {
  std::array<pollfd, 2> ends{{{running.out, POLLIN, 0}, {running.err, POLLIN, 0}}};
  std::array<std::string*, 2> texts{&outcome.out, &outcome.err};
  std::array<char, 4096> buffer{};
  while (ends[0].fd >= 0 || ends[1].fd >= 0) {
    if (poll(ends.data(), ends.size(), -1) < 0) break;
    for (std::size_t i = 0; i < 2; ++i) {
      if (ends[i].fd < 0 || ends[i].revents == 0) continue;
      const ssize_t got = read(ends[i].fd, buffer.data(), buffer.size());
      if (got > 0)
        texts[i]->append(buffer.data(), static_cast<std::size_t>(got));
      else
        ends[i].fd = -1;
    }
  }
}

/// A pseudo-terminal: what is written to the second end comes out of the first.
std::array<int, 2> open_terminal() {
  const int ours = posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
  if (ours < 0 || grantpt(ours) != 0 || unlockpt(ours) != 0) throw std::runtime_error("posix_openpt");
  const int theirs = open(ptsname(ours), O_RDWR | O_NOCTTY | O_CLOEXEC);
  if (theirs < 0) throw std::runtime_error("ptsname");
  return {ours, theirs};
}

}  // namespace

bool has_terminals() {
  try {
    for (int end : open_terminal()) close(end);
    return true;
  } catch (const std::runtime_error&) {
    return false;
  }
}

Running start(const std::vector<std::string>& arguments, bool on_terminal, const std::string& input) {
  std::array<int, 2> out{}, err = on_terminal ? open_terminal() : std::array<int, 2>{};
  if (pipe2(out.data(), O_CLOEXEC) != 0 || (!on_terminal && pipe2(err.data(), O_CLOEXEC) != 0))
    throw std::runtime_error("pipe2");
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 0, input.c_str(), O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, out[1], 1);
  posix_spawn_file_actions_adddup2(&actions, err[1], 2);
  posix_spawnattr_t attributes;  // SIGHUP as it is, also where the tests run under nohup
  posix_spawnattr_init(&attributes);
  sigset_t hangup;
  sigemptyset(&hangup);
  sigaddset(&hangup, SIGHUP);
  posix_spawnattr_setsigdefault(&attributes, &hangup);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
  std::vector<std::string> words = arguments;
  words.insert(words.begin(), AHM_PROGRAM);
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  Running running{-1, out[0], err[0]};
  const int failure = posix_spawn(&running.pid, AHM_PROGRAM, &actions, &attributes, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  close(out[1]);
  close(err[1]);
  if (failure != 0) throw std::runtime_error("cannot start " AHM_PROGRAM);
  return running;
}

namespace {

/// Takes leave of a program whose outputs have ended.
void reap(const Running& running, Outcome& outcome) {
  close(running.out);
  close(running.err);
  int status = 0;
  waitpid(running.pid, &status, 0);
  outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace

Outcome finish(Running running) {
  Outcome outcome;
  drain(running, outcome);
  reap(running, outcome);
  return outcome;
}

Outcome finish_slowly(Running running) {
  Outcome outcome;
  {
    const std::jthread brake([&](const std::stop_token& ended) {
      for (int slice = 0; slice < 50 && !ended.stop_requested(); ++slice) {
        kill(running.pid, SIGSTOP);
        std::this_thread::sleep_for(std::chrono::milliseconds(200));
        kill(running.pid, SIGCONT);
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
      }
    });
    drain(running, outcome);
  }  // the brake is off before the process is taken leave of
  reap(running, outcome);
  return outcome;
}

std::string read_until(const Running& running, const std::string& word) {
  std::string text;
  char letter;
  while (text.find(word) == std::string::npos && read(running.err, &letter, 1) == 1) text += letter;
  return text;
}

Outcome run(const std::vector<std::string>& arguments) { return finish(start(arguments)); }

std::string Folder::write(const std::string& name, const std::string& bytes) const {
  std::ofstream(directory() / name, std::ios::binary) << bytes;
  return *this / name;
}

std::vector<std::string> Folder::files() const {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(directory()))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::string read_text(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  EXPECT_TRUE(file) << path;
  return {std::istreambuf_iterator<char>(file), {}};
}

nlohmann::json read_json(const std::string& path) { return nlohmann::json::parse(read_text(path)); }

std::vector<Row> read_csv(const std::string& path) {
  std::istringstream lines(read_text(path));
  std::string line;
  std::getline(lines, line);
  EXPECT_TRUE(line.starts_with("index,x,y,z,u,v,distance,angle,status,quality,spread")) << line;
  const std::ptrdiff_t columns = 1 + std::ranges::count(line, ',');
  std::vector<Row> rows;
  while (std::getline(lines, line)) {
    std::vector<std::string> fields;
    std::istringstream stream(line);
    for (std::string field; std::getline(stream, field, ',');) fields.push_back(field);
    if (std::ssize(fields) != columns) {
      ADD_FAILURE() << "not " << columns << " fields: " << line;
      break;
    }
    const auto number = [&](std::size_t i) { return std::strtod(fields[i].c_str(), nullptr); };
    rows.push_back({std::stol(fields[0]),
                    {number(1), number(2), number(3)},
                    number(4),
                    number(5),
                    number(6),
                    number(7),
                    fields[8]});
  }
  return rows;
}

std::vector<NumberRow> read_numbers(const std::string& path) {
  std::istringstream lines(read_text(path));
  std::string line, field;
  std::vector<std::string> names;
  std::getline(lines, line);
  for (std::istringstream header(line); std::getline(header, field, ',');) names.push_back(field);
  std::vector<NumberRow> rows;
  while (std::getline(lines, line)) {
    rows.emplace_back();
    std::size_t column = 0;
    for (std::istringstream fields(line); std::getline(fields, field, ',');)
      rows.back()[names.at(column++)] = std::strtod(field.c_str(), nullptr);
    EXPECT_EQ(column, names.size()) << line;
  }
  return rows;
}

std::string xyz(const std::vector<Vec3>& points, const std::vector<Vec3>& normals) {
  std::ostringstream text;
  text.precision(17);
  for (std::size_t i = 0; i < points.size(); ++i) {
    text << points[i][0] << ' ' << points[i][1] << ' ' << points[i][2];
    if (!normals.empty()) text << ' ' << normals[i][0] << ' ' << normals[i][1] << ' ' << normals[i][2];
    text << '\n';
  }
  return text.str();
}

std::vector<Vec3> plane(int m) {
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> jitter(-0.3 / m, 0.3 / m);
  std::vector<Vec3> points;
  for (int i = 0; i < m; ++i)
    for (int j = 0; j < m; ++j)
      points.push_back({(i + 0.5) / m + jitter(generator), (j + 0.5) / m + jitter(generator), 0});
  std::swap(points[0], points[m / 2 * m + m / 2]);
  return points;
}

std::vector<Vec3> sphere(int n) {
  std::vector<Vec3> points = even_sphere(n).points;
  points[0] = {0, 0, 1};
  return points;
}

}  // namespace ahm::test
