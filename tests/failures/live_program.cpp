#include "live_program.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <sstream>

#include <sched.h>

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

LiveProgram::LiveProgram(const fs::path& folder, const std::string& arguments)
    : folder_(folder), running_(folder, "run " + arguments + " -v --json --record out.mcap >out") {}

nlohmann::json LiveProgram::end() {
  exit_code_ = running_.end();
  return nlohmann::json::parse(program::last_line(text_of(folder_ / "out")), nullptr, false);
}

std::size_t LiveProgram::heard(const std::string& text) const {
  std::size_t count = 0;
  for (auto at = heard().find(text); at != std::string::npos; at = heard().find(text, at + 1)) ++count;
  return count;
}

// One that has not begun its program yet may be of either kind, and counts as one of behaviors.
pid_t LiveProgram::child(bool decides, pid_t other) const {
  for (; state_of(running_.pid()).lives(); sched_yield()) {
    for (const auto& entry : fs::directory_iterator("/proc")) {
      const pid_t child = std::atoi(entry.path().filename().c_str());
      if (child <= 1 || child == other) continue;
      const State state = state_of(child);
      if (state.parent != running_.pid() || !state.lives()) continue;
      if ((text_of(entry.path() / "cmdline").find("decision-process") != std::string::npos) == decides) return child;
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
    if (time_s < from_s || time_s > to_s || read_cdr(message.payload, values) != Precision::full) continue;
    range.min = std::min(range.min, values[at]);
    range.max = std::max(range.max, values[at]);
  }
  return range;
}

}  // namespace kadans::failures
