#include "decisions.h"

#include <algorithm>
#include <exception>
#include <utility>

#include "kadans/signal/input_error.h"
#include "script/host/script_host.h"
#include "signal/byte_order.h"
#include "signal/input_file.h"

namespace kadans {
namespace {

bool plays(const PlayOrder& order) noexcept {
  return order.kind == PlayOrder::Kind::play || order.kind == PlayOrder::Kind::replace;
}

}  // namespace

void put_decided(bool failed, const Decider::Decided& decided, ByteWriter& bytes) {
  bytes.put<std::uint8_t>(failed);
  bytes.put(static_cast<std::uint32_t>(decided.orders.size()));
  for (const PlayOrder& order : decided.orders) put_order(order, bytes);
  bytes.put(static_cast<std::uint32_t>(decided.messages.size()));
  for (const PlayedEvent& message : decided.messages) put_event(message, bytes);
}

bool take_decided(ByteReader& bytes, bool& failed, Decider::Decided& decided) {
  failed = bytes.take<std::uint8_t>() != 0;
  const auto orders = bytes.take<std::uint32_t>();
  if (orders > Decider::orders_max) return false;
  for (std::uint32_t i = 0; i < orders && bytes.ok(); ++i) decided.orders.push_back(take_order(bytes));
  const auto messages = bytes.take<std::uint32_t>();
  if (messages > Decider::messages_max) return false;
  for (std::uint32_t i = 0; i < messages && bytes.ok(); ++i) decided.messages.push_back(take_event(bytes));
  return bytes.ok() && bytes.left() == 0;
}

Decisions::Decisions(Behavior::Settings settings, const Catalog& catalog, BehaviorLog& log)
    : settings_(std::move(settings)), catalog_(catalog), log_(log), behavior_(load()) {}

std::unique_ptr<Behavior> Decisions::load() const {
  auto loaded = std::make_unique<Behavior>(settings_, catalog_, log_);
  if (loaded->chart().decides) return loaded;
  throw InputError({settings_.file.string(), 1, 0,
                    "'" + loaded->name() + "' is a k.behavior; what decides returns k.decisions \"" + loaded->name() +
                        "\" { ... }"});
}

void Decisions::load_anew() {
  std::unique_ptr<Behavior> loaded = load();
  loaded->take_place_of(*behavior_);
  behavior_ = std::move(loaded);
}

void Decisions::declare_signals(SignalTable& signals, std::vector<SignalState>& states) {
  add_signal_states(behavior_->chart(), behavior_->status().declare_numbered(signals, behavior_->name()), signals,
                    states);
}

void Decisions::tell(const char* event, const std::string& why) noexcept {
  if (!behavior_->waits_for(event)) return;
  PlayedEvent told{.name = event, .who = "what plays"};
  if (!why.empty()) told.data.push_back({.name = "why", .value = why.substr(0, 200)});
  (void)behavior_->post(told);
}

void Decisions::hear(const PlayReport& report) noexcept {
  if (report.orders_refused != refused_) {
    refused_ = report.orders_refused;
    tell("play.refused", report.refusal.data());
  }
  if (report.taken_over != taken_over_) {
    taken_over_ = report.taken_over;
    asked_ = false;
    return tell("play.failed");
  }
  if (!asked_ || report.orders != report.given || report.phase != 0) return;
  asked_ = false;
  tell(report.not_done == not_done_ ? "play.done" : "play.failed");
}

bool Decisions::tick(const Snapshot& snapshot, const PlayReport& report) noexcept {
  decided_.orders.clear();
  decided_.messages.clear();
  if (behavior_->failed() || behavior_->finished()) return true;
  hear(report);
  behavior_->show_plays(&report);
  (void)behavior_->tick(snapshot, silence_);
  if (behavior_->failed()) {
    log_.message(snapshot.time_ns, BehaviorLog::Severity::error, behavior_->name(), behavior_->error().text());
  } else {
    take_decided(report);
  }
  return true;
}

void Decisions::take_decided(const PlayReport& report) noexcept {
  for (PlayOrder& order : behavior_->decided()) {
    if (plays(order) && !asked_) not_done_ = report.not_done;
    asked_ = (asked_ && order.kind != PlayOrder::Kind::stop) || plays(order);
    decided_.orders.push_back(std::move(order));
  }
  for (SentEvent& sent : behavior_->sent_events()) {
    sent.event.who = behavior_->name();
    if (sent.to == other_robots) {
      decided_.messages.push_back(std::move(sent.event));
    } else {
      decided_.orders.push_back(
          {.kind = PlayOrder::Kind::emit, .behavior = {sent.to, {}}, .event = std::move(sent.event)});
    }
  }
  behavior_->decided().clear();
  behavior_->sent_events().clear();
}

void Decisions::hear(PlayedEvent event) noexcept {
  std::string who = event.who;
  decided_.heard.push_back({std::move(who), refusal(std::move(event))});
}

// Who sent it is data, too, when the declaration wants it: not what the message says, but who its sender is.
std::string Decisions::refusal(PlayedEvent event) {
  if (behavior_->failed() || behavior_->finished()) return "nothing decides";
  const ScriptEvent* declared = find_event(behavior_->events(), event.name);
  if (declared == nullptr) return "the decisions do not declare the event '" + event.name + "' (k.events)";
  std::erase_if(event.data, [](const PlayArgument& field) { return field.name == "from"; });
  if (std::ranges::find(declared->fields, "from", &ScriptEvent::Field::name) != declared->fields.end())
    event.data.push_back({.name = "from", .value = event.who});
  return behavior_->post(event);
}

// What came of it is in the log, too.
BehaviorReply Decisions::read_again(const Snapshot& snapshot) noexcept {
  using Reload = Behavior::Reload;
  if (!behavior_->failed()) {
    const Reload reload = behavior_->finished() ? Reload::unchanged : behavior_->reload(snapshot, silence_);
    if (reload == Reload::refused)
      return {.error = behavior_->name() + ": reload refused, the old version goes on: " + behavior_->complaint()};
    if (reload == Reload::taken) return {.text = behavior_->name() + ": reloaded " + behavior_->settings().chunk};
    return {.text = behavior_->name() + ": no new version: " +
                    (behavior_->finished() ? "it is over" : "the files are as they were loaded")};
  }
  try {
    load_anew();
    asked_ = false;
    log_.message(snapshot.time_ns, BehaviorLog::Severity::info, behavior_->name(), "begins anew");
    return {.text = behavior_->name() + ": begins anew"};
  } catch (const std::exception& error) {
    log_.message(snapshot.time_ns, BehaviorLog::Severity::error, behavior_->name(), error.what());
    return {.error = error.what()};
  }
}

BehaviorReply Decisions::reply(const BehaviorQuestion& question, const Snapshot& snapshot) {
  if (question.kind == BehaviorQuestion::Kind::reload) return read_again(snapshot);
  if (question.kind != BehaviorQuestion::Kind::why) refuse("decisions are asked why, and to read their files again");
  if (failed() || behavior_->finished()) refuse(behavior_->name() + " is over");
  return {.reasons = {{behavior_->name(), behavior_->why(snapshot)}}};
}

void Decisions::ask(std::unique_ptr<DecisionQuestion> question, const Snapshot& snapshot) noexcept {
  try {
    question->reply = reply(question->question, snapshot);
  } catch (const std::exception& error) {
    question->reply = {.error = error.what()};
  }
  decided_.replies.push_back(std::move(question));
}

std::string Decisions::keep(ByteWriter& bytes) {
  for (const std::uint32_t count : {refused_, not_done_, taken_over_}) bytes.put(count);
  bytes.put<std::uint8_t>(asked_);
  return behavior_->keep(bytes);
}

std::string Decisions::go_on(ByteReader& bytes, const Snapshot& snapshot) noexcept {
  for (std::uint32_t* count : {&refused_, &not_done_, &taken_over_}) *count = bytes.take<std::uint32_t>();
  asked_ = bytes.take<std::uint8_t>() != 0;
  return behavior_->go_on(bytes, snapshot, silence_) ? "" : behavior_->error().text();
}

std::string Decisions::take_over(const Snapshot& snapshot, bool from_beginning) {
  ByteWriter kept;
  if (std::string why = keep(kept); !from_beginning && !why.empty()) return why;
  load_anew();
  if (from_beginning) return "";
  ByteReader bytes(kept.bytes());
  return go_on(bytes, snapshot);
}

}  // namespace kadans
