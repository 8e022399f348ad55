// The inputs of a run on threads, as its record holds them, so that it can be repeated bit for bit: what each control
// tick took from outside, and what the behavior thread took, in the order in which it took it.
//
// Channel /inputs: a message holds some ticks. What a tick took is a row of 64-bit words (InputLayout), which the
// control thread only copies. A message stores word by word:
//
//   steady    as the two ticks before lead to: constant, or growing evenly (counters, times)
//   signal    the same bits as a recorded signal of the tick: they are not held twice
//   xor       the bits that differ from those of the tick before, byte by byte, the lowest bytes of all ticks first
//   change    how its growth changed, in the same way
//   counts    what an encoder counts: multiples of a step, both zeros among them, and how their number changes
//   near      how far it is from a signal of the tick, or of one of the ticks before: a drive tells the effort that it
//             was asked for
//   alike     grows as a word before it does: all readings of a frame are counted alike
//
// So a message is read after the rows of its ticks, and after the messages before it. Channel /inputs/behaviors: a
// message holds events one after the other, each with a number, so that one that is missing is noticed. Channel
// /inputs/decisions: the same of the supervisor's thread, when decisions run there.
//
// A flight record begins in the middle of a run and may lack any part before. Each of its messages therefore also holds
// the words of its first tick as they are, and its layout says so. Channel /inputs/states: a message holds the state of
// the control engine after a tick (engine/tick/engine_states.h).
//
// Everything that is read is from outside: a length must fit the bytes, a number its range.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/tick/control_engine.h"
#include "engine/tick/engine_states.h"
#include "kadans/control/hand_over.h"
#include "signal/byte_order.h"

namespace kadans {

inline constexpr const char* inputs_topic = "/inputs";
inline constexpr const char* behavior_inputs_topic = "/inputs/behaviors";
inline constexpr const char* decision_inputs_topic = "/inputs/decisions";
inline constexpr const char* states_topic = "/inputs/states";
inline constexpr const char* inputs_metadata = "tick_inputs";  // the layout, and all signals by their numbers
inline constexpr const char* inputs_format = "2";

// How many of each there are in a run.
struct InputLayout {
  std::uint32_t joints = 0, feet = 0, channels = 0;
  std::uint32_t down = 0;  // storages from high to low levels
  std::uint32_t seen = 0;  // entries of the world model
  // Of a flight record: the most bytes that a state of the control engine may have; each message stands alone.
  std::uint32_t state_bytes = 0;

  std::size_t words() const noexcept;
  TextMap facts() const;
  // nullopt: damaged, or of another format.
  static std::optional<InputLayout> of(const TextMap& facts);
};

// What a tick took from outside, whole.
struct TickTaken {
  std::uint64_t tick = 0;
  std::int64_t time_ns = 0;
  TickInputs inputs;
  FaultWords stopped_by{};
  JoystickState joystick;
  SeenBall ball;
  SeenEntries seen;                // as the supervisor published it
  std::vector<std::int64_t> down;  // which values low levels found
  SensorFrame sensors;
  std::vector<std::uint64_t> words;  // all of it, as it is stored
};
// The world model as bytes, as it was recorded. False: damaged.
[[nodiscard]] bool take_seen(std::span<const std::byte> bytes, SeenEntries& seen) noexcept;
void unpack(std::span<const std::uint64_t> words, const InputLayout& layout, TickTaken& taken);

// Where a tick's inputs are read, in pieces, by the control thread.
class InputPieces {
 public:
  InputPieces(const ControlEngine& engine, const InputLayout& layout, std::vector<const DownStorage*> down);

  // Control thread, at the end of a tick: the pieces, valid until the next tick.
  std::span<const std::span<const double>> gather() noexcept;
  const InputLayout& layout() const noexcept { return layout_; }

 private:
  InputLayout layout_;
  std::vector<const DownStorage*> down_;
  std::vector<std::int64_t> numbers_;
  std::vector<std::span<const double>> pieces_;
};

// Record thread.
class InputEncoder {
 public:
  static constexpr std::size_t ticks_max = 100;  // of a message
  static constexpr std::size_t lag_max = 3;      // ticks between a signal and what is near to it

  // `exact`: for each signal whether every tick of it is recorded with all its bits.
  InputEncoder(const InputLayout& layout, std::vector<bool> exact);

  // False: it does not follow the ticks before; encode them first.
  [[nodiscard]] bool add(std::uint64_t tick, std::int64_t time_ns, std::span<const std::uint64_t> words,
                         std::span<const double> row);
  bool full() const noexcept { return ticks_ == ticks_max; }
  std::size_t ticks() const noexcept { return ticks_; }
  std::int64_t time_ns() const noexcept { return last_time_ns_; }
  // Empties it.
  void encode(ByteWriter& message);
  // What it holds, and the largest message.
  static std::size_t bytes_max(const InputLayout& layout) noexcept;

 private:
  static constexpr std::uint32_t none = 0xffffffff;
  // What is tried in vain is tried again after 1, 2, 4 .. 32 messages.
  struct Patience {
    std::uint32_t wait = 0, next = 1;
    bool over() noexcept { return wait == 0 || --wait == 0; }
    bool note(bool found) noexcept {
      wait = found ? 0 : next;
      next = found ? 1 : std::min(2 * next, 32U);
      return found;
    }
  };
  struct Column {
    std::uint64_t before = 0, last = 0, began = 0;  // `began`: the last one before the message
    std::uint32_t signal = none;                    // the same bits
    std::uint32_t alike = none;                     // column
    std::uint32_t near = none;                      // signal
    std::size_t lag = 0;                            // the same
    double step = 0;                                // of what it counts; 0: none was found
    Patience for_near, for_counts;
  };
  using Values = std::span<const std::uint64_t>;

  std::uint64_t signal_bits(std::uint32_t signal, std::size_t tick, std::size_t lag) const noexcept;
  bool find_counts(Column& column, Values values);
  void put_counts(const Column& column, ByteWriter& message);
  bool steady(const Column& column, Values values) const noexcept;
  bool as_signal(std::uint32_t signal, Values values) const noexcept;
  std::uint32_t find_signal(Values values) const noexcept;
  bool grows_as(std::uint32_t column, Values values, std::uint64_t began) const noexcept;
  std::uint32_t find_alike(std::uint32_t column, Values values) const noexcept;
  void find_near(Column& column, Values values) const noexcept;
  std::size_t near_bytes(const Column& column, Values values) noexcept;
  void encode(std::uint32_t c, Values values, ByteWriter& message);
  bool encode_known(std::uint32_t c, Values values, ByteWriter& message);
  void encode_rest(Column& column, Values values, ByteWriter& message);

  bool alone_;
  std::vector<bool> exact_;
  std::vector<Column> columns_;  // the time, then the words
  std::size_t ticks_ = 0;
  std::uint64_t first_tick_ = 0, next_tick_ = 0;
  std::int64_t last_time_ns_ = 0;
  std::size_t past_ = 0;                      // ticks before the message whose rows are known
  std::vector<std::uint64_t> values_;         // tick by tick
  std::vector<double> rows_;                  // the same, behind those of the past
  std::vector<std::uint64_t> column_, rest_;  // of one encoding
  std::vector<double> sorted_;                // the same
  std::vector<std::int64_t> counts_;          // the same
};

// The bits of a signal in a tick, of the record that is read; nullopt: the record does not have them.
class SignalBits {
 public:
  virtual ~SignalBits() = default;
  virtual std::optional<std::uint64_t> bits(std::uint64_t tick, std::uint32_t signal) const = 0;
};

class InputDecoder {
 public:
  explicit InputDecoder(const InputLayout& layout) : layout_(layout), columns_(1 + layout.words()) {}
  // Appends the ticks of a message. False: it is damaged; then nothing behind it can be read either.
  [[nodiscard]] bool decode(std::span<const std::byte> message, const SignalBits& signals,
                            std::deque<TickTaken>& ticks);

 private:
  struct Column {
    std::uint64_t before = 0, last = 0, began = 0;
  };
  InputLayout layout_;
  std::vector<Column> columns_;
};

// What the control thread saved, as a message, and back. False: damaged. The spans point into the message.
void put_state(const EngineStates::Saved& saved, ByteWriter& message);
[[nodiscard]] bool take_state(std::span<const std::byte> message, std::vector<std::int64_t>& found,
                              EngineStates::Saved& saved);

}  // namespace kadans
