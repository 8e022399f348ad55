#include "child_answer.h"

#include <algorithm>
#include <atomic>
#include <cstring>

#include "kadans/signal/state_hash.h"
#include "signal/byte_order.h"

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

ChildAnswer::ChildAnswer() {
  bytes_.reserve(decltype(BehaviorLink::lines)::capacity());
  commands_.reserve(CommandQueue::capacity());
}

bool ChildAnswer::is_ready(BehaviorLink& link) noexcept { return link.ready.is.given() == 1; }
std::uint64_t ChildAnswer::fingerprint(BehaviorLink& link) noexcept { return copy_of(link.ready.fingerprint); }

bool ChildAnswer::answers(BehaviorLink& link, std::uint32_t number) noexcept {
  return link.answer.number.given() == number;
}

std::optional<std::vector<std::string>> ChildAnswer::names(BehaviorLink& link) {
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

bool ChildAnswer::take_commands(BehaviorLink& link) {
  const std::size_t waiting = link.commands.size();
  commands_.clear();
  if (waiting > CommandQueue::capacity()) return false;
  for (std::size_t i = 0; i < waiting; ++i) commands_.push_back(copy_of(link.commands.peek(i)));
  link.commands.drop(waiting);
  for (std::size_t at = 0, count = 0; at < waiting; at += count + 1) {
    count = commands_[at].count;
    const bool whole =
        commands_[at].kind == CommandKind::transaction && count > 0 && count < max_transaction && count < waiting - at;
    if (!whole) return false;
    for (std::size_t i = 1; i <= count; ++i) {
      if (commands_[at + i].kind == CommandKind::order_drive) return false;  // drives are no behavior's to order
    }
  }
  return true;
}

void ChildAnswer::send_on(CommandSender& commands, std::int64_t time_ns) const noexcept {
  for (std::size_t at = 0; at < commands_.size(); at += commands_[at].count + 1) {
    commands.begin(time_ns);
    for (std::size_t i = 1; i <= commands_[at].count; ++i) (void)commands.add(commands_[at + i]);
    (void)commands.commit();
  }
}

bool ChildAnswer::tell_lines(BehaviorLink& link, BehaviorLog& log, std::int64_t time_ns) {
  const std::size_t waiting = link.lines.size();
  if (waiting > link.lines.capacity()) return false;
  bytes_.resize(waiting);
  for (std::size_t i = 0; i < waiting; ++i) bytes_[i] = link.lines.peek(i);
  std::atomic_signal_fence(std::memory_order_seq_cst);
  link.lines.drop(waiting);
  ByteReader lines(bytes_);
  while (lines.left() > 0) {
    const auto line = lines.take_bytes(lines.take<std::uint32_t>());
    if (!lines.ok() || !tell_line(line, log, time_ns)) return false;
  }
  return true;
}

bool ChildAnswer::tell_line(std::span<const std::byte> line, BehaviorLog& log, std::int64_t time_ns) {
  ByteReader fields(line);
  const auto kind = fields.take<std::uint8_t>();
  const std::string behavior = fields.take_string();
  if (kind == transition_line) {
    const Transition transition{time_ns, behavior, fields.take_string(), fields.take_string(), fields.take_string()};
    if (fields.ok()) log.transition(transition);
  } else {
    const std::string text = fields.take_string();
    if (kind > static_cast<std::uint8_t>(BehaviorLog::Severity::error)) return false;
    if (fields.ok()) log.message(time_ns, static_cast<BehaviorLog::Severity>(kind), behavior, text);
  }
  return fields.ok() && fields.left() == 0;
}

bool ChildAnswer::take_kept(BehaviorLink& link, std::optional<std::vector<std::byte>>& kept) {
  if (once(link.answer.kept_changed) == 0) return true;
  const std::uint32_t size = once(link.answer.kept.size);
  if (size == KeptState::none) return kept.reset(), true;
  if (size > KeptState::bytes_max) return false;
  const std::uint64_t hash = copy_of(link.answer.kept.hash);
  bytes_.resize(size);
  std::memcpy(bytes_.data(), link.answer.kept.bytes.data(), size);
  std::atomic_signal_fence(std::memory_order_seq_cst);
  if (hash_of_kept(bytes_.data(), size) != hash) return false;
  if (!kept) kept.emplace();
  kept->assign(bytes_.begin(), bytes_.end());
  return true;
}

void ChildAnswer::take_status(BehaviorLink& link, PlayStatus& play, std::deque<BehaviorStatus>& behaviors) noexcept {
  const auto store = [](std::atomic<std::uint32_t>& to, std::uint32_t& from) {
    to.store(once(from), std::memory_order_relaxed);
  };
  BehaviorLink::Numbers& list = link.answer.play;
  store(play.phase, list[0]);
  store(play.playing, list[1]);
  store(play.waiting, list[2]);
  store(play.done, list[3]);
  store(play.not_done, list[4]);
  for (std::size_t i = 0; i < behaviors.size() && i < BehaviorLink::behaviors_max; ++i) {
    BehaviorLink::Numbers& numbers = link.answer.status[i];
    store(behaviors[i].heap_bytes, numbers[0]);
    store(behaviors[i].instructions, numbers[1]);
    store(behaviors[i].gc_pause_ns, numbers[2]);
    store(behaviors[i].state, numbers[3]);
    store(behaviors[i].reloads, numbers[4]);
  }
}

}  // namespace kadans
