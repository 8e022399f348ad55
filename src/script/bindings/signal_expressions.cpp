#include "signal_expressions.h"

#include <algorithm>
#include <array>
#include <cctype>

#include "kadans/signal/nearest_name.h"
#include "script/check/source_lexer.h"
#include "script/lua/lua_core.h"
#include "script/lua/lua_state.h"
#include "script/sandbox/sandbox.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

constexpr std::uint64_t evaluation_instructions = 100'000;
constexpr std::uint64_t compilation_instructions = 10'000;
constexpr std::array<std::string_view, 6> lua_words{"and", "or", "not", "true", "false", "nil"};
constexpr std::array<std::string_view, 9> expression_functions{"abs",  "min", "max", "sqrt", "floor",
                                                               "ceil", "sin", "cos", "deg"};
constexpr std::string_view tick_before = "last.";

bool continues_name(char c) { return in_name(c) || c == '.'; }

// Where a number that begins at `at` ends: an exponent's letter is no name.
std::size_t number_end(std::string_view text, std::size_t at) {
  while (at < text.size()) {
    const bool sign = (text[at] == '-' || text[at] == '+') && (text[at - 1] == 'e' || text[at - 1] == 'E');
    if (!continues_name(text[at]) && !sign) break;
    ++at;
  }
  return at;
}

std::optional<SignalId> find_signal(const SignalTable& signals, std::string_view name) {
  if (const auto id = signals.find(name)) return id;
  return signals.find("plant." + std::string(name));
}

// Where the longest name of a signal ends that begins at `at` and holds what is otherwise an operator; else where the
// dotted name does.
std::size_t name_end(const SignalTable& signals, std::string_view text, std::size_t at) {
  constexpr std::string_view ends = " \t\n()<>=~,\"'";
  std::size_t plain = at;
  while (plain < text.size() && continues_name(text[plain])) ++plain;
  std::size_t end = std::min(text.find_first_of(ends, at), text.size());
  for (; end > plain; --end) {
    if (end < text.size() && continues_name(text[end])) continue;  // in the middle of a word
    const std::string_view name = text.substr(at, end - at);
    if (find_signal(signals, name.starts_with(tick_before) ? name.substr(tick_before.size()) : name)) return end;
  }
  return plain;
}

// Its place in the table of values, from 1; it becomes one of the condition's signals and of those in use.
std::ptrdiff_t place_of(SignalId signal, std::vector<SignalId>& of_condition, std::vector<SignalId>& used) {
  if (std::ranges::find(of_condition, signal) == of_condition.end()) of_condition.push_back(signal);
  auto place = std::ranges::find(used, signal);
  if (place == used.end()) place = used.insert(place, signal);
  return place - used.begin() + 1;
}

}  // namespace

struct SignalExpressions::State {
  LuaState lua{{.root = {}, .folder = {}, .name = "conditions", .seed = 1, .limits = ScriptLimits{}, .voice = nullptr}};
  int values = LUA_NOREF;  // registry: the table of the signals' values, by place in `used_`
  int last = LUA_NOREF;    // registry: that of one tick before
  bool begun = false;
};

// [-0 +2] Raises when one gives no value of its kind.
void SignalExpressions::evaluate_all(lua_State* state, double time_s, std::span<const double> row) {
  lua_rawgeti(state, LUA_REGISTRYINDEX, state_->values);
  const int values = lua_gettop(state);
  lua_rawgeti(state, LUA_REGISTRYINDEX, state_->last);
  const int last = lua_gettop(state);
  const auto copy = [&](int from, int to, int i) {
    lua_rawgeti(state, from, i);
    lua_rawseti(state, to, i);
  };
  for (std::size_t place = 0; place < used_.size(); ++place) {
    const int i = static_cast<int>(place) + 1;
    if (state_->begun) copy(values, last, i);
    lua_pushnumber(state, row[used_[place]]);
    lua_rawseti(state, values, i);
    if (!state_->begun) copy(values, last, i);
  }
  state_->begun = true;
  for (failed_ = 0; failed_ < conditions_.size(); ++failed_) {
    Condition& condition = conditions_[failed_];
    lua_rawgeti(state, LUA_REGISTRYINDEX, condition.function);
    lua_pushvalue(state, values);
    lua_pushnumber(state, time_s);
    lua_pushvalue(state, last);
    lua_call(state, 3, 1);
    const bool number = condition.gives == Gives::number;
    if (lua_type(state, -1) != (number ? LUA_TNUMBER : LUA_TBOOLEAN))
      luaL_error(state, "'%s' gives a %s, wanted %s", condition.text.c_str(), luaL_typename(state, -1),
                 number ? "a number" : "true or false");
    condition.value = number ? lua_tonumber(state, -1) : lua_toboolean(state, -1);
    lua_pop(state, 1);
  }
}

SignalExpressions::SignalExpressions(const SignalTable& signals, std::span<const SignalState> states)
    : signals_(signals), states_(states), state_(std::make_unique<State>()) {}

SignalExpressions::~SignalExpressions() = default;

// From behind the word `state` on: ("PATH"). It becomes a question about the signals of the behaviors that have it.
bool SignalExpressions::translate_state(std::string_view text, std::size_t& at, Condition& condition,
                                        std::vector<SignalId>& used, std::string& lua, ExpressionError& error) const {
  const auto after = [&](std::size_t from) { return std::min(text.find_first_not_of(" \t", from), text.size()); };
  const std::size_t open = after(at);
  const std::size_t quote = open < text.size() && text[open] == '(' ? after(open + 1) : text.size();
  const bool quoted = quote < text.size() && (text[quote] == '"' || text[quote] == '\'');
  const std::size_t end = quoted ? text.find(text[quote], quote + 1) : std::string_view::npos;
  const std::size_t close = end == std::string_view::npos ? text.size() : after(end + 1);
  if (close == text.size() || text[close] != ')') {
    error = {static_cast<int>(at) + 1, "state wants the path of a state in quotes: state(\"act.arm\")"};
    return false;
  }
  const std::string path(text.substr(quote + 1, end - quote - 1));
  std::string any;
  for (const SignalState& state : states_) {
    const auto names = state.names();
    if (std::ranges::find(names, path) == names.end()) continue;
    const std::string value = "values[" + std::to_string(place_of(state.signal, condition.signals, used)) + "]";
    any += (any.empty() ? "(" : " or ") + value + " >= " + number_text(state.first) + " and " + value + " < " +
           number_text(state.end);
  }
  if (any.empty()) {
    std::vector<std::string> known;
    for (const SignalState& state : states_) {
      for (std::string& name : state.names()) known.push_back(std::move(name));
    }
    error = {static_cast<int>(quote) + 2, states_.empty()
                                              ? "no states are known here: what plays is not loaded in this process"
                                              : "no behavior has the state '" + path + "'" + did_you_mean(path, known)};
    return false;
  }
  lua += any + ")";
  at = close + 1;
  return true;
}

// Puts values[n] where a signal's name stands.
bool SignalExpressions::translate(std::string_view text, Condition& condition, std::string& lua,
                                  ExpressionError& error) const {
  std::vector<SignalId> used = used_;
  for (std::size_t at = 0; at < text.size();) {
    const bool digit = std::isdigit(static_cast<unsigned char>(text[at])) != 0;
    const std::size_t begin = at;
    if (digit) {
      at = number_end(text, at + 1);
    } else if (starts_name(text[at])) {
      at = name_end(signals_, text, at);
    } else {
      ++at;
    }
    const std::string_view word = text.substr(begin, at - begin);
    if (digit || !starts_name(word[0]) || word == "time_s" || std::ranges::find(lua_words, word) != lua_words.end()) {
      lua += word;
      continue;
    }
    if (std::ranges::find(expression_functions, word) != expression_functions.end()) {
      lua += "math." + std::string(word);
      continue;
    }
    if (word == "state") {
      if (!translate_state(text, at, condition, used, lua, error)) return false;
      continue;
    }
    const bool before = word.starts_with(tick_before);
    const auto signal = find_signal(signals_, before ? word.substr(tick_before.size()) : word);
    if (!signal) {
      error = {static_cast<int>(begin) + 1,
               "unknown signal '" + std::string(word) + "'" + did_you_mean(word, signals_.names())};
      return false;
    }
    lua += (before ? "last[" : "values[") + std::to_string(place_of(*signal, condition.signals, used)) + "]";
  }
  return true;
}

bool SignalExpressions::compile(const std::string& lua, Condition& condition, ExpressionError& error) {
  const auto compile = [&](lua_State* state) {
    if (luaL_loadbufferx(state, lua.data(), lua.size(), "=condition", "t") != 0) lua_error(state);
    push_environment(state);
    lua_setfenv(state, -2);
    condition.function = luaL_ref(state, LUA_REGISTRYINDEX);
    for (int* table : {&state_->values, &state_->last}) {
      if (*table != LUA_NOREF) continue;
      lua_newtable(state);
      *table = luaL_ref(state, LUA_REGISTRYINDEX);
    }
  };
  if (state_->lua.call(compile, compilation_instructions, 0)) return true;
  error = {1, "is not a condition: " + std::string(state_->lua.error().message.data())};
  return false;
}

bool SignalExpressions::add(std::string_view text, std::size_t& index, ExpressionError& error, Gives gives) {
  Condition condition{.text = std::string(text), .signals = {}, .gives = gives};
  std::string lua = "local values, time_s, last = ...; return (";
  if (!translate(text, condition, lua, error) || !compile(lua + "\n)", condition, error)) return false;
  for (const SignalId signal : condition.signals) {
    if (std::ranges::find(used_, signal) == used_.end()) used_.push_back(signal);
  }
  index = conditions_.size();
  conditions_.push_back(std::move(condition));
  return true;
}

bool SignalExpressions::evaluate(double time_s, std::span<const double> row) noexcept {
  const auto evaluate = [&](lua_State* state) { evaluate_all(state, time_s, row); };
  if (state_->lua.call(evaluate, evaluation_instructions, 0)) {
    state_->lua.collect();
    return true;
  }
  error_ = state_->lua.error().text();
  return false;
}

}  // namespace kadans
