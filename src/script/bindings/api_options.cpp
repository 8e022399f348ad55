#include "api_options.h"

#include <cstdio>

#include "script/motion/motion_options.h"

namespace kadans {
namespace {

struct OptionTable {
  MotionOption::Method method;
  const char* type;      // of the stubs
  const char* argument;  // of which function
  const char* title;
};
constexpr OptionTable tables[] = {{MotionOption::move, "kadans.MoveOptions", "move", "move"},
                                  {MotionOption::set, "kadans.SetOptions", "set", "set"},
                                  {MotionOption::through, "kadans.ThroughOptions", "move_through", "move_through"},
                                  {MotionOption::point, "kadans.Point", "", "a point of move_through"},
                                  {MotionOption::follow, "kadans.FollowLimits", "follow", "follow"}};

struct ArgumentType {
  const char* name;
  const char* type;
};
constexpr ArgumentType types[] = {{"pose", "kadans.pose|table<string, number>"},
                                  {"points", "kadans.Point[]"},
                                  {"name", "string"},
                                  {"setpoint", "string"},
                                  {"preset", "string"},
                                  {"event", "string"},
                                  {"format", "string"},
                                  {"value", "number"},
                                  {"seconds", "number"},
                                  {"table", "table<string, table>"},
                                  {"...", "any"}};

const char* type_name(const MotionOption& option) noexcept {
  switch (option.type) {
    case MotionOption::Type::number:
      return "number";
    case MotionOption::Type::text:
      return "'minimum_jerk'|'trapezoid'";
    case MotionOption::Type::flag:
      return "boolean";
  }
  return "any";
}

std::string range(const MotionOption& option) {
  if (option.type != MotionOption::Type::number) return "";
  char text[64];
  std::snprintf(text, sizeof text, "%g..%g %s", option.min, option.max, option.unit);
  return text;
}

}  // namespace

std::string argument_type(std::string_view function, std::string_view name) {
  if (name == "options" || name == "limits") {
    for (const OptionTable& table : tables) {
      const bool needed = table.method == MotionOption::move || table.method == MotionOption::follow;
      if (function == table.argument) return std::string(needed ? ": " : "?: ") + table.type;
    }
  }
  if (function == "pose" && name == "name") return ": kadans.pose";
  for (const ArgumentType& known : types) {
    if (name == known.name) return std::string(": ") + known.type;
  }
  return "";
}

std::string motion_option_stubs() {
  std::string text;
  for (const OptionTable& table : tables) {
    text += "---@class " + std::string(table.type) + "\n";
    if (table.method == MotionOption::point) text += "---@field [1] kadans.pose|table<string, number>\n";
    for (const MotionOption& option : motion_options()) {
      if ((option.methods & table.method) == 0) continue;
      const bool needed = table.method == MotionOption::point || table.method == MotionOption::follow;
      const std::string limits = range(option);
      text += "---@field " + std::string(option.name) + (needed ? " " : "? ") + type_name(option) + " " + option.doc +
              (limits.empty() ? "" : "; " + limits) + "\n";
    }
    text += "\n";
  }
  return text;
}

std::string motion_option_reference() {
  std::string text =
      "\n## How a motion goes: the last argument of `move` and its kin\n\n| option | of | value | "
      "|\n|---|---|---|---|\n";
  for (const MotionOption& option : motion_options()) {
    std::string where;
    for (const OptionTable& table : tables) {
      if ((option.methods & table.method) != 0) where += (where.empty() ? "" : ", ") + std::string(table.title);
    }
    std::string value = range(option);
    if (value.empty()) value = option.type == MotionOption::Type::flag ? "boolean" : "text";
    text += "| `" + std::string(option.name) + "` | " + where + " | " + value + " | " + option.doc + " |\n";
  }
  return text;
}

}  // namespace kadans
