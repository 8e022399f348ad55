// An order of a client to a running instance, and its answer. order_queue.h says how they cross threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "kadans/signal/frames.h"
#include "kadans/signal/parameter.h"
#include "order_queue.h"
#include "script/host/script_parameter.h"

namespace kadans {

struct ParameterChange {
  std::string name;
  double before = 0, now = 0;
  std::string chunk{};  // for a behavior's parameter: the file that declares it
};

struct Order {
  enum class Kind : std::uint8_t {
    // Behavior thread.
    report,    // Answer::behaviors = what plays
    describe,  // Answer::text = behaviors_description
    play,      // `text` = list; it is appended to what plays
    replace,   // `text` = list; it replaces what plays
    pause,
    resume,
    stop,
    reload,         // `text` = name; "": all playing behaviors
    switch_set,     // `text` = name
    set_point,      // `text` = "gaze.x_m=1.2,gaze.y_m=0.3", in one transaction; `value` = duration in s
    set_parameter,  // `text` = name in the table, or BEHAVIOR.NAME; `value`
    undo,           // reverts the newest set_parameter
    changes,        // Answer::changes = changes by set_parameter since the start or the last `saved`
    saved,          // `changes` have been written into the configuration
    clear_faults,
    // `text` = joints by a pattern, "" = all; as the orders to drives (frames.h).
    enable_drives,
    disable_drives,
    reset_drives,
    home_drives,
    brake_drives,
    release_drives,
    line,           // `text` for the console of this client
    complete,       // `text` = the beginning of a line
    leave_console,  // the client is gone
    // Record thread.
    record_start,  // `text` = file
    record_stop,
    record_dump,  // `text` = file; writes what the flight recorder holds
  };
  Kind kind = Kind::report;
  std::string text{};
  double value = 0;
  std::string who{};         // for the log: "uid 1000 (develop)"
  std::uint64_t client = 0;  // the client whose console it is
  std::vector<ParameterChange> changes{};
};

// What an order asks of drives; none: it is about something else.
constexpr DriveOrder drive_order_of(Order::Kind kind) noexcept {
  using enum Order::Kind;
  if (kind < enable_drives || kind > release_drives) return DriveOrder::none;
  return static_cast<DriveOrder>(1 + static_cast<std::uint8_t>(kind) - static_cast<std::uint8_t>(enable_drives));
}
static_assert(drive_order_of(Order::Kind::enable_drives) == DriveOrder::enable &&
              drive_order_of(Order::Kind::home_drives) == DriveOrder::home &&
              drive_order_of(Order::Kind::release_drives) == last_drive_order);

struct BehaviorReport {
  std::string name, state, outcome, error;
  std::uint32_t lane = 0;
  bool over = false;
  std::uint64_t chart = 0;  // a number that changes when the chart's states or transitions change
  std::vector<ScriptParameter> parameters;
};

struct Answer {
  std::uint64_t number = 0;  // of the order
  bool done = false;
  std::string text;  // when not done: the reason; else a message
  std::vector<BehaviorReport> behaviors{};
  bool paused = false;
  std::vector<ParameterChange> changes{};
  std::vector<ParameterChange> set{};  // for the order `changes`: also those that are already saved
  std::vector<std::string> words{};    // of a completion; they replace the text from `begin` on
  std::size_t begin = 0;
  bool incomplete = false, writes = false, leaves = false;  // of a console
};

using OrderCase = BasicOrderCase<Order, Answer>;
using OrderQueue = BasicOrderQueue<OrderCase>;

}  // namespace kadans
