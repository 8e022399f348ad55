// Orders: what plays, control sets, parameters, consoles.

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <sstream>
#include <string_view>

#include "behavior_side.h"
#include "config/json/fields.h"
#include "config/json/name_pattern.h"
#include "run_description.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

// What the supervisor's list calls it.
PlayOrder::Kind kind_of(Order::Kind kind) {
  switch (kind) {
    case Order::Kind::play:
      return PlayOrder::Kind::play;
    case Order::Kind::replace:
      return PlayOrder::Kind::replace;
    case Order::Kind::pause:
      return PlayOrder::Kind::pause;
    case Order::Kind::resume:
      return PlayOrder::Kind::resume;
    case Order::Kind::reload:
      return PlayOrder::Kind::reload;
    default:
      return PlayOrder::Kind::stop;
  }
}

// The parameters of behaviors are where their process is.
void check_is_no_behavior(const std::vector<std::string>& behaviors, const std::string& parameter) {
  const std::string name = parameter.substr(0, parameter.find('.'));
  if (std::find(behaviors.begin(), behaviors.end(), name) == behaviors.end()) return;
  throw InputError({.message = "parameters of behaviors cannot be set while they play in a process of their own: "
                               "change its file, then `kadans ctl reload " +
                               name + "`; or run with --behaviors thread"});
}

void check_range(const std::string& name, const std::string& unit, double value, double min, double max) {
  if (value >= min && value <= max) return;
  throw InputError({.message = name + " = " + number_text(value) + " is outside its range " + number_text(min) + ".." +
                               number_text(max) + (unit.empty() ? "" : " " + unit)});
}

constexpr ScriptLimits console_limits{.tick_instructions = 200'000,
                                      .load_instructions = 5'000'000,
                                      .tick_wall_ns = 20'000'000,
                                      .load_wall_ns = 100'000'000,
                                      .memory_bytes = std::size_t{4} << 20};

}  // namespace

void BehaviorSide::report(Answer& answer) const {
  if (p_.host == nullptr) return report_process(answer);
  const ScriptHost& host = *p_.host;
  answer.paused = host.paused();
  for (std::size_t i = 0; i < host.size(); ++i) {
    const Behavior& behavior = host.behavior(i);
    answer.behaviors.push_back({.name = behavior.name(),
                                .state = behavior.state(),
                                .outcome = behavior.outcome(),
                                .error = behavior.failed() ? behavior.error().text() : "",
                                .lane = host.lane(i),
                                .over = host.over(i),
                                .chart = chart_sign(behavior.chart()),
                                .parameters = behavior.parameters()});
  }
}

// What a process tells of its behaviors while it plays.
void BehaviorSide::report_process(Answer& answer) const {
  const ProcessHost& process = *p_.process;
  answer.paused = process.paused();
  for (std::size_t i = 0; i < process.names().size(); ++i) {
    answer.behaviors.push_back({.name = process.names()[i],
                                .state = process.down() ? "" : "state " + std::to_string(process.state(i)),
                                .outcome = "",
                                .error = process.down() ? "its process stays down" : "",
                                .lane = 0,
                                .over = process.down() || process.finished(),
                                .chart = 0,
                                .parameters = {}});
  }
}

// To the behaviors; the next tick carries it out.
void BehaviorSide::give(const Order& order) {
  const PlayOrder::Kind kind = kind_of(order.kind);
  if (kind == PlayOrder::Kind::reload && order.text.empty()) {
    p_.echo.listen();
    for (std::size_t i = 0; p_.host != nullptr && i < p_.host->size(); ++i) {
      if (!p_.host->over(i)) p_.host->order({.kind = kind, .behavior = {p_.host->behavior(i).name(), {}}});
    }
    if (p_.host != nullptr) return;
    throw InputError({.message = "behaviors play in a process of their own: name the one to be read again"});
  }
  const bool plays = kind == PlayOrder::Kind::play || kind == PlayOrder::Kind::replace;
  if ((plays || kind == PlayOrder::Kind::resume) && stopped_)
    throw InputError(
        {.message = "the emergency stop keeps the robot down: clear the faults first (kadans ctl fault clear)"});
  PlayOrder given{.kind = kind, .behavior = {kind == PlayOrder::Kind::reload ? order.text : "", {}}};
  if (plays) given.list = read_play_items(order.text, "LIST", p_.instance.facts().folders);
  orders().order(given);
  p_.echo.listen();
}

// What was said in the tick that carried it out: by the supervisor, or by the behavior that was reloaded.
std::string BehaviorSide::told(const Order& order, bool& done) {
  const bool reload = order.kind == Order::Kind::reload;
  std::string text;
  for (const LineEcho::Heard& line : lines_) {
    const bool supervisor = line.behavior == "supervisor";
    if (reload ? supervisor || (!order.text.empty() && line.behavior != order.text) : !supervisor) continue;
    if (line.severity != BehaviorLog::Severity::info) done = false;
    text += (text.empty() ? "" : "\n") + (supervisor ? "" : line.behavior + ": ") + line.text;
  }
  if (reload && text.empty()) return "no new version: the files are as they were loaded";
  if (!order.who.empty() && !reload)
    say(time_ns_, order.who, "asked for " + play_order_names[static_cast<std::size_t>(kind_of(order.kind))]);
  return text;
}

void BehaviorSide::send(Pending& pending, std::span<const Command> commands) {
  CommandSender& sender = p_.engine.sender();
  sender.begin(time_ns_);
  for (const Command& command : commands) (void)sender.add(command);
  pending.sequence = sender.commit();
  if (pending.sequence == 0) throw InputError({.message = "the command queue is full"});
}

// Those with a drive. Throws where there is none.
JointMask BehaviorSide::joints_of(const Order& order) const {
  const RobotModel& model = *p_.instance.catalog().model;
  const std::vector<std::string> names = model.joint_names();
  JointMask joints = 0;
  for (const std::size_t i : matching(order.text.empty() ? "*" : order.text, names)) {
    if (!model.joints[i].passive()) joints |= joint_bit(i);
  }
  if (joints != 0) return joints;
  if (const auto i = model.find_joint(order.text))
    throw InputError({.message = "joint '" + order.text + "' is passive: it has no drive"});
  throw InputError({.message = unknown_name("joint", order.text, names)});
}

void BehaviorSide::order_drives(Pending& pending) {
  const Order& order = pending.order->order;
  pending.joints = joints_of(order);
  std::vector<Command> commands;
  each_bit(pending.joints, [&](std::uint32_t joint) {
    commands.push_back({.kind = CommandKind::order_drive,
                        .index = joint,
                        .count = static_cast<std::uint32_t>(drive_order_of(order.kind))});
  });
  send(pending, commands);
}

// All are known and within their ranges.
std::vector<Command> BehaviorSide::set_points_of(const Order& order) const {
  const SetpointTable& table = p_.instance.catalog().setpoints;
  if (!(order.value >= 0 && order.value <= motion_duration_max_s))
    throw InputError({.message = "a set-point is reached in 0.." + number_text(motion_duration_max_s) + " s"});
  std::vector<Command> commands;
  std::istringstream entries(order.text);
  for (std::string entry; std::getline(entries, entry, ',');) {
    const std::size_t equals = std::min(entry.find('='), entry.size());
    const std::string name = entry.substr(0, equals);
    const std::optional<double> value =
        number_of<double>(std::string_view(entry).substr(std::min(equals + 1, entry.size())));
    if (!value) throw InputError({.message = "'" + entry + "' must be NAME=NUMBER, such as gaze.x_m=1.2"});
    const auto id = table.find(name);
    if (!id) throw InputError({.message = unknown_name("set-point", name, table.names())});
    check_range(name, table[*id].unit, *value, table[*id].min, table[*id].max);
    commands.push_back({.kind = CommandKind::set_point, .index = *id, .value = *value, .duration_s = order.value});
  }
  if (commands.empty()) throw InputError({.message = "there is no set-point in it"});
  return commands;
}

// The name as it is known, and the value now.
ParameterChange BehaviorSide::change_of(const Order& order) const {
  if (!std::isfinite(order.value)) throw InputError({.message = "a number is needed"});
  const ParameterTable& table = p_.instance.catalog().parameters;
  if (const auto id = table.find(order.text)) {
    const Parameter& info = table.info(*id);
    check_range(info.name, info.unit, order.value, info.min, info.max);
    double before = table.newest(*id);
    for (const Pending& other : pending_) {
      if (other.change.name == order.text) before = other.change.now;
    }
    return {order.text, before, order.value, {}};
  }
  std::vector<std::string> names = table.names();
  for (std::size_t i = 0; p_.host != nullptr && i < p_.host->size(); ++i) {
    const Behavior& behavior = p_.host->behavior(i);
    for (const ScriptParameter& own : behavior.parameters()) {
      names.push_back(behavior.name() + "." + own.name);
      if (names.back() != order.text) continue;
      check_range(order.text, own.unit, order.value, own.min, own.max);
      return {order.text, own.value, order.value, own.chunk};
    }
  }
  if (p_.process != nullptr) check_is_no_behavior(p_.process->names(), order.text);
  throw InputError({.message = unknown_name("parameter", order.text, names)});
}

void BehaviorSide::begin_change(Pending& pending, const ParameterChange& change) {
  pending.change = change;
  if (const auto id = p_.instance.catalog().parameters.find(change.name)) {
    pending.lasting = true;
    return send(pending, std::array{Command{.kind = CommandKind::set_parameter, .index = *id, .value = change.now}});
  }
  for (std::size_t i = 0; p_.host != nullptr && i < p_.host->size(); ++i) {
    Behavior& behavior = p_.host->behavior(i);
    const std::string own = behavior.name() + ".";
    if (!change.name.starts_with(own) || !behavior.set_parameter(change.name.substr(own.size()), change.now)) continue;
    pending.lasting = true;
    return;
  }
  throw InputError({.message = change.name + " is not there any more"});
}

// Consoles of clients have a smaller budget than that of a simulation, because the robot waits for them.
Console& BehaviorSide::console_of(const Order& order) {
  if (p_.host == nullptr)
    throw InputError(
        {.message = "there is no console while behaviors play in a process of their own: run with --behaviors thread"});
  const auto found = consoles_.find(order.client);
  if (found != consoles_.end()) return *found->second;
  if (consoles_.size() == consoles_max) throw InputError({.message = "all consoles are taken"});
  const Instance::Facts& facts = p_.instance.facts();
  return *(consoles_[order.client] = std::make_unique<Console>(
               Console::Settings{.root = facts.root, .folders = facts.folders, .limits = console_limits},
               p_.instance.catalog(), *p_.host));
}

void BehaviorSide::evaluate(const Order& order, Answer& answer) {
  if (!consoles_.contains(order.client)) return;  // who typed it is gone
  const ParameterTable& table = p_.instance.catalog().parameters;
  parameters_.resize(table.size());
  for (ParameterId id = 0; id < table.size(); ++id) parameters_[id] = table.newest(id);
  Console& console = console_of(order);
  const auto snapshot = p_.exchange.snapshot.read(0);
  const auto row = p_.instance.console_row();
  const Console::Reply reply = console.evaluate(order.text, {*snapshot, row->values, parameters_, p_.engine.sender()});
  answer.done = !reply.error && reply.run_s == 0;
  answer.text = reply.run_s > 0 ? ":run is for a simulation that waits; time goes on by itself here" : reply.text;
  answer.incomplete = reply.incomplete;
  answer.writes = console.writes();
  answer.leaves = reply.quit;
  if (console.writes()) say(time_ns_, order.who, "typed " + order.text);
}

}  // namespace kadans
