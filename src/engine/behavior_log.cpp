#include "behavior_log.h"

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <system_error>

#include <spdlog/details/file_helper.h>
#include <spdlog/formatter.h>
#include <spdlog/logger.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <sys/stat.h>
#include <unistd.h>

#include "signal/byte_order.h"
#include "signal/input_file.h"
#include "signal/utf8.h"

namespace kadans {
namespace {

// All that spdlog's own sinks read, and with it the facts that have no place there.
struct Message final : spdlog::details::log_msg {
  explicit Message(const Line& said)
      : log_msg(spdlog::log_clock::time_point(
                    std::chrono::duration_cast<spdlog::log_clock::duration>(std::chrono::nanoseconds(said.time_ns))),
                {}, {said.behavior.data(), said.behavior.size()}, level_of(said), {said.text.data(), said.text.size()}),
        line(said) {}
  static spdlog::level::level_enum level_of(const Line& line) {
    if (line.transition != nullptr) return spdlog::level::debug;
    if (line.severity == BehaviorLog::Severity::error) return spdlog::level::err;
    return line.severity == BehaviorLog::Severity::warning ? spdlog::level::warn : spdlog::level::info;
  }
  const Line& line;
};

// Only the log's own messages come to its sinks.
const Line& line_of(const spdlog::details::log_msg& message) { return static_cast<const Message&>(message).line; }

class FactSink final : public spdlog::sinks::sink {
 public:
  explicit FactSink(LineSink& to) : to_(to) {}
  void log(const spdlog::details::log_msg& message) override { to_.tell(line_of(message)); }
  void flush() override {}
  void set_pattern(const std::string& /*pattern*/) override {}
  void set_formatter(std::unique_ptr<spdlog::formatter> /*formatter*/) override {}

 private:
  LineSink& to_;
};

enum class Medium : std::uint8_t { plain, terminal, colored_terminal, journal };

class LineFormatter final : public spdlog::formatter {
 public:
  explicit LineFormatter(Medium medium) : medium_(medium) {}

  void format(const spdlog::details::log_msg& message, spdlog::memory_buf_t& text) override {
    const Line& line = line_of(message);
    put_priority(message.level, text);
    if (line.time_ns != Line::no_time) {
      // A bar that shows progress may stand there.
      if (medium_ == Medium::terminal || medium_ == Medium::colored_terminal) put("\r\033[K", text);
      char time[32];
      const int size = std::snprintf(time, sizeof time, "%9.2f s  ", 1e-9 * static_cast<double>(line.time_ns));
      put({time, static_cast<std::size_t>(size)}, text);
    } else if (message.level == spdlog::level::err && line.behavior.empty()) {
      put(medium_ == Medium::colored_terminal ? "\033[31;1merror:\033[0m " : "error: ", text);
    }
    if (!line.behavior.empty()) {
      put_said(line.behavior, message.level, text);
      put(": ", text);
    }
    if (const Transition* t = line.transition; t != nullptr) {
      for (const std::string_view part : {std::string_view(t->from), std::string_view(" -> "), std::string_view(t->to),
                                          std::string_view(" ("), std::string_view(t->why), std::string_view(")")})
        put_said(part, message.level, text);
    }
    put_said(line.text, message.level, text);
    text.push_back('\n');
  }
  std::unique_ptr<spdlog::formatter> clone() const override { return std::make_unique<LineFormatter>(medium_); }

 private:
  static void put(std::string_view part, spdlog::memory_buf_t& text) {
    text.append(part.data(), part.data() + part.size());
  }
  // What is said may come from a script: it must not steer the terminal.
  void put_said(std::string_view part, spdlog::level::level_enum level, spdlog::memory_buf_t& text) const {
    for (const char c : shown_text(part)) {
      text.push_back(c);
      if (c == '\n') put_priority(level, text);
    }
  }
  // As in sd-daemon(3): 3 error, 4 warning, 6 information, 7 debug.
  void put_priority(spdlog::level::level_enum level, spdlog::memory_buf_t& text) const {
    if (medium_ != Medium::journal) return;
    put(level == spdlog::level::err    ? "<3>"
        : level == spdlog::level::warn ? "<4>"
        : level == spdlog::level::info ? "<6>"
                                       : "<7>",
        text);
  }
  Medium medium_;
};

std::string environment(const char* name) {
  const char* value = std::getenv(name);  // NOLINT(concurrency-mt-unsafe): nothing sets variables
  return value == nullptr ? "" : value;
}

Medium medium_of_stderr() {
  if (stderr_is_journal()) return Medium::journal;
  if (isatty(STDERR_FILENO) != 1) return Medium::plain;
  return environment("NO_COLOR").empty() ? Medium::colored_terminal : Medium::terminal;
}

}  // namespace

class BehaviorLog::Logger final : public spdlog::logger {
 public:
  Logger() : spdlog::logger("") { flush_on(spdlog::level::trace); }
  void say(const Line& line) { log_it_(Message(line), true, false); }
};

BehaviorLog::BehaviorLog(std::initializer_list<LineSink*> sinks) : logger_(std::make_unique<Logger>()) {
  for (LineSink* sink : sinks) add(*sink);
}
BehaviorLog::BehaviorLog(TextSink sink) : BehaviorLog() { add(std::move(sink)); }
BehaviorLog::~BehaviorLog() = default;

void BehaviorLog::add(LineSink& sink) {
  add(std::make_shared<FactSink>(sink));
  facts_.push_back(&sink);
}
void BehaviorLog::add(TextSink sink) { logger_->sinks().push_back(std::move(sink)); }
void BehaviorLog::say(const Line& line) { logger_->say(line); }

void BehaviorLog::transition(const Transition& transition) {
  say({.time_ns = transition.time_ns, .behavior = transition.behavior, .text = {}, .transition = &transition});
}

void BehaviorLog::message(std::int64_t time_ns, Severity severity, std::string_view behavior, std::string_view text) {
  say({.time_ns = time_ns, .severity = severity, .behavior = behavior, .text = text});
}

void BehaviorLog::emitted(const EmittedEvent& event) {
  for (LineSink* sink : facts_) sink->tell_emitted(event);
}

void BehaviorLog::active(const ActiveStates& active) {
  for (LineSink* sink : facts_) sink->tell_active(active);
}

namespace {

void put_head(Event::Kind kind, std::string_view behavior, ByteWriter& bytes) {
  bytes.put(static_cast<std::uint8_t>(kind));
  bytes.put_string(behavior);
}

bool take_states(ByteReader& bytes, std::vector<std::string>& states) {
  auto left = bytes.take<std::uint32_t>();
  if (left > ActiveStates::told_max) return false;
  for (; left > 0 && bytes.ok(); --left) states.push_back(bytes.take_string());
  return true;
}

}  // namespace

void put_told(const Line& line, ByteWriter& bytes) {
  if (const Transition* t = line.transition) {
    put_head(Event::Kind::transition, line.behavior, bytes);
    for (const std::string* text : {&t->from, &t->to, &t->why}) bytes.put_string(*text);
  } else {
    put_head(Event::Kind::message, line.behavior, bytes);
    bytes.put(static_cast<std::uint8_t>(line.severity));
    bytes.put_string(line.text);
  }
}

void put_told(const ActiveStates& active, ByteWriter& bytes) {
  put_head(Event::Kind::active, active.behavior, bytes);
  bytes.put(static_cast<std::uint32_t>(active.states.size()));
  for (const std::string_view state : active.states) bytes.put_string(state);
}

void put_told(const EmittedEvent& event, ByteWriter& bytes) {
  put_head(Event::Kind::emitted, "", bytes);
  bytes.put(event.tick);
  bytes.put<std::uint8_t>(event.ordered);
  for (const std::string* text : {&event.event, &event.data, &event.who}) bytes.put_string(*text);
}

bool take_told(ByteReader& bytes, std::int64_t time_ns, Event& event) {
  const auto kind = bytes.take<std::uint8_t>();
  if (kind > static_cast<std::uint8_t>(Event::Kind::emitted)) return false;
  event.kind = static_cast<Event::Kind>(kind);
  event.transition = {.time_ns = time_ns, .behavior = bytes.take_string(), .from = {}, .to = {}, .why = {}};
  event.severity = BehaviorLog::Severity::info;
  event.text.clear();
  event.states.clear();
  if (event.kind == Event::Kind::transition) {
    for (std::string* text : {&event.transition.from, &event.transition.to, &event.transition.why})
      *text = bytes.take_string();
  } else if (event.kind == Event::Kind::emitted) {
    EmittedEvent& emitted = event.emitted;
    emitted = {.time_ns = time_ns, .tick = bytes.take<std::uint64_t>()};
    emitted.ordered = bytes.take<std::uint8_t>() != 0;
    for (std::string* text : {&emitted.event, &emitted.data, &emitted.who}) *text = bytes.take_string();
  } else if (event.kind == Event::Kind::active) {
    if (!take_states(bytes, event.states)) return false;
  } else {
    const auto severity = bytes.take<std::uint8_t>();
    if (severity > static_cast<std::uint8_t>(BehaviorLog::Severity::error)) return false;
    event.severity = static_cast<BehaviorLog::Severity>(severity);
    event.text = bytes.take_string();
  }
  return bytes.ok() && bytes.left() == 0;
}

void Event::say_to(BehaviorLog& log) const {
  if (kind == Kind::active) {
    const std::vector<std::string_view> paths(states.begin(), states.end());
    return log.active({transition.time_ns, transition.behavior, paths});
  }
  if (kind == Kind::emitted) return log.emitted(emitted);
  log.say(line());
}

void ActiveNow::take(const ActiveStates& told) {
  const auto known = all_.find(told.behavior);
  if (told.states.empty() && known != all_.end()) all_.erase(known);
  if (told.states.empty() || (known == all_.end() && all_.size() == behaviors_max)) return;
  all_.insert_or_assign(std::string(told.behavior), told.copies());
}

// systemd.exec(5): the device and inode of the stream that it connected.
bool stderr_is_journal() {
  struct stat is {};
  if (fstat(STDERR_FILENO, &is) != 0) return false;
  return environment("JOURNAL_STREAM") == std::to_string(is.st_dev) + ":" + std::to_string(is.st_ino);
}

TextSink stderr_sink(Shown shown) {
  auto sink = std::make_shared<spdlog::sinks::stderr_sink_mt>();
  sink->set_formatter(std::make_unique<LineFormatter>(medium_of_stderr()));
  sink->set_level(shown == Shown::errors     ? spdlog::level::err
                  : shown == Shown::messages ? spdlog::level::info
                                             : spdlog::level::trace);
  return sink;
}

class LogFile::Sink final : public spdlog::sinks::sink {
 public:
  // spdlog opens and closes the file. It is written here, because spdlog would report a failure in its own words.
  explicit Sink(const std::string& file) : file_(noting(stream_)) { file_.open(file); }

  void log(const spdlog::details::log_msg& message) override {
    if (const std::string why = append(message); !why.empty()) {
      program_log().message(Line::no_time, BehaviorLog::Severity::error, "",
                            file_.filename() + ": not all lines of this run could be written: " + why);
    }
  }
  void flush() override {}
  void set_pattern(const std::string& /*pattern*/) override {}
  void set_formatter(std::unique_ptr<spdlog::formatter> /*formatter*/) override {}
  bool failed() const noexcept { return failed_.load(std::memory_order_relaxed); }

 private:
  static spdlog::file_event_handlers noting(std::FILE*& stream) {
    spdlog::file_event_handlers handlers;
    handlers.after_open = [&stream](const spdlog::filename_t& /*file*/, std::FILE* opened) { stream = opened; };
    return handlers;
  }
  // Returns why the line cannot be written; "": it is, or the file has failed before.
  std::string append(const spdlog::details::log_msg& message) {
    const std::lock_guard lock(mutex_);
    if (failed()) return "";
    text_.clear();
    formatter_->format(message, text_);
    if (std::fwrite(text_.data(), 1, text_.size(), stream_) == text_.size() && std::fflush(stream_) == 0) return "";
    const int error = errno;
    failed_.store(true, std::memory_order_relaxed);
    return std::generic_category().message(error);
  }

  std::mutex mutex_;
  std::unique_ptr<spdlog::formatter> formatter_ = std::make_unique<LineFormatter>(Medium::plain);
  spdlog::memory_buf_t text_;
  std::FILE* stream_ = nullptr;
  std::atomic<bool> failed_{false};
  spdlog::details::file_helper file_;
};

LogFile::LogFile(const std::string& file) try : sink_(std::make_shared<Sink>(file)) {
} catch (const spdlog::spdlog_ex& error) {
  refuse(error.what());
}
TextSink LogFile::sink() const { return sink_; }
bool LogFile::failed() const noexcept { return sink_->failed(); }

BehaviorLog& program_log() {
  static BehaviorLog log(stderr_sink(Shown::all));
  return log;
}

}  // namespace kadans
