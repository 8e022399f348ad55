// A running instance (a robot or a simulation) as servers see it: the ctl server, the live server and any other.
//
// A server has a thread of its own and opens a port before the loop. Through the port it gets the newest values, the
// events and the answers, and sends orders. It never touches the data that the engines work on. The tables (catalog) do
// not change once the loop runs; everything else crosses threads by storages and rings that never block.
//
//   control thread   control_side.h     rows of signals to the ports that want them
//   behavior thread  behavior_side.h    carries out orders, between its ticks
//   record thread    record_side.h      starts and stops records
//   supervisor       publish(), tell()  status, words, transitions, faults
//
// A simulation on one thread does the work of all these threads in turn.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "config/scenario/play_item.h"
#include "kadans/control/catalog.h"
#include "kadans/exchange/latest.h"
#include "kadans/exchange/ring.h"
#include "kadans/signal/fault.h"
#include "kadans/signal/status.h"
#include "latest_row.h"
#include "parameter_history.h"
#include "remote/order/order.h"
#include "remote/order/order_queue.h"
#include "safety/emergency_stop.h"
#include "script/host/behavior_tables.h"
#include "telemetry/record/event_log.h"
#include "telemetry/record/viewer_messages.h"

namespace kadans {

struct RecordStatus {
  static constexpr std::size_t path_bytes = 4096;  // PATH_MAX
  bool goes_on = false;
  bool failed = false;  // writing to the disk failed
  std::uint64_t rows = 0, bytes = 0;
  std::uint32_t dropped = 0;
  std::array<char, path_bytes> file{};
  std::uint32_t flights = 0;              // number of records that the flight recorder wrote
  std::array<char, path_bytes> flight{};  // file of the last one
};

// Published by the supervisor about twenty times a second.
struct InstanceStatus {
  std::uint64_t tick = 0;
  std::int64_t time_ns = 0;
  SafetyStatus safety;
  SetMask control_sets = 0;
  std::uint32_t commands_refused = 0;
  RecordStatus record;
  PowerStatus power;
  SeenEntries seen;
};
InstanceStatus status_of(const Snapshot& snapshot, const RecordStatus& record) noexcept;

struct Answer {
  std::uint64_t number = 0;  // of the order
  bool done = false;
  std::string text;  // when not done: the reason; else a message
  std::vector<BehaviorReport> behaviors{};
  std::vector<BehaviorReasons> reasons{};
  bool paused = false;
  std::vector<ParameterChange> changes{};
  std::vector<ParameterChange> set{};  // for the order `changes`: also those that are already saved
  std::vector<std::string> words{};    // of a completion; they replace the text from `begin` on
  std::size_t begin = 0;
  bool incomplete = false, writes = false, leaves = false;  // of a console
};
using OrderCase = BasicOrderCase<Order, Answer>;
using OrderQueue = BasicOrderQueue<OrderCase>;

class InstancePort {
 public:
  explicit InstancePort(std::size_t signals) : row_(signals) {}

  // Call all methods on the thread that serves the clients.
  InstanceStatus status() noexcept { return status_.newest(); }
  // want_signals: get each n-th row of the catalog's signals from now on; 0: none. signals: the newest of these rows.
  void want_signals(std::uint32_t every_ticks) noexcept { row_.want(every_ticks); }
  LatestRow::Reading signals() noexcept { return row_.read(); }
  // Takes the next transition or message of a behavior, or the next fault. False when none is waiting.
  [[nodiscard]] bool next(Event& event) { return events_.pop(INT64_MAX, event); }
  [[nodiscard]] bool next(Fault& fault) noexcept { return faults_.try_pop(fault); }

  // Returns the order's number, from 1; 0: refused, because too many orders wait for their answers.
  std::uint64_t send(Order order);
  [[nodiscard]] bool next(Answer& answer);
  // Withdraws an order whose client is gone or no longer waits. It is not carried out, unless that has already begun.
  // An answer comes in any case.
  void withdraw(std::uint64_t order) noexcept {
    behaviors_.withdraw(order);
    records_.withdraw(order);
  }

 private:
  friend class Instance;
  friend class ControlSide;
  friend class BehaviorSide;
  friend class RecordSide;

  LatestRow row_;                   // control thread writes
  Latest<InstanceStatus> status_;   // supervisor
  EventLog events_;                 // supervisor
  Ring<Fault, 256> faults_;         // supervisor
  OrderQueue behaviors_, records_;  // behavior thread, record thread
  std::uint64_t sent_ = 0;
};

class Instance final : public LineSink {
 public:
  static constexpr std::size_t ports_max = 4;

  struct Facts {
    std::string name;                     // of the robot
    std::string mode;                     // "run", "run on virtual time", "simulation"
    std::string version;                  // of the program
    std::filesystem::path configuration;  // of the robot; absolute, "": none
    std::filesystem::path root;           // of the project
    PlayFolders folders;
    std::filesystem::path records;  // folder in which ordered records are written
    double control_period_s = 0.001, behavior_period_s = 0.01;
    ViewerSubjects subjects = {};  // the parts of its robots, as viewers name them
  };
  // Make it when all signals are declared. `catalog` and `stop` must outlive it. Throws InputError when the
  // configuration cannot be read.
  Instance(Facts facts, const Catalog& catalog, EmergencyStop& stop)
      : facts_(std::move(facts)),
        catalog_(catalog),
        stop_(stop),
        configuration_(facts_.configuration, facts_.folders.robot),
        console_row_(catalog.signals.size()) {}

  // Any thread. Of the catalog, other threads may use only names, units, ranges, and parameters.newest(id).
  const Facts& facts() const noexcept { return facts_; }
  const Catalog& catalog() const noexcept { return catalog_; }
  // For threads that serve clients.
  ConfigurationText& configuration() noexcept { return configuration_; }
  // Any thread; works without the behavior thread. The robot damps from the next tick on and is then off, until the
  // faults are cleared.
  void stop_now(const std::string& who) noexcept { stop_.ask(who); }
  void clear_faults() noexcept { stop_.lift(); }  // also lifts the emergency stop

  // Any thread. Returns the number of the control set. Throws InputError with the nearest name.
  std::uint32_t set_named(const std::string& name) const;

  // Before the loop. Throws std::logic_error when ports_max are open.
  InstancePort& open_port();
  const std::vector<std::unique_ptr<InstancePort>>& ports() const noexcept { return ports_; }

  // Behavior thread: the newest row of signals for consoles.
  void want_console_row(bool wanted) noexcept { console_row_.want(wanted ? 1 : 0); }
  LatestRow::Reading console_row() noexcept { return console_row_.read(); }

  // Supervisor.
  void publish(const InstanceStatus& status) noexcept;
  void tell(const Line& line) override;
  void tell_active(const ActiveStates& active) override;
  void tell(const Fault& fault) noexcept;

 private:
  friend class ControlSide;

  Facts facts_;
  const Catalog& catalog_;
  EmergencyStop& stop_;
  ConfigurationText configuration_;
  LatestRow console_row_;
  std::vector<std::unique_ptr<InstancePort>> ports_;
};

}  // namespace kadans
