// k.events { ball_seen = { "the camera sees it", distance_m = "m", left = k.flag } }: events that may come from outside
// the chart, and what their data is. A field is a unit for a number, k.flag or k.text; or a table that begins with one
// of them and has min, max, optional or doc.
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>

#include "chart_reader.h"
#include "config/scenario/event_text.h"
#include "script/bindings/bindings.h"
#include "script/check/foreign_words.h"
#include "script/lua/lua_core.h"
#include "script/sandbox/handle.h"
#include "script/sandbox/sandbox.h"

namespace kadans {
namespace {

using Field = ScriptEvent::Field;

const HandleKey type_key = 0;
constexpr std::size_t events_max = 256, doc_max = 512, unit_max = 32;
constexpr double event_instructions = 300, field_instructions = 200, checked_instructions = 40;
constexpr const char* field_keys[] = {"min", "max", "optional", "doc", nullptr};
constexpr const char* emit_keys[] = {"to", nullptr};

// Of a text within bounds: it is kept outside the script's memory.
const char* text_at(lua_State* state, int index, std::size_t most, const char* what, const ScriptPlace& place) {
  if (lua_type(state, index) != LUA_TSTRING)
    raise_at(state, place, what, "'%s' must be a text, not a %s", what, luaL_typename(state, index));
  if (lua_objlen(state, index) > most)
    raise_at(state, place, what, "'%s' is longer than %d characters", what, static_cast<int>(most));
  return lua_tostring(state, index);
}

// The type at `index`: a unit, k.flag or k.text. False: it is none.
bool read_type(lua_State* state, int index, Field& field, const ScriptPlace& place) {
  if (lua_type(state, index) == LUA_TSTRING) {
    field.unit = text_at(state, index, unit_max, field.name.c_str(), place);
    const std::string_view type = foreign_type(field.unit);
    if (!type.empty())
      raise_at(state, place, field.name.c_str(), "field '%s': '%s' is no unit: write %s", field.name.c_str(),
               field.unit.c_str(), type.data());
    return true;
  }
  const auto* type = static_cast<const Field::Type*>(to_handle(state, index, type_key));
  if (type != nullptr) field.type = *type;
  return type != nullptr;
}

// [-0 +1] Without metamethods, so that no script runs in between: what is checked is what counts.
void push_raw(lua_State* state, int table, const char* key) {
  lua_pushstring(state, key);
  lua_rawget(state, table);
}

double limit_at(lua_State* state, int table, const char* key, double otherwise, const ScriptPlace& place) {
  push_raw(state, table, key);
  if (!lua_isnil(state, -1) && lua_type(state, -1) != LUA_TNUMBER)
    raise_at(state, place, key, "'%s' must be a number, not a %s", key, luaL_typename(state, -1));
  const double value = lua_isnil(state, -1) ? otherwise : lua_tonumber(state, -1);
  lua_pop(state, 1);
  return value;
}

void read_options(lua_State* state, int table, Field& field, const ScriptPlace& place) {
  check_keys(state, table, place, "a field of an event", field_keys);
  field.min = limit_at(state, table, "min", field.min, place);
  field.max = limit_at(state, table, "max", field.max, place);
  const bool bounded = std::isfinite(field.min) || std::isfinite(field.max);
  if (!(field.min <= field.max) || (bounded && field.type != Field::Type::number))
    raise_at(state, place, field.name.c_str(), "field '%s': min and max are a number's, and min is not above max",
             field.name.c_str());
  push_raw(state, table, "optional");
  field.optional = lua_toboolean(state, -1) != 0;
  push_raw(state, table, "doc");
  if (!lua_isnil(state, -1)) field.doc = text_at(state, lua_gettop(state), doc_max, "doc", place);
  lua_pop(state, 2);
}

// Names that are too long are not repeated in a message.
void check_length(lua_State* state, const char* name, const ScriptPlace& place) {
  if (std::strlen(name) > EventBounds::name_bytes)
    raise_at(state, place, nullptr, "k.events: a name has at most %d characters",
             static_cast<int>(EventBounds::name_bytes));
}

void read_field(lua_State* state, const char* name, int value, ScriptEvent& event, const ScriptPlace& place) {
  core_of(state).budget.charge(state, field_instructions);
  check_length(state, name, place);
  const bool good = is_event_name(name) && !std::strchr(name, '.') && std::strcmp(name, "doc") != 0;
  if (!good)
    raise_at(state, place, name, "event '%s': a field is named with letters, digits and '_', and not 'doc'; not '%s'",
             event.name.c_str(), name);
  if (event.fields.size() >= EventBounds::fields)
    raise_at(state, place, name, "event '%s' has more than %d fields", event.name.c_str(),
             static_cast<int>(EventBounds::fields));
  Field& field = event.fields.emplace_back();
  field.name = name;
  field.min = -std::numeric_limits<double>::infinity();
  field.max = std::numeric_limits<double>::infinity();
  const bool table = lua_istable(state, value);
  if (table) lua_rawgeti(state, value, 1);
  if (!read_type(state, table ? lua_gettop(state) : value, field, place))
    raise_at(state, place, name,
             "event '%s': field '%s' must be a unit such as \"m\", k.flag or k.text, or a table that begins with one",
             event.name.c_str(), name);
  if (table) read_options(state, value, field, place);
}

bool is_reserved(std::string_view name) noexcept {
  return name == "done" || name.starts_with("run.") || reserved_for_reports(name);
}

void read_event(lua_State* state, const char* name, int value, const ScriptPlace& place) {
  core_of(state).budget.charge(state, event_instructions);
  std::vector<ScriptEvent>& events = core_of(state).events;
  check_length(state, name, place);
  if (!is_event_name(name))
    raise_at(state, place, name, "an event's name is words of letters, digits and '_' with dots between them, not '%s'",
             name);
  if (is_reserved(name)) raise_at(state, place, name, "the event '%s' is made by the runtime alone", name);
  if (!lua_istable(state, value))
    raise_at(state, place, name, "event '%s' must be a table { field = type }, not a %s", name,
             luaL_typename(state, value));
  if (events.size() >= events_max) raise_at(state, place, name, "more than %d events", static_cast<int>(events_max));
  const int line = find_line(state, place, name);
  ScriptEvent& event = events.emplace_back();
  event.chunk = place.chunk;
  event.line = line;
  event.name = name;
  each_in_order(state, value, [&](int key, int field) {
    if (lua_type(state, key) == LUA_TSTRING) return read_field(state, lua_tostring(state, key), field, event, place);
    if (lua_type(state, key) != LUA_TNUMBER || lua_tonumber(state, key) != 1)
      raise_at(state, place, name, "event '%s': every field needs a name; before them stands one sentence alone", name);
    event.doc = text_at(state, field, doc_max, name, place);
  });
  for (const ScriptEvent& other : events) {
    if (&other == &event || other.name != event.name) continue;
    if (!other.same_as(event))
      raise_at(state, place, name, "event '%s' is declared in %s:%d with other fields", name, other.chunk.c_str(),
               other.line);
    return events.pop_back();
  }
}

// events(table)
int events(lua_State* state) {
  const ScriptPlace place = calling_place(state);
  if (!lua_istable(state, 1))
    return raise_at(state, place, nullptr, "k.events needs a table { name = { field = type } }");
  lua_settop(state, 1);
  each_in_order(state, 1, [&](int key, int value) {
    if (lua_type(state, key) != LUA_TSTRING)
      raise_at(state, place, nullptr, "k.events: every event needs a name: name = { field = type }");
    read_event(state, lua_tostring(state, key), value, place);
  });
  return 0;
}

void add_type(lua_State* state, const char* name, Field::Type type) {
  *static_cast<Field::Type*>(lua_newuserdata(state, sizeof type)) = type;
  set_kind(state, type_key);
  lua_setfield(state, -2, name);
}

PlayValue value_at_top(lua_State* state, Field::Type type) {
  std::size_t length = 0;
  if (type == Field::Type::flag) return lua_toboolean(state, -1) != 0;
  if (type == Field::Type::number) return lua_tonumber(state, -1);
  const char* text = lua_tolstring(state, -1, &length);
  return std::string(text, length);
}

// [-0 +0] Raises when the value at the top of the stack is none of this field.
void check_field(lua_State* state, const ScriptEvent& event, const Field& field) {
  constexpr int types[] = {LUA_TNUMBER, LUA_TBOOLEAN, LUA_TSTRING};
  const int type = lua_type(state, -1);
  const char* const in = field.unit.empty() ? "" : " in ";
  if (type == LUA_TNIL && field.optional) return;
  if (type == LUA_TNIL)
    luaL_error(state, "event '%s': field '%s' is missing: %s%s%s", event.name.c_str(), field.name.c_str(),
               type_text(field.type), in, field.unit.c_str());
  if (type != types[static_cast<std::size_t>(field.type)])
    luaL_error(state, "event '%s': field '%s' must be %s%s%s, not a %s", event.name.c_str(), field.name.c_str(),
               type_text(field.type), in, field.unit.c_str(), luaL_typename(state, -1));
  if (field.type != Field::Type::number) return;
  const double value = lua_tonumber(state, -1);
  if (!std::isfinite(value))
    luaL_error(state, "event '%s': field '%s' is not finite", event.name.c_str(), field.name.c_str());
  if (!(value >= field.min && value <= field.max))
    luaL_error(state, "event '%s': field '%s' = %f is outside its range %f..%f %s", event.name.c_str(),
               field.name.c_str(), value, field.min, field.max, field.unit.c_str());
}

}  // namespace

void open_events(lua_State* state) {
  open_kind(state, type_key, {});
  lua_pushcfunction(state, events);
  lua_setfield(state, -2, "events");
  add_type(state, "flag", Field::Type::flag);
  add_type(state, "text", Field::Type::text);
}

// Nothing here raises but the charge, before there are texts.
void declare_play_events(lua_State* state) {
  core_of(state).budget.charge(state, 3 * event_instructions);
  constexpr std::array<std::array<const char*, 3>, 3> all{
      {{"play.done", "what was played is over: all of it ended with done", nullptr},
       {"play.failed", "what was played is over: something ended otherwise", nullptr},
       {"play.refused", "what was asked for cannot be played", "why"}}};
  for (const auto& [name, doc, field] : all) {
    if (find_event(core_of(state).events, name) != nullptr) continue;
    ScriptEvent& event = core_of(state).events.emplace_back();
    event.chunk = "kadans";  // no file declares it: nobody has to wait for it
    event.name = name;
    event.doc = doc;
    if (field != nullptr) event.fields.push_back({.name = field, .type = Field::Type::text});
  }
}

void check_event_data(lua_State* state, const ScriptEvent& event, int index) {
  core_of(state).budget.charge(state, checked_instructions * static_cast<double>(event.fields.size() + 1));
  const bool given = !lua_isnoneornil(state, index);
  std::array<const char*, EventBounds::fields + 1> names{};
  for (std::size_t i = 0; i < event.fields.size(); ++i) names[i] = event.fields[i].name.c_str();
  char what[EventBounds::name_bytes + 16];
  std::snprintf(what, sizeof what, "event '%s'", event.name.c_str());
  if (given) check_keys(state, index, calling_place(state), what, names.data());
  if (given && lua_objlen(state, index) > 0) luaL_error(state, "%s: every field needs a name", what);
  for (const Field& field : event.fields) {
    given ? push_raw(state, index, field.name.c_str()) : lua_pushnil(state);
    check_field(state, event, field);
    lua_pop(state, 1);
  }
}

int send_away(lua_State* state, const ScriptEvent* declared, const char* name, int data, int options) {
  if (!lua_istable(state, options)) return luaL_error(state, "the last argument of m:emit is { to = \"behavior\" }");
  check_keys(state, options, calling_place(state), "m:emit", emit_keys);
  push_raw(state, options, "to");
  const int to = lua_gettop(state);
  if (lua_type(state, to) != LUA_TSTRING || lua_objlen(state, to) > EventBounds::name_bytes)
    return luaL_error(state, "m:emit: 'to' must be the name of a behavior, or \"all\"");
  return send_to(state, declared, name, data, lua_tostring(state, to));
}

// What is read does not raise any more, so the texts and the list are safe.
int send_to(lua_State* state, const ScriptEvent* declared, const char* name, int data, const char* to) {
  if (declared == nullptr)
    return luaL_error(state, "the event '%s' is not declared: k.events { %s = {} } says what other behaviors get", name,
                      name);
  check_event_data(state, *declared, data);
  std::vector<SentEvent>& sent = bindings_of(state).sent_events;
  if (sent.size() >= EventQueue::sent_max) return queue_full(state);
  SentEvent& event = sent.emplace_back();
  event.to = to;
  event.event.name = name;
  for (const Field& field : declared->fields) {
    if (lua_isnoneornil(state, data)) break;
    push_raw(state, data, field.name.c_str());
    if (!lua_isnil(state, -1))
      event.event.data.push_back({.name = field.name, .value = value_at_top(state, field.type)});
    lua_pop(state, 1);
  }
  char why[200];
  std::snprintf(why, sizeof why, "%s", out_of_bounds(event.event.data).c_str());
  if (why[0] == '\0') return lua_pushboolean(state, 1), 1;
  sent.pop_back();
  return luaL_error(state, "event '%s': %s", name, why);
}

}  // namespace kadans
