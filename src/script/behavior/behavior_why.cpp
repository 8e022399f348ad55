#include "behavior_why.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <optional>

#include "behavior_parts.h"
#include "script/chart/chart_graph.h"
#include "script/check/source_lexer.h"
#include "script/lua/lua_core.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

constexpr std::size_t reasons_max = 200, paths_max = 8;
constexpr std::int64_t asking_wall_ns = 20'000'000;

// What a guard reads, "s.base.pitch_rad", and its value as text.
struct Seen {
  std::string path;
  bool of_snapshot = true;  // else of m
  std::string_view fields;  // of the path, behind the first dot
  std::array<char, 64> value{};
};

struct Question {
  std::uint16_t transition = 0;
  bool asked = false, yes = false;
  std::array<char, 200> value{};  // what the guard gave, or raised
  std::vector<Seen> seen{};
};

struct Asking {
  Behavior::Parts& parts;
  std::vector<Question> questions{};
  Question* now = nullptr;
  Seen* look = nullptr;
};

void put_value(lua_State* state, int index, char* to, std::size_t size) {
  switch (lua_type(state, index)) {
    case LUA_TNUMBER:
      std::snprintf(to, size, "%.6g", lua_tonumber(state, index));
      return;
    case LUA_TBOOLEAN:
      std::snprintf(to, size, "%s", lua_toboolean(state, index) != 0 ? "true" : "false");
      return;
    case LUA_TSTRING:
      std::snprintf(to, size, "\"%s\"", lua_tostring(state, index));
      return;
    default:
      std::snprintf(to, size, "%s", luaL_typename(state, index));
  }
}

// Raises where there is no such field.
int look_up_field(lua_State* state) {
  const Asking& asking = *static_cast<const Asking*>(lua_touserdata(state, 1));
  const Chart::State& source = asking.parts.chart.states[asking.parts.chart.transitions[asking.now->transition].source];
  const RunnerTables& tables = asking.parts.tables;
  lua_rawgeti(state, LUA_REGISTRYINDEX,
              asking.look->of_snapshot ? tables.snapshot : tables.machines[source.machine].handle);
  for (std::string_view rest = asking.look->fields; !rest.empty();) {
    const std::size_t dot = std::min(rest.find('.'), rest.size());
    lua_pushlstring(state, rest.data(), dot);
    lua_gettable(state, -2);
    lua_remove(state, -2);
    rest.remove_prefix(std::min(dot + 1, rest.size()));
  }
  const int type = lua_type(state, -1);
  if (type == LUA_TNUMBER || type == LUA_TBOOLEAN || type == LUA_TSTRING || type == LUA_TNIL)
    put_value(state, -1, asking.look->value.data(), asking.look->value.size());
  return 0;
}

int ask_guard(lua_State* state) {
  const Asking& asking = *static_cast<const Asking*>(lua_touserdata(state, 1));
  asking.parts.runner->call_guard(state, asking.now->transition);
  asking.now->yes = lua_toboolean(state, -1) != 0;
  put_value(state, -1, asking.now->value.data(), asking.now->value.size());
  return 0;
}

void ask_guards(lua_State* state, Asking& asking) {
  const auto attempt = [&](lua_CFunction function) {
    lua_pushcfunction(state, function);
    lua_pushlightuserdata(state, &asking);
    const bool done = lua_pcall(state, 1, 0, 0) == 0;
    core_of(state).budget.raise_again(state);
    return done;
  };
  for (Question& question : asking.questions) {
    asking.now = &question;
    if (asking.parts.chart.transitions[question.transition].when == Chart::no_function) continue;
    for (Seen& seen : question.seen) {
      asking.look = &seen;
      if (!attempt(look_up_field)) lua_settop(state, 1);
    }
    question.asked = true;
    std::snprintf(question.value.data(), question.value.size(), "no answer within its budget");
    if (attempt(ask_guard)) continue;
    const char* raised = lua_tostring(state, -1);
    std::snprintf(question.value.data(), question.value.size(), "raises: %s", raised != nullptr ? raised : "an error");
    lua_settop(state, 1);
  }
}

std::string shown_lines(const std::string& text, int first, int last) {
  std::vector<std::string> lines;
  std::size_t common = std::string::npos;
  for (int line = first; line <= last && lines.size() < GuardSource::lines_max; ++line) {
    lines.emplace_back(line_of_text(text, line));
    common = std::min(common, lines.back().find_first_not_of(" \t"));
  }
  std::string all;
  for (std::string& line : lines) {
    line.erase(0, std::min(common, line.size()));
    if (line.size() > GuardSource::line_max) line = line.substr(0, GuardSource::line_max - 3) + "...";
    all += (all.empty() ? "" : "\n") + line;
  }
  if (last - first + 1 > static_cast<int>(GuardSource::lines_max)) all += "\n...";
  return all;
}

struct FunctionLines {
  const LuaState::Source* source = nullptr;  // null: there is no function, or no text of it
  int first = 0, last = 0;
};

FunctionLines lines_of(const Behavior::Parts& parts, int function) {
  lua_State* state = parts.lua->get();
  if (function == Chart::no_function || lua_checkstack(state, 2) == 0) return {};
  lua_Debug place{};
  lua_rawgeti(state, LUA_REGISTRYINDEX, function);
  lua_getinfo(state, ">S", &place);
  for (const LuaState::Source& source : parts.lua->sources()) {
    if (place.linedefined <= 0 || source.chunk != std::string_view(place.source).substr(1)) continue;
    return {&source, place.linedefined, place.lastlinedefined};
  }
  return {};
}

GuardSource source_of(const Behavior::Parts& parts, int function) {
  const FunctionLines lines = lines_of(parts, function);
  if (lines.source == nullptr) return {};
  return {lines.source->chunk, lines.first, shown_lines(lines.source->text, lines.first, lines.last)};
}

// The fields of the function's arguments, s and m as a rule, that stand in a guard's lines; no calls.
std::vector<Seen> fields_read(const FunctionLines& lines) {
  Tokens tokens = lines.source != nullptr ? lex_source(lines.source->text) : Tokens();
  std::erase_if(tokens, [&](const SourceToken& one) { return one.line < lines.first || one.line > lines.last; });
  tokens.resize(tokens.size() + 5, SourceToken{TokenKind::end, "", lines.last});
  std::size_t open = 0;
  while (!tokens[open].is("function") && tokens[open].kind != TokenKind::end) ++open;
  while (!tokens[open].is("(") && tokens[open].kind != TokenKind::end) ++open;
  const std::string snapshot = tokens[open + 1].text, machine = tokens[open + 2].is(",") ? tokens[open + 3].text : "";
  std::vector<Seen> all;
  for (std::size_t i = open; tokens[i].kind != TokenKind::end && all.size() < paths_max; ++i) {
    const bool of_snapshot = tokens[i].is_name(snapshot);
    if ((!of_snapshot && !tokens[i].is_name(machine)) || tokens[i - 1].is(".")) continue;
    std::string path = tokens[i].text;
    const std::size_t first = i;
    for (; tokens[i + 1].is(".") && tokens[i + 2].kind == TokenKind::name; i += 2) path += "." + tokens[i + 2].text;
    const bool known = std::ranges::find(all, path, &Seen::path) != all.end();
    if (i > first && !tokens[i + 1].is_any({"(", ":", "["}) && !known)
      all.push_back({.path = path, .of_snapshot = of_snapshot, .fields = {}});
  }
  return all;
}

void add(std::string& to, const std::string& clause) { to += (to.empty() ? "" : "; ") + clause; }

// What speaks against a transition; "": nothing.
std::string why_not(const Behavior::Parts& parts, const Question& question) {
  const Chart::Transition& transition = parts.chart.transitions[question.transition];
  std::string why;
  if (transition.on == run_done_event && !parts.runner->run_done(transition.source)) add(why, "`run` is not over");
  if (transition.on != no_event && transition.on != run_done_event)
    add(why, "no event '" + parts.chart.events[static_cast<std::size_t>(transition.on)] + "'");
  if (transition.timed) {
    const double after_s = parts.runner->after_s(parts.lua->get(), transition);
    const double left_s = after_s - parts.runner->state_time_s(transition.source);
    if (left_s > 0) add(why, printed("%.2f s left of %g s", left_s, after_s));
  }
  if (question.asked && !question.yes) {
    const std::string value = question.value.data();
    add(why, value.starts_with("raises") ? "the guard " + value : "the guard gives " + value);
  }
  return why;
}

// Those of a state that are looked at while it is active.
void add_questions(const Behavior::Parts& parts, StateIndex index, std::vector<Question>& to) {
  const Chart::State& state = parts.chart.states[index];
  const auto add_all = [&](std::uint16_t first, std::uint16_t count) {
    for (std::uint16_t i = 0; i < count && to.size() < reasons_max; ++i)
      to.push_back({.transition = static_cast<std::uint16_t>(first + i)});
  };
  add_all(state.first_always, state.always_count);
  add_all(state.first_transition, state.transition_count);
}

}  // namespace

std::vector<GuardSource> Behavior::guards() const {
  std::vector<GuardSource> all;
  for (const Chart::Transition& transition : chart().transitions) all.push_back(source_of(*parts_, transition.when));
  return all;
}

std::vector<TransitionReason> Behavior::why(const Snapshot& snapshot) const {
  if (failed() || finished() || !parts_->runner->started()) return {};
  BehaviorLog silence;
  Parts copy(parts_->settings, parts_->catalog, silence);
  copy.bindings.held_ns = parts_->bindings.held_ns;
  copy.bindings.now_ns = clock_ns(snapshot);
  load_behavior(copy, copy.settings.limits.reload_instructions);
  if (!std::ranges::equal(copy.lua->sources(), parts_->lua->sources(), {}, &LuaState::Source::text,
                          &LuaState::Source::text))
    throw InputError({.message = name() + ": its files have changed since they were read; reload it first"});
  ByteWriter kept;
  (void)keep_behavior(*parts_, kept);
  ByteReader bytes(kept.bytes());
  const auto nowhere = std::make_unique<CommandQueue>();
  CommandSender sender(*nowhere);
  if (!go_on_with(copy, bytes, snapshot, sender, copy.settings.limits.reload_instructions, false))
    throw InputError({.message = name() + ": its guards cannot be tried: " + copy.error.text()});

  Asking asking{copy};
  for (const StateIndex index : copy.runner->active_states()) add_questions(copy, index, asking.questions);
  for (Question& question : asking.questions) {
    question.seen = fields_read(lines_of(copy, copy.chart.transitions[question.transition].when));
    for (Seen& seen : question.seen) seen.fields = std::string_view(seen.path).substr(seen.path.find('.') + 1);
  }
  const ScriptLimits& limits = copy.settings.limits;
  const bool asked = copy.lua->call([&](lua_State* state) { ask_guards(state, asking); }, limits.tick_instructions,
                                    limits.tick_wall_ns > 0 ? asking_wall_ns : 0);
  sender.discard();

  std::vector<TransitionReason> reasons;
  const std::vector<ScriptParameter> own = parameters();
  for (const Question& question : asking.questions) {
    const Chart::Transition& transition = copy.chart.transitions[question.transition];
    TransitionReason reason{.transition = question.transition,
                            .from = copy.chart.states[transition.source].path,
                            .to = transition.target == no_state ? "" : copy.chart.states[transition.target].path,
                            .label = transition_label(copy.chart, transition, own),
                            .why = why_not(copy, question),
                            .guard = source_of(copy, transition.when)};
    if (transition.when != Chart::no_function && !question.asked)
      add(reason.why, asked ? "its guard was not asked" : "its guard was not asked: " + copy.lua->error().text());
    reason.free = reason.why.empty();
    for (const Seen& seen : question.seen) {
      if (seen.value[0] != '\0') reason.saw += (reason.saw.empty() ? "" : ", ") + seen.path + " = " + seen.value.data();
    }
    reasons.push_back(std::move(reason));
  }
  return reasons;
}

namespace {

std::string reason_text(const TransitionReason& reason) {
  std::string text = "\n  " + (reason.from.empty() ? "any state" : reason.from) + " -> " + reason.to;
  text += (reason.label.empty() ? "" : "  " + reason.label) + ": ";
  text += reason.free ? "nothing holds it back" : reason.why;
  if (reason.guard.file.empty()) return text;
  text += "\n      " + reason.guard.file + ":" + std::to_string(reason.guard.line) + "  ";
  for (const char c : reason.guard.text) text += c == '\n' ? std::string("\n        ") : std::string(1, c);
  return text + (reason.saw.empty() ? "" : "\n      " + reason.saw);
}

}  // namespace

std::string reasons_text(const std::vector<BehaviorReasons>& behaviors) {
  std::string text;
  for (const BehaviorReasons& behavior : behaviors) {
    text += (text.empty() ? "" : "\n") + behavior.name;
    if (behavior.transitions.empty()) text += ": no transition waits";
    for (const TransitionReason& reason : behavior.transitions) text += reason_text(reason);
  }
  return text.empty() ? "nothing plays" : text;
}

}  // namespace kadans
