#include "process_host.h"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <exception>
#include <new>

#include "behavior_link.h"
#include "kadans/signal/state_hash.h"
#include "signal/byte_order.h"
#include "signal/input_file.h"

namespace kadans {
namespace {

// Once, whatever the other side does meanwhile. That it is whole is_ready() or answers() has said.
template <typename T>
T once(T& shared) noexcept {
  return std::atomic_ref(shared).load(std::memory_order_relaxed);
}

// A copy that the compiler cannot trade for a second look at the original.
template <typename T>
T copy_of(const T& shared) noexcept {
  T copy;
  std::memcpy(static_cast<void*>(&copy), &shared, sizeof copy);
  std::atomic_signal_fence(std::memory_order_seq_cst);
  return copy;
}

// Whether a line of the process is a message, and neither a transition nor another event of the run.
bool is_said(std::span<const std::byte> line) noexcept {
  return !line.empty() && line.front() == std::byte(Event::Kind::message);
}

bool is_name(std::string_view name) noexcept {
  return !name.empty() && std::ranges::all_of(name, [](char c) { return c > ' ' && c < '\x7f'; });
}

}  // namespace

std::uint64_t hash_of_kept(const std::byte* bytes, std::size_t size) noexcept {
  StateHash hash;
  hash.add(size);
  for (std::size_t i = 0; i + 8 <= size; i += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes + i, sizeof word);
    hash.add(word);
  }
  for (std::size_t i = size / 8 * 8; i < size; ++i) hash.add(static_cast<std::uint8_t>(bytes[i]));
  return hash.value();
}

using Severity = BehaviorLog::Severity;

// A process and the memory shared with it: fresh for each, so that nothing which the one before left half written is
// ever looked at.
//
// Reads what the process wrote into the memory. The process may be dying or hostile, and may change anything at any
// moment. So each number is read once, bounded, and used from the copy. Bytes are copied before they are read. Indices
// of rings can only point into the rings (Ring masks them). The control engine checks the commands, as it does with
// those of a thread. A function that returns false means: the process breaks the rules.
struct ProcessHost::Incarnation {
  Incarnation(const Settings& settings, std::span<const std::byte> kept)
      : link(*new (memory.get()) BehaviorLink), process(prepare(settings, kept), settings.arguments, memory) {
    copied.reserve(decltype(BehaviorLink::lines)::capacity());
    answered.reserve(CommandQueue::capacity());
  }

  const std::string& prepare(const Settings& settings, std::span<const std::byte> kept) noexcept {
    link.setup = settings.setup;
    link.setup.kept.size = static_cast<std::uint32_t>(kept.size());
    link.setup.kept.hash = hash_of_kept(kept.data(), kept.size());
    std::ranges::copy(kept, link.setup.kept.bytes.begin());
    return settings.program;
  }

  bool is_ready() noexcept { return link.ready.is.given() == 1; }
  std::uint64_t fingerprint() noexcept { return copy_of(link.ready.fingerprint); }
  bool answers(std::uint32_t number) noexcept { return link.answer.number.given() == number; }

  // nullopt when one of the names is invalid.
  std::optional<std::vector<std::string>> names() {
    const std::uint32_t count = once(link.ready.count);
    if (count > BehaviorLink::behaviors_max) return std::nullopt;
    std::vector<std::string> all;
    for (std::uint32_t i = 0; i < count; ++i) {
      const BehaviorLink::Name name = copy_of(link.ready.names[i]);
      const auto end = std::ranges::find(name, '\0');
      all.emplace_back(name.begin(), end);
      if (end == name.end() || !is_name(all.back())) return std::nullopt;
    }
    return all;
  }

  // The paths of the behavior's regions, up to the first that is none.
  std::vector<std::string> regions(std::size_t behavior) {
    std::vector<std::string> paths;
    for (BehaviorLink::RegionPath& written : link.ready.regions[behavior]) {
      const BehaviorLink::RegionPath path = copy_of(written);
      const auto end = std::ranges::find(path, '\0');
      const std::string text(path.begin(), end);
      const bool taken = std::ranges::find(paths, text) != paths.end();
      if (end == path.end() || taken || !BehaviorStatus::is_region_path(text)) break;
      paths.push_back(text);
    }
    return paths;
  }

  // Takes the answer's transactions out of the link. send_on() sends them with `time_ns` as their time.
  [[nodiscard]] bool take_commands() {
    const std::size_t waiting = link.commands.size();
    answered.clear();
    if (waiting > CommandQueue::capacity()) return false;
    for (std::size_t i = 0; i < waiting; ++i) answered.push_back(copy_of(link.commands.peek(i)));
    link.commands.drop(waiting);
    for (std::size_t at = 0, count = 0; at < waiting; at += count + 1) {
      count = answered[at].count;
      const bool whole =
          answered[at].kind == CommandKind::transaction && count > 0 && count < max_transaction && count < waiting - at;
      if (!whole) return false;
      for (std::size_t i = 1; i <= count; ++i) {
        if (answered[at + i].kind == CommandKind::order_drive) return false;  // drives are no behavior's to order
      }
    }
    return true;
  }

  void send_on(CommandSender& sender, std::int64_t time_ns) const noexcept {
    for (std::size_t at = 0; at < answered.size(); at += answered[at].count + 1) {
      sender.begin(time_ns);
      for (std::size_t i = 1; i <= answered[at].count; ++i) (void)sender.add(answered[at + i]);
      (void)sender.commit();
    }
  }

  // Passes the lines to the log with `time_ns` as their time. With `counts` false only what is said: the tick that the
  // process was in does not count.
  [[nodiscard]] bool tell_lines(BehaviorLog& log, std::int64_t time_ns, bool counts = true) {
    const std::size_t waiting = link.lines.size();
    if (waiting > link.lines.capacity()) return false;
    copied.resize(waiting);
    for (std::size_t i = 0; i < waiting; ++i) copied[i] = link.lines.peek(i);
    std::atomic_signal_fence(std::memory_order_seq_cst);
    link.lines.drop(waiting);
    ByteReader lines(copied);
    while (lines.left() > 0) {
      const auto line = lines.take_bytes(lines.take<std::uint32_t>());
      if (!lines.ok()) return false;
      if ((counts || is_said(line)) && !tell_line(line, log, time_ns)) return false;
    }
    return true;
  }

  bool tell_line(std::span<const std::byte> line, BehaviorLog& log, std::int64_t time_ns) {
    ByteReader told(line);
    if (!take_told(told, time_ns, event)) return false;
    event.say_to(log);
    return true;
  }

  // To `copied`.
  void copy(std::span<const std::byte> shared) {
    copied.resize(shared.size());
    std::memcpy(copied.data(), shared.data(), shared.size());
    std::atomic_signal_fence(std::memory_order_seq_cst);
  }

  // Replaces `kept` when it changed; nullopt: the state cannot be kept.
  [[nodiscard]] bool take_kept(std::optional<std::vector<std::byte>>& kept) {
    if (once(link.answer.kept_changed) == 0) return true;
    const std::uint32_t size = once(link.answer.kept.size);
    if (size == KeptState::none) return kept.reset(), true;
    if (size > KeptState::bytes_max) return false;
    const std::uint64_t hash = copy_of(link.answer.kept.hash);
    copy(std::span(link.answer.kept.bytes).first(size));
    if (hash_of_kept(copied.data(), size) != hash) return false;
    if (!kept) kept.emplace();
    kept->assign(copied.begin(), copied.end());
    return true;
  }

  // What plays now, all but what PlayStatus has.
  void take_plays(PlayReport& plays) noexcept {
    plays.playing = copy_of(link.answer.plays.playing);
    plays.count = std::min(once(link.answer.plays.count), std::uint32_t{PlayReport::behaviors_max});
    for (PlayReport::Playing& one : plays.playing) one.name.back() = one.state.back() = '\0';
  }

  [[nodiscard]] bool take_decided(std::vector<std::byte>& decided, std::vector<std::byte>& told) {
    const std::uint32_t size = once(link.answer.decided_size), told_size = once(link.answer.told_size);
    if (size > BehaviorLink::decided_bytes || told_size > BehaviorLink::told_bytes) return false;
    copy(std::span(link.answer.decided).first(size));
    decided.assign(copied.begin(), copied.end());
    copy(std::span(link.answer.told).first(told_size));
    told.assign(copied.begin(), copied.end());
    return true;
  }

  // The replies by their numbers; there may be some that nobody asked for.
  [[nodiscard]] bool take_replies(std::map<std::uint32_t, BehaviorReply>& replies) {
    const std::uint32_t size = once(link.answer.reply_size);
    if (size > BehaviorLink::reply_bytes) return false;
    copy(std::span(link.answer.replies).first(size));
    ByteReader bytes(copied);
    while (bytes.left() > 0) {
      const auto number = bytes.take<std::uint32_t>();
      if (!take_reply(bytes, replies[number])) return false;
    }
    return true;
  }

  void take_status(PlayStatus& play, std::deque<BehaviorStatus>& behaviors) noexcept {
    const auto store = []<std::size_t count>(const std::array<std::atomic<std::uint32_t>*, count>& to,
                                             std::array<std::uint32_t, count>& from) {
      for (std::size_t n = 0; n < count; ++n) to[n]->store(once(from[n]), std::memory_order_relaxed);
    };
    store(play_numbers(play), link.answer.play);
    for (std::size_t i = 0; i < behaviors.size() && i < BehaviorLink::behaviors_max; ++i) {
      store(behavior_numbers(behaviors[i]), link.answer.status[i]);
      for (std::size_t r = 0; r < behaviors[i].region_paths.size(); ++r)
        behaviors[i].regions[r].store(once(link.answer.regions[i][r]), std::memory_order_relaxed);
    }
  }

  SharedMemory memory{sizeof(BehaviorLink)};
  BehaviorLink& link;
  PartnerProcess process;
  std::int64_t started_wall_ns = WallClock().now_ns();
  std::vector<std::byte> copied;  // from the memory
  std::vector<Command> answered;  // transactions, with their headers
  Event event;
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
  for (Foreseen& parameter : foreseen_) parameter.sent = std::numeric_limits<double>::quiet_NaN();
}

void ProcessHost::attach(Catalog& catalog, const SafePosture::Settings& safe) {
  safe_.emplace(safe, catalog);
  catalog_ = &catalog;
  for (const ObjectInfo& object : catalog.objects) {
    for (const ParameterId id : object.parameters) {
      if (object.foresight != nullptr) foreseen_.push_back({id, std::numeric_limits<double>::quiet_NaN()});
    }
  }
  fingerprint_ = fingerprint_of(catalog);
  const auto reject = [this](const std::string& why) { refuse(process_name() + " did not start: " + why); };
  while (!child_->is_ready()) {
    const std::int64_t left_ns = child_->started_wall_ns + settings_.start_patience_ns - clock_.now_ns();
    const bool gone = child_->process.bell().wait(std::max<std::int64_t>(left_ns, 0)) == Doorbell::Heard::end;
    if (gone) reject(child_->process.end());
    if (left_ns <= 0) reject("it takes too long");
  }
  const auto names = child_->names();
  if (!names) reject("it tells no names");
  if (child_->fingerprint() != fingerprint_) reject("the robot's files changed meanwhile");
  if (!decides()) play_.declare(catalog.signals);
  for (std::size_t i = 0; i < names->size(); ++i) {
    BehaviorStatus& status = behaviors_.emplace_back();
    status.region_paths = child_->regions(i);
    (void)status.declare_numbered(catalog.signals, (*names)[i]);
    reported_.push_back({.name = (*names)[i]});
  }
  play_.phase.store(behaviors_.empty() ? 0 : 1, std::memory_order_relaxed);
  phase_ = Phase::playing;
}

// Nothing plays any more when the process stays down, and what played did not end well.
void ProcessHost::report(PlayReport& plays) const noexcept {
  plays.phase = down() ? 0 : play_.phase.load(std::memory_order_relaxed);
  plays.not_done = play_.not_done.load(std::memory_order_relaxed) + (down() ? 1 : 0);
  plays.count = down() ? 0 : plays_.count;
  plays.playing = plays_.playing;
}

std::uint32_t ProcessHost::send(const PlayOrder& order) {
  ByteWriter bytes;
  bytes.put(sent_ + 1);
  put_order(order, bytes);
  if (bytes.size() > BehaviorLink::order_bytes) refuse("the order is too long");
  if (phase_ == Phase::down) refuse(process_name() + " is down");
  const bool event = order.kind == PlayOrder::Kind::emit;
  if (event) {
    if (paused()) refuse("the behaviors are paused; the event would be old when they go on");
    if (std::ranges::count(orders_.sent, true, &Sent::shares) >= static_cast<std::ptrdiff_t>(EventQueue::sent_max))
      refuse(std::to_string(EventQueue::sent_max) + " events wait for the next tick already");
  }
  orders_.sent.push_back({++sent_, {bytes.bytes().begin(), bytes.bytes().end()}, event});
  stopping_ = order.kind == PlayOrder::Kind::stop;
  return sent_;
}

std::uint32_t ProcessHost::ask(const PlayOrder& order) {
  const std::uint32_t number = send(order);
  asked_for_[number];
  return number;
}

std::uint32_t ProcessHost::ask(const BehaviorQuestion& question) {
  const bool report = question.kind == BehaviorQuestion::Kind::report;
  if (phase_ == Phase::down) {
    if (!report) refuse(process_name() + " is down");
    asked_for_[++sent_] = last_report();
    return sent_;
  }
  ByteWriter bytes;
  bytes.put(sent_ + 1);
  put_question(question, bytes);
  if (bytes.size() > BehaviorLink::question_bytes) refuse("the question is too long");
  asked_for_[++sent_];
  questions_.sent.push_back({sent_, {bytes.bytes().begin(), bytes.bytes().end()}, true, report});
  return sent_;
}

std::optional<BehaviorReply> ProcessHost::reply(std::uint32_t number) {
  const auto found = asked_for_.find(number);
  if (found == asked_for_.end() || !found->second) return std::nullopt;
  std::optional<BehaviorReply> reply = std::move(found->second);
  asked_for_.erase(found);
  return reply;
}

BehaviorReply ProcessHost::last_report() const {
  BehaviorReply report{.paused = paused(), .behaviors = reported_};
  for (BehaviorReport& behavior : report.behaviors) {
    if (behavior.over) continue;
    behavior.error = down() ? "its process stays down" : "its process does not answer";
    behavior.over = down();
    behavior.active.clear();
    behavior.events.clear();
  }
  return report;
}

// The first ones.
void ProcessHost::fail(Queue& queue, std::size_t count, const std::string& why) {
  for (; count > 0; --count, queue.sent.pop_front()) {
    const auto asked = asked_for_.find(queue.sent.front().number);
    if (asked == asked_for_.end()) continue;
    asked->second = queue.sent.front().report ? last_report() : BehaviorReply{.error = why};
  }
  queue.asked = 0;
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
    if (child_->is_ready()) {
      if (child_->fingerprint() != fingerprint_) return stay_down("the robot's files changed: start the run anew");
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

// The oldest, and those behind it that share a request with it, as far as there is room. Returns their size in bytes.
std::uint32_t ProcessHost::put(Queue& queue, std::span<std::byte> request) noexcept {
  std::size_t size = 0;
  queue.asked = 0;
  for (const Sent& one : queue.sent) {
    const bool next = queue.asked == 0 || (one.shares && queue.sent.front().shares);
    if (!next || size + one.bytes.size() > request.size()) break;
    std::ranges::copy(one.bytes, request.begin() + static_cast<std::ptrdiff_t>(size));
    size += one.bytes.size();
    ++queue.asked;
  }
  return static_cast<std::uint32_t>(size);
}

// The process reads the robot's files; what was changed since it has to be told.
void ProcessHost::put_parameters(BehaviorLink::Request& request) noexcept {
  std::uint32_t count = 0;
  for (Foreseen& parameter : foreseen_) {
    const double value = catalog_->parameters.newest(parameter.id);
    if (value == parameter.sent || count == BehaviorLink::parameters_max) continue;
    request.parameters[count++] = {parameter.id, parameter.sent = value};
  }
  request.parameter_count = count;
}

void ProcessHost::ask(const Snapshot& snapshot, const CommandSender& commands) noexcept {
  BehaviorLink::Request& request = child_->link.request;
  request.last_sequence = asked_sequence_ = commands.last_sequence();
  request.room = static_cast<std::uint32_t>(std::min(commands.room(), CommandQueue::capacity()));
  request.order_size = put(orders_, request.order);
  request.question_size = put(questions_, request.questions);
  put_parameters(request);
  if (decides()) request.plays = shown_;
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
  while (!child_->answers(number_)) {
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
  answer_cost_.add(clock_.now_ns() - asked_wall_ns_);
  if (!child_->tell_lines(log_, asked_for_ns_)) return false;
  if (!child_->take_commands() || !child_->take_kept(kept_)) return false;
  // A late answer whose numbers do not fit any more, since somebody else commanded meanwhile: what it sends counts, if
  // nobody wants behaviors to stop; its motions go by the transaction that has their number.
  if (commands.last_sequence() == asked_sequence_ || !stopping_) child_->send_on(commands, asked_for_ns_);
  child_->take_status(play_, behaviors_);
  child_->take_plays(plays_);
  if (!child_->take_decided(decided_, told_) || !take_replies()) return false;
  ++answers_;
  order_deaths_ = 0;
  policy_.answered();
  if (died_ns_ < 0) return true;
  ++takeovers_;
  outage_.add(now_ns_ - died_ns_);
  died_ns_ = -1;
  safe_->forget();
  say(Severity::info, process_name() + " goes on as " + std::to_string(child_->process.pid()));
  return true;
}

// What was in the request is done: an order without a reply was carried out.
bool ProcessHost::take_replies() {
  std::map<std::uint32_t, BehaviorReply> replies;
  if (!child_->take_replies(replies)) return false;
  const auto settle = [&](Queue& queue) {
    for (; queue.asked > 0; --queue.asked, queue.sent.pop_front()) {
      const Sent& first = queue.sent.front();
      BehaviorReply& reply = replies[first.number];
      if (first.report) reported_ = reply.behaviors;
      if (const auto waits = asked_for_.find(first.number); waits != asked_for_.end()) waits->second = std::move(reply);
    }
  };
  settle(orders_);
  settle(questions_);
  return true;
}

void ProcessHost::bury(const std::string& why, bool alive) noexcept {
  std::string how = why;
  if (child_) {
    (void)child_->tell_lines(log_, now_ns_, false);  // its last words: of a tick that does not count
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
  fail(questions_, questions_.asked, process_name() + " died of it, or at the same time: ask again");
  const std::optional<std::int64_t> due_ns = policy_.died(now_ns_);
  if (!kept_) return stay_down(how + ", and its state could not be kept");
  if (!due_ns) return stay_down(how + ", " + std::to_string(policy_.in_a_row()) + " times in a row");
  phase_ = Phase::waiting;
  start_due_ns_ = *due_ns;
  say(Severity::warning, process_name() + " died: " + how +
                             (decides() ? "; behaviors go on" : "; the robot holds until the next one goes on"));
}

// The next process gets it too, but not for ever.
void ProcessHost::give_up_order() noexcept {
  constexpr std::uint32_t deaths_max = 3;
  if (!asked_ || orders_.asked == 0 || ++order_deaths_ < deaths_max) return;
  fail(orders_, orders_.asked, process_name() + " died of it three times");
  order_deaths_ = 0;
  say(Severity::error, "an order was dropped: " + process_name() + " died of it three times");
}

void ProcessHost::stay_down(const std::string& why) noexcept {
  child_.reset();
  phase_ = Phase::down;
  const std::string how = process_name() + " stays down: " + why;
  fail(orders_, orders_.sent.size(), how);
  fail(questions_, questions_.sent.size(), how);
  say(Severity::error, how);
}

void ProcessHost::say(Severity severity, const std::string& text) noexcept {
  log_.message(now_ns_, severity, "supervisor", text);
}

}  // namespace kadans
