#include "behavior_side.h"

#include <algorithm>
#include <array>
#include <exception>
#include <utility>

#include "config/json/fields.h"
#include "engine/refusal_text.h"
#include "run_description.h"

namespace kadans {
namespace {

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
  settle(time_ns);
  for (const auto& port : p_.instance.ports()) {
    while (std::unique_ptr<OrderCase> order = port->behaviors_.take())
      carry_out(std::move(order), port->behaviors_, time_ns);
  }
  if (next_ != nullptr) next_->beside_tick(time_ns);
}

void BehaviorSide::carry_out(std::unique_ptr<OrderCase> order, OrderQueue& from, std::int64_t time_ns) {
  try {
    if (carry_out_now(order->order, order->answer)) {
      order->answer.done = true;
      return from.answer(std::move(order));
    }
    Pending pending{.order = std::move(order), .from = &from, .asked_ns = time_ns, .asked_tick = p_.engine.ticks()};
    try {
      begin(pending);
    } catch (...) {
      order = std::move(pending.order);
      throw;
    }
    pending_.push_back(std::move(pending));
  } catch (const std::exception& error) {
    order->answer.text = error.what();
    from.answer(std::move(order));
  }
}

// What played when the emergency stop came does not go on by itself when it is lifted.
void BehaviorSide::heed_stop() {
  const auto snapshot = p_.exchange.snapshot.read(0);
  const bool stopped_before = std::exchange(stopped_, snapshot->status.safety.stopped);
  lifts_ = snapshot->status.safety.lifts;
  if (stopped_ && !stopped_before) orders().order({.kind = PlayOrder::Kind::stop, .behavior = {}});
}

// False: it takes its time. Throws why not.
bool BehaviorSide::carry_out_now(const Order& order, Answer& answer) {
  switch (order.kind) {
    case Order::Kind::report:
      report(answer);
      return true;
    case Order::Kind::describe:
      answer.text = behaviors_description(p_.host);
      return true;
    case Order::Kind::changes:
      answer.changes = tuning_.unsaved();
      answer.set = tuning_.set();
      return true;
    case Order::Kind::saved:
      tuning_.saved(order.changes);
      for (const ParameterChange& change : order.changes)
        say(time_ns_, order.who, "saved " + change.name + " = " + number_text(change.now));
      return true;
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
    default:
      return false;
  }
}

// What is not answered at once.
void BehaviorSide::begin(Pending& pending) {
  const Order& order = pending.order->order;
  switch (order.kind) {
    case Order::Kind::switch_set:
      return send(pending,
                  std::array{Command{.kind = CommandKind::switch_set, .index = p_.instance.set_named(order.text)}});
    case Order::Kind::clear_faults:
      pending.lifts = lifts_;
      return p_.instance.clear_faults();
    case Order::Kind::set_point:
      return send(pending, set_points_of(order));
    case Order::Kind::set_parameter:
      return begin_change(pending, change_of(order));
    case Order::Kind::undo: {
      const ParameterChange* last = tuning_.newest();
      if (last == nullptr) throw InputError({.message = "there is nothing to undo"});
      const auto is_undo = [](const Pending& other) { return other.order->order.kind == Order::Kind::undo; };
      if (std::ranges::any_of(pending_, is_undo)) throw InputError({.message = "somebody else's undo is under way"});
      return begin_change(pending, {last->name, last->now, last->before, last->chunk});
    }
    case Order::Kind::line:
      p_.instance.want_console_row(true);
      (void)console_of(order);
      return;  // evaluated when there is a row of signals
    default:
      return drive_order_of(order.kind) == DriveOrder::none ? give(order) : order_drives(pending);
  }
}

bool BehaviorSide::waits_for_tick(const Pending& pending) const noexcept {
  const Order::Kind kind = pending.order->order.kind;
  return pending.sequence == 0 && kind != Order::Kind::line && kind != Order::Kind::clear_faults &&
         p_.engine.ticks() == pending.asked_tick;
}

void BehaviorSide::settle(std::int64_t time_ns) {
  if (pending_.empty()) return;
  const auto snapshot = p_.exchange.snapshot.read(0);
  const bool ticked = std::ranges::none_of(pending_, [this](const Pending& one) { return waits_for_tick(one); });
  if (ticked) lines_ = p_.echo.take();
  std::erase_if(pending_, [&](Pending& pending) {
    if (!settled(pending, *snapshot, time_ns)) return false;
    pending.from->answer(std::move(pending.order));
    return true;
  });
}

bool BehaviorSide::settled(Pending& pending, const Snapshot& snapshot, std::int64_t time_ns) {
  const Order& order = pending.order->order;
  Answer& answer = pending.order->answer;
  const bool late = time_ns - pending.asked_ns > control_answers_in_ns;
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
  if (waits_for_tick(pending)) {
    if (late) answer.text = "the behaviors did not tick within a second";
    return late;
  }
  if (pending.sequence == 0) {
    answer.done = true;
    if (order.kind == Order::Kind::set_parameter || order.kind == Order::Kind::undo) {
      finish(pending);
    } else {
      answer.text = told(order, answer.done);
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
      say(time_ns_, order.who,
          std::string("asks drives to ") + name(asked) + ": " + (order.text.empty() ? "all" : order.text));
    answer.done = undone.empty();
    const bool given_up = !answer.done && time_ns - pending.asked_ns > drives_answer_in_ns;
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
      return say(time_ns_, order.who, "switched to control set " + order.text);
    case Order::Kind::clear_faults:
      return say(time_ns_, order.who, "cleared the faults");
    case Order::Kind::set_point:
      if (time_ns_ - std::exchange(led_ns_, time_ns_) < led_again_ns) return;
      return say(time_ns_, order.who, "set " + order.text);
    case Order::Kind::undo:
      tuning_.drop();
      break;
    default:
      tuning_.note(change, pending.lasting);
  }
  answer.changes = {change};
  say(time_ns_, order.who,
      (order.kind == Order::Kind::undo ? "undid " : "set ") + change.name + ": " + number_text(change.before) + " -> " +
          number_text(change.now));
}

void BehaviorSide::say(std::int64_t time_ns, const std::string& who, const std::string& what) {
  p_.log.message(time_ns, BehaviorLog::Severity::info, "ctl", who.empty() ? what : who + " " + what);
}

}  // namespace kadans
