#include "run_description.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "config/json/foreign_json.h"
#include "kadans/control/set_partition.h"
#include "kadans/model/kinematics.h"
#include "script/chart/chart_graph.h"

namespace kadans {
namespace {

using Json = nlohmann::ordered_json;

Json vector_of(const Vec3& v) { return {v[0], v[1], v[2]}; }

constexpr const char* kind_names[] = {"state", "parallel", "region", "final", "history"};  // by Chart::Kind
static_assert(std::size(kind_names) == static_cast<std::size_t>(Chart::Kind::history) + 1);

Json number_of(StateIndex state) { return state == no_state ? Json(nullptr) : Json(state); }

// A transition has an entry for each of its targets, or one without a target when it is an action alone.
Json chart_of(const Behavior& behavior) {
  const Chart& chart = behavior.chart();
  const std::vector<ScriptParameter> parameters = behavior.parameters();
  Json states = Json::array(), transitions = Json::array();
  for (const Chart::State& state : chart.states) {
    states.push_back({{"name", state.name},
                      {"path", state.path},
                      {"kind", kind_names[static_cast<std::size_t>(state.kind)]},
                      {"parent", number_of(state.parent)},
                      {"initial", number_of(state.initial)}});
    if (state.deep) states.back()["deep"] = true;
  }
  const std::vector<GuardSource> guards = behavior.guards();
  for (std::size_t i = 0; i < chart.transitions.size(); ++i) {
    const Chart::Transition& transition = chart.transitions[i];
    const Chart::State& source = chart.states[transition.source];
    Json one{{"number", i},
             {"source", transition.source},
             {"target", number_of(transition.target)},
             {"label", transition_label(chart, transition, parameters)},
             {"line", source.chunk + ":" + std::to_string(transition.line)}};
    if (i - source.first_always < source.always_count) one["always"] = true;
    if (transition.internal) one["internal"] = true;
    if (!guards[i].file.empty()) one["guard"] = guard_json(guards[i]);
    transitions.push_back(one);
    for (const StateIndex target : transition.also) {
      one["target"] = target;
      transitions.push_back(one);
    }
  }
  return {{"states", states}, {"transitions", transitions}};
}

// Of a behavior or of the table. An infinite range has no JSON number: null.
Json parameter_of(const auto& p, double value) {
  return {{"name", p.name},       {"unit", p.unit}, {"min", p.min}, {"max", p.max},
          {"initial", p.initial}, {"value", value}, {"doc", p.doc}};
}

Json behaviors_of(const ScriptHost* host) {
  Json behaviors = Json::array();
  for (std::size_t i = 0; host != nullptr && i < host->size(); ++i) {
    const Behavior& behavior = host->behavior(i);
    Json parameters = Json::array();
    for (const ScriptParameter& p : behavior.parameters()) parameters.push_back(parameter_of(p, p.value));
    Json events = Json::array();
    for (const ScriptEvent& event : behavior.events()) events.push_back(event_json(event));
    behaviors.push_back(
        {{"name", behavior.name()}, {"chart", chart_of(behavior)}, {"parameters", parameters}, {"events", events}});
  }
  return behaviors;
}

Json robot_of(const RobotConfig& robot, const std::string& called) {
  Json joints = Json::array(), feet = Json::array();
  for (const Joint& joint : robot.model.joints) joints.push_back(joint.name);
  for (const FootSettings& foot : robot.plant.feet) {
    Json corners = Json::array();
    for (const Vec3& sensor_m : foot.sensors_m) corners.push_back(vector_of(sensor_m));
    feet.push_back({{"link", foot.link}, {"corners_m", corners}});
  }
  return {{"name", robot.name},
          {"called", called.empty() ? robot.name : called},
          {"base", robot.model.links.front().name},
          {"mass_kg", robot.model.mass_kg()},
          {"joints", joints},
          {"feet", feet},
          {"control_period_ns", robot.engine.control_period_ns()}};
}

Json sets_of(const Catalog& catalog) {
  Json sets = Json::array();
  for (std::uint32_t i = 0; i < catalog.sets.size(); ++i) {
    Json objects = Json::array();
    for (const std::uint32_t object : catalog.sets[i].objects) objects.push_back(catalog.objects[object].name);
    sets.push_back(
        {{"name", catalog.sets[i].name}, {"objects", objects}, {"initial", (catalog.initial_sets & set_bit(i)) != 0}});
  }
  return sets;
}

Json objects_of(const RobotConfig& robot, const Catalog& catalog) {
  Json objects = Json::array();
  for (const ObjectInfo& object : catalog.objects) {
    Json options = Json::object();
    const auto configured = std::ranges::find(robot.objects, object.name, &ObjectConfig::name);
    if (configured != robot.objects.end()) {
      for (const TextEntry& option : configured->options) options[option.key] = option.text;
    }
    Json joints = Json::array(), presets = Json::array();
    for (const std::size_t joint : object.joints) joints.push_back(catalog.model->joints[joint].name);
    for (const Preset& preset : object.presets) {
      Json values = Json::object();
      for (const auto& [id, value] : preset.values) values[catalog.parameters.info(id).name] = value;
      presets.push_back({{"name", preset.name}, {"values", values}});
    }
    objects.push_back(
        {{"name", object.name}, {"type", object.type}, {"options", options}, {"joints", joints}, {"presets", presets}});
  }
  return objects;
}

Json parameters_of(const Catalog& catalog) {
  Json parameters = Json::array();
  for (ParameterId id = 0; id < catalog.parameters.size(); ++id)
    parameters.push_back(parameter_of(catalog.parameters.info(id), catalog.parameters.get(id)));
  return parameters;
}

// The plane through the world's origin, and what is painted on it. One that is driven has signals world.ground.x_m and
// so on.
Json ground_of(const WorldSettings& world) {
  const auto& [w, x, y, z] = ground_pose(world).orientation;
  Json markings = Json::array();
  for (const GroundMarkings& painted : world.markings) {
    Json lines = Json::array(), arcs = Json::array();
    for (const auto& [from_m, to_m] : painted.lines) lines.push_back({{"from_m", from_m}, {"to_m", to_m}});
    for (const GroundMarkings::Arc& arc : painted.arcs) {
      arcs.push_back(
          {{"center_m", arc.center_m}, {"radius_m", arc.radius_m}, {"from_rad", arc.from_rad}, {"to_rad", arc.to_rad}});
    }
    markings.push_back({{"line_m", painted.line_m}, {"lines", lines}, {"arcs", arcs}});
  }
  return {{"orientation_xyzw", {x, y, z, w}}, {"markings", markings}};
}

// What is carried without an end has no until_s.
Json payloads_of(const WorldSettings& world) {
  Json payloads = Json::array();
  for (const PayloadSettings& payload : world.payloads) {
    payloads.push_back({{"name", payload.name},
                        {"link", payload.link},
                        {"point_m", vector_of(payload.point_m)},
                        {"mass_kg", payload.mass_kg},
                        {"from_s", payload.from_s}});
    if (std::isfinite(payload.until_s)) payloads.back()["until_s"] = payload.until_s;
  }
  return payloads;
}

// Where they are at the start; those that move have signals world.<name>.x_m and so on.
Json world_of(const WorldSettings& world) {
  Json objects = Json::array();
  for (const WorldObject& object : world.objects) {
    Json one{{"name", object.name}, {"position_m", vector_of(object.pose.position_m)}};
    if (const auto* ball = std::get_if<WorldBall>(&object.shape)) one["radius_m"] = ball->radius_m;
    if (const auto* pendulum = std::get_if<WorldPendulum>(&object.shape)) {
      one["radius_m"] = pendulum->radius_m;
      one["hinge_m"] = vector_of(transform(object.pose, {0, 0, pendulum->length_m}));
    }
    for (const SolidBox& box : solid_boxes(object)) {
      const auto& [w, x, y, z] = box.pose.orientation;
      one["boxes"].push_back({{"size_m", vector_of(box.size_m)},
                              {"position_m", vector_of(box.pose.position_m)},
                              {"orientation_xyzw", {x, y, z, w}}});
    }
    objects.push_back(std::move(one));
  }
  return objects;
}

}  // namespace

Json guard_json(const GuardSource& guard) { return {{"file", guard.file}, {"line", guard.line}, {"text", guard.text}}; }

Json event_json(const ScriptEvent& event) {
  constexpr const char* types[] = {"number", "flag", "text"};
  Json fields = Json::array();
  for (const ScriptEvent::Field& field : event.fields) {
    Json one{{"name", field.name}, {"type", types[static_cast<std::size_t>(field.type)]}};
    if (!field.unit.empty()) one["unit"] = field.unit;
    if (!field.doc.empty()) one["doc"] = field.doc;
    if (field.type == ScriptEvent::Field::Type::number && std::isfinite(field.min)) one["min"] = field.min;
    if (field.type == ScriptEvent::Field::Type::number && std::isfinite(field.max)) one["max"] = field.max;
    if (field.optional) one["optional"] = true;
    fields.push_back(std::move(one));
  }
  return {{"name", event.name}, {"doc", event.doc}, {"fields", fields}};
}

void describe_robots(RecordWriter& record, const RobotTexts& texts, std::int64_t time_ns) {
  // A disk that fails is told when the record is closed.
  if (!texts.urdf.empty()) (void)record.describe_robot(texts.name, texts.urdf, time_ns);
  for (const RobotTexts::Other& other : texts.others) (void)record.describe_other(other.name, other.urdf, time_ns);
  if (!texts.description.empty()) (void)record.describe_parts(texts.description, time_ns);
}

std::string run_description(const RobotConfig& robot, const std::string& called, const Catalog& catalog,
                            const ScriptHost* host, const WorldSettings& world) {
  const Json description{
      {"robot", robot_of(robot, called)},     {"sets", sets_of(catalog)},       {"objects", objects_of(robot, catalog)},
      {"parameters", parameters_of(catalog)}, {"world", world_of(world)},       {"ground", ground_of(world)},
      {"payloads", payloads_of(world)},       {"behaviors", behaviors_of(host)}};
  return json_text(description);
}

std::string behaviors_description(const ScriptHost* host) { return json_text(behaviors_of(host)); }

}  // namespace kadans
