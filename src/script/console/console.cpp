#include "console.h"

#include <algorithm>
#include <exception>
#include <iterator>

#include "console_parts.h"
#include "kadans/signal/input_error.h"
#include "script/sandbox/sandbox.h"
#include "signal/nearest_name.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

std::vector<std::string> parameter_names(const ParameterTable& table) {
  std::vector<std::string> names;
  for (ParameterId id = 0; id < table.size(); ++id) names.push_back(table.info(id).name);
  return names;
}

std::vector<std::string> signal_names(const SignalTable& table) {
  std::vector<std::string> names;
  for (SignalId id = 0; id < table.size(); ++id) names.push_back(table.info(id).name);
  return names;
}

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

int evaluate_line(lua_State* state) {
  Evaluation& evaluation = *static_cast<Evaluation*>(lua_touserdata(state, 1));
  push_line(state, evaluation);
  refill_console(state, evaluation.parts, evaluation.view);
  const int before = lua_gettop(state) - 1;
  lua_call(state, 0, LUA_MULTRET);
  const int results = lua_gettop(state) - before;
  if (results == 0) return 0;
  luaL_checkstack(state, results + 2, "too many values");
  lua_rawgeti(state, LUA_REGISTRYINDEX, evaluation.parts.show);
  lua_insert(state, before + 1);
  lua_call(state, results, 1);
  evaluation.text = lua_tostring(state, -1);
  return 0;
}

std::vector<ConsoleBehavior> behaviors_of(const ScriptHost& host) {
  std::vector<ConsoleBehavior> all;
  for (std::size_t i = 0; i < host.size(); ++i) {
    const Behavior& behavior = host.behavior(i);
    all.push_back({behavior.name(), behavior.state(), behavior.outcome(),
                   behavior.failed() ? behavior.error().text() : "", behavior.parameters()});
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
    "  behaviors               by name: behaviors.squat.state, .outcome, .error, .parameters\n"
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

bool continues_word(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '.' || c == ':';
}

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
      signals(signal_names(offered.signals)),
      parameters(parameter_names(offered.parameters)) {
  bindings.catalog = &catalog;
  lua.core().bindings = &bindings;
}

Console::Console(const Settings& settings, const Catalog& catalog, ScriptHost& host)
    : parts_(std::make_unique<Parts>(settings, catalog, host)) {
  if (!parts_->lua.call(open_console, parts_.get(), settings.limits.load_instructions, settings.limits.load_wall_ns))
    throw InputError({.message = "the console: " + parts_->lua.error().text()});
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
      const Reply reply = command(std::string(line));
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
  const bool done = parts.lua.call(evaluate_line, &evaluation, limits.tick_instructions, limits.tick_wall_ns);
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
    const std::string outcome = behavior.outcome(), state = behavior.state();
    text += "\n  " + behavior.name() + ": ";
    text += !outcome.empty() ? outcome : host.over(i) ? "stopped" : state.empty() ? "waits" : "in " + state;
    if (behavior.failed()) text += ", " + behavior.error().text();
  }
  return text;
}

Console::Reply Console::command(const std::string& line) noexcept {
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
