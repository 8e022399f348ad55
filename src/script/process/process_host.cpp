#include "process_host.h"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <exception>
#include <new>

#include "catalog_fingerprint.h"
#include "script/host/play_order_bytes.h"

namespace kadans {

using Severity = BehaviorLog::Severity;

// Fresh for each process, so that nothing which the one before left half written is ever looked at.
struct ProcessHost::Incarnation {
  Incarnation(const Settings& settings, std::span<const std::byte> kept)
      : link(*new (memory.get()) BehaviorLink), process(prepare(settings, kept), settings.arguments, memory) {}

  const std::string& prepare(const Settings& settings, std::span<const std::byte> kept) noexcept {
    link.setup = settings.setup;
    link.setup.kept.size = static_cast<std::uint32_t>(kept.size());
    link.setup.kept.hash = hash_of_kept(kept.data(), kept.size());
    std::ranges::copy(kept, link.setup.kept.bytes.begin());
    return settings.program;
  }

  SharedMemory memory{sizeof(BehaviorLink)};
  BehaviorLink& link;
  PartnerProcess process;
  std::int64_t started_wall_ns = WallClock().now_ns();
};

ProcessHost::ProcessHost(Settings settings, BehaviorLog& log)
    : settings_(std::move(settings)), log_(log), policy_(settings_.restart) {
  kept_->reserve(KeptState::bytes_max);
  start();
}

ProcessHost::~ProcessHost() = default;

void ProcessHost::start() {
  child_ = std::make_unique<Incarnation>(settings_, *kept_);
  phase_ = Phase::starting;
  asked_ = false;
}

void ProcessHost::attach(Catalog& catalog, const SafePosture::Settings& safe) {
  safe_.emplace(safe, catalog);
  fingerprint_ = fingerprint_of(catalog);
  const auto refuse = [](const std::string& why) {
    throw InputError({.message = "the behaviors' process did not start: " + why});
  };
  while (!ChildAnswer::is_ready(child_->link)) {
    const std::int64_t left_ns = child_->started_wall_ns + settings_.start_patience_ns - clock_.now_ns();
    const bool gone = child_->process.bell().wait(std::max<std::int64_t>(left_ns, 0)) == Doorbell::Heard::end;
    if (gone) refuse(child_->process.end());
    if (left_ns <= 0) refuse("it takes too long");
  }
  const auto names = ChildAnswer::names(child_->link);
  if (!names) refuse("it tells no names");
  if (ChildAnswer::fingerprint(child_->link) != fingerprint_) refuse("the robot's files changed meanwhile");
  play_.declare(catalog.signals);
  names_ = *names;
  for (const std::string& name : names_) behaviors_.emplace_back().declare_numbered(catalog.signals, name);
  play_.phase.store(behaviors_.empty() ? 0 : 1, std::memory_order_relaxed);
  phase_ = Phase::playing;
}

void ProcessHost::order(const PlayOrder& order) {
  ByteWriter bytes;
  put_order(order, bytes);
  if (bytes.size() > BehaviorLink::order_bytes) throw InputError({.message = "the order is too long"});
  if (phase_ == Phase::down) throw InputError({.message = "the behaviors' process is down"});
  orders_.emplace_back(bytes.bytes().begin(), bytes.bytes().end());
  stopping_ = order.kind == PlayOrder::Kind::stop;
}

void ProcessHost::tick(const Snapshot& snapshot, CommandSender& commands) noexcept {
  now_ns_ = snapshot.time_ns;
  if (phase_ == Phase::waiting) start_when_due();
  if (phase_ == Phase::starting) look_if_ready();
  if (phase_ == Phase::playing && !asked_) ask(snapshot, commands);
  if (phase_ == Phase::playing && asked_) wait_for_answer(commands);
  if (safe_->due(now_ns_)) safe_->move(snapshot, commands, 0);
}

void ProcessHost::start_when_due() noexcept {
  if (now_ns_ < start_due_ns_) return;
  try {
    start();
  } catch (const std::exception& error) {
    bury(error.what(), false);
  }
}

void ProcessHost::look_if_ready() noexcept {
  for (;;) {
    if (ChildAnswer::is_ready(child_->link)) {
      if (ChildAnswer::fingerprint(child_->link) != fingerprint_)
        return stay_down("the robot's files changed: start the run anew");
      phase_ = Phase::playing;
      return;
    }
    const std::int64_t left_ns = child_->started_wall_ns + settings_.start_patience_ns - clock_.now_ns();
    const Doorbell::Heard heard =
        child_->process.bell().wait(settings_.time_stands ? std::max<std::int64_t>(left_ns, 0) : 0);
    if (heard == Doorbell::Heard::end) return bury("", false);
    if (left_ns <= 0) return bury("it takes too long to start", true);
    if (heard == Doorbell::Heard::nothing && !settings_.time_stands) return;
  }
}

void ProcessHost::ask(const Snapshot& snapshot, const CommandSender& commands) noexcept {
  BehaviorLink::Request& request = child_->link.request;
  request.last_sequence = asked_sequence_ = commands.last_sequence();
  request.room = static_cast<std::uint32_t>(std::min(commands.room(), CommandQueue::capacity()));
  request.order_size = 0;
  asked_order_ = !orders_.empty();
  if (asked_order_) {
    request.order_size = static_cast<std::uint32_t>(orders_.front().size());
    std::ranges::copy(orders_.front(), request.order.begin());
  }
  request.snapshot = snapshot;
  asked_for_ns_ = snapshot.time_ns;
  asked_wall_ns_ = clock_.now_ns();
  asked_ = true;
  request.number.give(++number_, child_->process.bell());
}

// As long as this tick may wait, unless the process is gone or its time is over.
void ProcessHost::wait_for_answer(CommandSender& commands) noexcept {
  const std::int64_t began_ns = clock_.now_ns();
  const std::int64_t over_ns = asked_wall_ns_ + settings_.patience_ns;
  const std::int64_t until_ns = settings_.time_stands ? over_ns : std::min(over_ns, began_ns + settings_.answer_ns);
  while (!ChildAnswer::answers(child_->link, number_)) {
    const std::int64_t left_ns = until_ns - clock_.now_ns();
    if (child_->process.bell().wait(std::max<std::int64_t>(left_ns, 0)) == Doorbell::Heard::end) return bury("", false);
    if (left_ns > 0) continue;
    if (clock_.now_ns() >= over_ns) bury("it did not answer", true);
    return;
  }
  asked_ = false;
  if (!take_answer(commands)) return bury("it wrote rubbish", true);
}

bool ProcessHost::take_answer(CommandSender& commands) noexcept {
  BehaviorLink& link = child_->link;
  answer_cost_.add(clock_.now_ns() - asked_wall_ns_);
  if (!answer_.tell_lines(link, log_, asked_for_ns_)) return false;
  if (!answer_.take_commands(link) || !answer_.take_kept(link, kept_)) return false;
  // A late answer whose numbers do not fit any more, since somebody else commanded meanwhile: what it sends counts, if
  // nobody wants behaviors to stop; its motions go by the transaction that has their number.
  if (commands.last_sequence() == asked_sequence_ || !stopping_) answer_.send_on(commands, asked_for_ns_);
  ChildAnswer::take_status(link, play_, behaviors_);
  if (asked_order_) orders_.pop_front();
  order_deaths_ = 0;
  policy_.answered();
  if (died_ns_ < 0) return true;
  ++takeovers_;
  outage_.add(now_ns_ - died_ns_);
  died_ns_ = -1;
  safe_->forget();
  say(Severity::info, "the behaviors' process goes on as " + std::to_string(child_->process.pid()));
  return true;
}

void ProcessHost::bury(const std::string& why, bool alive) noexcept {
  std::string how = why;
  if (child_) {
    (void)answer_.tell_lines(child_->link, log_, now_ns_);  // its last words
    if (alive) child_->process.kill();
    const std::string end = child_->process.end();
    if (!alive) how = end;
    child_.reset();
  }
  if (died_ns_ < 0) {
    died_ns_ = now_ns_;
    if (play_.phase.load(std::memory_order_relaxed) != 0) safe_->failed(now_ns_, ~ObjectMask{0});
  }
  give_up_order();
  const std::optional<std::int64_t> due_ns = policy_.died(now_ns_);
  if (!kept_) return stay_down(how + ", and its state could not be kept");
  if (!due_ns) return stay_down(how + ", " + std::to_string(policy_.in_a_row()) + " times in a row");
  phase_ = Phase::waiting;
  start_due_ns_ = *due_ns;
  say(Severity::warning, "the behaviors' process died: " + how + "; the robot holds until the next one goes on");
}

// The next process gets it too, but not for ever.
void ProcessHost::give_up_order() noexcept {
  constexpr std::uint32_t deaths_max = 3;
  if (!asked_ || !asked_order_ || ++order_deaths_ < deaths_max) return;
  orders_.pop_front();
  order_deaths_ = 0;
  say(Severity::error, "an order was dropped: the behaviors' process died of it three times");
}

void ProcessHost::stay_down(const std::string& why) noexcept {
  child_.reset();
  phase_ = Phase::down;
  orders_.clear();
  asked_order_ = false;
  say(Severity::error, "the behaviors' process stays down: " + why);
}

void ProcessHost::say(Severity severity, const std::string& text) noexcept {
  log_.message(now_ns_, severity, "supervisor", text);
}

}  // namespace kadans
