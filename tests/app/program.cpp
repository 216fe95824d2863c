#include "program.hpp"

#include <fcntl.h>
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
#include <sstream>
#include <stdexcept>
#include <thread>

#include "ahm/io/image.hpp"

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

/// Arguments of a command line.
Words split(const std::string& command) {
  Words words;
  for (bool quoted = false, inside = false; char c : command) {
    if (c == ' ' && !quoted) {
      inside = false;
      continue;
    }
    if (!inside) words.emplace_back();
    inside = true;
    if (c == '\'')
      quoted = !quoted;
    else
      words.back() += c;
  }
  return words;
}

/// Paths and bytes of all files below the working directory.
std::map<std::string, std::string> contents() {
  std::map<std::string, std::string> result;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(".")) {
    std::string& bytes = result[entry.path().string()];
    if (std::ifstream file(entry.path(), std::ios::binary); entry.is_regular_file())
      bytes.assign(std::istreambuf_iterator<char>(file), {});
  }
  return result;
}

/// A pseudo-terminal: the first end reads what is written to the second end.
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

Running start(const std::string& command, bool on_terminal, const std::string& input) {
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
  Words words = split(command);
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

Outcome finish(const Running& running, bool slowly) {
  Outcome outcome;
  {
    std::jthread brake;
    if (slowly)
      brake = std::jthread([&](const std::stop_token& ended) {
        for (int slice = 0; slice < 50 && !ended.stop_requested(); ++slice) {
          kill(running.pid, SIGSTOP);
          std::this_thread::sleep_for(std::chrono::milliseconds(200));
          kill(running.pid, SIGCONT);
          std::this_thread::sleep_for(std::chrono::milliseconds(20));
        }
      });
    drain(running, outcome);
  }  // The thread has ended before waitpid: afterwards another process may have this id.
  close(running.out);
  close(running.err);
  int status = 0;
  waitpid(running.pid, &status, 0);
  outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return outcome;
}

std::string read_until(const Running& running, const std::string& word) {
  std::string text;
  char letter;
  while (text.find(word) == std::string::npos && read(running.err, &letter, 1) == 1) text += letter;
  return text;
}

Outcome run(const std::string& command) { return finish(start(command)); }

Outcome run_ok(const std::string& command) {
  Outcome outcome = run(command);
  EXPECT_EQ(outcome.status, 0) << command << '\n' << outcome.err;
  return outcome;
}

nlohmann::json summary(const std::string& command) { return nlohmann::json::parse(run_ok(command + " --json -").out); }

void InFolderWithImages::SetUp() {
  if (!io::has_images()) GTEST_SKIP() << "this build has no stb";
}

void write(const std::string& file, const std::string& bytes) { std::ofstream(file, std::ios::binary) << bytes; }

std::string read_text(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  EXPECT_TRUE(stream) << file;
  return {std::istreambuf_iterator<char>(stream), {}};
}

nlohmann::json read_json(const std::string& file) { return nlohmann::json::parse(read_text(file)); }

Words files() {
  Words names;
  for (const auto& entry : std::filesystem::directory_iterator(".")) names.push_back(entry.path().filename().string());
  std::ranges::sort(names);
  return names;
}

std::vector<Row> read_csv(const std::string& file) {
  std::istringstream lines(read_text(file));
  std::string line;
  const auto fields = [&] {
    Words result;
    std::istringstream stream(line);
    for (std::string field; std::getline(stream, field, ',');) result.push_back(field);
    return result;
  };
  std::getline(lines, line);
  const Words names = fields();
  std::vector<Row> rows;
  while (std::getline(lines, line)) {
    const Words words = fields();
    EXPECT_EQ(words.size(), names.size()) << line;
    rows.emplace_back();
    for (std::size_t c = 0; c < std::min(words.size(), names.size()); ++c) {
      rows.back().numbers[names[c]] = std::strtod(words[c].c_str(), nullptr);
      if (names[c] == "status" || names[c] == "kind") rows.back().status = words[c];
    }
  }
  return rows;
}

std::vector<Row> table(const std::string& command) {
  run_ok(command + " -o table.csv");
  return read_csv("table.csv");
}

std::vector<std::vector<double>> obj_lines(const std::string& file, const std::string& keyword) {
  std::string text = read_text(file);
  std::ranges::replace(text, '/', ' ');
  std::istringstream lines(text);
  std::vector<std::vector<double>> result;
  for (std::string line, word; std::getline(lines, line);) {
    std::istringstream words(line);
    if (!(words >> word) || word != keyword) continue;
    result.emplace_back();
    for (double x; words >> x;) result.back().push_back(x);
  }
  return result;
}

std::size_t count(const std::vector<Row>& rows, const std::string& status) {
  return static_cast<std::size_t>(std::ranges::count(rows, status, &Row::status));
}

testing::AssertionResult has_all(const std::string& text, const Words& parts) {
  for (const std::string& part : parts)
    if (text.find(part) == std::string::npos) return testing::AssertionFailure() << "no '" << part << "' in\n" << text;
  return testing::AssertionSuccess() << text;
}

void expect_refused(const std::string& command, const std::vector<Refusal>& refusals) {
  const auto before = contents();
  for (const auto& [arguments, status, parts] : refusals) {
    SCOPED_TRACE(command + " " + arguments);
    const Outcome outcome = run(command + " " + arguments);
    EXPECT_EQ(outcome.status, status) << outcome.err;
    EXPECT_TRUE(has(outcome.err, "ahm: error: "));
    EXPECT_TRUE(has_all(outcome.err, parts));
    EXPECT_EQ(outcome.out, "");
    EXPECT_TRUE(contents() == before) << testing::PrintToString(files());
  }
}

std::vector<Row> LogmapOf::map(const std::string& bytes, const std::string& options) {
  write(file_, bytes);
  err = run_ok("logmap " + file_ + " -o map.csv --json map.json " + options).err;
  json = read_json("map.json");
  return read_csv("map.csv");
}

void LogmapOf::expect_error(const std::string& bytes, const std::string& text, const std::string& options) {
  write(file_, bytes);
  expect_refused("logmap " + file_ + " -o refused.csv", {{options, 1, {text}}});
}

void expect_values(const nlohmann::json& json, const Values& values) {
  for (const auto& [pointer, value] : values)
    EXPECT_EQ(json.at(nlohmann::json::json_pointer(pointer)), value) << pointer;
}

double number(const nlohmann::json& json, const std::string& pointer) {
  return json.at(nlohmann::json::json_pointer(pointer)).get<double>();
}

double distance(const Vec3& a, const Vec3& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

}  // namespace ahm::test
