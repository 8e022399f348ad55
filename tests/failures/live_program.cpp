#include "live_program.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <sstream>

#include <doctest/doctest.h>
#include <fcntl.h>
#include <sched.h>
#include <sys/wait.h>
#include <unistd.h>

#include "telemetry/mcap/mcap_reader.h"
#include "telemetry/record/signal_topics.h"

namespace kadans::failures {

namespace fs = std::filesystem;

namespace {

// Of a process that is gone as the kernel reads its file: "". A streambuf's iterator would throw.
std::string text_of(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

struct State {
  char letter = 'X';  // 'R' runs, 'S' sleeps, 'Z' is dead ...
  pid_t parent = -1;
  bool lives() const { return letter != 'Z' && letter != 'X'; }
};

State state_of(pid_t pid) {
  const std::string stat = text_of("/proc/" + std::to_string(pid) + "/stat");
  State state;
  std::istringstream(stat.substr(std::min(stat.rfind(')') + 1, stat.size()))) >> state.letter >> state.parent;
  return state;
}

}  // namespace

LiveProgram::LiveProgram(const fs::path& folder, const std::string& arguments) : folder_(folder) {
  std::array<int, 2> ends{};
  REQUIRE(pipe2(ends.data(), O_CLOEXEC) == 0);
  const std::string command =
      "exec '" KADANS_BINARY_DIR "/kadans' run " + arguments + " -v --json --record out.mcap >out";
  pid_ = fork();
  if (pid_ == 0) {
    dup2(ends[1], STDERR_FILENO);
    if (chdir(folder.c_str()) == 0) execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
    _exit(127);
  }
  close(ends[1]);
  messages_ = fdopen(ends[0], "r");
}

LiveProgram::~LiveProgram() {
  if (exit_code_ < 0) {
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  std::fclose(messages_);
}

bool LiveProgram::says(const std::string& text) {
  std::array<char, 4096> line{};
  while (std::fgets(line.data(), line.size(), messages_) != nullptr) {
    heard_ += line.data();
    if (std::string_view(line.data()).find(text) != std::string_view::npos) return true;
  }
  return false;
}

nlohmann::json LiveProgram::end() {
  (void)says("\n\n no line is like this");
  int status = 0;
  waitpid(pid_, &status, 0);
  exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  std::istringstream lines(text_of(folder_ / "out"));
  std::string last;
  for (std::string line; std::getline(lines, line);) last = line;
  return nlohmann::json::parse(last, nullptr, false);
}

std::size_t LiveProgram::heard(const std::string& text) const {
  std::size_t count = 0;
  for (auto at = heard_.find(text); at != std::string::npos; at = heard_.find(text, at + 1)) ++count;
  return count;
}

pid_t LiveProgram::behavior_process(pid_t other) const {
  for (; state_of(pid_).lives(); sched_yield()) {
    for (const auto& entry : fs::directory_iterator("/proc")) {
      const pid_t child = std::atoi(entry.path().filename().c_str());
      if (child <= 1 || child == other) continue;
      const State state = state_of(child);
      if (state.parent == pid_ && state.lives()) return child;
    }
  }
  return -1;
}

LiveProgram::Range LiveProgram::recorded(const std::string& signal, double from_s, double to_s) const {
  Range range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  McapReader reader((folder_ / "out.mcap").string());
  for (McapMessage message; reader.next(message);) {
    const McapChannel& channel = reader.channels().at(message.channel);
    const auto described = channel.metadata.find("signals");
    if (described == channel.metadata.end() || described->second.find(signal + "\t") == std::string::npos) continue;
    std::istringstream lines(described->second);
    std::size_t at = 0, count = 0;
    for (std::string line; std::getline(lines, line); ++count) {
      if (line.substr(0, line.find('\t')) == signal) at = count;
    }
    std::vector<double> values(count);
    const double time_s = 1e-9 * static_cast<double>(message.time_ns);
    if (time_s < from_s || time_s > to_s || !read_cdr(message.payload, values, Precision::full)) continue;
    range.min = std::min(range.min, values[at]);
    range.max = std::max(range.max, values[at]);
  }
  return range;
}

}  // namespace kadans::failures
