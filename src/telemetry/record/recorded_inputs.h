// What the behavior thread takes and sends, as the record of a run holds it (input_stream.h): event by event.
//
// A complete record holds all by which its behaviors and the high levels of its control objects are repeated. A flight
// record holds what came down to the control engine: commands, and values that high levels handed down.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "engine/behavior_inputs.h"
#include "kadans/control/hand_over.h"
#include "kadans/exchange/ring.h"
#include "kadans/signal/command.h"
#include "signal/byte_order.h"

namespace kadans {

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
    private_file,  // its text is the hash of its content
    handed_down    // of flight records alone: from a high level, whose updates they do not repeat
  };
  static constexpr Kind last_kind = Kind::handed_down;

  Kind kind = Kind::tick_begins;
  std::uint64_t snapshot = 0;       // tick_begins: 1 + the control tick whose snapshot it sees; 0: there was none yet
  std::int64_t time_ns = 0;         // tick_begins
  bool in_tick = false;             // sent: by a behavior
  std::vector<Command> commands{};  // sent, behind their header
  std::uint32_t number = 0;         // newer, handed_down: of the storage; time_over: of the look at the clock
  std::int64_t handed = 0;          // handed_down: number of the value
  double value = 0;                 // parameter
  std::string path{}, text{};       // file, private_file
  BehaviorInputs::Asked how{};      // asked
  std::vector<std::byte> bytes{};   // newer, asked, handed_down
};
std::uint32_t number_of_behavior_input(ByteReader message);  // of the next event
// The next event of a message; `expected` counts them. False: damaged, or one is missing.
[[nodiscard]] bool take_behavior_input(ByteReader& message, std::uint32_t& expected, BehaviorInput& input);

// Sorts events into those of a record and those of a flight record, each with numbers of its own.
class EventSorter {
 public:
  // Appends to each. A nullptr gets none.
  void sort(std::span<const std::byte> events, ByteWriter* record, ByteWriter* flight);

 private:
  std::uint32_t expected_ = 0, left_out_ = 0, flight_number_ = 0;
};

// Writes what the behavior thread takes. The ring is emptied by the record thread; what does not fit is missing in the
// record, which says so.
class RecordedInputs final : public BehaviorInputs, public HandedDownSink {
 public:
  // Paths of files start at the project's root. Of files that these patterns name only the hash is recorded.
  explicit RecordedInputs(std::string root, std::vector<std::string> private_files = {});
  // For a flight recorder without a record: commands, and what is handed down.
  struct FlightAlone {};
  explicit RecordedInputs(FlightAlone);
  static constexpr std::size_t flight_bytes = std::size_t{1} << 16U;

  // Before the loop: a file whose text the record has already; of a private one the hash of its content.
  void knows(const std::string& path, std::string_view text) { (void)is_known(path, text); }

  void tick_begins(const Snapshot& snapshot, std::int64_t time_ns) override;
  void tick_ends() override;
  void sent(std::span<const Command> batch, bool in_tick) noexcept override;
  void found_newer(std::uint32_t storage, std::span<const std::byte> value) override;
  double parameter(double newest) noexcept override;
  bool time_is_over(bool (*over)(void*) noexcept, void* budget) noexcept override;
  void file_read(const std::string& path, std::string_view text) override;
  void asked(Asked kind, std::span<const std::byte> bytes) override;
  void handed_down(std::uint32_t storage, std::int64_t number, std::span<const std::byte> value) noexcept override;

  // Record thread: moves what waits to the end of `message`.
  void take(ByteWriter& message);
  void tell_on(ByteWriter& told) override { take(told); }
  // What tell_on() gave in another process, which may be hostile. Where something is missing, it is missing here, too.
  [[nodiscard]] bool pass_on(std::span<const std::byte> told) override;
  std::uint32_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }

 private:
  using Bytes = Ring<std::byte, std::size_t{1} << 20U>;
  using FewBytes = Ring<std::byte, flight_bytes>;

  void begin(BehaviorInput::Kind kind);
  void push() noexcept;
  bool is_known(const std::string& name, std::string_view text);

  std::string root_;
  std::vector<std::string> private_files_;
  std::unordered_map<std::string, std::size_t> hash_of_;
  ByteWriter event_;
  std::uint32_t number_ = 0;
  std::uint32_t expected_ = 0;        // of those that are passed on
  std::unique_ptr<Bytes> ring_;       // one of the two
  std::unique_ptr<FewBytes> flight_;  // nothing but what this needs is told
  std::atomic<std::uint32_t> dropped_{0};
};

}  // namespace kadans
