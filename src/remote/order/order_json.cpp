
#include "order_json.h"

#include <algorithm>

#include <unistd.h>

#include "config/json/fields.h"
#include "config/json/foreign_json.h"
#include "config/json/problems.h"
#include "kadans/control/set_partition.h"
#include "remote/instance/run_description.h"
#include "signal/input_file.h"

namespace kadans {
namespace {

// JSON has no infinity: a range without an end has no such key.
void put_finite(Json& to, const char* key, double value) {
  if (std::isfinite(value)) to[key] = value;
}

Json own_parameter(const std::string& name, const ScriptParameter& own) {
  return {{"name", name},       {"unit", own.unit},       {"min", own.min}, {"max", own.max},
          {"value", own.value}, {"default", own.initial}, {"doc", own.doc}};
}

Json parameters_json(const Catalog& catalog, const Answer& report) {
  Json all = Json::array();
  for (ParameterId id = 0; id < catalog.parameters.size(); ++id) {
    const Parameter& info = catalog.parameters.info(id);
    Json one{{"name", info.name},
             {"unit", info.unit},
             {"value", catalog.parameters.newest(id)},
             {"default", info.initial},
             {"doc", info.doc}};
    put_finite(one, "min", info.min);
    put_finite(one, "max", info.max);
    all.push_back(std::move(one));
  }
  for (const BehaviorReport& behavior : report.behaviors) {
    for (const ScriptParameter& own : behavior.parameters)
      all.push_back(own_parameter(behavior.name + "." + own.name, own));
  }
  return all;
}

Json signals_json(const SignalTable& table) {
  Json all = Json::array();
  for (SignalId id = 0; id < table.size(); ++id) {
    const Signal& info = table.info(id);
    all.push_back({{"name", info.name}, {"unit", info.unit}, {"doc", info.doc}});
  }
  return all;
}

Json objects_json(const Catalog& catalog) {
  Json all = Json::array();
  for (const ObjectInfo& object : catalog.objects) {
    Json one{{"name", object.name}, {"type", object.type}, {"joints", Json::array()}, {"presets", Json::array()}};
    for (const std::size_t joint : object.joints) one["joints"].push_back(catalog.model->joints[joint].name);
    for (const Preset& preset : object.presets) one["presets"].push_back(preset.name);
    all.push_back(std::move(one));
  }
  return all;
}

Json sets_json(const Catalog& catalog, SetMask active) {
  Json all = Json::array();
  for (std::uint32_t set = 0; set < catalog.sets.size(); ++set) {
    Json one{{"name", catalog.sets[set].name}, {"active", (active & set_bit(set)) != 0}, {"objects", Json::array()}};
    for (const std::uint32_t object : catalog.sets[set].objects) one["objects"].push_back(catalog.objects[object].name);
    all.push_back(std::move(one));
  }
  return all;
}

// Those that somebody who plays declares, each once.
Json events_json(const Answer& report) {
  Json all = Json::array();
  for (const BehaviorReport& behavior : report.behaviors) {
    for (const ScriptEvent& event : behavior.events) {
      const bool there = std::ranges::any_of(all, [&](const Json& one) { return one["name"] == event.name; });
      const std::string fields = fields_text(event);
      if (there) continue;
      all.push_back(event_json(event));
      all.back()["doc"] = event.doc + (event.doc.empty() || fields.empty() ? "" : "; ") + fields;
    }
  }
  return all;
}

Json joints_json(const RobotModel& model) {
  Json all = Json::array();
  for (const Joint& joint : model.joints) {
    Json one{{"name", joint.name}, {"unit", "rad"}, {"doc", joint.passive() ? "passive" : "driven"}};
    put_finite(one, "min", joint.lower_rad);
    put_finite(one, "max", joint.upper_rad);
    all.push_back(std::move(one));
  }
  return all;
}

// What could be played, then what plays.
Json all_behaviors_json(const Instance& instance, const Answer& report) {
  Json all = behaviors_json(report);
  for (const std::string& name : playable_names(instance.facts().folders)) {
    const bool there = std::ranges::any_of(report.behaviors, [&](const BehaviorReport& b) { return b.name == name; });
    if (!there) all.push_back({{"name", name}, {"plays", false}});
  }
  return all;
}

Json record_json(const RecordStatus& record) {
  if (!record.goes_on) return nullptr;
  return {{"file", record.file.data()},
          {"rows", record.rows},
          {"bytes", record.bytes},
          {"dropped", record.dropped},
          {"failed", record.failed}};
}

}  // namespace

std::string refusal(const std::string& why) { return json_text({{"ok", false}, {"error", why}}); }

Json behaviors_json(const Answer& report) {
  Json all = Json::array();
  for (const BehaviorReport& behavior : report.behaviors) {
    Json one{{"name", behavior.name}, {"plays", !behavior.over}, {"lane", behavior.lane}};
    if (!behavior.active.empty()) {
      one["state"] = behavior.active.front();
      one["active"] = behavior.active;
    }
    if (!behavior.outcome.empty()) one["outcome"] = behavior.outcome;
    if (!behavior.result.empty()) one["result"] = behavior.result;
    if (!behavior.error.empty()) one["error"] = behavior.error;
    all.push_back(std::move(one));
  }
  return all;
}

Json reasons_json(const Answer& answer) {
  Json all = Json::array();
  for (const BehaviorReasons& behavior : answer.reasons) {
    for (const TransitionReason& reason : behavior.transitions) {
      Json one{{"behavior", behavior.name}, {"number", reason.transition}, {"from", reason.from}, {"to", reason.to},
               {"label", reason.label},     {"free", reason.free},         {"why", reason.why}};
      if (!reason.saw.empty()) one["saw"] = reason.saw;
      if (!reason.guard.file.empty()) one["guard"] = guard_json(reason.guard);
      all.push_back(std::move(one));
    }
  }
  return all;
}

Json drives_json(const PowerStatus& power, const RobotModel& model) {
  const auto told = [](double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); };
  Json drives = Json::array();
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    if (model.joints[i].passive()) continue;
    const DriveStatus& drive = power.drives[i];
    drives.push_back({{"joint", model.joints[i].name},
                      {"state", name(drive.state)},
                      {"code", drive.code},
                      {"temperature_C", told(static_cast<double>(drive.temperature_C))},
                      {"homed", drive.homed},
                      {"braked", drive.braked}});
  }
  return {{"supply_V", told(power.supply_V)}, {"emergency", power.emergency}, {"drives", drives}};
}

Json world_json(const SeenEntries& seen, const std::vector<SeenInfo>& declared) {
  Json all = Json::array();
  for (std::size_t i = 0; i < declared.size() && i < seen.count; ++i) {
    const SeenEntry& entry = seen.entries[i];
    Json one{{"entry", declared[i].name}};
    if (entry.confidence > 0) {
      one["source"] = name(entry.source);
      one["age_s"] = entry.age_s;
      one["confidence"] = entry.confidence;
      one["carried"] = entry.carried;
      for (std::size_t f = 0; f < declared[i].fields.size(); ++f)
        one["fields"][declared[i].fields[f].name] = entry.fields[f];
    }
    all.push_back(std::move(one));
  }
  return {{"world", all}};
}

Json status_json(const Instance& instance, const InstanceStatus& status) {
  const Instance::Facts& facts = instance.facts();
  const Catalog& catalog = instance.catalog();
  Json sets = Json::array();
  for (std::uint32_t set = 0; set < catalog.sets.size(); ++set) {
    if ((status.control_sets & set_bit(set)) != 0) sets.push_back(catalog.sets[set].name);
  }
  Json safety{
      {"level", name(status.safety.level)}, {"faults", status.safety.fault_count}, {"stopped", status.safety.stopped}};
  if (status.safety.fault_count > 0)
    safety["first"] = fault_json(status.safety.first_fault, told(status.safety.first_fault, *catalog.model));
  return {{"ok", true},
          {"name", facts.name},
          {"mode", facts.mode},
          {"version", facts.version},
          {"pid", getpid()},
          {"configuration", facts.configuration.string()},
          {"tick", status.tick},
          {"time_s", 1e-9 * static_cast<double>(status.time_ns)},
          {"safety", std::move(safety)},
          {"control_sets", std::move(sets)},
          {"commands_refused", status.commands_refused},
          {"record", record_json(status.record)}};
}

const std::vector<std::string>& list_kinds() {
  static const std::vector<std::string> kinds{"behaviors", "sets",   "objects", "parameters",
                                              "signals",   "joints", "events"};
  return kinds;
}

Json list_json(const std::string& what, const Instance& instance, const InstanceStatus& status, const Answer& report) {
  const Catalog& catalog = instance.catalog();
  if (what == "behaviors") return all_behaviors_json(instance, report);
  if (what == "parameters") return parameters_json(catalog, report);
  if (what == "signals") return signals_json(catalog.signals);
  if (what == "objects") return objects_json(catalog);
  if (what == "sets") return sets_json(catalog, status.control_sets);
  if (what == "joints") return joints_json(*catalog.model);
  if (what == "events") return events_json(report);
  refuse(unknown_name("kind of list", what, list_kinds()));
}

namespace {

using enum OrderArgument::Kind;

// As it is shown to whoever said it.
std::string shown(const std::string& verb) { return "'" + verb.substr(0, 64) + "'"; }

bool fits(const Json& value, OrderArgument::Kind kind) {
  const auto is_text = [](const Json& one) { return one.is_string(); };
  return (kind == text && is_text(value)) || (kind == number && value.is_number()) ||
         (kind == flag && value.is_boolean()) ||
         (kind == texts && value.is_array() && std::ranges::all_of(value, is_text));
}

const char* kind_text(OrderArgument::Kind kind) {
  if (kind == number) return "a number";
  if (kind == flag) return "true or false";
  return kind == texts ? "an array of strings" : "a string";
}

const OrderInfo& order_named(const std::string& verb) {
  if (const OrderInfo* found = find_order(verb)) return *found;
  std::vector<std::string> verbs;
  for (const OrderInfo& order : order_table::orders) verbs.emplace_back(order.verb);
  refuse(unknown_name("verb", verb, verbs));
}

// `called`: what the client calls it.
void check_argument(const OrderInfo& order, const OrderArgument& argument, const char* called, const Json& json) {
  const auto given = json.find(argument.name);
  const std::string quoted = "\"" + std::string(called) + "\"";
  if (given == json.end()) {
    if (argument.required) refuse(std::string(order.verb) + " needs " + quoted);
    return;
  }
  if (!fits(*given, argument.kind)) refuse(quoted + " must be " + kind_text(argument.kind));
  if (argument.kind == text && argument.required && given->get_ref<const std::string&>().empty())
    refuse(std::string(order.verb) + " needs " + quoted);
  if (argument.kind != number) return;
  const double value = given->get<double>();
  if (value >= argument.min && value <= argument.max) return;
  const bool bounded = argument.max < std::numeric_limits<double>::max();
  refuse(quoted + " = " + number_text(value) + " must be " +
         (bounded ? number_text(argument.min) + ".." + number_text(argument.max)
                  : "at least " + number_text(argument.min)));
}

// A field that is not known could be the name of joints, without which an order is about all of them.
void check_names(const OrderInfo& order, const Json& json, const std::vector<std::string>& known) {
  for (const auto& [key, value] : json.items()) {
    if (std::ranges::find(known, key) == known.end())
      refuse(unknown_name("field", key, known, std::string("of ") + order.verb));
  }
}

const std::string& verb_in(const Json& json) {
  const auto verb = json.find("verb");
  if (verb == json.end() || !verb->is_string()) refuse("a request needs \"verb\", a string");
  return verb->get_ref<const std::string&>();
}

}  // namespace

Order OrderRequest::order(const std::string& who, std::uint64_t client) const {
  Order order{.kind = *info->kind, .who = who, .client = client};
  if (json.value("replace", false)) order.kind = Order::Kind::replace;
  if (const OrderArgument* of = info->argument(OrderArgument::Kind::text)) order.text = text(of->name);
  if (const OrderArgument& second = info->arguments[1]; second.kind == OrderArgument::Kind::text) {
    if (const std::string more = text(second.name); !more.empty()) order.text += " " + more;
  }
  if (const OrderArgument* of = info->argument(OrderArgument::Kind::number)) order.value = number(of->name, 0);
  return order;
}

OrderRequest read_request(std::string_view line, Role role) {
  std::optional<Json> json = read_foreign_json(line);
  if (!json || !json->is_object()) refuse("this is no JSON object on one line");
  OrderRequest request{&order_named(verb_in(*json)), std::move(*json)};
  const OrderInfo& order = *request.info;
  std::vector<std::string> known{"verb"};
  for (const OrderArgument& argument : order.arguments) {
    if (argument.kind == none) continue;
    check_argument(order, argument, argument.name, request.json);
    known.emplace_back(argument.name);
  }
  check_names(order, request.json, known);
  if (order.faces == OrderInfo::Faces::paced) refuse(std::string("'") + order.verb + "' is for the page and ROS 2");
  if (order.role > role)
    refuse(std::string("'") + order.verb + "' needs the role " + name(order.role) + "; this socket gives " +
           name(role));
  return request;
}

OrderRequest read_brief_request(const Json& json, bool paced) {
  const std::string& verb = verb_in(json);
  const OrderInfo* const info = find_order(verb);
  if (info == nullptr || !info->is_brief() || (info->faces == OrderInfo::Faces::paced && !paced))
    refuse(shown(verb) + " is no order; there are " + brief_verbs(paced));
  check_names(*info, json, {"verb", "id", "text", "value"});
  OrderRequest request{info};
  for (const auto& [kind, field] : {std::pair{text, "text"}, {number, "value"}}) {
    const auto given = json.find(field);
    if (given != json.end() && !fits(*given, kind)) refuse("\"" + std::string(field) + "\" must be " + kind_text(kind));
    const OrderArgument* const argument = info->argument(kind);
    const bool said = given != json.end() && *given != (kind == text ? Json("") : Json(0));
    if (argument == nullptr) {
      if (said) refuse(std::string(verb) + " takes no \"" + field + "\"");
      continue;
    }
    if (said || (given != json.end() && kind == number)) request.json[argument->name] = *given;
    check_argument(*info, *argument, field, request.json);
  }
  return request;
}

std::vector<PresetOverride> save_changes(Instance& instance, InstancePort& port, const Answer& answer,
                                         const std::string& who, const std::string& preset) {
  const std::vector<PresetOverride> overridden =
      instance.configuration().save(answer.changes, instance.catalog(), {.preset = preset, .values = answer.set});
  (void)port.send({.kind = Order::Kind::saved, .who = who, .changes = answer.changes});
  return overridden;
}

Answer saved(Instance& instance, InstancePort& port, const Answer& answer, const std::string& who,
             const std::string& preset) {
  try {
    const std::vector<PresetOverride> overridden = save_changes(instance, port, answer, who, preset);
    return {.done = true, .text = instance.configuration().told(answer.changes.size(), overridden)};
  } catch (const std::exception& error) {
    return {.done = false, .text = error.what()};
  }
}

}  // namespace kadans
