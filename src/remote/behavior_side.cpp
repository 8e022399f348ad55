#include "kadans/remote/behavior_side.h"

#include <algorithm>
#include <array>
#include <exception>
#include <utility>

#include "kadans/config/fields.h"
#include "kadans/engine/refusal_text.h"
#include "kadans/remote/run_description.h"

namespace kadans {
namespace {

constexpr std::int64_t control_answers_in_ns = 1'000'000'000;

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
      return begin_change(pending, {last->name, last->now, last->before, last->chunk});
    }
    case Order::Kind::line:
      p_.instance.want_console_row(true);
      (void)console_of(order);
      return;  // evaluated when there is a row of signals
    default:
      return give(order);
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
  if (snapshot.transactions_applied >= pending.sequence) {
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
