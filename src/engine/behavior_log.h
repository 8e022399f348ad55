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

class ByteReader;
class ByteWriter;

// One change of state of a behavior, for the record and the console.
struct Transition {
  std::int64_t time_ns = 0;
  std::string behavior;
  std::string from;  // path of the state, "stand.wait"; "" when entering
  std::string to;
  std::string why;
};

// An event from outside that behaviors got, for the record.
struct EmittedEvent {
  std::int64_t time_ns = 0;
  std::uint64_t tick = 0;  // of the control engine, whose snapshot the behaviors saw
  std::string event{};
  std::string data{};  // a JSON object
  std::string who{};
  bool ordered = false;  // given while the run went on: only the record knows of it
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
  void emitted(const EmittedEvent& event);  // for sinks that read facts
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
  virtual void tell_emitted(const EmittedEvent& event) { (void)event; }
  virtual void tell_active(const ActiveStates& active) { (void)active; }
};

// What a sink is told, kept on its way to another thread or process.
struct Event {
  enum class Kind : std::uint8_t { message, transition, active, emitted };
  Kind kind = Kind::message;
  Transition transition;  // all kinds use its time_ns and behavior
  BehaviorLog::Severity severity = BehaviorLog::Severity::info;
  std::string text;
  std::vector<std::string> states;  // the active ones
  EmittedEvent emitted{};

  // Of a message or transition; valid as long as the event.
  Line line() const noexcept {
    return {transition.time_ns, severity, transition.behavior, text, kind == Kind::transition ? &transition : nullptr};
  }
  void say_to(BehaviorLog& log) const;
};
// As bytes, which begin with the kind, without the time.
void put_told(const Line& line, ByteWriter& bytes);
void put_told(const ActiveStates& active, ByteWriter& bytes);
void put_told(const EmittedEvent& event, ByteWriter& bytes);
// False: the bytes are damaged, or there are more.
[[nodiscard]] bool take_told(ByteReader& bytes, std::int64_t time_ns, Event& event);

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

// Bounds the log lines of a behavior to lines_max in a second of the engine's clock, so that a script that logs in
// every tick floods neither the record nor the console. Further lines are dropped and counted.
class LogBound {
 public:
  static constexpr std::uint32_t lines_max = 100;

  enum class Answer : std::uint8_t { say, warn, drop };  // warn: the first line that is dropped in this second
  Answer admit(std::int64_t now_ns) noexcept {
    if (now_ns - began_ns_ >= second_ns || now_ns < began_ns_) {
      began_ns_ = now_ns;
      said_ = 0;
    }
    if (said_ < lines_max) return ++said_, Answer::say;
    ++dropped_;
    return said_++ == lines_max ? Answer::warn : Answer::drop;
  }
  // Returns the lines dropped since the last call once their second is over, or with `at_once`; else 0.
  std::uint64_t take_dropped(std::int64_t now_ns, bool at_once) noexcept {
    if (dropped_ == 0 || (now_ns - began_ns_ < second_ns && !at_once)) return 0;
    const std::uint64_t count = dropped_;
    dropped_ = 0;
    return count;
  }

 private:
  static constexpr std::int64_t second_ns = 1'000'000'000;
  std::int64_t began_ns_ = 0;
  std::uint32_t said_ = 0;
  std::uint64_t dropped_ = 0;
};

}  // namespace kadans
