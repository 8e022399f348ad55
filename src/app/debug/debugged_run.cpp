#include "debugged_run.h"

#include <algorithm>
#include <csignal>
#include <cstring>
#include <filesystem>

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <unistd.h>

#include "realtime/machine/child_process.h"
#include "script/behavior/behavior.h"
#include "signal/monotonic_clock.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

constexpr std::int64_t work_between_copies_ns = 20'000'000;  // so that any moment is repeated in about this time
constexpr std::uint64_t polled_ticks = 8;
constexpr int look_s = 2, condition_s = 1;
constexpr int lines_max = 1'000'000;

// Ends this process when it has worked so long; 0: does not.
void end_after(int seconds) noexcept {
  const itimerval timer{.it_interval = {}, .it_value = {.tv_sec = seconds, .tv_usec = 0}};
  (void)setitimer(ITIMER_PROF, &timer, nullptr);
}

// Files that this process reads. A copy of a process shares the places up to which they are read; so it opens them
// again, each at the place where it was when the copy was made.
class OpenFiles {
 public:
  // Before the copy is made.
  OpenFiles() {
    std::error_code ignored;
    for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd", ignored)) {
      const auto descriptor = number_of<int>(entry.path().filename().string());
      struct stat facts {};
      if (!descriptor || fstat(*descriptor, &facts) != 0 || !S_ISREG(facts.st_mode)) continue;
      if ((fcntl(*descriptor, F_GETFL) & O_ACCMODE) != O_RDONLY) continue;
      files_.push_back({*descriptor, lseek(*descriptor, 0, SEEK_CUR)});
    }
  }
  // In the copy.
  void open_again() const noexcept {
    for (const auto& [descriptor, place] : files_) {
      const int fresh = open(("/proc/self/fd/" + std::to_string(descriptor)).c_str(), O_RDONLY | O_CLOEXEC);
      if (fresh < 0) _exit(1);
      (void)lseek(fresh, place, SEEK_SET);
      (void)dup3(fresh, descriptor, O_CLOEXEC);
      close(fresh);
    }
  }

 private:
  std::vector<std::pair<int, off_t>> files_;  // descriptor, place
};

// "5", ">= 5", "% 5"
bool hits_hold(const std::string& text, std::uint32_t hits) {
  const std::size_t begin = std::min(text.find_first_of("0123456789"), text.size());
  const std::string digits = text.substr(begin, text.find_last_of("0123456789") + 1 - begin);
  const auto number = number_of<std::uint32_t>(digits);
  if (!number) return true;
  std::string sign = text.substr(0, begin);
  std::erase(sign, ' ');
  if (sign == ">") return hits > *number;
  if (sign == ">=") return hits >= *number;
  if (sign == "<") return hits < *number;
  if (sign == "<=") return hits <= *number;
  if (sign == "%") return *number != 0 && hits % *number == 0;
  return hits == *number;
}

// Whether a path of a state is meant by its name, its last names or "*".
bool is_meant(const std::string& path, const std::string& name) {
  return name.empty() || name == "*" || path == name || path.ends_with("." + name);
}

std::string without_blanks(const std::string& text) {
  const std::size_t begin = std::min(text.find_first_not_of(' '), text.size());
  return text.substr(begin, text.find_last_not_of(' ') + 1 - begin);
}

// "FROM -> TO", or "TO"
bool is_meant(const Transition& transition, const std::string& text) {
  const std::size_t arrow = text.find("->");
  if (arrow == std::string::npos) return is_meant(transition.to, without_blanks(text));
  return is_meant(transition.from, without_blanks(text.substr(0, arrow))) &&
         is_meant(transition.to, without_blanks(text.substr(arrow + 2)));
}

std::string sentence(const Transition& transition) {
  return transition.behavior + ": " + (transition.from.empty() ? "enters" : transition.from + " ->") + " " +
         transition.to + (transition.why.empty() ? "" : " (" + transition.why + ")");
}

}  // namespace

DebuggedRun::DebuggedRun(RunChannel& channel, Assembly& assembly, RunLog& log, const Checks* checks)
    : channel_(channel), assembly_(assembly), checks_(checks) {
  const auto add = [this](Assembly& one) {
    if (one.own_host() == nullptr) return;
    hosts_.push_back(&one.host());
    one.host().watch_lines_by(this);
  };
  add(assembly);
  for (const auto& other : assembly.others()) add(*other);
  log.add(*this);
  if (checks != nullptr) lost_.resize(checks->size());
  std::signal(SIGCHLD, SIG_IGN);
}

void DebuggedRun::collect_behaviors() {
  behaviors_.clear();
  for (std::size_t robot = 0; robot < hosts_.size(); ++robot) {
    const std::string prefix = robot == 0 ? "" : assembly_.others()[robot - 1]->scenario().name + ".";
    for (std::size_t i = 0; i < hosts_[robot]->size(); ++i) {
      Behavior& behavior = hosts_[robot]->behavior(i);
      behaviors_.emplace_back(prefix + behavior.name(), &behavior);
    }
  }
}

int DebuggedRun::behavior_of(lua_State* state) const {
  int index = 0;
  for (ScriptHost* host : hosts_) {
    for (std::size_t i = 0; i < host->size(); ++i, ++index) {
      if (plays_in(host->behavior(i), state)) return index;
    }
  }
  return -1;
}

void DebuggedRun::begin(Json ready) {
  ready["event"] = "ready";
  ready["where"] = where();
  ready["behavior_ticks"] = assembly_.robot().engine.behavior_divisor();
  if (!channel_.send(ready)) _exit(0);
  serve();
}

void DebuggedRun::end(Json result) {
  if (goal_.search) arrive(nullptr, -1);
  result["event"] = "ended";
  result["stop"] = where();
  if (!channel_.send(result)) _exit(0);
  serve();
}

Json DebuggedRun::where() const {
  return {{"at", now_},
          {"time_s", 1e-9 * static_cast<double>(time_ns_)},
          {"state_hash", hash_text(hash_)},
          {"way_hash", hash_text(way_)},
          {"lines", lines_},
          {"thread", behavior_ < 0 ? run_thread : first_behavior_thread + behavior_}};
}

void DebuggedRun::tick(double, std::span<const double> row) { row_.assign(row.begin(), row.end()); }

void DebuggedRun::between_ticks(const RunMark& mark) {
  now_ = {mark.ticks, 0};
  time_ns_ = mark.time_ns;
  hash_ = mark.state_hash;
  reload();
  std::optional<Json> why = look_at_tick();
  const bool there = goal_.until && *goal_.until <= now_;
  if (why && !goal_.quiet && (!goal_.search || !there || goal_.with_end)) stop(std::move(*why));
  if (goal_.until && *goal_.until <= now_) arrive(nullptr, -1);
  if (mark.ticks % polled_ticks == 0) hear_orders();
  if (std::exchange(paused_, false)) stop({{"reason", "pause"}});
  leave_copy();
}

// Conditions of signals that became true, and checks that are lost.
std::optional<Json> DebuggedRun::look_at_tick() {
  std::optional<Json> why;
  if (conditions_ && conditions_->evaluate(1e-9 * static_cast<double>(time_ns_), row_)) {
    for (SignalBreak& one : breaks_.signals) {
      const bool holds = conditions_->holds(one.expression);
      if (holds && !one.held && !why) why = {{"reason", "data breakpoint"}, {"ids", {one.id}}, {"text", one.text}};
      one.held = holds;
    }
  }
  for (std::size_t i = 0; i < lost_.size(); ++i) {
    if (lost_[i] || !checks_->lost(i)) continue;
    lost_[i] = true;
    if (breaks_.check && !why)
      why = {{"reason", "exception"}, {"filter", "check"}, {"text", "check failed: " + checks_->config(i).name}};
  }
  return why;
}

// A moment within a tick. False: nothing can stop here any more.
bool DebuggedRun::passes(lua_State* state, int behavior) {
  ++now_.point;
  if (goal_.until && *goal_.until == now_) return arrive(state, behavior), false;
  return !goal_.quiet;
}

void DebuggedRun::fault(const Fault& fault) {
  if (!passes(nullptr, -1)) return;
  const std::string text = fault_text(told(fault, assembly_.robot().model, time_ns_));
  const bool meant = breaks_.fault && text.find(*breaks_.fault) != std::string::npos;
  if (meant) stop({{"reason", "exception"}, {"filter", "fault"}, {"text", "fault: " + text}});
}

void DebuggedRun::raised(lua_State* state, const char* message) noexcept {
  const int behavior = behavior_of(state);
  if (passes(state, behavior) && breaks_.error)
    stop({{"reason", "exception"}, {"filter", "error"}, {"text", message}}, state, behavior);
}

void DebuggedRun::tell(const Line& line) {
  const bool transition = line.transition != nullptr;
  const std::string text =
      transition ? sentence(*line.transition)
                 : std::string(line.behavior) + (line.behavior.empty() ? "" : ": ") + std::string(line.text);
  if (!goal_.search) {
    const bool error = !transition && line.severity == BehaviorLog::Severity::error;
    (void)channel_.send({{"event", "output"},
                         {"at", now_},
                         {"category", error        ? "stderr"
                                      : transition ? "console"
                                                   : "stdout"},
                         {"text", printed("%8.2f s  ", 1e-9 * static_cast<double>(line.time_ns)) + text + "\n"}});
  }
  if (!transition || !passes(nullptr, -1)) return;
  const auto named = [&](const auto& robot) { return robot.first == line.transition->behavior; };
  collect_behaviors();
  const auto which = std::ranges::find_if(behaviors_, named);
  const int behavior = which == behaviors_.end() ? -1 : static_cast<int>(which - behaviors_.begin());
  Json ids = Json::array();
  for (const NamedBreak& one : breaks_.states) {
    if (is_meant(line.transition->behavior + "." + line.transition->to, one.text)) ids.push_back(one.id);
  }
  if (!ids.empty()) return stop({{"reason", "function breakpoint"}, {"ids", ids}, {"text", text}}, nullptr, behavior);
  if (breaks_.transition && is_meant(*line.transition, *breaks_.transition))
    stop({{"reason", "exception"}, {"filter", "transition"}, {"text", text}}, nullptr, behavior);
}

DebuggedRun::LineCount& DebuggedRun::count(const char* chunk, int line) {
  auto found = std::ranges::find_if(chunks_, [&](const Chunk& one) { return one.name == chunk; });
  if (found == chunks_.end()) found = chunks_.insert(chunks_.end(), {chunk, {}});
  const auto at = static_cast<std::size_t>(std::clamp(line, 0, lines_max));
  if (found->lines.size() <= at) {
    found->lines.resize(at + 64);
    for (const LineBreak& one : breaks_.lines) {
      if (one.chunk == chunk && static_cast<std::size_t>(one.line) < found->lines.size())
        found->lines[static_cast<std::size_t>(one.line)].broken = true;
    }
  }
  return found->lines[at];
}

void DebuggedRun::line(lua_State* state, const char* chunk, int line) noexcept {
  LineCount& at = count(chunk, line);
  ++at.hits;
  look_at(state, chunk, line, at);
  const auto behavior = static_cast<std::size_t>(behavior_of(state) + 1);  // 0: of one that is being loaded
  if (lines_.size() <= behavior) lines_.resize(behavior + 1);
  ++lines_[behavior];
}

void DebuggedRun::look_at(lua_State* state, const char* chunk, int line, LineCount at) {
  way_ = (way_ ^ static_cast<std::uint64_t>(line)) * 0x9e3779b97f4a7c15U;
  if (goal_.until && goal_.until->tick == now_.tick && goal_.until->point == now_.point + 1)
    return (void)passes(state, behavior_of(state));
  if (!passes(state, -1)) return;
  if (at.broken && look_at_line(state, chunk, line, at.hits)) return;
  if (goal_.step && step_is_over(state)) stop({{"reason", "step"}}, state, behavior_of(state));
}

// True when it stopped there.
bool DebuggedRun::look_at_line(lua_State* state, const char* chunk, int line, std::uint32_t hits) {
  Json ids = Json::array();
  for (const LineBreak& one : breaks_.lines) {
    if (one.line != line || one.chunk != chunk) continue;
    if (!one.hits.empty() && !hits_hold(one.hits, hits)) continue;
    if (one.log.empty()) {
      if (one.condition.empty() || holds(one, state)) ids.push_back(one.id);
    } else if (!goal_.search && (one.condition.empty() || holds(one, state))) {
      (void)channel_.send({{"event", "output"},
                           {"at", now_},
                           {"always", true},
                           {"category", "console"},
                           {"text", filled(one.log, state) + "\n"}});
    }
  }
  if (ids.empty()) return false;
  stop({{"reason", "breakpoint"}, {"ids", ids}}, state, behavior_of(state));
  return true;
}

bool DebuggedRun::step_is_over(lua_State* state) const {
  const Step& step = *goal_.step;
  if (step.kind == Step::Kind::in) return true;
  const ScriptMoment place = script_moment(state, step.state);
  if (behavior_of(state) != step.behavior) return false;
  const bool same_thread = place.in_run == step.in_run && (!step.in_run || place.state == step.state);
  if (step.kind == Step::Kind::out) return same_thread && place.depth < step.depth;
  if (step.in_run && !same_thread) return !place.run_under_way;
  return place.depth <= step.depth;
}

void DebuggedRun::stop(Json why, lua_State* state, int behavior) {
  behavior_ = behavior;
  why.update(where());
  if (goal_.search) {
    behavior_ = -1;
    found_ = std::move(why);
    return;
  }
  if (state != nullptr) {
    const ScriptMoment place = script_moment(state, no_state);
    why["place"] = {{"behavior", behavior}, {"in_run", place.in_run}, {"state", place.state}, {"depth", place.depth}};
  }
  if (!channel_.send({{"event", "stopped"}, {"stop", std::move(why)}})) _exit(0);
  state_ = state;
  serve();
  state_ = nullptr;
  behavior_ = -1;
}

void DebuggedRun::arrive(lua_State* state, int behavior) {
  if (!goal_.search) return stop({{"reason", "arrived"}}, state, behavior);
  (void)channel_.send({{"event", "found"}, {"stop", found_ ? *found_ : Json()}});
  _exit(0);
}

// Stands still, until the debugger says how to go on.
void DebuggedRun::serve() {
  for (;;) {
    const std::optional<Json> order = channel_.receive();
    if (!order) _exit(0);
    const std::string what = order->value("order", "");
    if (what == "go") return go(*order);
    if (what == "fork") split({{"event", "copy"}});
    if (what != "look") continue;
    goal_ = {.until = {}, .quiet = true, .step = {}};  // of a copy, which never goes on
    end_after(look_s);
    (void)channel_.send(look(*order));
    end_after(0);
  }
}

void DebuggedRun::go(const Json& order) {
  goal_ = {.until = {},
           .quiet = order.value("quiet", false),
           .search = order.value("search", false),
           .with_end = order.value("with_end", false),
           .step = {}};
  if (order.contains("until")) goal_.until = order.at("until").get<RunPosition>();
  if (order.contains("step")) {
    const Json& step = order.at("step");
    const std::string kind = step.value("kind", "in");
    goal_.step = Step{.kind = kind == "over"  ? Step::Kind::over
                              : kind == "out" ? Step::Kind::out
                                              : Step::Kind::in,
                      .behavior = step.value("behavior", -1),
                      .in_run = step.value("in_run", false),
                      .state = step.value("state", no_state),
                      .depth = step.value("depth", 0)};
  }
  if (order.contains("breaks")) take_breaks(order.at("breaks"));
  found_.reset();
  inspections_.clear();
  reloads_ = order.value("reload", false);
  if (now_.point == 0) reload();
  copied_ns_ = thread_cpu_ns();
}

void DebuggedRun::take_breaks(const Json& breaks) {
  if (breaks == breaks_as_told_) return;
  breaks_as_told_ = breaks;
  breaks_ = {};
  breaks.at("lines").get_to(breaks_.lines);
  for (Chunk& chunk : chunks_) {
    for (LineCount& line : chunk.lines) line.broken = false;
  }
  for (const LineBreak& one : breaks_.lines) count(one.chunk.c_str(), one.line).broken = true;
  breaks.at("states").get_to(breaks_.states);
  for (const Json& filter : breaks.at("filters")) {
    const std::string name = filter.at("name"), text = filter.value("condition", "");
    if (name == "fault") breaks_.fault = text;
    if (name == "transition") breaks_.transition = text;
    breaks_.error = breaks_.error || name == "error";
    breaks_.check = breaks_.check || name == "check";
  }
  conditions_.reset();
  if (breaks.at("signals").empty()) return;
  conditions_ = std::make_unique<SignalExpressions>(assembly_.catalog().signals, assembly_.signal_states());
  for (const Json& one : breaks.at("signals")) {
    SignalBreak added{one.get<NamedBreak>()};
    if (ExpressionError error; conditions_->add(added.text, added.expression, error))
      breaks_.signals.push_back(std::move(added));
  }
  if (row_.empty() || !conditions_->evaluate(1e-9 * static_cast<double>(time_ns_), row_)) return;
  for (SignalBreak& one : breaks_.signals) one.held = conditions_->holds(one.expression);
}

void DebuggedRun::hear_orders() {
  while (channel_.waiting()) {
    const std::optional<Json> order = channel_.receive();
    if (!order) _exit(0);
    paused_ = paused_ || order->value("order", "") == "pause";
    if (order->contains("breaks")) take_breaks(order->at("breaks"));
  }
}

// Also shortly before the moment to which it goes: steps back from there are short, then.
void DebuggedRun::leave_copy() {
  const auto near = 2 * static_cast<std::uint64_t>(assembly_.robot().engine.behavior_divisor());
  const bool approaches = goal_.quiet && goal_.until && goal_.until->tick == now_.tick + near;
  if (!approaches && (now_.tick % polled_ticks != 0 || thread_cpu_ns() - copied_ns_ < work_between_copies_ns)) return;
  if (split({{"event", "copy"}})) return serve();
  copied_ns_ = thread_cpu_ns();
}

// Makes a copy of this process, and gives it to the debugger. True in the copy.
bool DebuggedRun::split(Json message) {
  message["where"] = where();
  auto [ours, theirs] = RunChannel::make_pair();
  const OpenFiles files;
  const pid_t pid = ChildProcess::copy_alone();
  if (pid == 0) {
    channel_ = std::move(ours);
    theirs.close();
    files.open_again();
    return true;
  }
  message["pid"] = pid;
  if (!channel_.send(message, pid < 0 ? nullptr : &theirs)) _exit(0);
  return false;
}

// Between two ticks: the behaviors will be read again in their next one, when that was asked for.
void DebuggedRun::reload() {
  if (!std::exchange(reloads_, false)) return;
  for (ScriptHost* host : hosts_) host->order({.kind = PlayOrder::Kind::reload});
}

std::string DebuggedRun::in_copy(const std::function<std::string()>& work) {
  int ends[2];
  std::string text;
  if (pipe(ends) != 0) return text;
  const pid_t pid = ChildProcess::copy_alone();
  if (pid == 0) {
    end_after(condition_s);
    goal_ = {.until = {}, .quiet = true, .step = {}};
    close(ends[0]);
    (void)write_all(ends[1], work());
    _exit(0);
  }
  close(ends[1]);
  char part[4096];
  for (ssize_t got = 0; pid > 0 && (got = read(ends[0], part, sizeof part)) > 0;)
    text.append(part, static_cast<std::size_t>(got));
  close(ends[0]);
  return text;
}

bool DebuggedRun::holds(const LineBreak& at, lua_State* state) {
  const std::string answer = in_copy([&]() -> std::string {
    collect_behaviors();
    state_ = state;
    const int behavior = behavior_of(state);
    ShownValue value;
    if (behavior < 0) return "no";
    if (!inspection(behavior).evaluate(0, at.condition, value)) return "is wrong: " + value.text;
    return value.text == "nil" || value.text == "false" ? "no" : "yes";
  });
  if (answer == "yes" || answer == "no") return answer == "yes";
  const std::string why = answer.empty() ? "took longer than " + std::to_string(condition_s) + " s" : answer;
  (void)channel_.send(
      {{"event", "output"},
       {"at", now_},
       {"always", true},
       {"category", "stderr"},
       {"text", at.chunk + ":" + std::to_string(at.line) + ": the condition '" + at.condition + "' " + why + "\n"}});
  return true;
}

// The text of a log point: what stands in braces is evaluated.
std::string DebuggedRun::filled(const std::string& text, lua_State* state) {
  const std::string all = in_copy([&] {
    collect_behaviors();
    state_ = state;
    const int behavior = behavior_of(state);
    std::string to;
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t open = text.find('{', at), close = text.find('}', open == std::string::npos ? at : open);
      if (open == std::string::npos || close == std::string::npos || behavior < 0) return to + text.substr(at);
      ShownValue value;
      (void)inspection(behavior).evaluate(0, text.substr(open + 1, close - open - 1), value);
      const bool quoted = value.type == "string" && value.text.size() > 1;
      to += text.substr(at, open - at) + (quoted ? value.text.substr(1, value.text.size() - 2) : value.text);
      at = close + 1;
    }
    return to;
  });
  return all.empty() ? text : all;
}

}  // namespace kadans
