
#include "behavior_side.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "config/json/fields.h"
#include "config/scenario/event_text.h"
#include "engine/refusal_text.h"
#include "kadans/signal/nearest_name.h"
#include "signal/input_file.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

constexpr std::size_t mark_bytes_max = 200;
constexpr std::size_t orders_in_tick = 64;  // of one kind of client

constexpr std::int64_t control_answers_in_ns = 1'000'000'000, drives_answer_in_ns = 5'000'000'000;

// Whether a drive says that it has done what it was asked for.
bool has_done(DriveOrder order, const DriveStatus& drive) noexcept {
  switch (order) {
    case DriveOrder::enable:
      return drive.state == DriveState::enabled;
    case DriveOrder::disable:
      return drive.state != DriveState::enabled && drive.state != DriveState::homing;
    case DriveOrder::reset:
      return drive.state != DriveState::fault;
    case DriveOrder::home:  // which may take its time
      return drive.homed || drive.state == DriveState::homing;
    case DriveOrder::brake:
      return drive.braked;
    case DriveOrder::release:
      return !drive.braked;
    case DriveOrder::none:
      break;
  }
  return true;
}

// "l_knee is ready", of those that have not; "": all have.
std::string undone_text(DriveOrder order, JointMask joints, const PowerStatus& power, const RobotModel& model) {
  std::string text;
  each_bit(joints, [&](std::uint32_t i) {
    const DriveStatus& drive = power.drives[i];
    if (has_done(order, drive)) return;
    text += (text.empty() ? "" : ", ") + model.joints[i].name + " is " + name(drive.state);
    if (drive.code != 0) text += " (code " + std::to_string(drive.code) + ")";
    if (order == DriveOrder::brake || order == DriveOrder::release) text += drive.braked ? ", braked" : ", not braked";
  });
  return text;
}

bool asks_only(Order::Kind kind) noexcept {
  return kind == Order::Kind::report || kind == Order::Kind::why || kind == Order::Kind::describe;
}

// Whether the line is about the event of this order: others may have come in the same tick.
bool tells_of(const std::string& line, const Order& order) {
  const std::string name = order.text.substr(0, order.text.find_first_of(" \t{"));
  const bool names = line.starts_with("event " + name + " ") || line.starts_with("event '" + name + "'");
  return names && line.find(" from " + order.who) != std::string::npos;
}

bool names_transaction(const Snapshot& snapshot, std::uint32_t sequence, Refusal& refusal) {
  const auto found = std::ranges::find(snapshot.refusals, sequence, &Refusal::sequence);
  if (found == snapshot.refusals.end()) return false;
  refusal = *found;
  return true;
}

}  // namespace

void BehaviorSide::beside_tick(std::int64_t time_ns) {
  time_ns_ = time_ns;
  heed_stop();
  settle();
  settle_decisions();
  for (const auto& port : p_.instance.ports()) {
    for (std::size_t left = orders_in_tick; left > 0; --left) {  // whoever asks again at once waits for the next tick
      std::unique_ptr<OrderCase> order = port->behaviors_.take();
      if (order == nullptr) break;
      carry_out(std::move(order), port->behaviors_);
    }
  }
  if (next_ != nullptr) next_->beside_tick(time_ns);
}

void BehaviorSide::carry_out(std::unique_ptr<OrderCase> order, OrderQueue& from) {
  if (concerns_decisions(order->order) && !order->order.text.empty()) {
    order->answer.done = true;
    return ask_decisions(std::move(order), from);
  }
  Pending pending{.order = std::move(order), .from = &from, .asked_ns = time_ns_, .asked_tick = p_.engine.ticks()};
  Answer& answer = pending.order->answer;
  try {
    if (!begin(pending)) return pending_.push_back(std::move(pending));
    answer.done = true;
  } catch (const std::exception& error) {
    answer.text = error.what();
  }
  this->answer(std::move(pending.order), from);
}

// Those that name what decides, or nobody.
bool BehaviorSide::concerns_decisions(const Order& order) const noexcept {
  const bool kind = order.kind == Order::Kind::why || order.kind == Order::Kind::reload;
  if (!kind || p_.decisions == nullptr || p_.decisions->name.empty()) return false;
  return order.text.empty() || order.text == p_.decisions->name;
}

void BehaviorSide::answer(std::unique_ptr<OrderCase> order, OrderQueue& from) {
  const bool goes_on = order->answer.done || order->order.kind == Order::Kind::reload;
  if (goes_on && concerns_decisions(order->order)) return ask_decisions(std::move(order), from);
  from.answer(std::move(order));
}

void BehaviorSide::ask_decisions(std::unique_ptr<OrderCase> order, OrderQueue& from) {
  const bool why = order->order.kind == Order::Kind::why;
  auto question = std::make_unique<DecisionQuestion>();
  question->number = ++decision_questions_;
  question->question.kind = why ? BehaviorQuestion::Kind::why : BehaviorQuestion::Kind::reload;
  if (p_.decisions->asked.try_push(std::move(question))) {
    asked_decisions_.push_back({std::move(order), &from, time_ns_, decision_questions_});
    return;
  }
  order->answer.done = false;
  order->answer.text = "too many questions wait for the decisions: ask again";
  from.answer(std::move(order));
}

void BehaviorSide::settle_decisions() {
  if (p_.decisions == nullptr) return;
  while (const auto replied = p_.decisions->answered.try_pop()) {
    for (AskedDecisions& asked : asked_decisions_) {
      if (asked.number != replied->number) continue;
      Answer& answer = asked.order->answer;
      BehaviorReply& reply = replied->reply;
      answer.done = answer.done && reply.error.empty();
      if (asked.order->order.kind == Order::Kind::why && answer.done) {
        for (BehaviorReasons& reasons : reply.reasons) answer.reasons.push_back(std::move(reasons));
        answer.text = reasons_text(answer.reasons);
      } else {
        answer.text += (answer.text.empty() ? "" : "\n") + (reply.error.empty() ? reply.text : reply.error);
      }
      asked.from->answer(std::move(asked.order));
    }
    std::erase_if(asked_decisions_, [](const AskedDecisions& asked) { return asked.order == nullptr; });
  }
  std::erase_if(asked_decisions_, [&](AskedDecisions& asked) {
    if (time_ns_ - asked.asked_ns <= control_answers_in_ns) return false;
    asked.order->answer.done = false;
    asked.order->answer.text +=
        (asked.order->answer.text.empty() ? "" : "\n") + std::string("the decisions did not answer within a second");
    asked.from->answer(std::move(asked.order));
    return true;
  });
}

// What played when the emergency stop came does not go on by itself when it is lifted.
void BehaviorSide::heed_stop() {
  const auto snapshot = p_.exchange.snapshot.read(0);
  const bool stopped_before = std::exchange(stopped_, snapshot->status.safety.stopped);
  lifts_ = snapshot->status.safety.lifts;
  if (!stopped_ || stopped_before) return;
  try {
    orders().order({.kind = PlayOrder::Kind::stop, .behavior = {}});
  } catch (const InputError&) {  // the behaviors' process is down: nothing plays
  }
}

// True: it is carried out. False: it takes its time. Throws why not.
bool BehaviorSide::begin(Pending& pending) {
  const Order& order = pending.order->order;
  Answer& answer = pending.order->answer;
  switch (order.kind) {
    case Order::Kind::report:
      return ask(pending, {});
    case Order::Kind::why:
      return ask_why(pending);
    case Order::Kind::describe:
      return ask(pending, {.kind = BehaviorQuestion::Kind::describe});
    case Order::Kind::play:
      return give(pending, PlayOrder::Kind::play), false;
    case Order::Kind::replace:
      return give(pending, PlayOrder::Kind::replace), false;
    case Order::Kind::pause:
      return give(pending, PlayOrder::Kind::pause), false;
    case Order::Kind::resume:
      return give(pending, PlayOrder::Kind::resume), false;
    case Order::Kind::stop:
      return give(pending, PlayOrder::Kind::stop), false;
    case Order::Kind::reload:
      return give(pending, PlayOrder::Kind::reload), false;
    case Order::Kind::emit:
      return give(pending, PlayOrder::Kind::emit), false;
    case Order::Kind::switch_set: {
      const std::uint32_t set = p_.instance.set_named(order.text);
      return send(pending, std::array{Command{.kind = CommandKind::switch_set, .index = set}}), false;
    }
    case Order::Kind::set_point:
      return send(pending, set_points_of(order)), false;
    case Order::Kind::set_parameter:
      return set_parameter(pending, order.text, order.value), false;
    case Order::Kind::undo: {
      const ParameterChange* last = tuning_.newest();
      if (last == nullptr) refuse("there is nothing to undo");
      const auto is_undo = [](const Pending& other) { return other.order->order.kind == Order::Kind::undo; };
      if (std::ranges::any_of(pending_, is_undo)) refuse("somebody else's undo is under way");
      return set_parameter(pending, last->name, last->before), false;
    }
    case Order::Kind::changes:
      answer.changes = tuning_.unsaved();
      answer.set = tuning_.set();
      return true;
    case Order::Kind::saved:
      tuning_.saved(order.changes);
      for (const ParameterChange& change : order.changes)
        say(order.who, "saved " + change.name + " = " + number_text(change.now));
      return true;
    case Order::Kind::clear_faults:
      pending.lifts = lifts_;
      return p_.instance.clear_faults(), false;
    case Order::Kind::reset_odometry:
      return send(pending, std::array{Command{.kind = CommandKind::reset_odometry}}), false;
    case Order::Kind::mark:
      if (order.text.size() > mark_bytes_max) refuse("a mark has at most " + std::to_string(mark_bytes_max) + " bytes");
      return say(order.who, "marks: " + order.text), true;
    case Order::Kind::enable_drives:
    case Order::Kind::disable_drives:
    case Order::Kind::reset_drives:
    case Order::Kind::home_drives:
    case Order::Kind::brake_drives:
    case Order::Kind::release_drives:
      return order_drives(pending), false;
    case Order::Kind::line:
      p_.instance.want_console_row(true);
      (void)console_of(order);
      return false;  // evaluated when there is a row of signals
    case Order::Kind::complete: {
      Console::Completion found = console_of(order).complete(order.text);
      answer.begin = found.begin;
      answer.words = std::move(found.words);
      return true;
    }
    case Order::Kind::leave_console:
      consoles_.erase(order.client);
      if (consoles_.empty()) p_.instance.want_console_row(false);
      return true;
    case Order::Kind::record_start:
    case Order::Kind::record_stop:
    case Order::Kind::record_dump:
      break;
  }
  throw std::logic_error("an order about records came to the behaviors");
}

bool BehaviorSide::waits_for_tick(const Pending& pending) const noexcept {
  const Order::Kind kind = pending.order->order.kind;
  if (pending.asked != 0) return true;
  return pending.sequence == 0 && kind != Order::Kind::line && kind != Order::Kind::clear_faults &&
         p_.engine.ticks() == pending.asked_tick;
}

void BehaviorSide::settle() {
  if (pending_.empty()) return;
  for (Pending& pending : pending_) {
    if (pending.asked != 0) hear(pending);
  }
  const auto snapshot = p_.exchange.snapshot.read(0);
  const bool ticked = std::ranges::none_of(pending_, [this](const Pending& one) { return waits_for_tick(one); });
  if (ticked) lines_ = p_.echo.take();
  std::erase_if(pending_, [&](Pending& pending) {
    if (!settled(pending, *snapshot)) return false;
    answer(std::move(pending.order), *pending.from);
    return true;
  });
}

bool BehaviorSide::settled(Pending& pending, const Snapshot& snapshot) {
  const Order& order = pending.order->order;
  Answer& answer = pending.order->answer;
  const bool late = time_ns_ - pending.asked_ns > control_answers_in_ns;
  if (order.kind == Order::Kind::line) {
    const auto row = p_.instance.console_row();
    if (row->values.empty() && !late) return false;
    evaluate(order, answer);
    return true;
  }
  if (order.kind == Order::Kind::clear_faults) {
    const bool lifted = snapshot.status.safety.lifts != pending.lifts;
    if (lifted) finish(pending);
    if (!lifted && late) answer.text = "the control thread did not clear them within a second, or was stopped again";
    return lifted || late;
  }
  if (pending.failed) return true;
  if (waits_for_tick(pending)) {
    if (late) answer.text = "the behaviors did not tick within a second";
    return late;
  }
  if (pending.sequence == 0) {
    answer.done = true;
    if (order.kind == Order::Kind::set_parameter || order.kind == Order::Kind::undo) {
      finish(pending);
    } else if (!asks_only(order.kind)) {
      answer.text = told(pending, answer.done);
    }
    return true;
  }
  Refusal refusal;
  if (names_transaction(snapshot, pending.sequence, refusal)) {
    answer.text = refusal_text(refusal, p_.instance.catalog());
    return true;
  }
  const bool taken = snapshot.transactions_applied >= pending.sequence;
  if (const DriveOrder asked = drive_order_of(order.kind); taken && asked != DriveOrder::none) {
    const std::string undone = undone_text(asked, pending.joints, snapshot.power, *p_.instance.catalog().model);
    if (!std::exchange(pending.logged, true))
      say(order.who, std::string("asks drives to ") + name(asked) + ": " + (order.text.empty() ? "all" : order.text));
    answer.done = undone.empty();
    const bool given_up = !answer.done && time_ns_ - pending.asked_ns > drives_answer_in_ns;
    if (answer.done && asked == DriveOrder::home) answer.text = "asked; `kadans ctl drives` tells when they are homed";
    if (given_up) answer.text = undone + ", 5 s after it was asked to " + name(asked);
    return answer.done || given_up;
  }
  if (taken) {
    finish(pending);
    return true;
  }
  if (late) answer.text = "the control thread did not take it within a second";
  return late;
}

// The control engine, or the behavior, has taken it.
void BehaviorSide::finish(Pending& pending) {
  const Order& order = pending.order->order;
  Answer& answer = pending.order->answer;
  answer.done = true;
  const ParameterChange& change = pending.change;
  switch (order.kind) {
    case Order::Kind::switch_set:
      return say(order.who, "switched to control set " + order.text);
    case Order::Kind::clear_faults:
      return say(order.who, "cleared the faults");
    case Order::Kind::reset_odometry:
      return say(order.who, "reset the odometry");
    case Order::Kind::set_point:
      if (time_ns_ - std::exchange(led_ns_, time_ns_) < led_again_ns) return;
      return say(order.who, "set " + order.text);
    case Order::Kind::undo:
      tuning_.drop();
      break;
    case Order::Kind::set_parameter:
      tuning_.note(change);
      break;
    default:
      return;
  }
  answer.changes = {change};
  say(order.who, (order.kind == Order::Kind::undo ? "undid " : "set ") + change.name + ": " +
                     number_text(change.before) + " -> " + number_text(change.now));
}

void BehaviorSide::say(const std::string& who, const std::string& what) {
  p_.log.message(time_ns_, BehaviorLog::Severity::info, "ctl", who.empty() ? what : who + " " + what);
}

// Orders: what plays, control sets, parameters, consoles.

namespace {

constexpr ScriptLimits console_limits{.tick_instructions = 200'000,
                                      .load_instructions = 5'000'000,
                                      .tick_wall_ns = 20'000'000,
                                      .load_wall_ns = 100'000'000,
                                      .memory_bytes = std::size_t{4} << 20};

}  // namespace

// True: the behaviors have replied, as they do in this process. One of their own replies with its next answer.
bool BehaviorSide::ask(Pending& pending, const BehaviorQuestion& question) {
  if (p_.process != nullptr) {
    pending.asked = p_.process->ask(question);
    return false;
  }
  const auto snapshot = p_.exchange.snapshot.read(0);
  take(pending, p_.host->reply(question, *snapshot));
  return true;
}

bool BehaviorSide::ask_why(Pending& pending) {
  if (std::exchange(why_tick_, p_.engine.ticks()) == p_.engine.ticks())  // it costs a reload
    refuse("somebody else asked why in the same tick: ask again");
  return ask(pending, {.kind = BehaviorQuestion::Kind::why, .text = pending.order->order.text});
}

void BehaviorSide::take(Pending& pending, BehaviorReply&& reply) {
  Answer& answer = pending.order->answer;
  answer.paused = reply.paused;
  answer.behaviors = std::move(reply.behaviors);
  answer.reasons = std::move(reply.reasons);
  answer.text = pending.order->order.kind == Order::Kind::why ? reasons_text(answer.reasons) : std::move(reply.text);
  pending.change.before = reply.before;
  pending.change.chunk = std::move(reply.chunk);
}

// What the behaviors' process replies. One that is late is not waited for; a report then tells what it told last.
void BehaviorSide::hear(Pending& pending) {
  std::optional<BehaviorReply> reply = p_.process->reply(pending.asked);
  if (!reply && time_ns_ - pending.asked_ns <= control_answers_in_ns) return;
  if (!reply) {
    p_.process->forget(pending.asked);
    reply = pending.order->order.kind == Order::Kind::report
                ? p_.process->last_report()
                : BehaviorReply{.error = "the behaviors' process did not answer within a second"};
  }
  pending.asked = 0;
  pending.failed = !reply->error.empty();
  if (pending.failed) {
    pending.order->answer.text = reply->error;
  } else {
    take(pending, std::move(*reply));
  }
}

// To the behaviors; the next tick carries it out.
void BehaviorSide::give(Pending& pending, PlayOrder::Kind kind) {
  const Order& order = pending.order->order;
  pending.given = kind;
  const bool plays = kind == PlayOrder::Kind::play || kind == PlayOrder::Kind::replace;
  if ((plays || kind == PlayOrder::Kind::resume) && stopped_)
    refuse("the emergency stop keeps the robot down: clear the faults first (kadans ctl fault clear)");
  PlayOrder given{.kind = kind, .behavior = {kind == PlayOrder::Kind::reload ? order.text : "", {}}};
  if (plays) given.list = read_play_items(order.text, "LIST", p_.instance.facts().folders);
  if (kind == PlayOrder::Kind::emit) {
    given.event = read_event(order.text, "event");
    given.event.who = order.who;
    given.event.ordered = true;
  }
  if (p_.process != nullptr) {
    pending.asked = p_.process->ask(given);
  } else {
    p_.host->order(given);
  }
  p_.echo.listen();
}

// What was said in the tick that carried it out: by the supervisor, or by the behavior that was reloaded.
std::string BehaviorSide::told(const Pending& pending, bool& done) {
  const Order& order = pending.order->order;
  const bool reload = pending.given == PlayOrder::Kind::reload;
  std::string text;
  for (const LineEcho::Heard& line : lines_) {
    const bool supervisor = line.behavior == "supervisor";
    if (reload ? supervisor || (!order.text.empty() && line.behavior != order.text) : !supervisor) continue;
    const bool of_event = line.text.starts_with("event ");  // also those of others in the same tick
    if (pending.given == PlayOrder::Kind::emit ? !tells_of(line.text, order) : of_event && !reload) continue;
    if (line.severity != BehaviorLog::Severity::info) done = false;
    text += (text.empty() ? "" : "\n") + (supervisor ? "" : line.behavior + ": ") + line.text;
  }
  if (reload && text.empty()) return "no new version: the files are as they were loaded";
  if (!order.who.empty() && !reload && pending.given != PlayOrder::Kind::emit)
    say(order.who, "asked for " + play_order_names[static_cast<std::size_t>(pending.given)]);
  return text;
}

void BehaviorSide::send(Pending& pending, std::span<const Command> commands) {
  CommandSender& sender = p_.engine.sender();
  sender.begin(time_ns_);
  for (const Command& command : commands) (void)sender.add(command);
  pending.sequence = sender.commit();
  if (pending.sequence == 0) refuse("the command queue is full");
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
  if (const auto i = model.find_joint(order.text)) refuse("joint '" + order.text + "' is passive: it has no drive");
  refuse(unknown_name("joint", order.text, names));
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
    refuse("a set-point is reached in 0.." + number_text(motion_duration_max_s) + " s");
  std::vector<Command> commands;
  std::istringstream entries(order.text);
  for (std::string entry; std::getline(entries, entry, ',');) {
    const std::size_t equals = std::min(entry.find('='), entry.size());
    const std::string name = entry.substr(0, equals);
    const std::optional<double> value =
        number_of<double>(std::string_view(entry).substr(std::min(equals + 1, entry.size())));
    if (!value) refuse("'" + entry + "' must be NAME=NUMBER, such as gaze.x_m=1.2");
    const auto id = table.find(name);
    if (!id) refuse(unknown_name("set-point", name, table.names()));
    const Setpoint& info = table[*id];
    if (!table.accepts(*id, *value)) refuse(outside_range(name, *value, info.min, info.max, info.unit));
    commands.push_back({.kind = CommandKind::set_point, .index = *id, .value = *value, .duration_s = order.value});
  }
  if (commands.empty()) refuse("there is no set-point in it");
  return commands;
}

// Of the control layer: one command. Of a behavior: at once.
void BehaviorSide::set_parameter(Pending& pending, const std::string& name, double value) {
  if (!std::isfinite(value)) refuse("a number is needed");
  const ParameterTable& table = p_.instance.catalog().parameters;
  if (const auto id = table.find(name)) {
    const Parameter& info = table.info(*id);
    if (!table.accepts(*id, value)) refuse(outside_range(name, value, info.min, info.max, info.unit));
    pending.change = {name, table.newest(*id), value, {}};
    for (const Pending& other : pending_) {
      if (other.change.name == name) pending.change.before = other.change.now;
    }
    return send(pending, std::array{Command{.kind = CommandKind::set_parameter, .index = *id, .value = value}});
  }
  pending.change = {name, 0, value, {}};
  (void)ask(pending, {.kind = BehaviorQuestion::Kind::set_parameter, .text = name, .value = value});
}

// Consoles of clients have a smaller budget than that of a simulation, because the robot waits for them.
Console& BehaviorSide::console_of(const Order& order) {
  if (p_.host == nullptr)
    refuse("there is no console while behaviors play in a process of their own: run with --behaviors thread");
  const auto found = consoles_.find(order.client);
  if (found != consoles_.end()) return *found->second;
  if (consoles_.size() == consoles_max) refuse("all consoles are taken");
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
  if (console.writes()) say(order.who, "typed " + order.text);
}

}  // namespace kadans
