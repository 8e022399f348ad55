#include "supervisor.h"

#include <cmath>
#include <exception>
#include <span>

#include "engine/tick/seen_entries.h"
#include "script/host/script_host.h"
#include "supervisor/world/perception_message.h"

namespace kadans {
namespace {

using Asked = BehaviorInputs::Asked;

constexpr const char* no_room = "too many orders wait for the behaviors";

}  // namespace

Behavior::Settings decision_settings(const SupervisorConfig& config, const std::filesystem::path& root,
                                     const PlayFolders& folders, std::uint64_t seed, bool on_wall_clock) {
  const PlayItem& item = config.decisions.front();
  Behavior::Settings settings{.root = root,
                              .file = item.file.is_absolute() ? item.file : root / item.file,
                              .seed = seed,
                              .arguments = item.arguments,
                              .source = item.source,
                              .folders = folders};
  if (!on_wall_clock) return settings;
  settings.limits.tick_wall_ns = std::llround(0.5e9 / config.rate_Hz);
  settings.limits.load_wall_ns = 20 * settings.limits.tick_wall_ns;
  return settings;
}

Supervisor::Supervisor(const Settings& settings, Catalog& catalog, SupervisorLink& link, SeenStorage& seen,
                       BehaviorLog& log)
    : period_ns_(std::llround(1e9 / settings.config.rate_Hz)),
      link_(link),
      seen_(seen),
      log_(log),
      world_(settings.config.seen),
      messages_(settings.config.messages, settings.boot),
      message_channel_(settings.messages),
      perception_channel_(settings.perception) {
  if (!settings.config.decisions.empty()) {
    Behavior::Settings decides =
        decision_settings(settings.config, settings.root, settings.folders, settings.seed, settings.on_wall_clock);
    if (settings.start) {
      process_ = std::make_unique<DecisionProcess>(decides, catalog, log, settings.start, period_ns_);
      decider_ = process_.get();
    } else {
      decides.limits.inputs = &inputs_;
      decisions_ = std::make_unique<Decisions>(decides, catalog, log);
      decider_ = decisions_.get();
    }
  }
  if (decider_ != nullptr) link_.questions.name = decider_->name();
  seen_.publish(world_.entries());
}

void Supervisor::declare_signals(SignalTable& signals, std::vector<SignalState>& states) {
  signals.add({"supervisor.ticks", "", "Ticks of the supervisor so far."}, &status_.ticks);
  signals.add({"supervisor.observations", "", "Observations that the world model took."}, &status_.observations);
  signals.add({"supervisor.refused", "", "Observations that it refused, or that found no place."}, &status_.refused);
  signals.add({"supervisor.orders", "", "Orders of the decisions so far."}, &status_.orders);
  signals.add({"supervisor.sent", "", "Messages to other robots."}, &status_.sent);
  signals.add({"supervisor.unsent", "", "Messages that were refused: too long, or beyond the budget."},
              &status_.unsent);
  signals.add({"supervisor.heard", "", "Messages of other robots that the decisions got."}, &status_.heard);
  signals.add({"supervisor.unheard", "", "Messages and datagrams of perception that were refused."}, &status_.unheard);
  signals.add({"supervisor.failed", "", "Whether an error ended the decisions."}, &status_.failed);
  if (decider_ != nullptr) decider_->declare_signals(signals, states);
}

void Supervisor::watch() {
  if (decider_ == nullptr) return;
  watch_ = std::make_unique<FileWatch>();
  for (const std::filesystem::path& file : decider_->files()) (void)watch_->add(file.parent_path());
}

void Supervisor::observe(const Observation& observation) noexcept {
  if (waiting_count_ < waiting_.size()) {
    waiting_[waiting_count_++] = observation;
  } else {
    status_.refused.fetch_add(1, std::memory_order_relaxed);
  }
}

void Supervisor::warn_once(std::string_view about, const std::string& text) {
  if (warned_.size() < 64 && warned_.insert(std::string(about)).second)
    log_.message(snapshot_.time_ns, BehaviorLog::Severity::warning, "supervisor", text + " (told once)");
}

void Supervisor::take_perception(std::int64_t time_ns) {
  std::string_view datagram;
  std::int64_t came_ns = time_ns;
  for (std::size_t i = 0; i < datagrams_max && perception_channel_->receive(time_ns, datagram, came_ns); ++i) {
    const std::string why = read_perception(datagram, world_.declared(), came_ns, perceived_);
    if (why.empty()) continue;
    status_.unheard.fetch_add(1, std::memory_order_relaxed);
    warn_once("perception", "a datagram of perception was refused: " + why);
  }
  for (const Observation& one : perceived_) observe(one);
  perceived_.clear();
}

// Each goes to the decisions as an event, when they declare it so.
void Supervisor::take_messages(std::int64_t time_ns) {
  std::string_view datagram;
  std::int64_t came_ns = time_ns;
  for (std::size_t i = 0; i < datagrams_max && message_channel_->receive(time_ns, datagram, came_ns); ++i) {
    PlayedEvent event;
    std::string why;
    const RobotMessages::Answer answer = messages_.decode(datagram, came_ns, event, why);
    if (answer == RobotMessages::Answer::own) continue;
    if (answer == RobotMessages::Answer::taken) {
      tell_asked(inputs_, Asked::heard, [&](ByteWriter& bytes) { put_event(event, bytes); });
      decider_->hear(std::move(event));
    } else {
      tell_heard({event.who, why});
    }
  }
}

void Supervisor::tell_heard(const Decider::Heard& heard) {
  (heard.why.empty() ? status_.heard : status_.unheard).fetch_add(1, std::memory_order_relaxed);
  if (!heard.why.empty()) warn_once("message " + heard.who, "a message was refused: " + heard.why);
}

void Supervisor::send_messages() {
  for (const PlayedEvent& event : decider_->decided().messages) {
    std::string why = "this robot has no name among others: supervisor.messages in its configuration";
    const bool named = message_channel_ != nullptr;
    const std::string bytes = named ? messages_.encode(event, snapshot_.time_ns, why) : "";
    const bool sent = !bytes.empty() && message_channel_->send(snapshot_.time_ns, bytes);
    (sent ? status_.sent : status_.unsent).fetch_add(1, std::memory_order_relaxed);
    if (bytes.empty()) warn_once("send " + event.name, "message '" + event.name + "' was not sent: " + why);
  }
}

void Supervisor::take_observations(std::int64_t time_ns) noexcept {
  for (const Observation& one : std::span(waiting_).first(waiting_count_)) {
    const bool taken = world_.observe(one, past_, time_ns) == WorldModel::Answer::taken;
    (taken ? status_.observations : status_.refused).fetch_add(1, std::memory_order_relaxed);
  }
  waiting_count_ = 0;
  world_.forget(time_ns);
  seen_.publish(world_.entries());
}

// Whatever goes wrong in it, nobody waits for it: the heartbeat says so, and the behaviors' side does the rest.
void Supervisor::tick(std::int64_t time_ns) noexcept {
  bool decides = ended_;
  try {
    if (!ended_) decides = step(time_ns);
  } catch (const std::exception& error) {
    ended_ = true;
    log_.message(time_ns, BehaviorLog::Severity::error, "supervisor", std::string("ended: ") + error.what());
  }
  status_.ticks.fetch_add(1, std::memory_order_relaxed);
  beats_ += decides ? 1 : 0;
  const bool failed = ended_ || (decider_ != nullptr && decider_->failed());
  status_.failed.store(failed ? 1 : 0, std::memory_order_relaxed);
  link_.heartbeat.publish({beats_, failed ? 1U : 0U});
}

// False: nobody decided, who should have.
bool Supervisor::step(std::int64_t time_ns) {
  for (PastPose pose; link_.poses.try_pop(pose);) past_.add(pose);
  if (perception_channel_ != nullptr) take_perception(time_ns);
  take_observations(time_ns);
  if (past_.size() == 0 || link_.leaving.load(std::memory_order_relaxed)) return true;  // not begun, or about to end
  const auto shown = link_.snapshot.read();
  copy_used(*shown, snapshot_);
  return decide();
}

bool Supervisor::decide() {
  if (decider_ == nullptr) return true;
  show_seen(world_.entries(), snapshot_.status.odometry, snapshot_.time_ns, snapshot_.seen);
  {
    const auto report = link_.report.read();
    report_ = *report;
  }
  report_.given = status_.orders.load(std::memory_order_relaxed);
  report_.orders += lost_;
  report_.orders_refused += lost_;
  if (std::exchange(lost_now_, false)) put_text(report_.refusal, no_room);
  if (inputs_ != nullptr) {
    inputs_->tick_begins(snapshot_, snapshot_.time_ns);
    inputs_->asked(Asked::seen, std::as_bytes(std::span(&world_.entries(), 1)));
    inputs_->asked(Asked::plays, std::as_bytes(std::span(&report_, 1)));
  }
  reload_saved();
  if (message_channel_ != nullptr) take_messages(snapshot_.time_ns);
  while (auto asked = link_.questions.asked.try_pop()) {
    tell_asked(inputs_, Asked::question, [&](ByteWriter& bytes) { put_question(asked->question, bytes); });
    decider_->ask(std::move(asked), snapshot_);
  }
  const bool decides = decider_->tick(snapshot_, report_);
  tell_asked(inputs_, Asked::decided,
             [&](ByteWriter& bytes) { put_decided(decider_->failed(), decider_->decided(), bytes); });
  if (inputs_ != nullptr) inputs_->tick_ends();
  for (const Decider::Heard& heard : decider_->decided().heard) tell_heard(heard);
  decider_->decided().heard.clear();
  for (auto& replied : decider_->decided().replies) (void)link_.questions.answered.try_push(std::move(replied));
  decider_->decided().replies.clear();
  send_orders();
  send_messages();
  return decides;
}

void Supervisor::send_orders() {
  for (PlayOrder& order : decider_->decided().orders) {
    status_.orders.fetch_add(1, std::memory_order_relaxed);
    if (link_.orders.try_push(std::make_unique<PlayOrder>(std::move(order)))) continue;
    ++lost_;
    lost_now_ = true;
    log_.message(snapshot_.time_ns, BehaviorLog::Severity::warning, "supervisor",
                 std::string("an order of the decisions was lost: ") + no_room);
  }
}

void Supervisor::reload_saved() {
  if (watch_ == nullptr || !watch_->poll()) return;
  if (inputs_ != nullptr) inputs_->asked(Asked::reload, {});
  decider_->reload(snapshot_);
}

}  // namespace kadans
