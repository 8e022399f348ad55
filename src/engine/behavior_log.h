// Where behaviors and the parts of the runtime speak to people. A log is an spdlog logger: each line goes to all of its
// sinks, on the thread that says it. Text sinks write it as text: stderr, the journal, a file. Other sinks (LineSink)
// read its facts: the record, the servers of an instance, the lines kept for a report. Each thread of a live run has a
// log of its own. What behaviors say reaches the supervisor's log through a queue: that queue is a sink of the
// behaviors' log (telemetry/record/event_log.h). Real-time threads say nothing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace spdlog::sinks {
class sink;
}

namespace kadans {

// One change of state of a behavior, for the record and the console.
struct Transition {
  std::int64_t time_ns = 0;
  std::string behavior;
  std::string from;  // path of the state, "stand.wait"; "" when entering
  std::string to;
  std::string why;
};

// The innermost active states of a behavior: those of all its regions and of the behaviors that it calls, by path, in
// document order. Told when they have changed, at the end of a tick; none: the behavior is over. Valid while it is
// told.
struct ActiveStates {
  static constexpr std::size_t told_max = 64;  // of one behavior

  std::int64_t time_ns = 0;
  std::string_view behavior;
  std::span<const std::string_view> states;

  std::vector<std::string> copies() const { return {states.begin(), states.end()}; }
};
// What is active now: the states by behavior, of at most behaviors_max of them; none that is over.
class ActiveNow {
 public:
  static constexpr std::size_t behaviors_max = 64;
  void take(const ActiveStates& told);
  const std::map<std::string, std::vector<std::string>, std::less<>>& by_behavior() const noexcept { return all_; }

 private:
  std::map<std::string, std::vector<std::string>, std::less<>> all_;
};
// "act.arm.wave, act.leg.step"
std::string listed(const std::vector<std::string>& states);

struct Line;
class LineSink;
using TextSink = std::shared_ptr<spdlog::sinks::sink>;

class BehaviorLog {
 public:
  enum class Severity : std::uint8_t { info, warning, error };

  BehaviorLog(std::initializer_list<LineSink*> sinks = {});  // without a sink it drops everything
  explicit BehaviorLog(TextSink sink);
  ~BehaviorLog();
  BehaviorLog(const BehaviorLog&) = delete;
  BehaviorLog& operator=(const BehaviorLog&) = delete;

  // On the thread that says lines, or before the first one. A LineSink must outlive the last line.
  void add(LineSink& sink);
  void add(TextSink sink);

  void say(const Line& line);
  void transition(const Transition& transition);
  void active(const ActiveStates& active);  // for sinks that read facts
  void message(std::int64_t time_ns, Severity severity, std::string_view behavior, std::string_view text);

 private:
  class Logger;
  std::unique_ptr<Logger> logger_;
  std::vector<LineSink*> facts_;
};

// Valid while it is said.
struct Line {
  static constexpr std::int64_t no_time = -1;  // said outside of a run

  std::int64_t time_ns = no_time;  // of the run: virtual in a simulation
  BehaviorLog::Severity severity = BehaviorLog::Severity::info;
  std::string_view behavior;               // or the part of the runtime that says it; "": the program
  std::string_view text;                   // of a message
  const Transition* transition = nullptr;  // nullptr: it is a message
};

class LineSink {
 public:
  virtual ~LineSink() = default;
  virtual void tell(const Line& line) = 0;
  virtual void tell_active(const ActiveStates& active) { (void)active; }
};

// Text sinks write "     1.50 s  squat: on my way". They lock, so no real-time thread uses them.
// When stderr is systemd's journal, each line of stderr_sink begins with its priority, "<4>".
enum class Shown : std::uint8_t { errors, messages, all };  // all: messages and transitions
TextSink stderr_sink(Shown shown);
bool stderr_is_journal();

// A file to which lines are appended. When one cannot be written (a full disk), program_log() tells it once, and no
// further line is appended. Any thread that is not real-time.
class LogFile {
 public:
  explicit LogFile(const std::string& file);  // throws InputError when the file cannot be opened
  TextSink sink() const;
  bool failed() const noexcept;

 private:
  class Sink;
  std::shared_ptr<Sink> sink_;
};

// What the program says of itself, on stderr. Any thread that is not real-time; add() only before other threads start.
BehaviorLog& program_log();

}  // namespace kadans
