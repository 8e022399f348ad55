#include "decision_process.h"

#include <algorithm>
#include <exception>
#include <utility>

#include "config/robot/supervisor_config.h"
#include "config/scenario/event_text.h"
#include "script/host/script_host.h"
#include "signal/input_file.h"
#include "signal/utf8.h"

namespace kadans {
namespace {

using Severity = BehaviorLog::Severity;

bool is_event(const PlayedEvent& event) { return is_event_name(event.name) && out_of_bounds(event.data).empty(); }

}  // namespace

DecisionProcess::DecisionProcess(const Behavior::Settings& settings, Catalog& catalog, BehaviorLog& log,
                                 const Start& start, std::int64_t period_ns)
    : root_(std::filesystem::absolute(settings.root).lexically_normal()),
      catalog_(catalog),
      read_(std::make_unique<Decisions>(settings, catalog, log)),
      name_(read_->name()),
      files_(read_->files()),
      process_(start(log, period_ns)) {}

void DecisionProcess::declare_signals(SignalTable& signals, std::vector<SignalState>& states) {
  process_->attach(catalog_, {});
  add_signal_states(read_->behavior().chart(), name_, signals, states);
  read_.reset();
}

void DecisionProcess::hear(PlayedEvent event) noexcept {
  const std::string who = event.who;
  try {
    asked_.push_back({process_->ask(PlayOrder{.kind = PlayOrder::Kind::emit, .event = std::move(event)}), who});
  } catch (const std::exception& error) {
    decided_.heard.push_back({who, error.what()});
  }
}

bool DecisionProcess::tick(const Snapshot& snapshot, const PlayReport& report) noexcept {
  decided_.orders.clear();
  decided_.messages.clear();
  process_->show(report);
  const std::uint32_t requests = process_->requests();
  process_->tick(snapshot, silence_);
  if (inputs_ != nullptr && process_->requests() != requests) {
    asked_with_.tick = snapshot.tick, asked_with_.time_ns = snapshot.time_ns;
    seen_with_ = *seen_;
  }
  take_replies();
  if (std::exchange(answers_, process_->answers()) == process_->answers()) return false;
  bool sound = false;
  try {
    sound = take_decided();
  } catch (const std::exception&) {  // no memory for what it says
  }
  // The next process goes on from this tick, whatever came of it here.
  sound = tell_taken() && sound;
  if (sound) return true;
  decided_.orders.clear();
  decided_.messages.clear();
  process_->end_for_rubbish();
  return false;
}

// Nothing of it is believed: kinds, counts, and files within the project, which are then read as any others.
bool DecisionProcess::take_decided() {
  ByteReader bytes(process_->decided());
  if (!kadans::take_decided(bytes, failed_, decided_)) return false;
  for (PlayOrder& order : decided_.orders) {
    for (PlayItem& item : order.list) item.source = "m:play";
    if (!may_play(order)) return false;
  }
  return std::ranges::all_of(decided_.messages, [](const PlayedEvent& message) {
    return is_event(message) && message.name.starts_with(message_event_prefix);
  });
}

// The process has told what it took since; of ticks whose answer did not come nobody knows it, and none of them counts.
bool DecisionProcess::tell_taken() {
  if (inputs_ == nullptr) return true;
  inputs_->tick_begins(asked_with_, asked_with_.time_ns);
  inputs_->asked(BehaviorInputs::Asked::seen, std::as_bytes(std::span(&seen_with_, 1)));
  const std::uint64_t takeovers = process_->takeovers();
  if (takeovers != takeovers_) inputs_->asked(BehaviorInputs::Asked::taken_over, {});
  takeovers_ = takeovers;
  const bool sound = inputs_->pass_on(process_->told());
  inputs_->tick_ends();
  return sound;
}

bool DecisionProcess::may_play(const PlayOrder& order) const {
  using Kind = PlayOrder::Kind;
  if (order.kind > Kind::emit || order.kind == Kind::reload) return false;
  if (order.kind == Kind::emit && (!is_event(order.event) || !order.list.empty())) return false;
  if (order.behavior.name.size() > EventBounds::name_bytes ||
      find_invalid_utf8(order.behavior.name) != std::string_view::npos)
    return false;
  return std::ranges::all_of(order.list, [&](const PlayItem& item) {
    if (find_invalid_utf8(item.file.native()) != std::string_view::npos || !out_of_bounds(item.arguments).empty())
      return false;
    const std::filesystem::path below = (root_ / item.file).lexically_normal().lexically_relative(root_);
    return !below.empty() && *below.begin() != "..";
  });
}

void DecisionProcess::take_replies() {
  std::erase_if(asked_, [this](const Asked& asked) {
    const std::optional<BehaviorReply> reply = process_->reply(asked.number);
    if (reply) decided_.heard.push_back({asked.who, reply->error});
    return reply.has_value();
  });
  std::erase_if(questions_, [this](auto& asked) {
    std::optional<BehaviorReply> reply = process_->reply(asked.first);
    if (!reply) return false;
    asked.second->reply = std::move(*reply);
    decided_.replies.push_back(std::move(asked.second));
    return true;
  });
}

void DecisionProcess::reload(const Snapshot& /*snapshot*/) noexcept {
  try {
    process_->forget(process_->ask(BehaviorQuestion{.kind = BehaviorQuestion::Kind::reload}));
  } catch (const std::exception&) {  // it is down, and has said so
  }
}

void DecisionProcess::ask(std::unique_ptr<DecisionQuestion> question, const Snapshot& /*snapshot*/) noexcept {
  try {
    const std::uint32_t number = process_->ask(question->question);
    questions_.emplace_back(number, std::move(question));
  } catch (const std::exception& error) {
    question->reply = {.error = error.what()};
    decided_.replies.push_back(std::move(question));
  }
}

void ServedDecisions::order(const PlayOrder& order) {
  if (order.kind != PlayOrder::Kind::emit) refuse("decisions take events alone");
  tell_asked(inputs_, BehaviorInputs::Asked::heard, [&](ByteWriter& bytes) { put_event(order.event, bytes); });
  if (const std::string why = decisions_.refusal(order.event); !why.empty()) refuse(why);
}

void ServedDecisions::before_tick(const Snapshot& snapshot) noexcept {
  if (kept_.empty()) return;
  ByteReader bytes(kept_);
  lost_ = decisions_.go_on(bytes, snapshot);
  kept_ = {};
}

void ServedDecisions::tick(const Snapshot& snapshot, CommandSender& /*commands*/) noexcept {
  if (!lost_.empty()) return;
  if (inputs_ != nullptr) inputs_->asked(BehaviorInputs::Asked::plays, std::as_bytes(std::span(&plays_, 1)));
  (void)decisions_.tick(snapshot, plays_);
  bytes_.clear();
  put_decided(decisions_.failed(), decisions_.decided(), bytes_);
  if (inputs_ != nullptr) inputs_->asked(BehaviorInputs::Asked::decided, bytes_.bytes());
  if (bytes_.size() <= BehaviorLink::decided_bytes) return;
  bytes_.clear();
  put_decided(decisions_.failed(), {}, bytes_);
  log_.message(snapshot.time_ns, Severity::error, decisions_.name(),
               "what it asked for in a tick was lost: it is more than " +
                   std::to_string(BehaviorLink::decided_bytes / 1024) + " kB");
}

BehaviorReply ServedDecisions::reply(const BehaviorQuestion& question, const Snapshot& snapshot) {
  tell_asked(inputs_, BehaviorInputs::Asked::question, [&](ByteWriter& bytes) { put_question(question, bytes); });
  return decisions_.reply(question, snapshot);
}

std::span<const std::byte> ServedDecisions::told() noexcept {
  told_.clear();
  if (inputs_ != nullptr) inputs_->tell_on(told_);
  return told_.bytes();
}

std::string ServedDecisions::keep(ByteWriter& bytes, std::int64_t /*time_ns*/) { return decisions_.keep(bytes); }

}  // namespace kadans
