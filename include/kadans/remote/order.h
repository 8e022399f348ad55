// What somebody outside asks of a running instance, and what comes back; order_queue.h says how they travel.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "kadans/remote/order_queue.h"
#include "kadans/script/script_parameter.h"
#include "kadans/signal/frames.h"
#include "kadans/signal/parameter.h"

namespace kadans {

struct ParameterChange {
  std::string name;
  double before = 0, now = 0;
  std::string chunk{};  // the file that declares it, of a behavior's
};

struct Order {
  enum class Kind : std::uint8_t {
    // Behavior thread.
    report,    // what plays: Answer::behaviors
    describe,  // Answer::text = behaviors_description
    play,      // `text` = list; behind what plays
    replace,   // the same in its place
    pause,
    resume,
    stop,
    reload,         // `text` = name; "" = all that play
    switch_set,     // `text` = name
    set_point,      // `text` = "gaze.x_m=1.2,gaze.y_m=0.3", in one transaction; `value` = to be reached in so many s
    set_parameter,  // `text` = name, of the table or BEHAVIOR.NAME; `value`
    undo,           // takes the newest set_parameter back
    changes,        // Answer::changes: what set_parameter changed since the start or the last `saved`
    saved,          // `changes` stand in the configuration now
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
    record_dump,  // `text` = file; what the flight recorder has
  };
  Kind kind = Kind::report;
  std::string text{};
  double value = 0;
  std::string who{};         // for the log: "uid 1000 (develop)"
  std::uint64_t client = 0;  // whose console
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
  std::uint64_t chart = 0;  // changes with its states and transitions
  std::vector<ScriptParameter> parameters;
};

struct Answer {
  std::uint64_t number = 0;  // of the order
  bool done = false;
  std::string text;  // not done: why; else what there is to say
  std::vector<BehaviorReport> behaviors{};
  bool paused = false;
  std::vector<ParameterChange> changes{};
  std::vector<ParameterChange> set{};  // of `changes`: also what stands in the configuration already
  std::vector<std::string> words{};    // of a completion, in place of what begins at `begin`
  std::size_t begin = 0;
  bool incomplete = false, writes = false, leaves = false;  // a console's
};

using OrderCase = BasicOrderCase<Order, Answer>;
using OrderQueue = BasicOrderQueue<OrderCase>;

}  // namespace kadans
