#include "console.h"

#include <algorithm>
#include <exception>
#include <iterator>
#include <numeric>
#include <string>
#include <vector>

#include "kadans/signal/nearest_name.h"
#include "script/bindings/bindings.h"
#include "script/bindings/snapshot_tables.h"
#include "script/check/source_lexer.h"
#include "script/lua/lua_state.h"
#include "script/sandbox/sandbox.h"
#include "signal/input_file.h"
#include "signal/number_text.h"

namespace kadans {

struct ConsoleBehavior {
  std::string name, state, outcome, error;
  std::vector<std::string> active;
  std::vector<ScriptParameter> parameters;
};

// Shows names with dots as nested tables; all values are refilled together.
struct ValueTree {
  std::vector<std::string> names;  // sorted
  std::vector<std::size_t> ids;    // ids of the values, in the names' order
  int slots = Chart::no_function;  // registry: table and key of each, in the names' order

  explicit ValueTree(const std::vector<std::string>& unsorted);
  void push(lua_State* state, const char* title);  // [-0 +1] raises
  void refill(lua_State* state, std::span<const double> values) const;
};

struct Console::Parts final : ScriptVoice {
  Parts(const Settings& settings, const Catalog& offered, ScriptHost& plays);
  ~Parts() override = default;
  Parts(const Parts&) = delete;
  Parts& operator=(const Parts&) = delete;
  void say_with(BehaviorLog::Severity /*severity*/, const char* text) noexcept override {
    printed += std::string(text) + "\n";
  }

  Settings settings;
  const Catalog& catalog;
  ScriptHost& host;
  LuaState lua;
  Chart chart;
  Bindings bindings;
  RunnerTables tables;
  SnapshotTables snapshot_tables;
  ValueTree signals, parameters;
  std::vector<ConsoleBehavior> behaviors;
  int environment = Chart::no_function;  // registry: the globals of the lines
  int content = Chart::no_function;      // registry: the console's own names
  int show = Chart::no_function;         // registry: the function that makes text of values

  bool writes = false;
  int line_number = 0;
  std::string pending;  // lines that do not form a complete statement yet
  int pending_line = 1;
  std::string printed;

  CommandQueue nowhere_queue;  // takes the commands while the console only reads
  CommandSender nowhere{nowhere_queue};
};

// What a line on the console sees, and the names in it.

namespace {

// Values as text: tables with their fields in order, numbers without noise.
constexpr const char* show_text = R"(
local function show(value, depth)
  local kind = type(value)
  if kind == "number" then return string.format("%.10g", value) end
  if kind == "string" then return depth > 0 and string.format("%q", value) or value end
  if kind ~= "table" then return tostring(value) end
  if depth >= 3 then return "{ ... }" end
  local parts = {}
  for key, field in pairs(value) do
    if #parts >= 100 then parts[#parts + 1] = "..." break end
    local name = type(key) == "string" and key .. " = " or type(key) ~= "number" and tostring(key) .. " = " or ""
    parts[#parts + 1] = name .. show(field, depth + 1)
  end
  if #parts == 0 then return "{}" end
  return "{ " .. table.concat(parts, ", ") .. " }"
end
return function(...)
  local texts = {}
  for i = 1, select("#", ...) do texts[i] = show((select(i, ...)), 0) end
  return table.concat(texts, "  ")
end
)";

// A name of the globals that no line has set; upvalue 1: the content, 2: the parts.
int look_up(lua_State* state) {
  const auto& parts = *static_cast<const Console::Parts*>(lua_touserdata(state, lua_upvalueindex(2)));
  lua_settop(state, 2);
  lua_pushvalue(state, 2);
  lua_rawget(state, lua_upvalueindex(1));
  if (lua_isnil(state, 3)) return raise_unknown_field(state, "", lua_upvalueindex(1), 2);
  const bool machine = lua_type(state, 2) == LUA_TSTRING && std::string_view(lua_tostring(state, 2)) == "m";
  if (machine && !parts.writes) return luaL_error(state, "this console only reads: ':write' lets it command");
  return 1;
}

// [-0 +1] Registers and pushes the content: everything that is not set by lines.
void push_new_content(lua_State* state, Console::Parts& parts) {
  lua_newtable(state);
  const int content = lua_gettop(state);
  push_environment(state);
  (void)push_content(state, content + 1);
  for (lua_pushnil(state); lua_next(state, content + 2) != 0; lua_pop(state, 1)) {
    if (lua_type(state, -2) != LUA_TSTRING || std::string_view(lua_tostring(state, -2)) == "_G") continue;
    lua_pushvalue(state, -2);
    lua_pushvalue(state, -2);
    lua_rawset(state, content);
  }
  lua_settop(state, content);
  lua_getfield(state, LUA_REGISTRYINDEX, "kadans.modules");
  lua_getfield(state, -1, "kadans");
  lua_setfield(state, content, "k");
  lua_settop(state, content);
  open_machines(state, parts.chart, parts.bindings, parts.tables);
  lua_rawgeti(state, LUA_REGISTRYINDEX, parts.tables.machines[0].handle);
  lua_setfield(state, content, "m");
  parts.tables.snapshot = parts.snapshot_tables.open(state, parts.catalog);
  lua_rawgeti(state, LUA_REGISTRYINDEX, parts.tables.snapshot);
  lua_setfield(state, content, "s");
  parts.signals.push(state, "signals");
  lua_setfield(state, content, "signals");
  parts.parameters.push(state, "parameters");
  lua_setfield(state, content, "parameters");
  lua_settop(state, content);
}

// [-0 +1] { name = { state =, active =, outcome =, error =, parameters = } }
void push_behaviors(lua_State* state, const std::vector<ConsoleBehavior>& behaviors) {
  lua_newtable(state);
  for (const ConsoleBehavior& behavior : behaviors) {
    lua_newtable(state);
    set_field(state, "state", behavior.state.c_str());
    set_field(state, "outcome", behavior.outcome.c_str());
    set_field(state, "error", behavior.error.c_str());
    push_texts(state, behavior.active);
    lua_setfield(state, -2, "active");
    lua_newtable(state);
    for (const ScriptParameter& parameter : behavior.parameters)
      set_field(state, parameter.name.c_str(), parameter.value);
    make_read_only(state, "parameters");
    lua_setfield(state, -2, "parameters");
    make_read_only(state, "a behavior");
    lua_setfield(state, -2, behavior.name.c_str());
  }
  make_read_only(state, "behaviors");
}

// [-1 +1] From a value to the table that holds its fields; nil when it has none.
void to_fields(lua_State* state) {
  const int value = lua_gettop(state);
  if (lua_istable(state, value)) {
    if (push_content(state, value)) lua_remove(state, value);
    return;
  }
  if (lua_type(state, value) == LUA_TUSERDATA && lua_getmetatable(state, value) != 0) {
    lua_getfield(state, -1, "__index");
    if (lua_istable(state, -1) && push_content(state, lua_gettop(state))) {
      lua_replace(state, value);
      return lua_settop(state, value);
    }
  }
  lua_settop(state, value - 1);
  lua_pushnil(state);
}

struct Naming {
  Console::Parts& parts;
  std::vector<std::string> path{};  // before the last word
  std::string begin{};              // of the last word
  std::vector<std::string> found{};
};

// Adds the string keys of the table at the top that begin like the last word.
void add_names(lua_State* state, Naming& naming) {
  for (lua_pushnil(state); lua_next(state, -2) != 0; lua_pop(state, 1)) {
    if (lua_type(state, -2) != LUA_TSTRING) continue;
    const std::string_view name = lua_tostring(state, -2);
    if (name.starts_with(naming.begin)) naming.found.emplace_back(name);
  }
}

void find_names(lua_State* state, Naming& naming) {
  for (const int root : {naming.parts.environment, naming.parts.content}) {
    lua_settop(state, 1);
    lua_rawgeti(state, LUA_REGISTRYINDEX, root);
    for (const std::string& part : naming.path) {
      lua_pushlstring(state, part.data(), part.size());
      lua_rawget(state, -2);
      to_fields(state);
      if (lua_isnil(state, -1)) break;
    }
    if (lua_istable(state, -1)) add_names(state, naming);
  }
}

}  // namespace

ValueTree::ValueTree(const std::vector<std::string>& unsorted) : ids(unsorted.size()) {
  std::iota(ids.begin(), ids.end(), std::size_t{0});
  std::ranges::sort(ids, {}, [&](std::size_t id) -> const std::string& { return unsorted[id]; });
  for (const std::size_t id : ids) names.push_back(unsorted[id]);
}

namespace {

// [-0 +1] The table of names[first..last), which agree up to `from`; slots are at `slots` on the stack.
void push_branch(lua_State* state, const ValueTree& tree, std::size_t first, std::size_t last, std::size_t from,
                 int slots, const char* title) {
  luaL_checkstack(state, 8, "names");
  lua_newtable(state);
  const int table = lua_gettop(state);
  while (first < last) {
    const std::string& name = tree.names[first];
    const std::size_t dot = std::min(name.find('.', from), name.size());
    std::size_t end = first + 1;
    while (end < last && tree.names[end].compare(from, dot + 1 - from, name, from, dot - from + 1) == 0) ++end;
    lua_pushlstring(state, name.data() + from, dot - from);
    if (dot == name.size()) {
      end = first + 1;
      lua_pushvalue(state, table);
      lua_rawseti(state, slots, static_cast<int>(2 * first + 1));
      lua_pushvalue(state, -1);
      lua_rawseti(state, slots, static_cast<int>(2 * first + 2));
      lua_pushnumber(state, 0);
    } else {
      push_branch(state, tree, first, end, dot + 1, slots, title);
    }
    lua_rawset(state, table);
    first = end;
  }
  make_read_only(state, title);
}

}  // namespace

void ValueTree::push(lua_State* state, const char* title) {
  lua_newtable(state);
  push_branch(state, *this, 0, names.size(), 0, lua_gettop(state), title);
  lua_insert(state, -2);
  slots = luaL_ref(state, LUA_REGISTRYINDEX);
}

void ValueTree::refill(lua_State* state, std::span<const double> values) const {
  const int top = lua_gettop(state);
  lua_rawgeti(state, LUA_REGISTRYINDEX, slots);
  for (std::size_t i = 0; i < ids.size(); ++i) {
    lua_rawgeti(state, top + 1, static_cast<int>(2 * i + 1));
    lua_rawgeti(state, top + 1, static_cast<int>(2 * i + 2));
    lua_pushnumber(state, ids[i] < values.size() ? values[ids[i]] : 0);
    lua_rawset(state, top + 2);
    lua_settop(state, top + 1);
  }
  lua_settop(state, top);
}

// Makes the environment. Raises.
void open_console(lua_State* state, Console::Parts& parts) {
  push_new_content(state, parts);
  lua_pushvalue(state, -1);
  parts.content = luaL_ref(state, LUA_REGISTRYINDEX);
  const int content = lua_gettop(state);
  lua_newtable(state);
  lua_newtable(state);
  lua_pushvalue(state, content);
  lua_pushlightuserdata(state, &parts);
  lua_pushcclosure(state, look_up, 2);
  lua_setfield(state, -2, "__index");
  lua_pushboolean(state, 0);
  lua_setfield(state, -2, "__metatable");
  lua_setmetatable(state, -2);
  parts.environment = luaL_ref(state, LUA_REGISTRYINDEX);
  if (luaL_loadbuffer(state, show_text, std::char_traits<char>::length(show_text), "=show") != 0) lua_error(state);
  push_environment(state);
  lua_setfenv(state, -2);
  lua_call(state, 0, 1);
  parts.show = luaL_ref(state, LUA_REGISTRYINDEX);
}

// [-0 +0] Refills s, signals, parameters and behaviors.
void refill_console(lua_State* state, Console::Parts& parts, const Console::View& view) {
  parts.snapshot_tables.refill(view.snapshot, view.snapshot.time_ns);
  parts.signals.refill(state, view.signals);
  parts.parameters.refill(state, view.parameters);
  lua_rawgeti(state, LUA_REGISTRYINDEX, parts.content);
  push_behaviors(state, parts.behaviors);
  lua_setfield(state, -2, "behaviors");
  lua_pop(state, 1);
}

// The completions of the last part of a path such as "signals.plant.ba".
std::vector<std::string> console_names(Console::Parts& parts, const std::string& path) {
  Naming naming{parts};
  std::size_t from = 0;
  for (std::size_t at = path.find_first_of(".:"); at != std::string::npos; at = path.find_first_of(".:", from)) {
    naming.path.push_back(path.substr(from, at - from));
    from = at + 1;
  }
  naming.begin = path.substr(from);
  (void)parts.lua.call([&](lua_State* state) { find_names(state, naming); }, parts.settings.limits.tick_instructions,
                       0);
  std::ranges::sort(naming.found);
  naming.found.erase(std::unique(naming.found.begin(), naming.found.end()), naming.found.end());
  for (std::string& name : naming.found) name.insert(0, path, 0, from);
  return naming.found;
}

namespace {

Chart console_chart() {
  Chart chart;
  chart.name = "console";
  chart.states.emplace_back();
  chart.machines.emplace_back();
  chart.machines.front().name = "console";
  return chart;
}

struct Evaluation {
  Console::Parts& parts;
  const Console::View& view;
  const std::string& value;      // the text as what an expression gives
  const std::string& statement;  // the text as it is
  std::string text{};            // what it gives
  bool incomplete = false;
};

// [-0 +1] The line as a function in the console's environment. Raises what is wrong with it.
void push_line(lua_State* state, Evaluation& evaluation) {
  const auto load = [&](const std::string& text) {
    return luaL_loadbufferx(state, text.data(), text.size(), "@console", "t") == 0;
  };
  if (!load(evaluation.value)) {
    lua_pop(state, 1);
    if (!load(evaluation.statement)) {
      const std::string_view why = lua_tostring(state, -1);
      evaluation.incomplete = why.ends_with("'<eof>'");
      lua_error(state);
    }
  }
  lua_rawgeti(state, LUA_REGISTRYINDEX, evaluation.parts.environment);
  lua_setfenv(state, -2);
}

void evaluate_line(lua_State* state, Evaluation& evaluation) {
  push_line(state, evaluation);
  refill_console(state, evaluation.parts, evaluation.view);
  const int before = lua_gettop(state) - 1;
  lua_call(state, 0, LUA_MULTRET);
  const int results = lua_gettop(state) - before;
  if (results == 0) return;
  luaL_checkstack(state, results + 2, "too many values");
  lua_rawgeti(state, LUA_REGISTRYINDEX, evaluation.parts.show);
  lua_insert(state, before + 1);
  lua_call(state, results, 1);
  evaluation.text = lua_tostring(state, -1);
}

std::vector<ConsoleBehavior> behaviors_of(const ScriptHost& host) {
  std::vector<ConsoleBehavior> all;
  for (std::size_t i = 0; i < host.size(); ++i) {
    const Behavior& behavior = host.behavior(i);
    all.push_back({behavior.name(), behavior.state(), behavior.outcome(),
                   behavior.failed() ? behavior.error().text() : "", behavior.active(), behavior.parameters()});
  }
  return all;
}

constexpr double run_max_s = 1e6;

struct CommandInfo {
  const char* name;
  const char* argument;
  const char* doc;
};
constexpr CommandInfo commands[] = {
    {":help", "", "what can be typed here"},
    {":status", "", "what plays, and how what played ended"},
    {":why", " [NAME]", "why transitions of the active states were not taken: events, times, guards"},
    {":play", " LIST", "adds behaviors behind what plays: squat{depth_m=0.08}, wave"},
    {":replace", " LIST", "the same, in place of what plays"},
    {":pause", "", "behaviors and motions stand still"},
    {":resume", "", "they go on"},
    {":stop", "", "ends what plays"},
    {":run", " SECONDS", "simulates so long"},
    {":write", "", "lets lines command control objects: m.posture:move(\"stand\", { time_s = 1 })"},
    {":clear_faults", "", "lets the safety layer forget its faults, after :write"},
    {":read", "", "lets them read only, as at the beginning"},
    {":quit", "", "ends the console"},
};

constexpr const char* help_head =
    "A line is Lua; what it gives is printed. There is\n"
    "  s                       the snapshot that behaviors see: s.base.pitch_rad, s.joints.l_knee.position_rad\n"
    "  signals, parameters     by name: signals.plant.base.height_m, parameters.posture.l_knee.kp_Nm_per_rad\n"
    "  behaviors               by name: behaviors.squat.state, .active, .outcome, .error, .parameters\n"
    "  m, k                    control objects, after :write; k.pose(\"stand\")\n"
    "Commands:";

std::string help() {
  std::string text = help_head;
  for (const CommandInfo& command : commands) {
    std::string call = std::string("\n  ") + command.name + command.argument;
    call.resize(std::max<std::size_t>(call.size() + 1, 20), ' ');
    text += call + command.doc;
  }
  return text;
}

std::vector<std::string> command_names() {
  std::vector<std::string> names;
  for (const CommandInfo& command : commands) names.emplace_back(command.name);
  return names;
}

bool continues_word(char c) { return in_name(c) || c == '.' || c == ':'; }

Console::Reply run_for(const std::string& argument) {
  const std::optional<double> seconds = number_of<double>(argument);
  if (!seconds || !(*seconds > 0 && *seconds <= run_max_s))
    return {.text = ":run wants seconds, more than 0: :run 1.5", .error = true};
  return {.text = {}, .run_s = *seconds};
}

}  // namespace

Console::Parts::Parts(const Settings& wanted, const Catalog& offered, ScriptHost& plays)
    : settings(wanted),
      catalog(offered),
      host(plays),
      lua({.root = wanted.root,
           .folder = wanted.root / "behaviors" / wanted.folders.robot,
           .name = "console",
           .seed = 1,
           .limits = wanted.limits,
           .voice = this}),
      chart(console_chart()),
      signals(offered.signals.names()),
      parameters(offered.parameters.names()) {
  bindings.catalog = &catalog;
  lua.core().bindings = &bindings;
}

Console::Console(const Settings& settings, const Catalog& catalog, ScriptHost& host)
    : parts_(std::make_unique<Parts>(settings, catalog, host)) {
  const auto open = [this](lua_State* state) { open_console(state, *parts_); };
  if (!parts_->lua.call(open, settings.limits.load_instructions, settings.limits.load_wall_ns))
    refuse("the console: " + parts_->lua.error().text());
}

Console::~Console() = default;

bool Console::writes() const noexcept { return parts_->writes; }

Console::Reply Console::evaluate(std::string_view line, const View& view) noexcept {
  Parts& parts = *parts_;
  ++parts.line_number;
  const std::size_t first = line.find_first_not_of(" \t\r");
  if (parts.pending.empty()) {
    if (first == std::string_view::npos) return {};
    parts.pending_line = parts.line_number;
    if (line[first] == ':') {
      const Reply reply = command(std::string(line), view);
      return parts.pending.empty() ? reply : run_lua(view);
    }
  } else {
    parts.pending += '\n';
  }
  parts.pending += line;
  return run_lua(view);
}

Console::Reply Console::run_lua(const View& view) noexcept {
  Parts& parts = *parts_;
  const std::string lines(static_cast<std::size_t>(parts.pending_line - 1), '\n');  // so that messages count right
  const std::string value = lines + "return " + parts.pending, statement = lines + parts.pending;
  parts.behaviors = behaviors_of(parts.host);
  parts.printed.clear();
  Evaluation evaluation{parts, view, value, statement};
  CommandSender& sender = parts.writes ? view.commands : parts.nowhere;
  const std::uint32_t nothing_sent = parts.nowhere.last_sequence();
  parts.bindings.begin(sender, view.snapshot, view.snapshot.time_ns);
  const ScriptLimits& limits = parts.settings.limits;
  const bool done = parts.lua.call([&](lua_State* state) { evaluate_line(state, evaluation); },
                                   limits.tick_instructions, limits.tick_wall_ns);
  Reply reply;
  if (evaluation.incomplete) return sender.discard(), Reply{.text = {}, .incomplete = true};
  parts.pending.clear();
  if (!done) {
    sender.discard();
    reply = {.text = parts.printed + parts.lua.error().text(), .error = true};
  } else if (!parts.bindings.commit()) {
    reply = {.text = parts.printed + "queue_full: what this line commanded was refused, all of it", .error = true};
  } else if (parts.nowhere.last_sequence() != nothing_sent) {
    for (Command dropped; parts.nowhere_queue.try_pop(dropped);) {
    }
    reply = {.text = parts.printed + "this console only reads: nothing was sent; ':write' lets it command",
             .error = true};
  } else {
    if (parts.writes) parts.host.note(view.snapshot, sender);
    reply.text = parts.printed + evaluation.text;
    if (evaluation.text.empty() && reply.text.ends_with('\n')) reply.text.pop_back();
  }
  parts.lua.collect();
  return reply;
}

Console::Reply Console::order(PlayOrder::Kind kind, const std::string& line, std::size_t begin) noexcept {
  try {
    PlayOrder order{.kind = kind};
    if (kind == PlayOrder::Kind::play || kind == PlayOrder::Kind::replace) {
      Problems problems("console");
      const TextPlace start{parts_->line_number, static_cast<int>(begin) + 1};
      order.list = read_play_items(line.substr(begin), start, parts_->settings.folders, problems);
      problems.throw_if_any();
    }
    parts_->host.order(order);
  } catch (const std::exception& error) {
    return {.text = error.what(), .error = true};
  }
  return {};
}

std::string Console::status() const {
  const ScriptHost& host = parts_->host;
  std::string text = host.paused() ? "paused" : host.finished() ? "nothing plays" : "plays";
  for (std::size_t i = 0; i < host.size(); ++i) {
    const Behavior& behavior = host.behavior(i);
    const std::string outcome = behavior.outcome(), active = listed(behavior.active());
    text += "\n  " + behavior.name() + ": ";
    text += !outcome.empty() ? outcome : host.over(i) ? "stopped" : active.empty() ? "waits" : "in " + active;
    if (behavior.failed()) text += ", " + behavior.error().text();
  }
  return text;
}

Console::Reply Console::why(const std::string& name, const View& view) const noexcept {
  try {
    return {.text = reasons_text(parts_->host.why(name, view.snapshot))};
  } catch (const std::exception& error) {
    return {.text = error.what(), .error = true};
  }
}

Console::Reply Console::command(const std::string& line, const View& view) noexcept {
  const std::size_t first = line.find(':');
  const std::size_t end = std::min(line.find_first_of(" \t\r", first), line.size());
  const std::string name = line.substr(first, end - first);
  const std::size_t begin = std::min(line.find_first_not_of(" \t\r", end), line.size());
  std::string argument = line.substr(begin);
  argument.resize(argument.find_last_not_of(" \t\r") + 1);
  const auto known = std::ranges::find(commands, name, [](const CommandInfo& command) { return command.name; });
  if (known == std::end(commands)) {
    return {.text = "unknown command '" + name + "'" + did_you_mean(name, command_names()) + " (:help lists them)",
            .error = true};
  }
  if (*known->argument == '\0' && !argument.empty()) return {.text = name + " takes no argument", .error = true};
  if (name == ":help") return {.text = help()};
  if (name == ":status") return {.text = status()};
  if (name == ":why") return why(argument, view);
  if (name == ":quit") return {.text = {}, .quit = true};
  if (name == ":clear_faults") {
    parts_->pending = "local asked = m:clear_faults()";
    return {};
  }
  if (name == ":run") return run_for(argument);
  if (name == ":write" || name == ":read") {
    parts_->writes = name == ":write";
    return {.text = parts_->writes ? "m commands control objects from here on; :read locks it" : "m is locked"};
  }
  const auto kind = std::ranges::find(play_order_names, name.substr(1)) - play_order_names.begin();
  return order(static_cast<PlayOrder::Kind>(kind), line, begin);
}

Console::Completion Console::complete(std::string_view text) noexcept {
  Completion completion{.begin = text.size(), .words = {}};
  while (completion.begin > 0 && continues_word(text[completion.begin - 1])) --completion.begin;
  const std::string word(text.substr(completion.begin));
  const std::size_t first = std::min(text.find_first_not_of(" \t"), text.size());
  const auto keep = [&](const std::vector<std::string>& names) {
    for (const std::string& name : names) {
      if (name.starts_with(word)) completion.words.push_back(name);
    }
  };
  if (first == completion.begin && word.starts_with(':')) {
    keep(command_names());
  } else if (text.substr(first).starts_with(":play ") || text.substr(first).starts_with(":replace ")) {
    keep(playable_names(parts_->settings.folders));
  } else {
    completion.words = console_names(*parts_, word);
  }
  return completion;
}

}  // namespace kadans
