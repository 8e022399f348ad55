#include "behavior.h"

#include <algorithm>
#include <utility>

#include "behavior_parts.h"
#include "behavior_status.h"
#include "engine/clock.h"
#include "engine/refusal_text.h"
#include "script/bindings/machine_sets.h"
#include "script/chart/chart_reader.h"
#include "script/check/hint.h"
#include "script/lua/lua_core.h"
#include "script/sandbox/sandbox.h"

namespace kadans {
namespace {

// What a behavior is played with: the robot's values of its parameters, and arguments, which are values of its `args`,
// as from k.call, or of its parameters.
struct Giving {
  Behavior::Parts& parts;
  std::vector<std::pair<std::string, int>> declared{};  // name and Lua type of the default
  std::vector<const PlayArgument*> given{};
};

int read_declared(lua_State* state) {
  Giving& giving = *static_cast<Giving*>(lua_touserdata(state, 1));
  const int arguments = giving.parts.chart.machines.front().arguments;
  if (arguments == Chart::no_function) return 0;
  lua_rawgeti(state, LUA_REGISTRYINDEX, arguments);
  for (lua_pushnil(state); lua_next(state, 2) != 0; lua_pop(state, 1)) {
    if (lua_type(state, -2) == LUA_TSTRING) giving.declared.emplace_back(lua_tostring(state, -2), lua_type(state, -1));
  }
  return 0;
}

void push(lua_State* state, const PlayValue& value) {
  if (const auto* number = std::get_if<double>(&value)) return lua_pushnumber(state, *number);
  if (const auto* flag = std::get_if<bool>(&value)) return lua_pushboolean(state, *flag ? 1 : 0);
  const auto& text = *std::get_if<std::string>(&value);
  lua_pushlstring(state, text.data(), text.size());
}

int keep_given(lua_State* state) {
  const Giving& giving = *static_cast<const Giving*>(lua_touserdata(state, 1));
  lua_newtable(state);
  for (const PlayArgument* argument : giving.given) {
    push(state, argument->value);
    lua_setfield(state, 2, argument->name.c_str());
  }
  giving.parts.chart.machines.front().given = luaL_ref(state, LUA_REGISTRYINDEX);
  return 0;
}

const char* kind_name(int type) {
  switch (type) {
    case LUA_TNUMBER:
      return "a number";
    case LUA_TBOOLEAN:
      return "true or false";
    case LUA_TSTRING:
      return "a text";
    default:
      return "a table, which only k.call can give";
  }
}

int type_of(const PlayValue& value) {
  constexpr int lua_types[] = {LUA_TNUMBER, LUA_TBOOLEAN, LUA_TSTRING};
  return lua_types[value.index()];
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

ScriptParameter* find_parameter(Behavior::Parts& parts, const std::string& name) {
  for (ScriptParameter& parameter : parts.lua->core().parameters) {
    if (parameter.name == name) return &parameter;
  }
  return nullptr;
}

std::string who(const std::string& behavior) { return "of behavior '" + behavior + "'"; }

// "", or why it cannot be set so.
std::string set(ScriptParameter& parameter, double value, const std::string& behavior) {
  if (value >= parameter.min && value <= parameter.max) {
    parameter.value = value;
    return "";
  }
  return "parameter '" + parameter.name + "' " + who(behavior) + " = " + number(value) + " is outside its range " +
         number(parameter.min) + ".." + number(parameter.max) + (parameter.unit.empty() ? "" : " " + parameter.unit);
}

// What a robot's file calls it: the chunk, or, when the behavior was reloaded from another file, that of its first one.
const std::string& first_name(const Behavior::Parts& parts, const std::string& chunk) {
  return chunk == parts.lua->sources().front().chunk ? parts.settings.chunk : chunk;
}

// What is wrong with it, or "".
std::string give(Behavior::Parts& parts, const BehaviorValue& given) {
  std::vector<std::string> names;
  for (ScriptParameter& parameter : parts.lua->core().parameters) {
    if (first_name(parts, parameter.chunk) != given.chunk) continue;
    if (parameter.name == given.parameter) {
      const std::string wrong = set(parameter, given.value, given.behavior);
      parameter.initial = parameter.value;
      return wrong;
    }
    names.push_back(parameter.name);
  }
  return "behavior '" + given.behavior + "' has no parameter '" + given.parameter + "'" +
         hint_text(given.parameter, names);
}

// What is wrong with it, or "".
std::string give(Giving& giving, const PlayArgument& argument) {
  const std::string& behavior = giving.parts.chart.name;
  for (const auto& [name, type] : giving.declared) {
    if (name != argument.name) continue;
    if (type != type_of(argument.value)) return "argument '" + name + "' " + who(behavior) + " is " + kind_name(type);
    giving.given.push_back(&argument);
    return "";
  }
  if (ScriptParameter* parameter = find_parameter(giving.parts, argument.name)) {
    const auto* value = std::get_if<double>(&argument.value);
    if (value == nullptr) return "parameter '" + argument.name + "' " + who(behavior) + " is a number";
    return set(*parameter, *value, behavior);
  }
  std::vector<std::string> names;
  for (const auto& declared : giving.declared) names.push_back(declared.first);
  for (const ScriptParameter& known : giving.parts.lua->core().parameters) names.push_back(known.name);
  return "behavior '" + behavior + "' takes no argument '" + argument.name + "'" + hint_text(argument.name, names);
}

}  // namespace

void give_robot_values(Behavior::Parts& parts) {
  if (parts.settings.chunk.empty()) parts.settings.chunk = parts.lua->sources().front().chunk;
  std::vector<InputProblem> problems;
  for (const BehaviorValue& given : parts.catalog.behavior_values) {
    const auto is_its = [&](const LuaState::Source& source) { return first_name(parts, source.chunk) == given.chunk; };
    if (std::ranges::none_of(parts.lua->sources(), is_its)) continue;
    const std::string wrong = give(parts, given);
    if (!wrong.empty()) problems.push_back({given.file, given.line, given.column, wrong});
  }
  if (!problems.empty()) throw InputError(problems);
}

void give_arguments(Behavior::Parts& parts, std::uint64_t instructions) {
  const Behavior::Settings& settings = parts.settings;
  if (settings.arguments.empty()) return;
  Giving giving{parts};
  std::vector<InputProblem> problems;
  bool done = parts.lua->call(read_declared, &giving, instructions, settings.limits.load_wall_ns);
  for (const PlayArgument& argument : settings.arguments) {
    const std::string wrong = give(giving, argument);
    if (!wrong.empty()) problems.push_back({settings.source, argument.place.line, argument.place.column, wrong});
  }
  if (!problems.empty()) throw InputError(problems);
  done = done && parts.lua->call(keep_given, &giving, instructions, settings.limits.load_wall_ns);
  if (!done) throw InputError({.file = settings.source, .message = parts.lua->error().text()});
}

namespace {

constexpr const char* rehearsal_text =
    "local seen = { inner = { value = 1 } } "
    "local function look(from) return from.inner.value end "
    "return function(on) local sum = 0 for i = 1, 3 do sum = sum + look(seen) * i end "
    "if on and sum > 100 then seen.sum = sum end return sum ~= nil and sum < 0 end";

int tick_chart(lua_State* state) {
  auto& parts = *static_cast<Behavior::Parts*>(lua_touserdata(state, 1));
  parts.snapshot_tables.refill(state, *parts.bindings.snapshot, parts.bindings.now_ns);
  parts.runner->tick(state, parts.bindings.now_ns);
  return 0;
}

// The work of a tick but for the chart: tables filled with what they are going to hold anyway, and a function that uses
// the interpreter as functions of charts do.
int rehearse_tick(lua_State* state) {
  auto& parts = *static_cast<Behavior::Parts*>(lua_touserdata(state, 1));
  Behavior::Parts::Rehearsal& rehearsal = parts.rehearsal;
  parts.snapshot_tables.refill(state, *rehearsal.snapshot, rehearsal.now_ns);
  if (rehearsal.function == LUA_NOREF) {
    if (luaL_loadstring(state, rehearsal_text) != 0) return lua_error(state);
    lua_call(state, 0, 1);
    rehearsal.function = luaL_ref(state, LUA_REGISTRYINDEX);
  }
  lua_rawgeti(state, LUA_REGISTRYINDEX, rehearsal.function);
  lua_pushboolean(state, 1);
  lua_call(state, 1, 1);
  return 0;
}

int stop_chart(lua_State* state) {
  auto& parts = *static_cast<Behavior::Parts*>(lua_touserdata(state, 1));
  parts.snapshot_tables.refill(state, *parts.bindings.snapshot, parts.bindings.now_ns);
  parts.runner->stop(state, parts.bindings.now_ns);
  return 0;
}

// Runs the file and reads the chart from what it returns.
int read_file(lua_State* state) {
  auto& parts = *static_cast<Behavior::Parts*>(lua_touserdata(state, 1));
  if (!parts.lua->load_file(state, parts.settings.file)) return lua_error(state);
  lua_call(state, 0, 1);
  const int result = lua_gettop(state);
  NodeKind kind{};
  if (!is_node(state, result, &kind) || kind != NodeKind::behavior) {
    return luaL_error(state, "%s:1: the file must return k.behavior \"name\" { ... }",
                      parts.lua->sources().front().chunk.c_str());
  }
  read_chart(state, result, parts.chart);
  return 0;
}

int open_bindings(lua_State* state) {
  auto& parts = *static_cast<Behavior::Parts*>(lua_touserdata(state, 1));
  open_machines(state, parts.chart, parts.bindings, parts.tables);
  parts.tables.snapshot = parts.snapshot_tables.open(state, parts.catalog, parts.settings.feet, true);
  parts.tables.event = parts.snapshot_tables.event();
  return 0;
}

InputProblem problem_of(const ScriptError& error) { return {error.file.data(), error.line, 0, error.message.data()}; }

}  // namespace

Behavior::Parts::Parts(const Settings& wanted, const Catalog& offered, BehaviorLog& to)
    : settings(wanted), catalog(offered), log(to) {}

void Behavior::Parts::say(const char* text) noexcept { say_with(BehaviorLog::Severity::info, text); }

void Behavior::Parts::say_with(BehaviorLog::Severity severity, const char* text) noexcept {
  const std::int64_t now_ns = bindings.engine_ns();
  tell_dropped(false);
  const LogBound::Answer answer = bound.admit(now_ns);
  if (answer == LogBound::Answer::say) return log.message(now_ns, severity, chart.name, text);
  if (answer == LogBound::Answer::drop) return;
  log.message(now_ns, BehaviorLog::Severity::warning, chart.name,
              "says more than " + std::to_string(LogBound::lines_max) + " lines in a second; the rest is dropped");
}

void Behavior::Parts::tell_dropped(bool at_once) noexcept {
  const std::int64_t now_ns = bindings.engine_ns();
  const std::uint64_t dropped = bound.take_dropped(now_ns, at_once);
  if (dropped == 0) return;
  log.message(now_ns, BehaviorLog::Severity::warning, chart.name,
              std::to_string(dropped) + (dropped == 1 ? " line was dropped" : " lines were dropped"));
}

void Behavior::Parts::tell_refused() noexcept {
  while (const Refusal* refusal = bindings.next_refusal()) {
    ++transactions_refused;
    bindings.sets_lost = true;
    log.message(bindings.engine_ns(), BehaviorLog::Severity::warning, chart.name,
                "refused by the control engine, all commands of that tick: " + refusal_text(*refusal, catalog));
    bindings.forget_armed(refusal->sequence);
  }
}

void Behavior::Parts::tell_armed() noexcept {
  ArmedHere armed;
  ArmedStatus status;
  while (bindings.look_at_armed(armed, status)) {
    const std::string of = "what " + (armed.owner == 0 ? chart.name : chart.states[armed.owner].path) + " armed ";
    if (status.fired != armed.fired) {
      log.message(bindings.engine_ns(), BehaviorLog::Severity::info, chart.name,
                  of + "acted in tick " + std::to_string(status.fired_tick));
      if (armed.event != no_event) (void)runner->post(armed.event);
    }
    if (status.state == ArmedState::refused) {
      ++transactions_refused;
      log.message(bindings.engine_ns(), BehaviorLog::Severity::warning, chart.name,
                  of + "was refused when its condition was true");
    }
  }
}

void Behavior::Parts::want_sets() noexcept { bindings.wanted = runner->sets_asked() & ~bindings.sets_sent; }

void Behavior::Parts::transitioned(const std::string& from, const std::string& to, const std::string& why) noexcept {
  transition.time_ns = bindings.engine_ns();
  transition.behavior = chart.name;
  transition.from = from;
  transition.to = to;
  transition.why = why;
  log.transition(transition);
}

void Behavior::Parts::event_dropped(const char* event) noexcept {
  char text[320];
  std::snprintf(text, sizeof text, "event '%.200s' was dropped: no transition took it in its tick (told once)", event);
  say_with(BehaviorLog::Severity::warning, text);
}

void Behavior::Parts::out_of_steps(const char* chunk, int line) noexcept {
  char text[512];
  std::snprintf(
      text, sizeof text,
      "%.300s:%d: a tick took all %u steps, the last one by the transition here; further events were dropped. "
      "Do events lead to each other? (told once)",
      chunk, line, ChartRunner::steps_max);
  say_with(BehaviorLog::Severity::warning, text);
}

bool Behavior::Parts::run(int (*function)(lua_State*), void* argument) noexcept {
  return lua->call(function, argument != nullptr ? argument : this, settings.limits.tick_instructions,
                   settings.limits.tick_wall_ns);
}

Behavior::Behavior(const Settings& settings, const Catalog& catalog, BehaviorLog& log)
    : parts_(std::make_unique<Parts>(settings, catalog, log)), past_(std::make_unique<Past>()) {
  load_behavior(*parts_);
  publish_status();
}

Behavior::~Behavior() = default;

void Behavior::prepare(const Snapshot& newest) noexcept {
  if (failed() || finished()) return;
  parts_->rehearsal.snapshot = &newest;
  parts_->rehearsal.now_ns = clock_ns(newest);
  (void)parts_->run(rehearse_tick);
}

bool Behavior::tick(const Snapshot& snapshot, CommandSender& commands) noexcept {
  Parts& parts = *parts_;
  if (failed() || finished()) return false;
  forget_past(clock_ns(snapshot));
  Bindings& bindings = parts.bindings;
  bindings.begin(commands, snapshot, snapshot.time_ns);
  bindings.sent_events.clear();
  if (bindings.armed_count > 0) parts.tell_armed();
  bindings.take_back_orphans();
  if (snapshot.transactions_refused != bindings.refusals_seen) parts.tell_refused();
  if (bindings.sets_lost && bindings.sets_known() && snapshot.status.safety.level < SafetyLevel::hold) {
    bindings.sets_lost = false;
    bindings.sets_sent = bindings.sets_now = snapshot.control_sets;
    parts.want_sets();
  }
  if (bindings.wanted != 0) bindings.bring_in_again();
  if (!parts.run(tick_chart)) {
    commands.discard();
    bindings.sent_events.clear();
    if (take_back(snapshot, commands)) return true;
    parts.failed = true;
    parts.error = parts.lua->error();
    parts.tell_dropped(true);
    if (parts.error.breach == ScriptBreach::none) stop(snapshot, commands);
    return false;
  }
  if (!bindings.commit()) {
    ++parts.transactions_refused;
    parts.log.message(snapshot.time_ns, BehaviorLog::Severity::warning, name(),
                      "queue_full: the commands of this tick were refused, all of them");
  }
  parts.tell_dropped(finished());
  publish_status();
  return !finished();
}

void Behavior::publish_status() noexcept {
  Parts& parts = *parts_;
  const auto store = [](std::atomic<std::uint32_t>& to, std::uint64_t value) {
    to.store(static_cast<std::uint32_t>(value), std::memory_order_relaxed);
  };
  store(status_.instructions, parts.lua->core().budget.spent());
  const bool wall = parts.settings.limits.tick_wall_ns > 0;
  const std::int64_t began_ns = wall ? WallClock{}.now_ns() : 0;
  parts.lua->collect();
  store(status_.gc_pause_ns, wall ? static_cast<std::uint64_t>(WallClock{}.now_ns() - began_ns) : 0);
  store(status_.heap_bytes, parts.lua->used_bytes());
  store(status_.state, parts.runner->innermost());
}

void Behavior::stop(const Snapshot& snapshot, CommandSender& commands) noexcept {
  Parts& parts = *parts_;
  if (!parts.runner->started() || parts.error.breach != ScriptBreach::none) return;
  // An exit that raises ends its transaction; the states around it are left in the next one, in what is left of the
  // tick.
  const bool wall = parts.settings.limits.tick_wall_ns > 0;
  const std::int64_t end_ns = wall ? WallClock{}.now_ns() + parts.settings.limits.tick_wall_ns : 0;
  for (std::uint64_t left = parts.settings.limits.tick_instructions; left > 0;) {
    const std::int64_t left_ns = wall ? std::max<std::int64_t>(end_ns - WallClock{}.now_ns(), 1) : 0;
    parts.bindings.begin(commands, snapshot, snapshot.time_ns);
    if (parts.lua->call(stop_chart, &parts, left, left_ns)) {
      (void)parts.bindings.commit();
      return;
    }
    commands.discard();
    if (!parts.failed) parts.error = parts.lua->error();
    parts.failed = true;
    if (parts.lua->error().breach != ScriptBreach::none) return;
    left -= std::min(left, parts.lua->core().budget.spent());
  }
}

std::string Behavior::keep(ByteWriter& bytes) { return keep_behavior(*parts_, bytes); }

bool Behavior::go_on(ByteReader& bytes, const Snapshot& snapshot, CommandSender& commands) noexcept {
  const bool goes_on = go_on_with(*parts_, bytes, snapshot, commands, parts_->settings.limits.load_instructions, false);
  publish_status();
  return goes_on;
}

void Behavior::hold_clock(std::int64_t held_ns) noexcept {
  parts_->bindings.held_ns = held_ns;
  if (past_->parts != nullptr) past_->parts->bindings.held_ns = held_ns;
}

std::int64_t Behavior::clock_ns(const Snapshot& snapshot) const noexcept {
  return snapshot.time_ns - parts_->bindings.held_ns;
}

bool Behavior::post(const std::string& event) noexcept {
  const EventId id = parts_->chart.find_event(event);
  return id != no_event && !parts_->chart.made_by_runner(id) && parts_->runner->post(id);
}

const std::vector<ScriptEvent>& Behavior::events() const noexcept { return parts_->lua->core().events; }
std::vector<SentEvent>& Behavior::sent_events() noexcept { return parts_->bindings.sent_events; }

namespace {

struct Posting {
  Behavior::Parts& parts;
  const PlayedEvent& event;
  EventId id;
  bool taken = false;
};

int post_event(lua_State* state) {
  Posting& posting = *static_cast<Posting*>(lua_touserdata(state, 1));
  ChartRunner& runner = *posting.parts.runner;
  const bool with_data = !posting.event.data.empty();
  lua_rawgeti(state, LUA_REGISTRYINDEX, posting.parts.tables.event_data);
  if (with_data) push_event_data(state, posting.event);
  const std::int8_t place = with_data ? runner.events().free_place() : std::int8_t{-1};
  posting.taken = runner.post(posting.id, place);
  if (posting.taken && with_data) lua_rawseti(state, -2, place + 1);
  return 0;
}

}  // namespace

std::string Behavior::post(const PlayedEvent& event) {
  Parts& parts = *parts_;
  const ScriptEvent* declared = find_event(events(), event.name);
  const EventId id = parts.chart.find_event(event.name);
  if (failed() || finished() || declared == nullptr || id == no_event) return "'" + name() + "' does not declare it";
  if (WrongData wrong = wrong_data(*declared, event); !wrong.why.empty()) return wrong.why;
  Posting posting{parts, event, id};
  if (!parts.run(post_event, &posting)) return "'" + name() + "' has no memory for it";
  return posting.taken ? "" : "'" + name() + "' has as many events waiting as a tick may have";
}

const std::string& Behavior::name() const noexcept { return parts_->chart.name; }
const Behavior::Settings& Behavior::settings() const noexcept { return parts_->settings; }
const Chart& Behavior::chart() const noexcept { return parts_->chart; }
bool Behavior::finished() const noexcept { return parts_->runner->finished(); }
bool Behavior::failed() const noexcept { return parts_->failed; }
const ScriptError& Behavior::error() const noexcept { return parts_->error; }
std::uint64_t Behavior::transactions_refused() const noexcept { return parts_->transactions_refused; }
std::uint64_t Behavior::events_unhandled() const noexcept { return parts_->runner->events_unhandled(); }
std::size_t Behavior::heap_bytes() const noexcept { return parts_->lua->used_bytes(); }

std::string Behavior::outcome() const {
  if (failed()) return "error";
  const EventId outcome = parts_->runner->outcome();
  return outcome == no_event ? "" : parts_->chart.events[static_cast<std::size_t>(outcome)];
}

std::string Behavior::state() const { return parts_->chart.states[parts_->runner->innermost()].path; }

SetMask Behavior::control_sets() const noexcept { return parts_->bindings.all_sets; }

ObjectMask Behavior::objects() const noexcept {
  ObjectMask all = 0;
  for (const ObjectMask objects : parts_->bindings.machine_objects) all |= objects;
  return all;
}

std::vector<ScriptParameter> Behavior::parameters() const {
  const auto& all = parts_->lua->core().parameters;
  return {all.begin(), all.end()};
}

bool Behavior::set_parameter(const std::string& name, double value) noexcept {
  for (ScriptParameter& parameter : parts_->lua->core().parameters) {
    if (parameter.name != name || !(value >= parameter.min && value <= parameter.max)) continue;
    parameter.value = value;
    return true;
  }
  return false;
}

void load_behavior(Behavior::Parts& parts, std::uint64_t instructions) {
  const Behavior::Settings& settings = parts.settings;
  if (instructions == 0) instructions = settings.limits.load_instructions;
  parts.lua = std::make_unique<LuaState>(LuaState::Settings{.root = settings.root,
                                                            .folder = settings.file.parent_path(),
                                                            .name = settings.file.stem().string(),
                                                            .seed = settings.seed,
                                                            .limits = settings.limits,
                                                            .voice = &parts});
  parts.bindings.catalog = &parts.catalog;
  parts.bindings.feet = &parts.settings.feet;
  parts.lua->core().bindings = &parts.bindings;
  if (!parts.lua->call(read_file, &parts, instructions, settings.limits.load_wall_ns)) {
    throw InputError(problem_of(parts.lua->error()));
  }
  find_transition_lines(parts.lua->sources(), parts.chart);
  for (const ScriptEvent& event : parts.lua->core().events) parts.chart.intern(event.name);
  parts.chart.resolve(parts.problems);
  for (const ScriptEvent& event : parts.lua->core().events) {
    if (parts.chart.made_by_runner(parts.chart.find_event(event.name)))
      parts.problems.push_back(
          {event.chunk, event.line, 0, "event '" + event.name + "' is how a state ends: give it another name"});
  }
  find_control_sets(parts);
  if (!parts.problems.empty()) throw InputError(parts.problems);
  give_robot_values(parts);
  give_arguments(parts, instructions);
  if (!parts.lua->call(open_bindings, &parts, instructions, settings.limits.load_wall_ns)) {
    throw InputError(problem_of(parts.lua->error()));
  }
  parts.runner = std::make_unique<ChartRunner>(parts.chart, parts.tables, parts);
  parts.bindings.runner = parts.runner.get();
  parts.lua->core().loading = false;
}

static_assert(std::atomic<std::uint32_t>::is_always_lock_free);

void BehaviorStatus::declare(SignalTable& signals, const std::string& name) const {
  const std::string prefix = "behavior." + name + ".";
  signals.add({prefix + "heap_bytes", "B", "Memory of the behavior's Lua state."}, &heap_bytes);
  signals.add({prefix + "instructions", "", "Lua instructions of its last tick, in steps of a thousand."},
              &instructions);
  signals.add({prefix + "gc_pause_ns", "ns", "Pause of the collector after its last tick; 0 in virtual time."},
              &gc_pause_ns);
  signals.add({prefix + "state", "", "Number of its innermost active state; 0: the behavior itself."}, &state);
  signals.add({prefix + "reloads", "", "New versions taken since the start."}, &reloads);
}

void BehaviorStatus::declare_numbered(SignalTable& signals, const std::string& name) const {
  std::string free = name;
  for (int number = 2; signals.find("behavior." + free + ".state"); ++number)
    free = name + "_" + std::to_string(number);
  declare(signals, free);
}

}  // namespace kadans
