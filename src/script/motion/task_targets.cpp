#include "task_targets.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>

#include "script/bindings/bindings.h"
#include "script/bindings/snapshot_tables.h"
#include "script/check/hint.h"
#include "script/host/play_report.h"
#include "script/lua/script_error.h"

namespace kadans {
namespace {

constexpr std::string_view position_ending = ".position_rad", contact_group = "contact.";

bool of_joint(const Setpoint& setpoint) noexcept { return setpoint.joint != no_joint; }

double number_on_top(lua_State* state, const TaskWord& word) {
  if (lua_type(state, -1) != LUA_TNUMBER)
    luaL_error(state, "%s%s%s must be a number, not a %s", word.group.data(), word.group[0] != '\0' ? "." : "",
               word.key.data(), luaL_typename(state, -1));
  return lua_tonumber(state, -1);
}

// A list { x, y, z } at the top of the stack, with nothing else in it.
void check_list(lua_State* state, const char* name) {
  if (!lua_istable(state, -1))
    luaL_error(state, "%s must be a list { x, y, z }, not a %s", name, luaL_typename(state, -1));
  charge_table(state, lua_gettop(state));
  for (lua_pushnil(state); lua_next(state, -2) != 0; lua_pop(state, 1)) {
    const double at = lua_type(state, -2) == LUA_TNUMBER ? lua_tonumber(state, -2) : 0;
    if (at != 1 && at != 2 && at != 3) luaL_error(state, "%s must be a list { x, y, z } with nothing else in it", name);
  }
}

// The value of this word in the table at `index`, if it has one. Keeps the stack.
bool find_value(lua_State* state, int index, const TaskWord& word, double& value) {
  const int top = lua_gettop(state);
  lua_pushvalue(state, index);
  if (word.group[0] != '\0') {
    lua_getfield(state, -1, word.group.data());
    if (!lua_isnil(state, -1) && !lua_istable(state, -1))
      luaL_error(state, "%s must be a table { ... }, not a %s", word.group.data(), luaL_typename(state, -1));
  }
  bool found = false;
  if (lua_istable(state, -1)) {
    lua_getfield(state, -1, word.key.data());
    if (word.axis > 0 && !lua_isnil(state, -1)) {
      check_list(state, word.key.data());
      lua_rawgeti(state, -1, word.axis);
    }
    found = !lua_isnil(state, -1);
    if (found) value = number_on_top(state, word);
  }
  lua_settop(state, top);
  return found;
}

// Raises on a key that is no word of the object's: of the table at `index`, or, with a group, of that group's.
void check_words(lua_State* state, int index, const ObjectInfo& object, const char* group) {
  const Catalog& catalog = *bindings_of(state).catalog;
  std::array<TaskWord::Text, 2 * max_joints> words{};
  std::array<const char*, 2 * max_joints + 1> names{};
  std::size_t count = 0;
  for (const SetpointId id : object.setpoints) {
    const Setpoint& setpoint = catalog.setpoints[id];
    const TaskWord word = task_word(short_name(object, setpoint.name), of_joint(setpoint));
    if (group != nullptr && std::strcmp(group, word.group.data()) != 0) continue;
    const TaskWord::Text& own = group == nullptr ? word.outer() : word.key;
    const bool known = std::any_of(words.begin(), words.begin() + static_cast<std::ptrdiff_t>(count),
                                   [&](const TaskWord::Text& other) { return other == own; });
    if (known || count == words.size()) continue;
    words[count] = own;
    names[count] = words[count].data();
    ++count;
  }
  check_keys(state, index, calling_place(state), group != nullptr ? group : "this table of tasks", names.data());
}

// The table of this group, if it is given.
void check_group(lua_State* state, int index, const ObjectInfo& object, const TaskWord::Text& group) {
  if (group[0] == '\0') return;
  lua_getfield(state, index, group.data());
  if (lua_istable(state, -1)) check_words(state, lua_gettop(state), object, group.data());
  lua_pop(state, 1);
}

}  // namespace

TaskWord task_word(std::string_view name, bool of_joint) noexcept {
  TaskWord word;
  if (of_joint && name.ends_with(position_ending)) {
    put_text(word.key, name.substr(0, name.size() - position_ending.size()));
    return word;
  }
  if (const std::size_t dot = name.find('.'); dot != std::string_view::npos) {
    put_text(word.group, name.substr(0, dot));
    name.remove_prefix(dot + 1);
  }
  put_text(word.key, name);
  const std::size_t unit = name.rfind('_');
  if (unit == std::string_view::npos || unit < 2 || name[unit - 2] != '_') return word;
  const char axis = name[unit - 1];
  if (axis < 'x' || axis > 'z') return word;
  word.axis = axis - 'x' + 1;
  put_text(word.key, name.substr(0, unit - 2));
  const std::size_t begun = std::strlen(word.key.data());
  name.remove_prefix(unit);
  std::copy_n(name.data(), std::min(name.size(), word.key.size() - 1 - begun), word.key.data() + begun);
  return word;
}

bool has_tasks(const Catalog& catalog, const ObjectInfo& object) noexcept {
  return std::ranges::any_of(object.setpoints, [&](SetpointId id) { return !of_joint(catalog.setpoints[id]); });
}

void read_tasks(lua_State* state, int index, const ObjectInfo& object, const char* called, MotionTargets& targets) {
  const Catalog& catalog = *bindings_of(state).catalog;
  targets.count = 0;
  check_words(state, index, object, nullptr);
  TaskWord::Text group{};
  for (const SetpointId id : object.setpoints) {  // in the object's order, so that every run sends the same
    const Setpoint& setpoint = catalog.setpoints[id];
    const TaskWord word = task_word(short_name(object, setpoint.name), of_joint(setpoint));
    if (word.group != group) check_group(state, index, object, group = word.group);
    double value = 0;
    if (!find_value(state, index, word, value)) continue;
    if (targets.count == targets.all.size()) luaL_error(state, "%s: too many targets at once", called);
    targets.add(id, value);
  }
  if (targets.count == 0) luaL_error(state, "%s: there is no target in this table of tasks", called);
}

namespace {

void add(lua_State* state, TaskOptions& options, const Command& command) {
  if (options.count == options.commands.size()) luaL_error(state, "move: too many tasks at once");
  options.commands[options.count++] = command;
}

// The parameter of the task to which this set-point belongs: <task>.<parameter>.
const Parameter* task_parameter(const Catalog& catalog, const ObjectInfo& object, const char* setpoint,
                                std::string_view parameter, ParameterId& id) noexcept {
  for (const ParameterId candidate : object.parameters) {
    const std::string_view name = short_name(object, catalog.parameters.info(candidate).name);
    if (!name.ends_with(parameter)) continue;
    const std::string_view task = name.substr(0, name.size() - parameter.size());
    if (!std::string_view(setpoint).starts_with(task) || std::strchr("._", setpoint[task.size()]) == nullptr) continue;
    id = candidate;
    return &catalog.parameters.info(candidate);
  }
  return nullptr;
}

// weight and priority: of each task that is moved.
void read_parameter_option(lua_State* state, const char* option, std::string_view parameter, const ObjectInfo& object,
                           const MotionTargets& targets, TaskOptions& options) {
  const Catalog& catalog = *bindings_of(state).catalog;
  const double value = lua_tonumber(state, -1);
  for (const MotionTarget& target : targets) {
    const Setpoint& setpoint = catalog.setpoints[target.id];
    ParameterId id = 0;
    const Parameter* info = task_parameter(catalog, object, short_name(object, setpoint.name), parameter, id);
    if (info == nullptr) luaL_error(state, "move: %s belongs to no task with a %s", setpoint.name.c_str(), option);
    check_range(state, info->name.c_str(), info->unit.c_str(), value, info->min, info->max);
    const bool twice =
        std::any_of(options.commands.begin(), options.commands.begin() + options.count,
                    [&](const Command& one) { return one.kind == CommandKind::set_parameter && one.index == id; });
    if (!twice) add(state, options, {.kind = CommandKind::set_parameter, .index = id, .value = value});
  }
}

// contacts: the list of what stands; all else of the object's contacts is free.
void read_contacts(lua_State* state, const ObjectInfo& object, TaskOptions& options) {
  const Catalog& catalog = *bindings_of(state).catalog;
  const auto given = static_cast<int>(lua_objlen(state, -1));
  int taken = 0, entries = 0;
  charge_table(state, lua_gettop(state));
  for (lua_pushnil(state); lua_next(state, -2) != 0; lua_pop(state, 1)) ++entries;
  std::array<const char*, max_feet + 1> names{};
  std::size_t count = 0;
  for (const SetpointId id : object.setpoints) {
    const char* name = short_name(object, catalog.setpoints[id].name);
    if (!std::string_view(name).starts_with(contact_group) || count == max_feet) continue;
    names[count++] = name + contact_group.size();
    bool stands = false;
    for (int i = 1; i <= given && i <= static_cast<int>(max_feet); ++i) {
      lua_rawgeti(state, -1, i);
      const bool this_one =
          lua_type(state, -1) == LUA_TSTRING && std::strcmp(lua_tostring(state, -1), names[count - 1]) == 0;
      lua_pop(state, 1);
      stands = stands || this_one;
    }
    taken += stands ? 1 : 0;
    add(state, options, {.kind = CommandKind::set_point, .index = id, .value = stands ? 1.0 : 0.0});
  }
  if (count == 0) luaL_error(state, "move: '%s' has no contacts", object.name.c_str());
  if (taken == given && entries == given && given > 0) return;
  const Hint hint = make_hint(state, "", [&](auto& known) {
    for (std::size_t i = 0; i < count; ++i) known.emplace_back(names[i]);
  });
  luaL_error(state, "move: contacts must be a list of at least one of its contacts, each once%s", hint.data());
}

}  // namespace

void read_task_options(lua_State* state, int index, const ObjectInfo& object, const MotionTargets& targets,
                       TaskOptions& options) {
  if (!lua_istable(state, index)) return;
  lua_getfield(state, index, "weight");
  if (!lua_isnil(state, -1)) read_parameter_option(state, "weight", ".weight", object, targets, options);
  lua_getfield(state, index, "priority");
  if (!lua_isnil(state, -1)) read_parameter_option(state, "priority", ".priority", object, targets, options);
  lua_getfield(state, index, "contacts");
  if (!lua_isnil(state, -1)) read_contacts(state, object, options);
  lua_pop(state, 3);
}

}  // namespace kadans
