#include "input_stream.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "signal/number_text.h"

namespace kadans {
namespace {

template <typename T>
constexpr std::size_t words_of = sizeof(T) / sizeof(std::uint64_t);
static_assert(sizeof(TickInputs) % 8 == 0 && sizeof(FaultWords) % 8 == 0 && sizeof(JoystickState) % 8 == 0 &&
              sizeof(SeenBall) % 8 == 0 && sizeof(SeenEntry) % 8 == 0 && sizeof(JointSample) % 8 == 0 &&
              sizeof(ImuSample) % 8 == 0 && sizeof(FootSample) % 8 == 0 && sizeof(ChannelSample) % 8 == 0);

// A frame lies in three pieces: head and joints; IMU and feet; supply, button and channels.
constexpr std::size_t frame_head = offsetof(SensorFrame, joints) / 8, frame_imu = offsetof(SensorFrame, imu) / 8,
                      frame_supply = offsetof(SensorFrame, supply_V) / 8;
constexpr std::size_t supply_words = offsetof(SensorFrame, channels) / 8 - frame_supply;
static_assert(offsetof(SensorFrame, feet) == offsetof(SensorFrame, imu) + sizeof(ImuSample));

std::size_t body_words(const InputLayout& layout) noexcept {
  return words_of<ImuSample> + layout.feet * words_of<FootSample>;
}
std::size_t rest_words(const InputLayout& layout) noexcept {
  return supply_words + layout.channels * words_of<ChannelSample>;
}

enum class Mode : std::uint8_t { steady, signal, xored, change, counts, near, alike };

std::uint64_t next_of(std::uint64_t before, std::uint64_t last) noexcept { return last + (last - before); }

std::size_t bytes_in(std::uint64_t value) noexcept { return (static_cast<std::size_t>(std::bit_width(value)) + 7) / 8; }

// So that small numbers of both signs have few bytes.
std::uint64_t zigzag(std::uint64_t difference) noexcept { return (difference << 1U) ^ (0 - (difference >> 63U)); }
std::uint64_t unzigzag(std::uint64_t value) noexcept { return (value >> 1U) ^ (0 - (value & 1U)); }

// How many bytes the largest of the numbers has, then the lowest bytes of all, then the next bytes, up to these.
template <typename NumberAt>
void put_planes(std::size_t count, NumberAt number, ByteWriter& message) {
  std::uint64_t all = 0;
  for (std::size_t i = 0; i < count; ++i) all |= number(i);
  const std::size_t planes = bytes_in(all);
  message.put(static_cast<std::uint8_t>(planes));
  const std::span<std::byte> bytes = message.grow(planes * count);
  for (std::size_t p = 0; p < planes; ++p) {
    for (std::size_t i = 0; i < count; ++i) bytes[p * count + i] = static_cast<std::byte>(number(i) >> (8 * p));
  }
}

constexpr std::size_t bytes_of_bits(std::size_t bits) noexcept { return (bits + 7) / 8; }

std::optional<std::uint32_t> count_in(const TextMap& facts, const char* name, std::uint32_t max) {
  const auto number = number_of<std::uint32_t>(fact_in(facts, name));
  return number && *number <= max ? number : std::nullopt;
}

constexpr std::uint32_t down_max = 1024, state_bytes_max = 1U << 24U;

// Bytes from outside become values that these types have.
void make_sound(auto& value, std::uint8_t last) noexcept {
  std::uint8_t byte = 0;
  std::memcpy(&byte, &value, 1);
  byte = std::min(byte, last);
  std::memcpy(&value, &byte, 1);
}

void make_sound(SeenEntries& seen) noexcept {
  constexpr std::int64_t time_max_ns = std::int64_t{1} << 62U;  // an age is a difference of two
  for (SeenEntry& entry : seen.entries) {
    entry.time_ns = std::clamp(entry.time_ns, -time_max_ns, time_max_ns);
    make_sound(entry.places, 3);
    make_sound(entry.source, seen_sources - 1);
    make_sound(entry.carried, 1);
  }
}

void make_sound(TickTaken& taken) noexcept {
  for (JointSample& joint : taken.sensors.joints) {
    make_sound(joint.drive, static_cast<std::uint8_t>(DriveState::fault));
    make_sound(joint.homed, 1);
    make_sound(joint.braked, 1);
  }
  make_sound(taken.sensors.emergency, 1);
  make_sound(taken.seen);
  for (bool& button : taken.joystick.buttons) make_sound(button, 1);
  make_sound(taken.joystick.connected, 1);
}

// Multiples of a step by numbers that differ for the two zeros: -2 steps are -3, one is -2, -0.0 is -1, 0.0 is 0.
double multiple(std::int64_t number, double step) noexcept {
  return number < 0 ? -(static_cast<double>(-(number + 1)) * step) : static_cast<double>(number) * step;
}

// Whether all values are multiples of one step, bit for bit, and counts_ which.
bool counted(std::span<const std::uint64_t> values, double step, std::vector<std::int64_t>& counts) {
  counts.clear();
  for (const std::uint64_t bits : values) {
    const double count = std::round(std::bit_cast<double>(bits) / step);
    if (!(std::abs(count) < 1e9)) return false;
    counts.push_back(static_cast<std::int64_t>(count) - (std::signbit(count) ? 1 : 0));
    if (std::bit_cast<std::uint64_t>(multiple(counts.back(), step)) != bits) return false;
  }
  return true;
}

template <typename T>
std::span<const double> as_words(const T* first, std::size_t words) noexcept {
  return {reinterpret_cast<const double*>(first), words};
}

}  // namespace

std::size_t InputLayout::words() const noexcept {
  return words_of<TickInputs> + words_of<FaultWords> + words_of<JoystickState> + words_of<SeenBall> +
         seen * words_of<SeenEntry> + down + frame_head + joints * words_of<JointSample> + body_words(*this) +
         rest_words(*this);
}

TextMap InputLayout::facts() const {
  TextMap facts{{"format", inputs_format},
                {"joints", std::to_string(joints)},
                {"feet", std::to_string(feet)},
                {"channels", std::to_string(channels)},
                {"down", std::to_string(down)}};
  if (seen > 0) facts["seen"] = std::to_string(seen);
  if (state_bytes > 0) facts["state_bytes"] = std::to_string(state_bytes);
  return facts;
}

std::optional<InputLayout> InputLayout::of(const TextMap& facts) {
  const auto joints = count_in(facts, "joints", max_joints), feet = count_in(facts, "feet", max_feet),
             channels = count_in(facts, "channels", max_channels), down = count_in(facts, "down", down_max);
  const auto seen = facts.contains("seen") ? count_in(facts, "seen", max_seen) : std::optional<std::uint32_t>(0);
  const auto state_bytes =
      facts.contains("state_bytes") ? count_in(facts, "state_bytes", state_bytes_max) : std::optional<std::uint32_t>(0);
  if (fact_in(facts, "format") != inputs_format || !joints || !feet || !channels || !down || !seen || !state_bytes)
    return std::nullopt;
  return InputLayout{*joints, *feet, *channels, *down, *seen, *state_bytes};
}

void unpack(std::span<const std::uint64_t> words, const InputLayout& layout, TickTaken& taken) {
  const std::uint64_t* from = words.data();
  const auto take = [&](void* to, std::size_t count) {
    if (count == 0) return;  // then `to` may be null
    std::memcpy(to, from, count * sizeof(std::uint64_t));
    from += count;
  };
  take(&taken.inputs, words_of<TickInputs>);
  take(taken.stopped_by.data(), words_of<FaultWords>);
  take(&taken.joystick, words_of<JoystickState>);
  take(&taken.ball, words_of<SeenBall>);
  taken.seen.count = layout.seen;
  take(taken.seen.entries.data(), layout.seen * words_of<SeenEntry>);
  taken.down.resize(layout.down);
  take(taken.down.data(), layout.down);
  auto* const frame = reinterpret_cast<std::byte*>(&taken.sensors);
  take(frame, frame_head);
  take(taken.sensors.joints.data(), layout.joints * words_of<JointSample>);
  take(frame + 8 * frame_imu, body_words(layout));
  take(frame + 8 * frame_supply, rest_words(layout));
  make_sound(taken);
  taken.sensors.joint_count = std::min(taken.sensors.joint_count, layout.joints);
  taken.sensors.foot_count = std::min(taken.sensors.foot_count, layout.feet);
  taken.sensors.channel_count = std::min(taken.sensors.channel_count, layout.channels);
}

bool take_seen(std::span<const std::byte> bytes, SeenEntries& seen) noexcept {
  if (bytes.size() != sizeof seen) return false;
  std::memcpy(&seen, bytes.data(), sizeof seen);
  if (seen.count > seen.entries.size()) return false;
  make_sound(seen);
  return true;
}

InputPieces::InputPieces(const ControlEngine& engine, const InputLayout& layout, std::vector<const DownStorage*> down)
    : layout_(layout), down_(std::move(down)), numbers_(down_.size()) {
  const SensorFrame& frame = engine.sensors();
  const Snapshot& state = engine.state();
  pieces_.push_back(as_words(&engine.inputs(), words_of<TickInputs>));
  pieces_.push_back(as_words(engine.safety().stopped_by().data(), words_of<FaultWords>));
  pieces_.push_back(as_words(&state.joystick, words_of<JoystickState>));
  pieces_.push_back(as_words(&state.ball, words_of<SeenBall>));
  pieces_.push_back(as_words(engine.seen().entries.data(), layout.seen * words_of<SeenEntry>));
  pieces_.push_back(as_words(numbers_.data(), numbers_.size()));
  pieces_.push_back(as_words(&frame, frame_head + layout.joints * words_of<JointSample>));
  pieces_.push_back(as_words(&frame.imu, body_words(layout)));
  pieces_.push_back(as_words(&frame.supply_V, rest_words(layout)));
}

std::span<const std::span<const double>> InputPieces::gather() noexcept {
  for (std::size_t i = 0; i < down_.size(); ++i) numbers_[i] = down_[i]->taken();
  return pieces_;
}

InputEncoder::InputEncoder(const InputLayout& layout, std::vector<bool> exact)
    : alone_(layout.state_bytes > 0), exact_(std::move(exact)), columns_(1 + layout.words()) {
  values_.reserve(ticks_max * columns_.size());
  rows_.reserve((lag_max + ticks_max) * exact_.size());
}

bool InputEncoder::add(std::uint64_t tick, std::int64_t time_ns, std::span<const std::uint64_t> words,
                       std::span<const double> row) {
  if (full() || (ticks_ > 0 && tick != next_tick_)) return false;
  if (ticks_ == 0) {
    first_tick_ = tick;
    if (tick != next_tick_) {
      past_ = 0;
      rows_.clear();
    }
  }
  ++ticks_;
  next_tick_ = tick + 1;
  last_time_ns_ = time_ns;
  values_.push_back(static_cast<std::uint64_t>(time_ns));
  values_.insert(values_.end(), words.begin(), words.end());
  rows_.insert(rows_.end(), row.begin(), row.end());
  return true;
}

void InputEncoder::encode(ByteWriter& message) {
  message.put(first_tick_);
  message.put(static_cast<std::uint32_t>(ticks_));
  for (std::size_t c = 0; alone_ && c < columns_.size(); ++c) {
    Column& column = columns_[c];
    column.before = column.last = values_[c];
    message.put(column.last);
  }
  column_.resize(ticks_);
  for (std::uint32_t c = 0; c < columns_.size(); ++c) {
    for (std::size_t t = 0; t < ticks_; ++t) column_[t] = values_[t * columns_.size() + c];
    encode(c, column_, message);
  }
  const std::size_t kept = std::min(past_ + ticks_, lag_max);
  rows_.erase(rows_.begin(), rows_.end() - static_cast<std::ptrdiff_t>(kept * exact_.size()));
  past_ = kept;
  ticks_ = 0;
  values_.clear();
}

std::size_t InputEncoder::bytes_max(const InputLayout& layout) noexcept {
  constexpr std::size_t head = 32;  // of a column, at most
  const std::size_t columns = 1 + layout.words();
  return 2 * columns * ticks_max * sizeof(std::uint64_t) + columns * (sizeof(std::uint64_t) + head);
}

std::uint64_t InputEncoder::signal_bits(std::uint32_t signal, std::size_t tick, std::size_t lag) const noexcept {
  return std::bit_cast<std::uint64_t>(rows_[(past_ + tick - lag) * exact_.size() + signal]);
}

bool InputEncoder::steady(const Column& column, Values values) const noexcept {
  std::uint64_t before = column.before, last = column.last;
  for (const std::uint64_t value : values) {
    if (value != next_of(before, last)) return false;
    before = last;
    last = value;
  }
  return true;
}

bool InputEncoder::as_signal(std::uint32_t signal, Values values) const noexcept {
  for (std::size_t t = 0; t < values.size(); ++t) {
    if (signal_bits(signal, t, 0) != values[t]) return false;
  }
  return true;
}

std::uint32_t InputEncoder::find_signal(Values values) const noexcept {
  for (std::uint32_t signal = 0; signal < exact_.size(); ++signal) {
    if (exact_[signal] && as_signal(signal, values)) return signal;
  }
  return none;
}

bool InputEncoder::grows_as(std::uint32_t column, Values values, std::uint64_t began) const noexcept {
  for (std::size_t t = 0; t < values.size(); ++t) {
    if (values[t] - began != values_[t * columns_.size() + column] - columns_[column].began) return false;
  }
  return true;
}

// Among the columns before it.
std::uint32_t InputEncoder::find_alike(std::uint32_t column, Values values) const noexcept {
  for (std::uint32_t other = 0; other < column; ++other) {
    if (grows_as(other, values, columns_[column].began)) return other;
  }
  return none;
}

// The signal that is the nearest in some ticks of the message, with one lag or that of a tick more.
void InputEncoder::find_near(Column& column, Values values) const noexcept {
  constexpr std::size_t looks = 5;
  std::size_t best = std::numeric_limits<std::size_t>::max();
  for (std::uint32_t signal = 0; signal < exact_.size(); ++signal) {
    for (std::size_t lag = 0; exact_[signal] && lag < std::min(lag_max, past_); ++lag) {
      std::size_t bits = 0;
      for (std::size_t look = 0; look < looks && bits < best; ++look) {
        const std::size_t t = (values.size() - 1) * look / (looks - 1);
        const std::uint64_t one = zigzag(values[t] - signal_bits(signal, t, lag)),
                            more = zigzag(values[t] - signal_bits(signal, t, lag + 1));
        bits += static_cast<std::size_t>(std::bit_width(std::min(one, more)));
      }
      if (bits >= best) continue;
      best = bits;
      column.near = signal;
      column.lag = lag;
    }
  }
}

// Makes rest_, and in counts_ where the lag is a tick more; how many bytes count.
std::size_t InputEncoder::near_bytes(const Column& column, Values values) noexcept {
  if (column.near == none || column.lag >= past_) return std::numeric_limits<std::size_t>::max();
  counts_.resize(values.size());
  std::size_t bytes = 0;
  for (std::size_t t = 0; t < values.size(); ++t) {
    const std::uint64_t one = zigzag(values[t] - signal_bits(column.near, t, column.lag)),
                        more = zigzag(values[t] - signal_bits(column.near, t, column.lag + 1));
    counts_[t] = more < one ? 1 : 0;
    rest_[t] = std::min(one, more);
    bytes += bytes_in(rest_[t]);
  }
  return bytes;
}

// The step is at most the smallest difference of two values. Its last bits follow from the largest value.
bool InputEncoder::find_counts(Column& column, Values values) {
  sorted_.clear();
  for (const std::uint64_t bits : values) sorted_.push_back(std::bit_cast<double>(bits));
  if (!std::ranges::all_of(sorted_, [](double value) { return std::abs(value) < 1e9; })) return false;
  std::ranges::sort(sorted_);
  const double largest = std::max(std::abs(sorted_.front()), std::abs(sorted_.back()));
  if (largest == 0) {  // the two zeros: any step will do
    column.step = 1;
    return counted(values, column.step, counts_);
  }
  double least = largest;
  for (std::size_t i = 1; i < sorted_.size(); ++i) {
    const double apart = sorted_[i] - sorted_[i - 1];
    if (apart > 1e-12 * largest) least = std::min(least, apart);
  }
  for (int parts = 1; parts <= 4 && least > 0; ++parts) {
    const double count = std::round(largest / (least / parts));
    if (!(count < 1e9)) return false;
    double step = largest / count;
    for (int i = 0; i < 2; ++i) step = std::nextafter(step, 0.0);
    for (int i = 0; i < 5; ++i, step = std::nextafter(step, largest)) {
      if (!counted(values, step, counts_)) continue;
      column.step = step;
      return true;
    }
  }
  return false;
}

void InputEncoder::put_counts(const Column& column, ByteWriter& message) {
  message.put(static_cast<std::uint8_t>(Mode::counts));
  message.put(column.step);
  message.put(counts_.front());
  const auto change = [this](std::size_t t) {
    return zigzag(static_cast<std::uint64_t>(counts_[t + 1]) - static_cast<std::uint64_t>(counts_[t]));
  };
  put_planes(counts_.size() - 1, change, message);
}

void InputEncoder::encode(std::uint32_t c, Values values, ByteWriter& message) {
  Column& column = columns_[c];
  column.began = column.last;
  if (!encode_known(c, values, message)) encode_rest(column, values, message);
  column.before = values.size() > 1 ? values[values.size() - 2] : column.last;
  column.last = values.back();
}

// What follows from something else.
bool InputEncoder::encode_known(std::uint32_t c, Values values, ByteWriter& message) {
  Column& column = columns_[c];
  if (steady(column, values)) {
    message.put(static_cast<std::uint8_t>(Mode::steady));
    return true;
  }
  if (column.signal == none || !as_signal(column.signal, values)) column.signal = find_signal(values);
  if (column.signal != none) {
    message.put(static_cast<std::uint8_t>(Mode::signal));
    message.put(column.signal);
    return true;
  }
  if (column.alike == none || !grows_as(column.alike, values, column.began)) column.alike = find_alike(c, values);
  if (column.alike == none) return false;
  message.put(static_cast<std::uint8_t>(Mode::alike));
  message.put(column.alike);
  return true;
}

// The way with the fewest bytes.
void InputEncoder::encode_rest(Column& column, Values values, ByteWriter& message) {
  constexpr std::size_t few = 3;  // bytes a tick
  std::size_t xored = 0, change = 0;
  std::uint64_t before = column.before, last = column.last, all_xored = 0, all_change = 0;
  for (const std::uint64_t value : values) {
    const std::uint64_t changed = zigzag(value - next_of(before, last));
    all_xored |= value ^ last;
    all_change |= changed;
    xored += bytes_in(value ^ last);
    change += bytes_in(changed);
    before = last;
    last = value;
  }
  rest_.resize(values.size());
  Mode mode = change < xored ? Mode::change : Mode::xored;
  const std::size_t least = std::min(xored, change);
  if (std::min(bytes_in(all_xored), bytes_in(all_change)) > few && values.size() > 8) {
    if (column.step > 0 && counted(values, column.step, counts_)) return put_counts(column, message);
    std::size_t near = near_bytes(column, values);
    if (near > least / 2 && column.for_near.over()) {
      find_near(column, values);
      near = near_bytes(column, values);
      (void)column.for_near.note(near <= least / 2);
    }
    const bool tries = near > few * values.size() && column.for_counts.over();
    if (tries && column.for_counts.note(find_counts(column, values))) return put_counts(column, message);
    if (near < least) mode = Mode::near;
    if (mode == Mode::near) (void)near_bytes(column, values);  // makes rest_ and counts_ once more
  }
  before = column.before;
  last = column.last;
  for (std::size_t t = 0; t < values.size(); ++t) {
    if (mode == Mode::xored) rest_[t] = values[t] ^ last;
    if (mode == Mode::change) rest_[t] = zigzag(values[t] - next_of(before, last));
    before = last;
    last = values[t];
  }
  message.put(static_cast<std::uint8_t>(mode));
  if (mode == Mode::near) {
    message.put(column.near);
    message.put(static_cast<std::uint8_t>(column.lag));
    const bool varies = std::ranges::find(counts_, 1) != counts_.end();
    message.put(static_cast<std::uint8_t>(varies));
    const std::span<std::byte> bits = message.grow(varies ? bytes_of_bits(values.size()) : 0);
    for (std::size_t t = 0; varies && t < values.size(); ++t)
      bits[t / 8] |= static_cast<std::byte>(static_cast<unsigned>(counts_[t]) << (t % 8));
  }
  put_planes(
      values.size(), [this](std::size_t t) { return rest_[t]; }, message);
}

bool InputDecoder::decode(std::span<const std::byte> message, const SignalBits& signals, std::deque<TickTaken>& ticks) {
  ByteReader reader(message);
  const auto first_tick = reader.take<std::uint64_t>();
  const auto count = reader.take<std::uint32_t>();
  if (!reader.ok() || count == 0 || count > InputEncoder::ticks_max) return false;
  for (std::size_t c = 0; layout_.state_bytes > 0 && c < columns_.size(); ++c)
    columns_[c].before = columns_[c].last = reader.take<std::uint64_t>();
  std::vector<std::uint64_t> values(count * columns_.size());
  for (std::uint32_t c = 0; c < columns_.size(); ++c) {
    Column& column = columns_[c];
    column.began = column.last;
    const auto number = reader.take<std::uint8_t>();
    if (!reader.ok() || number > static_cast<std::uint8_t>(Mode::alike)) return false;
    const Mode mode = static_cast<Mode>(number);
    const bool counts = mode == Mode::counts;
    const double step = counts ? reader.take<double>() : 0;
    std::uint64_t counted = counts ? static_cast<std::uint64_t>(reader.take<std::int64_t>()) : 0;
    const bool other = mode == Mode::signal || mode == Mode::near || mode == Mode::alike;
    const std::uint32_t from = other ? reader.take<std::uint32_t>() : 0;  // signal or column
    const std::uint64_t lag = mode == Mode::near ? reader.take<std::uint8_t>() : 0;
    const bool varies = mode == Mode::near && reader.take<std::uint8_t>() != 0;
    const std::span<const std::byte> more = reader.take_bytes(varies ? bytes_of_bits(count) : 0);
    const bool packed = mode != Mode::steady && mode != Mode::signal && mode != Mode::alike;
    const std::size_t planes = packed ? reader.take<std::uint8_t>() : 0;
    const std::uint64_t lag_most = lag + (varies ? 1 : 0);
    if (!reader.ok() || planes > 8 || lag_most > first_tick || lag_most > InputEncoder::lag_max) return false;
    if (mode == Mode::alike && from >= c) return false;
    const std::size_t stored = counts ? count - 1 : count;  // the first count stands before the others
    const std::span<const std::byte> bytes = reader.take_bytes(planes * stored);
    if (!reader.ok()) return false;
    for (std::uint32_t t = 0; t < count; ++t) {
      std::uint64_t rest = 0;
      const std::size_t at = counts ? std::max(t, 1U) - 1 : t;
      for (std::size_t p = 0; p < planes && stored > 0; ++p)
        rest |= std::to_integer<std::uint64_t>(bytes[p * stored + at]) << (8 * p);
      std::uint64_t value = next_of(column.before, column.last);
      if (mode == Mode::signal || mode == Mode::near) {
        const bool later = varies && (std::to_integer<unsigned>(more[t / 8]) >> (t % 8) & 1U) != 0;
        const std::optional<std::uint64_t> bits = signals.bits(first_tick + t - lag - (later ? 1 : 0), from);
        if (!bits) return false;
        value = *bits + unzigzag(rest);
      } else if (mode == Mode::xored) {
        value = column.last ^ rest;
      } else if (mode == Mode::change) {
        value += unzigzag(rest);
      } else if (mode == Mode::alike) {
        value = column.began + (values[t * columns_.size() + from] - columns_[from].began);
      } else if (counts) {
        if (t > 0) counted += unzigzag(rest);
        value = std::bit_cast<std::uint64_t>(multiple(static_cast<std::int64_t>(counted), step));
      }
      column.before = column.last;
      column.last = values[t * columns_.size() + c] = value;
    }
  }
  if (reader.left() > 0) return false;
  for (std::uint32_t t = 0; t < count; ++t) {
    TickTaken& taken = ticks.emplace_back();
    taken.tick = first_tick + t;
    taken.time_ns = static_cast<std::int64_t>(values[t * columns_.size()]);
    const auto first = values.begin() + static_cast<std::ptrdiff_t>(t * columns_.size() + 1);
    taken.words.assign(first, first + static_cast<std::ptrdiff_t>(layout_.words()));
    unpack(taken.words, layout_, taken);
  }
  return true;
}

void put_state(const EngineStates::Saved& saved, ByteWriter& message) {
  message.put(saved.tick);
  message.put(static_cast<std::uint32_t>(saved.found.size()));
  message.put(std::as_bytes(saved.found));
  message.put(saved.bytes);
}

bool take_state(std::span<const std::byte> message, std::vector<std::int64_t>& found, EngineStates::Saved& saved) {
  ByteReader reader(message);
  saved.tick = reader.take<std::uint64_t>();
  const auto count = reader.take<std::uint32_t>();
  if (!reader.ok() || count > down_max) return false;
  found.resize(count);
  for (std::int64_t& number : found) number = reader.take<std::int64_t>();
  if (!reader.ok()) return false;
  saved.found = found;
  saved.bytes = reader.take_bytes(reader.left());
  return true;
}

}  // namespace kadans
