#include "recorded_inputs.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <functional>
#include <limits>
#include <utility>

#include "kadans/signal/nearest_name.h"
#include "run_inputs.h"

namespace kadans {
namespace {

constexpr std::size_t event_head = 2 * sizeof(std::uint32_t);  // bytes behind the head, number
constexpr std::size_t files_max = 4096, path_bytes_max = 4096;

}  // namespace

RecordedInputs::RecordedInputs(std::string root, std::vector<std::string> private_files)
    : root_(std::move(root)), private_files_(std::move(private_files)), ring_(std::make_unique<Bytes>()) {
  event_.reserve(std::size_t{64} << 10U);
}

RecordedInputs::RecordedInputs(FlightAlone) : flight_(std::make_unique<FewBytes>()) {
  event_.reserve(max_transaction * sizeof(Command) + 64);
}

void RecordedInputs::begin(BehaviorInput::Kind kind) {
  event_.clear();
  event_.put(std::uint32_t{0});
  event_.put(number_++);
  event_.put(static_cast<std::uint8_t>(kind));
}

void RecordedInputs::push() noexcept {
  event_.set(0, static_cast<std::uint32_t>(event_.size() - event_head));
  const bool fits = flight_ != nullptr ? flight_->try_push(event_.bytes()) : ring_->try_push(event_.bytes());
  if (!fits) dropped_.fetch_add(1, std::memory_order_relaxed);
}

void RecordedInputs::tick_begins(const Snapshot& snapshot, std::int64_t time_ns) {
  BehaviorInputs::tick_begins(snapshot, time_ns);
  if (flight_ != nullptr) return;
  begin(BehaviorInput::Kind::tick_begins);
  event_.put(snapshot.time_ns == 0 ? std::uint64_t{0} : snapshot.tick + 1);
  event_.put(time_ns);
  push();
}

void RecordedInputs::tick_ends() {
  BehaviorInputs::tick_ends();
  if (flight_ != nullptr) return;
  begin(BehaviorInput::Kind::tick_ends);
  push();
}

void RecordedInputs::sent(std::span<const Command> batch, bool in_tick) noexcept {
  begin(BehaviorInput::Kind::sent);
  event_.put(static_cast<std::uint8_t>(in_tick));
  event_.put(std::as_bytes(batch));
  push();
}

void RecordedInputs::found_newer(std::uint32_t storage, std::span<const std::byte> value) {
  if (flight_ != nullptr) return;
  begin(BehaviorInput::Kind::newer);
  event_.put(storage);
  event_.put(value);
  push();
}

double RecordedInputs::parameter(double newest) noexcept {
  if (flight_ != nullptr) return newest;
  begin(BehaviorInput::Kind::parameter);
  event_.put(newest);
  push();
  return newest;
}

bool RecordedInputs::time_is_over(bool (*over)(void*) noexcept, void* budget) noexcept {
  ++looks_;
  if (!over(budget)) return false;
  if (flight_ != nullptr) return true;
  begin(BehaviorInput::Kind::time_over);
  event_.put(looks_);
  push();
  return true;
}

void RecordedInputs::file_read(const std::string& path, std::string_view text) {
  if (flight_ != nullptr) return;
  const std::filesystem::path below = std::filesystem::path(path).lexically_relative(root_);
  const std::string name = below.empty() || *below.begin() == ".." ? path : below.generic_string();
  const bool left_out =
      std::ranges::any_of(private_files_, [&](const std::string& pattern) { return matches(pattern, name); });
  const std::string hash = left_out ? content_hash(text) : "";
  if (left_out) text = hash;
  if (is_known(name, text)) return;
  begin(left_out ? BehaviorInput::Kind::private_file : BehaviorInput::Kind::file);
  event_.put_string(name);
  event_.put_string(text);
  push();
}

// From now on it is, but for those that are too many for a robot.
bool RecordedInputs::is_known(const std::string& name, std::string_view text) {
  if (hash_of_.size() >= files_max && !hash_of_.contains(name)) return false;
  const std::size_t hash = std::hash<std::string_view>()(text);
  const auto [known, added] = hash_of_.try_emplace(name, hash);
  return !added && std::exchange(known->second, hash) == hash;
}

namespace {

// Values are as large as the largest robot and mostly zeros: how many zeros, how many others, these; in words.
using Word = std::uint32_t;
constexpr std::size_t run_max = std::numeric_limits<std::uint16_t>::max(), value_bytes_max = std::size_t{1} << 20U;

void put_value(std::span<const std::byte> value, ByteWriter& message) {
  message.put(static_cast<std::uint32_t>(value.size()));
  const std::size_t words = value.size() / sizeof(Word);
  const auto is_zero = [value](std::size_t word) {
    Word bits = 0;
    std::memcpy(&bits, &value[word * sizeof bits], sizeof bits);
    return bits == 0;
  };
  for (std::size_t at = 0; at < words;) {
    std::size_t zeros = 0, others = 0;
    while (at + zeros < words && zeros < run_max && is_zero(at + zeros)) ++zeros;
    at += zeros;
    while (at + others < words && others < run_max && !is_zero(at + others)) ++others;
    message.put(static_cast<std::uint16_t>(zeros));
    message.put(static_cast<std::uint16_t>(others));
    message.put(value.subspan(at * sizeof(Word), others * sizeof(Word)));
    at += others;
  }
  message.put(value.subspan(words * sizeof(Word)));
}

std::vector<std::byte> take_value(ByteReader& message) {
  const auto size = message.take<std::uint32_t>();
  if (size > value_bytes_max) return {};
  std::vector<std::byte> value(size);
  const std::size_t words = size / sizeof(Word);
  const auto copy = [&](std::size_t at, std::size_t count) {
    const std::span<const std::byte> from = message.take_bytes(count);
    std::ranges::copy(from, value.begin() + static_cast<std::ptrdiff_t>(at));
  };
  for (std::size_t at = 0; at < words && message.ok();) {
    const std::size_t zeros = message.take<std::uint16_t>(), others = message.take<std::uint16_t>();
    if (zeros + others == 0 || zeros + others > words - at) return {};
    copy((at + zeros) * sizeof(Word), others * sizeof(Word));
    at += zeros + others;
  }
  copy(words * sizeof(Word), size % sizeof(Word));
  return value;
}

bool is_value(BehaviorInputs::Asked kind) noexcept {
  return kind == BehaviorInputs::Asked::seen || kind == BehaviorInputs::Asked::plays;
}

}  // namespace

void RecordedInputs::asked(Asked kind, std::span<const std::byte> bytes) {
  BehaviorInputs::asked(kind, bytes);
  if (flight_ != nullptr) return;
  begin(BehaviorInput::Kind::asked);
  event_.put(static_cast<std::uint8_t>(kind));
  if (is_value(kind))
    put_value(bytes, event_);
  else
    event_.put(bytes);
  push();
}

void RecordedInputs::handed_down(std::uint32_t storage, std::int64_t number,
                                 std::span<const std::byte> value) noexcept {
  begin(BehaviorInput::Kind::handed_down);
  event_.put(storage);
  event_.put(number);
  put_value(value, event_);
  push();
}

void RecordedInputs::take(ByteWriter& message) {
  const auto take_all = [&message](auto& ring) {
    const std::size_t waiting = ring.size();
    const std::span<std::byte> to = message.grow(waiting);
    for (std::size_t i = 0; i < waiting; ++i) to[i] = ring.peek(i);
    ring.drop(waiting);
  };
  flight_ != nullptr ? take_all(*flight_) : take_all(*ring_);
}

bool RecordedInputs::pass_on(std::span<const std::byte> told) {
  using Kind = BehaviorInput::Kind;
  ByteReader reader(told);
  while (reader.left() > 0) {
    const std::uint32_t number = number_of_behavior_input(reader);
    if (number != std::exchange(expected_, number) && number != 0)
      ++number_;  // so that it is noticed; 0: a new process
    ByteReader event = reader;
    const auto size = event.take<std::uint32_t>();
    (void)event.take<std::uint32_t>();
    const std::span<const std::byte> bytes = event.take_bytes(size);
    BehaviorInput input;
    const bool whole = take_behavior_input(reader, expected_, input);
    const bool file = input.kind == Kind::file || input.kind == Kind::private_file;
    const bool may =
        file || input.kind == Kind::parameter || input.kind == Kind::time_over || input.kind == Kind::asked;
    if (!whole || !may || (file && input.path.size() > path_bytes_max)) {
      ++number_;
      return false;
    }
    if (file && is_known(input.path, input.text)) continue;
    event_.clear();
    event_.put(std::uint32_t{0});
    event_.put(number_++);
    event_.put(bytes);
    push();
  }
  return true;
}

void EventSorter::sort(std::span<const std::byte> events, ByteWriter* record, ByteWriter* flight) {
  ByteReader reader(events);
  const auto put = [](ByteWriter& to, std::span<const std::byte> event, std::uint32_t number) {
    to.put(static_cast<std::uint32_t>(event.size()));
    to.put(number);
    to.put(event);
  };
  while (reader.left() > 0) {
    const auto size = reader.take<std::uint32_t>();
    const auto number = reader.take<std::uint32_t>();
    const std::span<const std::byte> event = reader.take_bytes(size);
    if (!reader.ok() || event.empty()) return;
    if (number != expected_) ++flight_number_;  // so that it is noticed there, too
    expected_ = number + 1;
    const auto kind = static_cast<BehaviorInput::Kind>(event.front());
    const bool handed = kind == BehaviorInput::Kind::handed_down;
    if (flight != nullptr && (handed || kind == BehaviorInput::Kind::sent)) put(*flight, event, flight_number_++);
    left_out_ += handed ? 1 : 0;
    if (record != nullptr && !handed) put(*record, event, number - left_out_);
  }
}

std::uint32_t number_of_behavior_input(ByteReader message) {
  (void)message.take<std::uint32_t>();
  return message.take<std::uint32_t>();
}

bool take_behavior_input(ByteReader& message, std::uint32_t& expected, BehaviorInput& input) {
  const auto size = message.take<std::uint32_t>();
  const auto number = message.take<std::uint32_t>();
  ByteReader bytes(message.take_bytes(size));
  if (!message.ok() || number != expected++) return false;
  const auto kind = bytes.take<std::uint8_t>();
  if (!bytes.ok() || kind > static_cast<std::uint8_t>(BehaviorInput::last_kind)) return false;
  input = {.kind = static_cast<BehaviorInput::Kind>(kind)};
  const auto rest = [&bytes] {
    const std::span<const std::byte> all = bytes.take_bytes(bytes.left());
    return std::vector<std::byte>(all.begin(), all.end());
  };
  switch (input.kind) {
    case BehaviorInput::Kind::tick_begins:
      input.snapshot = bytes.take<std::uint64_t>();
      input.time_ns = bytes.take<std::int64_t>();
      break;
    case BehaviorInput::Kind::tick_ends:
      break;
    case BehaviorInput::Kind::sent: {
      input.in_tick = bytes.take<std::uint8_t>() != 0;
      const std::size_t count = bytes.left() / sizeof(Command);
      if (count == 0 || count > max_transaction || bytes.left() % sizeof(Command) != 0) return false;
      const std::span<const std::byte> from = bytes.take_bytes(bytes.left());
      input.commands.resize(count);
      std::memcpy(input.commands.data(), from.data(), from.size());
      break;
    }
    case BehaviorInput::Kind::newer:
      input.number = bytes.take<std::uint32_t>();
      input.bytes = rest();
      break;
    case BehaviorInput::Kind::handed_down:
      input.number = bytes.take<std::uint32_t>();
      input.handed = bytes.take<std::int64_t>();
      input.bytes = take_value(bytes);
      break;
    case BehaviorInput::Kind::parameter:
      input.value = bytes.take<double>();
      break;
    case BehaviorInput::Kind::time_over:
      input.number = bytes.take<std::uint32_t>();
      break;
    case BehaviorInput::Kind::file:
    case BehaviorInput::Kind::private_file:
      input.path = bytes.take_string();
      input.text = bytes.take_string();
      break;
    case BehaviorInput::Kind::asked: {
      const auto how = bytes.take<std::uint8_t>();
      if (how > static_cast<std::uint8_t>(BehaviorInputs::last_asked)) return false;
      input.how = static_cast<BehaviorInputs::Asked>(how);
      input.bytes = is_value(input.how) ? take_value(bytes) : rest();
      break;
    }
  }
  return bytes.ok() && bytes.left() == 0;
}

}  // namespace kadans
