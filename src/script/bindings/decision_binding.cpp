// The words of a k.decisions, one level above behaviors: what they ask for is orders to what plays behaviors.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "api.h"
#include "bindings.h"
#include "config/robot/supervisor_config.h"
#include "kadans/signal/input_error.h"
#include "script/chart/chart_reader.h"
#include "script/lua/lua_core.h"
#include "script/sandbox/handle.h"
#include "script/sandbox/sandbox.h"

namespace kadans {
namespace {

using OrderKind = PlayOrder::Kind;

constexpr std::size_t orders_max = 8;                     // in a tick
constexpr std::size_t list_max = 512, argument_max = 64;  // characters
constexpr double order_instructions = 2000, played_argument_instructions = 100;

// "" when it can be played. Nothing of Lua is called here.
const std::string& take_order(Bindings& bindings, OrderKind kind) noexcept {
  bindings.order_problem.clear();
  PlayOrder order{.kind = kind};
  try {
    if (kind == OrderKind::play || kind == OrderKind::replace) {
      if (bindings.folders == nullptr) return bindings.order_problem = "nothing here plays behaviors";
      order.list = read_play_items(bindings.order_text, "m:play", *bindings.folders);
    }
    bindings.decided.push_back(std::move(order));
  } catch (const InputError& error) {
    bindings.order_problem = error.problems().front().message;
  } catch (const std::exception& error) {
    bindings.order_problem = error.what();
  }
  return bindings.order_problem;
}

int ask(lua_State* state, OrderKind kind) {
  Bindings& bindings = bindings_of(state);
  core_of(state).budget.charge(state, order_instructions);
  if (bindings.decided.size() >= orders_max) return queue_full(state);
  if (!take_order(bindings, kind).empty()) return luaL_error(state, "%s", bindings.order_problem.c_str());
  return lua_pushboolean(state, 1), 1;
}

// [-0 +0] Appends name=value; the name is at `key`, the value behind it.
void add_argument(lua_State* state, int key) {
  std::string& text = bindings_of(state).order_text;
  core_of(state).budget.charge(state, played_argument_instructions);
  if (lua_type(state, key) != LUA_TSTRING || lua_objlen(state, key) > argument_max)
    luaL_error(state, "the arguments of a behavior are a table { name = value }");
  const char* name = lua_tostring(state, key);
  const int value = key + 1, type = lua_type(state, value);
  char pair[2 * argument_max + 64];
  if (type == LUA_TNUMBER && std::isfinite(lua_tonumber(state, value))) {
    std::snprintf(pair, sizeof pair, "%s=%.17g", name, lua_tonumber(state, value));
  } else if (type == LUA_TBOOLEAN) {
    std::snprintf(pair, sizeof pair, "%s=%s", name, lua_toboolean(state, value) != 0 ? "true" : "false");
  } else if (type == LUA_TSTRING && lua_objlen(state, value) <= argument_max &&
             std::strlen(lua_tostring(state, value)) == lua_objlen(state, value) &&
             std::strpbrk(lua_tostring(state, value), "'\n") == nullptr) {
    std::snprintf(pair, sizeof pair, "%s='%s'", name, lua_tostring(state, value));
  } else {
    luaL_error(state,
               "argument '%s' must be a finite number, true or false, or a text of at most %d characters without '",
               name, static_cast<int>(argument_max));
  }
  text += text.back() == '{' ? "" : ",";
  text += pair;
}

int ask_for_list(lua_State* state, OrderKind kind, const char* word) {
  lua_settop(state, 3);
  if (lua_type(state, 2) != LUA_TSTRING || lua_objlen(state, 2) > list_max)
    return luaL_error(state, "m:%s needs a list of behaviors: m:%s(\"walk_to{x_m=1}, kick\")", word, word);
  std::string& text = bindings_of(state).order_text;
  text = lua_tostring(state, 2);
  if (lua_isnil(state, 3)) return ask(state, kind);
  if (!lua_istable(state, 3))
    return luaL_error(state, "m:%s: the arguments are a table { name = value }, not a %s", word,
                      luaL_typename(state, 3));
  if (text.find_first_of("{,|") != std::string::npos)
    return luaL_error(state, "m:%s: a table of arguments belongs to a single behavior without others", word);
  text += '{';
  each_in_order(state, 3, [&](int key, int) { add_argument(state, key); });
  text += '}';
  return ask(state, kind);
}

// m:play(list, arguments?) -> true | nil, "queue_full". Raises on a list that cannot be read, or a behavior that is
// not there.
int play(lua_State* state) { return ask_for_list(state, OrderKind::play, "play"); }
// m:replace(list, arguments?): likewise.
int replace(lua_State* state) { return ask_for_list(state, OrderKind::replace, "replace"); }
// m:stop(), m:pause(), m:resume() -> true | nil, "queue_full".
int stop(lua_State* state) { return ask(state, OrderKind::stop); }
int pause(lua_State* state) { return ask(state, OrderKind::pause); }
int resume(lua_State* state) { return ask(state, OrderKind::resume); }

// m:plays(name?) -> path of its innermost active state | nil.
int plays(lua_State* state) {
  const char* name = lua_isnoneornil(state, 2) ? nullptr : luaL_checkstring(state, 2);
  const PlayReport* report = bindings_of(state).plays;
  for (std::uint32_t i = 0; report != nullptr && i < report->count; ++i) {
    const PlayReport::Playing& one = report->playing[i];
    if (name == nullptr || std::strcmp(one.name.data(), name) == 0) return lua_pushstring(state, one.state.data()), 1;
  }
  return lua_pushnil(state), 1;
}

// m:send(event, data?) -> true | nil, "queue_full": to the other robots.
int send(lua_State* state) {
  lua_settop(state, 3);
  const char* name = luaL_checkstring(state, 2);
  if (!std::string_view(name).starts_with(message_event_prefix))
    return luaL_error(state, "the event '%s' does not go to other robots: its name must begin with '%s'", name,
                      message_event_prefix);
  if (!lua_isnil(state, 3) && !lua_istable(state, 3))
    return luaL_error(state, "the data of an event is a table { name = value }, not a %s", luaL_typename(state, 3));
  return send_to(state, find_event(core_of(state).events, name), name, 3, other_robots);
}

constexpr luaL_Reg decision_calls[] = {{"play", play},     {"replace", replace}, {"stop", stop}, {"pause", pause},
                                       {"resume", resume}, {"plays", plays},     {"send", send}};

}  // namespace

void open_decisions(lua_State* state) { set_functions(state, decision_calls); }

std::vector<std::string> decider_words() {
  std::vector<std::string> all;
  for (const luaL_Reg& word : decision_calls) all.push_back(std::string("decider.") + word.name);
  return all;
}

}  // namespace kadans
