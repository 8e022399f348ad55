#include "console.h"

#include <exception>

#include "console_parts.h"
#include "kadans/signal/input_error.h"
#include "script/sandbox/sandbox.h"

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

}  // namespace kadans
