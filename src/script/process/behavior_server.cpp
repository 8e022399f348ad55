#include "behavior_server.h"

#include <algorithm>
#include <atomic>
#include <cstring>

#include "behavior_link.h"
#include "kadans/signal/input_error.h"

namespace kadans {

bool SpokenLines::push(const auto& told) {
  line_.clear();
  line_.put(std::uint32_t{0});
  put_told(told, line_);
  line_.set(0, static_cast<std::uint32_t>(line_.size() - sizeof(std::uint32_t)));
  return link_.lines.try_push(line_.bytes());
}

void SpokenLines::tell(const Line& line) {
  const bool fits = push(line);
  dropped_ += fits ? 0 : 1;
  if (fits) tell_dropped(line.time_ns);
}

void SpokenLines::tell_dropped(std::int64_t time_ns) {
  if (dropped_ == 0) return;
  const std::string text = std::to_string(dropped_) + " lines found no place";
  if (push(Line{time_ns, BehaviorLog::Severity::warning, "supervisor", text})) dropped_ = 0;
}

void SpokenLines::tell_active(const ActiveStates& active) { dropped_ += push(active) ? 0 : 1; }
void SpokenLines::tell_emitted(const EmittedEvent& event) { dropped_ += push(event) ? 0 : 1; }

BehaviorServer::BehaviorServer(BehaviorLink& link, Doorbell& bell, ServedHost& host, BehaviorLog& log,
                               SpokenLines& lines, Catalog& catalog, ControlSets& sets)
    : link_(link),
      bell_(bell),
      host_(host),
      log_(log),
      lines_(lines),
      catalog_(catalog),
      sets_(sets),
      commands_(link.commands) {
  link_.ready.count = static_cast<std::uint32_t>(std::min(host_.size(), BehaviorLink::behaviors_max));
  for (std::uint32_t i = 0; i < link_.ready.count; ++i) {
    put_text(link_.ready.names[i], host_.behavior(i).name());
    const std::vector<std::string>& regions = host_.behavior(i).status().region_paths;
    for (std::size_t r = 0; r < regions.size(); ++r) std::ranges::copy(regions[r], link_.ready.regions[i][r].begin());
  }
  link_.ready.fingerprint = fingerprint_of(catalog);
}

int BehaviorServer::serve() {
  link_.ready.is.give(1, bell_);
  while (const auto number = link_.request.number.next(done_, bell_)) {
    if (!answer()) return 1;
    done_ = *number;
    link_.answer.number.give(done_, bell_);
  }
  return 0;
}

bool BehaviorServer::answer() {
  snapshot_ = link_.request.snapshot;
  lines_.tell_dropped(snapshot_.time_ns);  // the lines of the tick before have been taken since
  commands_.follow(link_.request.last_sequence, link_.request.room);
  take_parameters();
  replies_.clear();
  host_.before_tick(snapshot_);
  take_orders();
  host_.show(link_.request.plays);
  host_.tick(snapshot_, commands_);
  if (!host_.lost().empty()) {
    log_.message(snapshot_.time_ns, BehaviorLog::Severity::error, "supervisor", "cannot go on: " + host_.lost());
    return false;
  }
  answer_questions();
  tell_status();
  tell_plays();
  keep(snapshot_.time_ns);
  return true;
}

// The objects here never run; what they foresee is to be as those of the runtime foresee it.
void BehaviorServer::take_parameters() noexcept {
  ObjectMask changed = 0;
  const std::size_t count = std::min<std::size_t>(link_.request.parameter_count, BehaviorLink::parameters_max);
  for (std::size_t i = 0; i < count; ++i) {
    const BehaviorLink::ParameterValue& given = link_.request.parameters[i];
    if (catalog_.parameters.set(given.id, given.value)) changed |= ObjectMask{1} << catalog_.parameters.owner(given.id);
  }
  for (std::uint32_t i = 0; i < catalog_.objects.size(); ++i) {
    if ((changed >> i & 1U) != 0) sets_.object(i).parameters_changed();
  }
}

void BehaviorServer::take_orders() {
  const std::uint32_t size = link_.request.order_size;
  if (size == 0 || size > BehaviorLink::order_bytes) return;
  ByteReader bytes(std::span(link_.request.order).first(size));
  while (bytes.left() > 0) {
    const auto number = bytes.take<std::uint32_t>();
    const PlayOrder order = take_order(bytes);
    if (!bytes.ok()) return;
    try {
      host_.order(order);
    } catch (const InputError& error) {
      put(number, {.error = error.what()});
    }
  }
}

// After the tick, as in a thread: what is told is what the next tick begins with.
void BehaviorServer::answer_questions() {
  const std::uint32_t size = std::min<std::uint32_t>(link_.request.question_size, BehaviorLink::question_bytes);
  ByteReader bytes(std::span(link_.request.questions).first(size));
  while (bytes.left() > 0) {
    const auto number = bytes.take<std::uint32_t>();
    BehaviorQuestion question;
    if (!take_question(bytes, question)) break;
    try {
      put(number, host_.reply(question, snapshot_));
    } catch (const InputError& error) {
      put(number, {.error = error.what()});
    }
  }
  link_.answer.reply_size = static_cast<std::uint32_t>(replies_.size());
  std::ranges::copy(replies_.bytes(), link_.answer.replies.begin());
}

void BehaviorServer::put(std::uint32_t number, const BehaviorReply& reply) {
  constexpr std::size_t spare = 16384;  // for the refusals of all others
  const std::size_t before = replies_.size();
  replies_.put(number);
  put_reply(reply, replies_);
  if (replies_.size() + spare <= BehaviorLink::reply_bytes) return;
  replies_.shrink(before);
  replies_.put(number);
  put_reply({.error = "the behaviors' process has too much to tell in one tick: ask again, or for less"}, replies_);
}

void BehaviorServer::tell_status() {
  const auto number = [](const std::atomic<std::uint32_t>* of) { return of->load(std::memory_order_relaxed); };
  std::ranges::transform(play_numbers(host_.status()), link_.answer.play.begin(), number);
  for (std::size_t i = 0; i < std::min<std::size_t>(host_.size(), link_.ready.count); ++i) {
    const BehaviorStatus& status = host_.behavior(i).status();
    std::ranges::transform(behavior_numbers(status), link_.answer.status[i].begin(), number);
    for (std::size_t r = 0; r < status.region_paths.size(); ++r)
      link_.answer.regions[i][r] = number(&status.regions[r]);
  }
}

void BehaviorServer::tell_plays() noexcept {
  host_.report(link_.answer.plays);
  const std::span<const std::byte> decided = host_.decided();
  link_.answer.decided_size = static_cast<std::uint32_t>(std::min(decided.size(), BehaviorLink::decided_bytes));
  std::ranges::copy(decided.first(link_.answer.decided_size), link_.answer.decided.begin());
  const std::span<const std::byte> told = host_.told();
  const bool fits = told.size() <= BehaviorLink::told_bytes;  // else the record lacks it, and says so
  link_.answer.told_size = fits ? static_cast<std::uint32_t>(told.size()) : 0;
  if (fits) std::ranges::copy(told, link_.answer.told.begin());
}

// Most ticks change nothing of it.
void BehaviorServer::keep(std::int64_t time_ns) {
  kept_.clear();
  std::string why = host_.keep(kept_, time_ns);
  if (why.empty() && kept_.size() > KeptState::bytes_max)
    why = "more than " + std::to_string(KeptState::bytes_max / 1024) + " kB";
  if (!why.empty()) {
    kept_.clear();
    if (why != unkept_) {
      log_.message(time_ns, BehaviorLog::Severity::warning, "supervisor",
                   "the state of what plays would be lost with this process: " + why);
    }
  }
  const bool turned = why.empty() != unkept_.empty();
  unkept_ = why;
  const auto bytes = kept_.bytes();
  link_.answer.kept_changed = !turned && std::ranges::equal(bytes, kept_last_) ? 0 : 1;
  if (link_.answer.kept_changed == 0) return;
  kept_last_.assign(bytes.begin(), bytes.end());
  link_.answer.kept.size = why.empty() ? static_cast<std::uint32_t>(bytes.size()) : KeptState::none;
  link_.answer.kept.hash = hash_of_kept(bytes.data(), bytes.size());
  std::ranges::copy(bytes, link_.answer.kept.bytes.begin());
}

}  // namespace kadans
