#include "foreign_words.h"

#include <algorithm>
#include <cctype>
#include <iterator>

namespace kadans {
namespace {

const ForeignWords foreign_names[] = {
    {{"null", "None", "NULL", "nullptr", "undefined", "Nil"}, ": Lua writes nil"},
    {{"True", "TRUE"}, ": Lua writes true"},
    {{"False", "FALSE"}, ": Lua writes false"},
    {{"self", "this"}, ": the functions of a state get m and s: function(m, s)"},
    {{"sleep", "wait", "delay", "usleep", "msleep", "setTimeout"},
     ": write m:wait(seconds) inside run, or a transition with after = seconds"},
    {{"os", "time", "clock", "millis", "now"},
     ": the time is m.time_s, since the state was entered, or s.time_s, of the engine"},
    {{"io", "open", "file"}, ": a behavior opens no files; k.params takes values, k.log.info writes lines"},
    {{"printf", "console", "fprintf", "echo", "puts", "log", "logging"},
     ": write k.log.info(format, ...) or print(...)"},
    {{"len"}, ": write #list"},
    {{"range"}, ": write for i = 1, n do"},
    {{"str"}, ": write tostring(x)"},
    {{"int", "float", "double", "bool", "var", "let", "const", "auto"}, ": Lua writes local x = ..."},
    {{"def", "func", "fn", "lambda"}, ": Lua writes function(m) ... end"},
    {{"switch", "case", "default"}, ": Lua has no switch: write if ... elseif ... end"},
    {{"elif", "elsif"}, ": Lua writes elseif"},
    {{"continue"}, ": Lua has no continue: put the rest of the loop into an if"},
    {{"try", "catch", "except", "throw", "raise"}, ": an error is raised by error(text)"},
    {{"import", "include", "from", "using"}, ": write local name = require \"name\""},
    {{"abs",  "sin",  "cos",   "tan", "sqrt", "min",  "max",  "floor", "ceil", "asin",
      "acos", "atan", "atan2", "pi",  "exp",  "huge", "fabs", "pow",   "fmod", "random"},
     ": it is a field of math: math.pi, math.sin(x)"},
    {{"rad", "deg", "radians", "degrees", "deg2rad", "rad2deg"}, ": write math.rad(degrees)"},
    {{"m"}, ": only functions have it: function(m, s) in enter, exit, during, run and action, function(s, m) in when"},
    {{"s"}, ": only functions have it: function(s, m) in when, function(m, s) in enter, exit, during, run and action"},
    {{"k", "kadans"}, ": write local k = require \"kadans\" at the top"},
    {{"P", "params"}, ": write local P = k.params { ... } at the top"},
    {{"state", "behavior", "final", "parallel", "region", "history", "call", "pose"}, ": write it with k., as k.state"},
    {{"joints", "base", "feet", "safety", "joystick", "support", "odometry", "seen"}, ": it is a field of s: s.base"},
    {{"vars"}, ": it is a field of m: m.vars"},
    {{"args", "arg"}, ": the arguments are a field of m: m.args"},
    {{"time_s"}, ": it is a field of m: m.time_s"},
    {{"emit", "send", "publish"}, ": write m:emit(\"name\")"},
    {{"event"}, ": it is a field of s: s.event"},
};

const ForeignWords foreign_keys[] = {
    {{"event", "events", "trigger", "signal", "message"}, "on"},
    {{"target", "next", "dest", "dst", "destination", "goto_state", "state"}, "to"},
    {{"guard", "cond", "condition", "predicate", "check"}, "when"},
    {{"timeout", "delay", "after_s", "time_s", "time"}, "after"},
    {{"effect", "actions", "exec"}, "action"},
    {{"reason", "label", "comment"}, "why"},
    {{"entry", "on_entry", "onentry", "on_enter", "onEnter", "start", "setup", "init"}, "enter"},
    {{"on_exit", "onexit", "onExit", "leave", "on_leave", "stop", "cleanup"}, "exit"},
    {{"update", "doo", "tick", "step", "loop", "each_tick", "do_activity", "execute"}, "during"},
    {{"coroutine", "thread", "body", "main", "task", "script"}, "run"},
    {{"start_state", "first", "initial_state"}, "initial"},
    {{"common", "common_transition", "any", "global"}, "always"},
    {{"result", "outcome_name", "status"}, "outcome"},
    {{"data", "variables", "locals", "datamodel"}, "vars"},
    {{"set", "controllers", "control_set"}, "controls"},
    {{"values", "choices", "options", "enum", "allowed"}, "one_of"},
    {{"arguments", "parameters", "params"}, "args"},
};

struct ForeignField {
  std::string_view owner;
  std::initializer_list<std::string_view> names;
  std::string_view hint;
};

const ForeignField foreign_fields[] = {
    {"m", {"event"}, ": it is a field of s: s.event"},
    {"m", {"call", "play", "start"}, ": a state calls a behavior: k.call \"name\" { ... } in its table"},
    {"m",
     {"wait_for", "wait_event", "on_event"},
     ": a transition waits for an event: { on = \"name\", to = \"state\" }"},
    {"m", {"send", "publish", "raise", "fire", "trigger"}, ", did you mean 'emit'?"},
    {"m", {"final", "finish", "done", "stop"}, ": a behavior ends in a state: { to = \"over\" } and k.final \"over\""},
    {"kadans", {"emit", "send", "publish"}, ": write m:emit(\"name\")"},
    {"s.event", {"result"}, ": it is a field of the event's data: s.event.data.result"},
    {"s.event", {"outcome"}, ": the outcome is the event's name: { on = \"done\" }, s.event.name"},
};

const ForeignWords foreign_types[] = {
    {{"bool", "boolean", "flag"}, "k.flag"},
    {{"string", "text", "str"}, "k.text"},
    {{"number", "int", "integer", "float", "double"}, "its unit, \"\" for none"},
};

constexpr std::string_view list_keys[] = {"states", "transitions", "children", "substates", "regions",
                                          "trans",  "finals",      "substate", "machines",  "transition"};

constexpr std::string_view text_keys[] = {"to", "on", "initial", "outcome", "controls", "why"};  // values are texts

constexpr std::string_view of_machine[] = {"vars", "args", "wait", "emit", "clear_faults", "reset_odometry"};
constexpr std::string_view of_snapshot[] = {"base",   "joints",   "feet", "support", "odometry",
                                            "safety", "joystick", "seen", "sensors"};

}  // namespace

std::string_view text_of(std::span<const ForeignWords> table, std::string_view word) noexcept {
  const auto has = [&](const ForeignWords& one) { return std::ranges::find(one.words, word) != one.words.end(); };
  const auto found = std::ranges::find_if(table, has);
  return found == table.end() ? std::string_view{} : found->text;
}

std::string_view foreign_name_hint(std::string_view name) noexcept {
  if (std::ranges::any_of(name, [](char c) { return static_cast<unsigned char>(c) >= 0x80; }))
    return ": texts stand in plain quotes, names have plain letters";
  return text_of(foreign_names, name);
}

std::string_view foreign_key(std::string_view key) noexcept { return text_of(foreign_keys, key); }

bool names_a_list(std::string_view key) noexcept { return std::ranges::find(list_keys, key) != std::end(list_keys); }

std::string_view unquoted_value_key(std::string_view line, std::string_view name) noexcept {
  const auto trim = [&](std::string_view text) { return text.substr(0, text.find_last_not_of(" \t") + 1); };
  for (std::size_t at = line.find(name); at != std::string_view::npos; at = line.find(name, at + 1)) {
    std::string_view before = trim(line.substr(0, at));
    if (!before.ends_with('=')) continue;
    before = trim(before.substr(0, before.size() - 1));
    for (const std::string_view key : text_keys) {
      if (!before.ends_with(key)) continue;
      const std::size_t begin = before.size() - key.size();
      const bool whole = begin == 0 || std::isalnum(static_cast<unsigned char>(before[begin - 1])) == 0;
      if (whole && (begin == 0 || before[begin - 1] != '_')) return key;
    }
  }
  return {};
}

std::string_view foreign_transition(std::string_view key) noexcept {
  const bool event = key == "on_done" || key == "on_error" || key == "on_refused" || key == "on_event" || key == "on";
  return event ? std::string_view(": a transition is a table of its own: { on = \"event\", to = \"state\" }")
               : std::string_view{};
}

std::string_view foreign_type(std::string_view unit) noexcept { return text_of(foreign_types, unit); }

std::string_view foreign_field_hint(std::string_view owner, std::string_view field) noexcept {
  const bool swapped = (owner == "s" && std::ranges::find(of_machine, field) != std::end(of_machine)) ||
                       (owner == "m" && std::ranges::find(of_snapshot, field) != std::end(of_snapshot));
  if (swapped) return order_hint;
  for (const ForeignField& one : foreign_fields)
    if (one.owner == owner && std::ranges::find(one.names, field) != one.names.end()) return one.hint;
  return {};
}

}  // namespace kadans
