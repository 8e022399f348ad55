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
// message holds events one after the other, each with a number, so that one that is missing is noticed.
//
// Everything that is read is from outside: a length must fit the bytes, a number its range.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "engine/behavior_inputs.h"
#include "engine/tick/control_engine.h"
#include "kadans/control/hand_over.h"
#include "kadans/exchange/ring.h"
#include "signal/byte_order.h"

namespace kadans {

inline constexpr const char* inputs_topic = "/inputs";
inline constexpr const char* behavior_inputs_topic = "/inputs/behaviors";
inline constexpr const char* inputs_metadata = "tick_inputs";  // the layout, and all signals by their numbers
inline constexpr const char* inputs_format = "2";

// How many of each there are in a run.
struct InputLayout {
  std::uint32_t joints = 0, feet = 0, channels = 0;
  std::uint32_t down = 0;  // storages from high to low levels
  std::uint32_t seen = 0;  // entries of the world model

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

// An event of the behavior thread.
struct BehaviorInput {
  enum class Kind : std::uint8_t {
    tick_begins,
    tick_ends,
    sent,
    newer,
    parameter,
    time_over,
    file,
    asked,
    private_file  // its text is the hash of its content
  };
  static constexpr Kind last_kind = Kind::private_file;

  Kind kind = Kind::tick_begins;
  std::uint64_t snapshot = 0;       // tick_begins: 1 + the control tick whose snapshot it sees; 0: there was none yet
  std::int64_t time_ns = 0;         // tick_begins
  bool in_tick = false;             // sent: by a behavior
  std::vector<Command> commands{};  // sent, behind their header
  std::uint32_t number = 0;         // newer: of the storage; time_over: of the look at the clock
  double value = 0;                 // parameter
  std::string path{}, text{};       // file, private_file
  BehaviorInputs::Asked how{};      // asked
  std::vector<std::byte> bytes{};   // newer, asked
};
// The next event of a message; `expected` counts them. False: damaged, or one is missing.
[[nodiscard]] bool take_behavior_input(ByteReader& message, std::uint32_t& expected, BehaviorInput& input);

// Writes what the behavior thread takes. The ring is emptied by the record thread; what does not fit is missing in the
// record, which says so.
class RecordedInputs final : public BehaviorInputs {
 public:
  // Paths of files start at the project's root. Of files that these patterns name only the hash is recorded.
  explicit RecordedInputs(std::string root, std::vector<std::string> private_files = {});

  // Before the loop: a file whose text the record has already.
  void knows(const std::string& path, std::string_view text) { hash_of_[path] = std::hash<std::string_view>()(text); }

  void tick_begins(const Snapshot& snapshot, std::int64_t time_ns) override;
  void tick_ends() override;
  void sent(std::span<const Command> batch, bool in_tick) noexcept override;
  void found_newer(std::uint32_t storage, std::span<const std::byte> value) override;
  double parameter(double newest) noexcept override;
  bool time_is_over(bool (*over)(void*) noexcept, void* budget) noexcept override;
  void file_read(const std::string& path, std::string_view text) override;
  void asked(Asked kind, std::span<const std::byte> bytes) override;

  // Record thread: moves what waits to the end of `message`.
  void take(ByteWriter& message);
  std::uint32_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }

 private:
  using Bytes = Ring<std::byte, std::size_t{1} << 20U>;

  void begin(BehaviorInput::Kind kind);
  void push() noexcept;

  std::string root_;
  std::vector<std::string> private_files_;
  std::unordered_map<std::string, std::size_t> hash_of_;
  ByteWriter event_;
  std::uint32_t number_ = 0;
  std::unique_ptr<Bytes> ring_;
  std::atomic<std::uint32_t> dropped_{0};
};

}  // namespace kadans
