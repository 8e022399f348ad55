#include "decisions.h"

#include <algorithm>
#include <exception>
#include <utility>

#include "kadans/signal/input_error.h"

namespace kadans {
namespace {

bool plays(const PlayOrder& order) noexcept {
  return order.kind == PlayOrder::Kind::play || order.kind == PlayOrder::Kind::replace;
}

}  // namespace

Decisions::Decisions(Behavior::Settings settings, const Catalog& catalog, BehaviorLog& log)
    : settings_(std::move(settings)), catalog_(catalog), log_(log), behavior_(load()) {}

std::unique_ptr<Behavior> Decisions::load() const {
  auto loaded = std::make_unique<Behavior>(settings_, catalog_, log_);
  if (loaded->chart().decides) return loaded;
  throw InputError({settings_.file.string(), 1, 0,
                    "'" + loaded->name() + "' is a k.behavior; what decides returns k.decisions \"" + loaded->name() +
                        "\" { ... }"});
}

void Decisions::tell(const char* event, const std::string& why) noexcept {
  if (!behavior_->waits_for(event)) return;
  PlayedEvent told{.name = event, .who = "what plays"};
  if (!why.empty()) told.data.push_back({.name = "why", .value = why});
  (void)behavior_->post(told);
}

void Decisions::refuse(const std::string& why) noexcept { tell("play.refused", why.substr(0, 200)); }

void Decisions::hear(const PlayReport& report) noexcept {
  if (report.orders_refused != refused_) {
    refused_ = report.orders_refused;
    refuse(report.refusal.data());
  }
  if (report.taken_over != taken_over_) {
    taken_over_ = report.taken_over;
    asked_ = false;
    return tell("play.failed");
  }
  if (!asked_ || report.orders != sent_ || report.phase != 0) return;
  asked_ = false;
  tell(report.not_done == not_done_ ? "play.done" : "play.failed");
}

void Decisions::tick(const Snapshot& snapshot, const PlayReport& report) noexcept {
  orders_.clear();
  messages_.clear();
  if (behavior_->failed() || behavior_->finished()) return;
  hear(report);
  behavior_->show_plays(&report);
  (void)behavior_->tick(snapshot, silence_);
  if (behavior_->failed()) {
    log_.message(snapshot.time_ns, BehaviorLog::Severity::error, behavior_->name(), behavior_->error().text());
    return;
  }
  for (PlayOrder& order : behavior_->decided()) {
    if (plays(order) && !asked_) not_done_ = report.not_done;
    asked_ = (asked_ && order.kind != PlayOrder::Kind::stop) || plays(order);
    orders_.push_back(std::move(order));
  }
  for (SentEvent& sent : behavior_->sent_events()) {
    sent.event.who = behavior_->name();
    if (sent.to == other_robots) {
      messages_.push_back(std::move(sent.event));
    } else {
      orders_.push_back({.kind = PlayOrder::Kind::emit, .behavior = {sent.to, {}}, .event = std::move(sent.event)});
    }
  }
  behavior_->decided().clear();
  behavior_->sent_events().clear();
}

// Who sent it is data, too, when the declaration wants it: not what the message says, but who its sender is.
std::string Decisions::hear(PlayedEvent event) {
  if (behavior_->failed() || behavior_->finished()) return "nothing decides";
  const ScriptEvent* declared = find_event(behavior_->events(), event.name);
  if (declared == nullptr) return "the decisions do not declare the event '" + event.name + "' (k.events)";
  std::erase_if(event.data, [](const PlayArgument& field) { return field.name == "from"; });
  if (std::ranges::find(declared->fields, "from", &ScriptEvent::Field::name) != declared->fields.end())
    event.data.push_back({.name = "from", .value = event.who});
  return behavior_->post(event);
}

void Decisions::reload(const Snapshot& snapshot) noexcept {
  if (!behavior_->failed()) {
    (void)behavior_->reload(snapshot, silence_);
    return;
  }
  try {
    behavior_ = load();
    asked_ = false;
    log_.message(snapshot.time_ns, BehaviorLog::Severity::info, behavior_->name(), "begins anew");
  } catch (const std::exception& error) {
    log_.message(snapshot.time_ns, BehaviorLog::Severity::error, behavior_->name(), error.what());
  }
}

}  // namespace kadans
