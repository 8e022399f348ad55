#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <vector>

#include "app/assembly/robot.h"
#include "config/json/fields.h"
#include "config/plan/experiment_plans.h"
#include "engine/behavior_log.h"
#include "reference_pages.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;

std::string range_text(double min, double max) {
  constexpr double exact_max = 9007199254740992.0;  // 2^53; beyond it there is no bound worth telling
  const bool above = std::isfinite(min) && min > -exact_max, below = std::isfinite(max) && max < exact_max;
  if (above && below) return number_text(min) + " to " + number_text(max);
  return above ? "from " + number_text(min) : below ? "to " + number_text(max) : "";
}

std::string type_of(const FieldInfo& field) {
  if (field.kind == FieldInfo::Kind::string && !field.choices.empty()) return listed(field.choices);
  constexpr const char* words[] = {
      "true or false", "whole number",        "number", "text", "number, text, true or false", "object",
      "list",          "object, keys by name"};
  return words[static_cast<std::size_t>(field.kind)];
}

void add_rows(const FieldInfo& info, const std::string& path, std::string& text) {
  for (const FieldInfo& field : info.fields) {
    using Kind = FieldInfo::Kind;
    const std::string name = path + field.name;
    if (!field.name.empty()) {
      const std::string range = range_text(field.min, field.max);
      text += "| `" + name + "` | " + markdown_text(type_of(field)) + (range.empty() ? "" : ", " + range) +
              (field.unit.empty() ? "" : " " + markdown_text(field.unit)) + " | " +
              (field.required               ? "required"
               : field.default_json.empty() ? ""
                                            : "`" + field.default_json + "`") +
              " | " + markdown_text(field.doc) + " |\n";
    }
    const bool many = field.kind == Kind::list || field.kind == Kind::map;
    if (!many)
      add_rows(field, name + ".", text);
    else if (!field.fields.empty())
      add_rows(field.fields.front(), name + (field.kind == Kind::list ? "[]." : ".NAME."), text);
  }
}

void add_file(const FieldInfo& info, const std::string& title, const std::string& doc, std::string& text) {
  text += "\n## " + title + "\n\n" + doc + "\n\n| field | type and range | default | meaning |\n|---|---|---|---|\n";
  add_rows(info, "", text);
}

// "posture.l_knee.kp_Nm_per_rad" -> "kp_Nm_per_rad"
std::string last_word(const std::string& name) { return name.substr(name.rfind('.') + 1); }

struct TypeRows {
  std::set<std::string> robots;
  std::map<std::string, std::string> parameters, setpoints;
};

void add_robot(const fs::path& file, std::map<std::string, TypeRows>& types, std::set<std::string>& known) {
  const Robot robot = read_robot(file);
  const auto system = make_control_system(robot);
  const Catalog& catalog = system->catalog;
  for (const std::string& name : robot.types.names()) known.insert(name);
  for (const ObjectInfo& object : catalog.objects) {
    TypeRows& rows = types[object.type];
    rows.robots.insert(robot.config.name);
    for (const ParameterId id : object.parameters) {
      const Parameter& info = catalog.parameters.info(id);
      rows.parameters[last_word(info.name)] =
          markdown_text(info.unit) + " | " + range_text(info.min, info.max) + " | " + markdown_text(info.doc);
    }
    for (const SetpointId id : object.setpoints) {
      const Setpoint& info = catalog.setpoints[id];
      rows.setpoints[last_word(info.name)] = markdown_text(info.unit) + " | " + range_text(info.min, info.max) + " | ";
    }
  }
}

void add_table(const std::string& what, const std::map<std::string, std::string>& rows, std::string& text) {
  if (rows.empty()) return;
  text += "\n| " + what + " | unit | range | meaning |\n|---|---|---|---|\n";
  for (const auto& [name, row] : rows) text += "| `" + name + "` | " + row + " |\n";
}

}  // namespace

std::string field_reference() {
  std::string text =
      "# Reference of the files\n\nGenerated from the tables by which the program reads them. Each object may also "
      "have a "
      "`doc` for people. `NAME` stands for a key of your choice, `[]` for each item of a list.\n";
  add_file(describe_robot_config(), "A robot", "`config/ROBOT/robot.json`", text);
  add_file(describe_scenario_config(), "A scenario", "`config/scenarios/NAME.json`", text);
  add_file(describe_sweep_plan(), "A sweep", "`config/sweeps/NAME.json`", text);
  add_file(describe_tune_plan(), "A tuning", "`config/tuning/NAME.json`", text);
  return text;
}

std::string object_reference(const fs::path& root) {
  std::map<std::string, TypeRows> types;
  std::set<std::string> known;
  std::set<fs::path> files;
  for (const auto& folder : fs::directory_iterator(root / "config")) {
    if (fs::exists(folder.path() / "robot.json")) files.insert(folder.path() / "robot.json");
  }
  for (const fs::path& file : files) add_robot(file, types, known);
  std::string text =
      "# Reference of the control objects\n\nGenerated from the tables of the robots that come with Kadans. A "
      "parameter "
      "or set-point that each joint of an object has stands once. [control.md](control.md) is the guide.\n";
  for (const auto& [type, rows] : types) {
    known.erase(type);
    text += "\n## " + type + "\n\nUsed by: " + listed(rows.robots) + ".\n";
    add_table("parameter", rows.parameters, text);
    add_table("set-point", rows.setpoints, text);
  }
  if (!known.empty()) text += "\n## Others\n\nNone of these robots uses: " + listed(known) + ".\n";
  return text;
}

}  // namespace kadans
