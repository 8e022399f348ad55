// What somebody outside asks of a running instance, and what comes back. An order travels as a case: made by the thread
// of the client, carried out and answered by the thread that owns what it changes, freed where it was made. The rings
// carry pointers, so no side waits for the other and an order may be as long as it is.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "kadans/exchange/ring.h"
#include "kadans/script/script_parameter.h"
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

// Whoever asked may withdraw an order until it is taken up: it expires with its client.
class OrderCase {
 public:
  Order order;
  Answer answer;

  // The thread that carries out, once. False: it was withdrawn.
  [[nodiscard]] bool take_up() noexcept { return !decided_.exchange(true, std::memory_order_acq_rel); }
  // Client's thread. False: it is taken up already.
  bool withdraw() noexcept { return !decided_.exchange(true, std::memory_order_acq_rel); }

 private:
  std::atomic<bool> decided_{false};
};

// From one client's thread to one that carries out, and back. At most `orders_waiting_max` are on their way.
inline constexpr std::size_t orders_waiting_max = 15;

class OrderQueue {
 public:
  OrderQueue() = default;
  ~OrderQueue();
  OrderQueue(const OrderQueue&) = delete;
  OrderQueue& operator=(const OrderQueue&) = delete;

  // Client's thread. False: too many wait.
  [[nodiscard]] bool ask(std::unique_ptr<OrderCase> order);
  // Client's thread: the order of this number is not carried out, unless it is being already.
  void withdraw(std::uint64_t number) noexcept;
  std::unique_ptr<OrderCase> answered() noexcept;  // nullptr: none

  // The thread that carries out.
  std::unique_ptr<OrderCase> take() noexcept;  // nullptr: none; what was withdrawn goes back unanswered
  void answer(std::unique_ptr<OrderCase> order) noexcept;

 private:
  using Cases = Ring<OrderCase*, 16>;
  Cases asked_, answered_;
  std::vector<OrderCase*> on_their_way_;  // client's
};

}  // namespace kadans
