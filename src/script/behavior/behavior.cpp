#include "behavior.h"

#include <algorithm>
#include <utility>

#include "behavior_parts.h"
#include "behavior_status.h"
#include "engine/clock.h"
#include "engine/refusal_text.h"
#include "script/bindings/machine_sets.h"
#include "script/chart/chart_arguments.h"
#include "script/chart/chart_calls.h"
#include "script/chart/chart_reader.h"
#include "script/check/hint.h"
#include "script/lua/lua_core.h"
#include "script/sandbox/sandbox.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

// What a behavior is played with: the robot's values of its parameters, and arguments, which are values of its `args`,
// as from k.call, or of its parameters.
struct Giving {
  Behavior::Parts& parts;
  const PlayArgument* argument = nullptr;  // the one that is given now
  bool declared = false;                   // among `args`
  std::string wrong{}, whom{};
  std::vector<std::string> names{};  // of `args`
};

void push(lua_State* state, const PlayValue& value) {
  if (const auto* number = std::get_if<double>(&value)) return lua_pushnumber(state, *number);
  if (const auto* flag = std::get_if<bool>(&value)) return lua_pushboolean(state, *flag ? 1 : 0);
  const auto& text = *std::get_if<std::string>(&value);
  lua_pushlstring(state, text.data(), text.size());
}

// Gives an argument when it is declared and fits.
void give_declared(lua_State* state, Giving& giving) {
  Chart::Machine& machine = giving.parts.chart.machines.front();
  const char* name = giving.argument->name.c_str();
  if (machine.arguments == Chart::no_function) return;
  push(state, giving.argument->value);  // 2
  lua_rawgeti(state, LUA_REGISTRYINDEX, machine.arguments);
  lua_getfield(state, 3, name);
  giving.declared = !lua_isnil(state, 4);
  if (giving.declared && push_refusal(state, 4, 2, name, giving.whom.c_str())) {
    giving.wrong = lua_tostring(state, -1);
    return;
  }
  if (!giving.declared) {
    for (lua_pushnil(state); lua_next(state, 3) != 0; lua_pop(state, 1))
      giving.names.emplace_back(lua_tostring(state, -2));
    return;
  }
  if (machine.given == Chart::no_function) {
    lua_newtable(state);
    machine.given = luaL_ref(state, LUA_REGISTRYINDEX);
  }
  lua_rawgeti(state, LUA_REGISTRYINDEX, machine.given);
  lua_pushvalue(state, 2);
  lua_setfield(state, -2, name);
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
  return outside_range("parameter '" + parameter.name + "' " + who(behavior), value, parameter.min, parameter.max,
                       parameter.unit);
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

// What is wrong with an argument that is not among `args`, or "".
std::string give_parameter(Giving& giving) {
  const std::string& behavior = giving.parts.chart.name;
  const PlayArgument& argument = *giving.argument;
  if (ScriptParameter* parameter = find_parameter(giving.parts, argument.name)) {
    const auto* value = std::get_if<double>(&argument.value);
    if (value == nullptr) return "parameter '" + argument.name + "' " + who(behavior) + " is a number";
    return set(*parameter, *value, behavior);
  }
  for (const ScriptParameter& known : giving.parts.lua->core().parameters) giving.names.push_back(known.name);
  return "behavior '" + behavior + "' takes no argument '" + argument.name + "'" +
         hint_text(argument.name, giving.names);
}

// Sets the parameters of the behavior and of those that it calls to the values in the robot's configuration. Throws
// InputError.
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

// Gives the behavior the values of Settings::arguments. Throws InputError.
void give_arguments(Behavior::Parts& parts, std::uint64_t instructions) {
  const Behavior::Settings& settings = parts.settings;
  std::vector<InputProblem> problems;
  for (const PlayArgument& argument : settings.arguments) {
    Giving giving{.parts = parts, .argument = &argument, .whom = "behavior '" + parts.chart.name + "'"};
    const auto give = [&](lua_State* state) { give_declared(state, giving); };
    if (!parts.lua->call(give, instructions, settings.limits.load_wall_ns))
      throw InputError({.file = settings.source, .message = parts.lua->error().text()});
    if (!giving.declared) giving.wrong = give_parameter(giving);
    if (!giving.wrong.empty())
      problems.push_back({settings.source, argument.place.line, argument.place.column, giving.wrong});
  }
  if (!problems.empty()) throw InputError(problems);
}

constexpr const char* rehearsal_text =
    "local seen = { inner = { value = 1 } } "
    "local function look(from) return from.inner.value end "
    "return function(on) local sum = 0 for i = 1, 3 do sum = sum + look(seen) * i end "
    "if on and sum > 100 then seen.sum = sum end return sum ~= nil and sum < 0 end";

void tick_chart(lua_State* state, Behavior::Parts& parts) {
  parts.snapshot_tables.refill(*parts.bindings.snapshot, parts.bindings.now_ns);
  if (parts.chart.waits_for_reports) post_reports(state, parts);
  parts.runner->tick(state, parts.bindings.now_ns);
}

// The work of a tick but for the chart: tables filled with what they are going to hold anyway, and a function that uses
// the interpreter as functions of charts do.
void rehearse_tick(lua_State* state, Behavior::Parts& parts, const Snapshot& newest, std::int64_t now_ns) {
  parts.snapshot_tables.refill(newest, now_ns);
  if (parts.rehearsal == LUA_NOREF) {
    if (luaL_loadstring(state, rehearsal_text) != 0) lua_error(state);
    lua_call(state, 0, 1);
    parts.rehearsal = luaL_ref(state, LUA_REGISTRYINDEX);
  }
  lua_rawgeti(state, LUA_REGISTRYINDEX, parts.rehearsal);
  lua_pushboolean(state, 1);
  lua_call(state, 1, 1);
}

// Runs the file and reads the chart from what it returns.
void read_file(lua_State* state, Behavior::Parts& parts) {
  if (!parts.lua->load_file(state, parts.settings.file)) lua_error(state);
  lua_call(state, 0, 1);
  const int result = lua_gettop(state);
  const std::optional<NodeKind> kind = node_kind(state, result);
  if (kind != NodeKind::behavior && kind != NodeKind::decisions) {
    luaL_error(state, "%s:1: the file must return k.behavior \"name\" { ... }",
               parts.lua->sources().front().chunk.c_str());
  }
  read_chart(state, result, parts.chart);
}

}  // namespace

const std::string& first_name(const Behavior::Parts& parts, const std::string& chunk) {
  return chunk == parts.lua->sources().front().chunk ? parts.settings.chunk : chunk;
}

Behavior::Parts::Parts(const Settings& wanted, const Catalog& offered, BehaviorLog& to)
    : settings(wanted), catalog(offered), log(to) {}

void Behavior::Parts::note(BehaviorLog::Severity severity, std::string_view text) noexcept {
  log.message(bindings.engine_ns(), severity, chart.name, text);
}

void Behavior::Parts::say_with(BehaviorLog::Severity severity, const char* text) noexcept {
  tell_dropped(false);
  const LogBound::Answer answer = bound.admit(bindings.engine_ns());
  if (answer == LogBound::Answer::say) return note(severity, text);
  if (answer == LogBound::Answer::drop) return;
  note(BehaviorLog::Severity::warning,
       "says more than " + std::to_string(LogBound::lines_max) + " lines in a second; the rest is dropped");
}

void Behavior::Parts::tell_dropped(bool at_once) noexcept {
  const std::uint64_t dropped = bound.take_dropped(bindings.engine_ns(), at_once);
  if (dropped == 0) return;
  note(BehaviorLog::Severity::warning,
       std::to_string(dropped) + (dropped == 1 ? " line was dropped" : " lines were dropped"));
}

void Behavior::Parts::tell_refused() noexcept {
  while (const Refusal* refusal = bindings.next_refusal()) {
    const std::string why = refusal_text(*refusal, catalog);
    if (bindings.was_armed(refusal->sequence)) {  // tell_armed() counted it; the states' sets are as they were
      note(BehaviorLog::Severity::warning, "all its commands: " + why);
      continue;
    }
    ++transactions_refused;
    bindings.sets_lost = true;
    reports.note(*refusal);
    note(BehaviorLog::Severity::warning, "refused by the control engine, all commands of that tick: " + why);
    bindings.forget_armed(refusal->sequence);
  }
}

void Behavior::Parts::tell_armed() noexcept {
  ArmedHere armed;
  ArmedStatus status;
  while (bindings.look_at_armed(armed, status)) {
    const std::string of = "what " + (armed.owner == 0 ? chart.name : chart.states[armed.owner].path) + " armed ";
    if (status.fired != armed.fired) {
      note(BehaviorLog::Severity::info, of + "acted in tick " + std::to_string(status.fired_tick));
      if (armed.event != no_event) (void)runner->post(armed.event);
    }
    if (status.state == ArmedState::refused) {
      ++transactions_refused;
      reports.note({.reason = status.reason});
      note(BehaviorLog::Severity::warning, of + "was refused when its condition was true");
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

Behavior::Behavior(const Settings& settings, const Catalog& catalog, BehaviorLog& log)
    : parts_(std::make_unique<Parts>(settings, catalog, log)), past_(std::make_unique<Past>()) {
  load_behavior(*parts_);
  for (const Chart::State& state : chart().states) {
    first_paths_.push_back(state.path);
    const bool shown = state.kind == Chart::Kind::region && BehaviorStatus::is_region_path(state.path);
    if (shown && status_->region_paths.size() < BehaviorStatus::regions_max)
      status_->region_paths.push_back(state.path);
  }
  number_states();
  publish_status();
}

Behavior::~Behavior() = default;

void Behavior::prepare(const Snapshot& newest) noexcept {
  if (failed() || finished()) return;
  (void)parts_->run([&](lua_State* state) { rehearse_tick(state, *parts_, newest, clock_ns(newest)); });
}

bool Behavior::tick(const Snapshot& snapshot, CommandSender& commands) noexcept {
  Parts& parts = *parts_;
  if (failed() || finished()) return false;
  forget_past(clock_ns(snapshot));
  Bindings& bindings = parts.bindings;
  bindings.begin(commands, snapshot, snapshot.time_ns);
  bindings.sent_events.clear();
  bindings.decided.clear();
  if (parts.chart.fault_events.empty()) parts.reports.faults_seen = snapshot.status.safety.faults_raised;
  if (bindings.armed_count > 0) parts.tell_armed();
  bindings.take_back_orphans();
  if (snapshot.transactions_refused != bindings.refusals_seen) parts.tell_refused();
  if (bindings.sets_lost && bindings.sets_known() && snapshot.status.safety.level < SafetyLevel::hold) {
    bindings.sets_lost = false;
    bindings.sets_sent = bindings.sets_now = snapshot.control_sets;
    parts.want_sets();
  }
  if (bindings.wanted != 0) bindings.bring_in_again();
  if (!parts.run([&](lua_State* state) { tick_chart(state, parts); })) {
    commands.discard();
    bindings.sent_events.clear();
    bindings.decided.clear();
    if (take_back(snapshot, commands)) return true;
    parts.failed = true;
    parts.error = parts.lua->error();
    parts.tell_dropped(true);
    if (parts.error.breach == ScriptBreach::none) stop(snapshot, commands);
    tell_active(snapshot.time_ns);
    return false;
  }
  if (!bindings.commit()) {
    ++parts.transactions_refused;
    parts.reports.queue_full = true;
    parts.note(BehaviorLog::Severity::warning, "queue_full: the commands of this tick were refused, all of them");
  }
  const bool over = finished();
  parts.tell_dropped(over);
  if (const std::string text = result(); !text.empty()) parts.note(BehaviorLog::Severity::info, "result " + text);
  publish_status();
  tell_active(snapshot.time_ns);
  return !over;
}

void Behavior::publish_status() noexcept {
  Parts& parts = *parts_;
  const auto store = [](std::atomic<std::uint32_t>& to, std::uint64_t value) {
    to.store(static_cast<std::uint32_t>(value), std::memory_order_relaxed);
  };
  store(status_->instructions, parts.lua->core().budget.spent());
  const bool wall = parts.settings.limits.tick_wall_ns > 0;
  const std::int64_t began_ns = wall ? WallClock{}.now_ns() : 0;
  parts.lua->collect();
  store(status_->gc_pause_ns, wall ? static_cast<std::uint64_t>(WallClock{}.now_ns() - began_ns) : 0);
  store(status_->heap_bytes, parts.lua->used_bytes());
  // Decisions stay where they ended; a behavior that is over is in no state any more.
  const StateIndex ended = parts.chart.decides ? parts.runner->finished_by() : no_state;
  store(status_->state, numbers_[ended == no_state ? parts.runner->innermost() : ended]);
  for (std::size_t i = 0; i < region_states_.size(); ++i) {
    const StateIndex region = region_states_[i];
    const bool active = region != no_state && parts.runner->active(region);
    store(status_->regions[i], active ? numbers_[parts.runner->innermost(region)] : 0);
  }
}

void Behavior::stop(const Snapshot& snapshot, CommandSender& commands) noexcept {
  Parts& parts = *parts_;
  if (!parts.runner->started() || parts.error.breach != ScriptBreach::none) return;
  // An exit that raises ends its transaction; the states around it are left in the next one, in what is left of the
  // tick.
  const bool wall = parts.settings.limits.tick_wall_ns > 0;
  const std::int64_t end_ns = wall ? WallClock{}.now_ns() + parts.settings.limits.tick_wall_ns : 0;
  const auto leave_all = [&](lua_State* state) {
    parts.snapshot_tables.refill(*parts.bindings.snapshot, parts.bindings.now_ns);
    parts.runner->stop(state, parts.bindings.now_ns);
  };
  for (std::uint64_t left = parts.settings.limits.tick_instructions; left > 0;) {
    const std::int64_t left_ns = wall ? std::max<std::int64_t>(end_ns - WallClock{}.now_ns(), 1) : 0;
    parts.bindings.begin(commands, snapshot, snapshot.time_ns);
    if (parts.lua->call(leave_all, left, left_ns)) {
      (void)parts.bindings.commit();
      publish_status();
      tell_active(snapshot.time_ns);
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
  const EventId id = parts_->chart.find_or_learn(event);
  return id != no_event && !parts_->chart.made_by_runner(id) && parts_->runner->post(id);
}

const std::vector<ScriptEvent>& Behavior::events() const noexcept { return parts_->lua->core().events; }
bool Behavior::waits_for(const std::string& event) const noexcept {
  const EventId id = parts_->chart.find_or_learn(event);
  return id != no_event && parts_->runner->waits_for(id);
}
std::vector<SentEvent>& Behavior::sent_events() noexcept { return parts_->bindings.sent_events; }
std::vector<PlayOrder>& Behavior::decided() noexcept { return parts_->bindings.decided; }
void Behavior::show_plays(const PlayReport* report) noexcept { parts_->bindings.plays = report; }

std::string Behavior::post(const PlayedEvent& event) {
  Parts& parts = *parts_;
  const ScriptEvent* declared = find_event(events(), event.name);
  const EventId id = parts.chart.find_or_learn(event.name);
  if (failed() || finished() || declared == nullptr) return "'" + name() + "' does not declare it";
  if (id == no_event) return "nothing in '" + name() + "' waits for it";
  if (WrongData wrong = wrong_data(*declared, event); !wrong.why.empty()) return wrong.why;
  bool taken = false;
  const auto post_it = [&](lua_State* state) {  // where fields are declared its data is a table, also without them
    const bool with_data = !declared->fields.empty();
    if (with_data) push_event_data(state, event);
    taken = with_data ? parts.runner->post_with_data(state, id) : parts.runner->post(id);
  };
  if (!parts.run(post_it)) return "'" + name() + "' has no memory for it";
  return taken ? "" : "'" + name() + "' has as many events waiting as a tick may have";
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

std::string Behavior::result() const { return finished() && !failed() ? result_text(*parts_) : ""; }

std::string Behavior::outcome() const {
  if (failed()) return "error";
  const EventId outcome = parts_->runner->outcome();
  return outcome == no_event ? "" : parts_->chart.events[static_cast<std::size_t>(outcome)];
}

std::string Behavior::state() const { return parts_->chart.states[parts_->runner->innermost()].path; }

std::vector<std::string> Behavior::active() const {
  std::vector<std::string> paths;
  const auto active = parts_->runner->active_states();
  for (std::size_t i = 0; i < active.size() && !failed(); ++i) {
    if (active[i] != 0 && parts_->runner->is_leaf(i)) paths.push_back(chart().states[active[i]].path);
  }
  return paths;
}

bool Behavior::active(StateIndex state) const noexcept { return !failed() && parts_->runner->active(state); }

void Behavior::tell_active(std::int64_t time_ns) noexcept {
  const auto now = failed() ? std::span<const StateIndex>() : parts_->runner->active_states();
  if (std::ranges::equal(now, told_)) return;
  told_.assign(now.begin(), now.end());
  told_paths_.clear();
  for (std::size_t i = 0; i < now.size() && told_paths_.size() < ActiveStates::told_max; ++i) {
    if (now[i] != 0 && parts_->runner->is_leaf(i)) told_paths_.push_back(chart().states[now[i]].path);
  }
  parts_->log.active({time_ns, name(), told_paths_});
}

void Behavior::take_place_of(Behavior& other) {
  first_paths_ = std::move(other.first_paths_);
  status_ = std::move(other.status_);
  number_states();
  publish_status();
}

// After its chart was loaded. A state that is new has the number of the one around it.
void Behavior::number_states() {
  const std::vector<Chart::State>& states = chart().states;
  numbers_.clear();
  for (std::size_t i = 0; i < states.size(); ++i) {
    const auto first = std::ranges::find(first_paths_, states[i].path);
    const std::uint32_t around = i == 0 ? 0 : numbers_[states[i].parent];
    numbers_.push_back(first == first_paths_.end() ? around : static_cast<std::uint32_t>(first - first_paths_.begin()));
  }
  region_states_.clear();
  for (const std::string& path : status_->region_paths) {
    const auto is_it = [&](const Chart::State& s) { return s.kind == Chart::Kind::region && s.path == path; };
    const auto found = std::ranges::find_if(states, is_it);
    region_states_.push_back(found == states.end() ? no_state : static_cast<StateIndex>(found - states.begin()));
  }
  told_.reserve(states.size() + 1);
  told_.assign(1, no_state);  // equals nothing that is active, not even nothing
  told_paths_.reserve(ActiveStates::told_max);
}

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

std::vector<ScriptArgument> Behavior::arguments() const {
  const int declared = parts_->chart.machines.front().arguments;
  if (declared == Chart::no_function) return {};
  std::vector<ScriptArgument> all;
  const auto read = [&](lua_State* state) {
    lua_rawgeti(state, LUA_REGISTRYINDEX, declared);
    all = read_declarations(state, 2);
  };
  const ScriptLimits& limits = parts_->settings.limits;
  if (!parts_->lua->call(read, limits.load_instructions, limits.load_wall_ns))
    throw InputError({.message = parts_->lua->error().text()});
  return all;
}

bool Behavior::set_parameter(const std::string& name, double value) noexcept {
  for (ScriptParameter& parameter : parts_->lua->core().parameters) {
    if (parameter.name != name || !(value >= parameter.min && value <= parameter.max)) continue;
    parameter.value = value;
    return true;
  }
  return false;
}

void open_lua(Behavior::Parts& parts) {
  const Behavior::Settings& settings = parts.settings;
  parts.lua = std::make_unique<LuaState>(LuaState::Settings{.root = settings.root,
                                                            .folder = settings.file.parent_path(),
                                                            .name = settings.file.stem().string(),
                                                            .seed = settings.seed,
                                                            .limits = settings.limits,
                                                            .voice = &parts});
  parts.bindings.catalog = &parts.catalog;
}

void load_behavior(Behavior::Parts& parts, std::uint64_t instructions) {
  const Behavior::Settings& settings = parts.settings;
  if (instructions == 0) instructions = settings.limits.load_instructions;
  open_lua(parts);
  parts.bindings.folders = settings.folders.project_file.empty() ? nullptr : &settings.folders;
  parts.lua->core().bindings = &parts.bindings;
  parts.lua->call_or_throw([&](lua_State* state) { read_file(state, parts); }, instructions,
                           settings.limits.load_wall_ns);
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
  for (ScriptParameter& parameter : parts.lua->core().parameters) parameter.loaded = parameter.value;
  const auto open_bindings = [&](lua_State* state) {
    open_machines(state, parts.chart, parts.bindings, parts.tables);
    parts.tables.snapshot = parts.snapshot_tables.open(state, parts.catalog, true);
    parts.tables.event = parts.snapshot_tables.event();
  };
  parts.lua->call_or_throw(open_bindings, instructions, settings.limits.load_wall_ns);
  make_room_for_calls(parts.lua->core(), parts.chart, parts.bindings);
  parts.runner = std::make_unique<ChartRunner>(parts.chart, parts.tables, parts);
  parts.bindings.runner = parts.runner.get();
  parts.lua->core().loading = false;
}

}  // namespace kadans
