// A running instance, a robot or a simulation, as it is seen from outside: what ctl, the live server and whatever else
// serves clients know of it.
//
// Who serves clients does so on a thread of its own and opens a port before the loop. Through it come the newest
// values, the events and the answers; orders go the other way. It never touches what the engines work on: the tables
// (catalog) do not change once the loop runs, everything else crosses by storages and rings that block nobody.
//
//   control thread   control_side.h     rows of signals to the ports that want them
//   behavior thread  behavior_side.h    carries out orders, between its ticks
//   record thread    record_side.h      starts and stops records
//   supervisor       publish(), tell()  status, words, transitions, faults
//
// A simulation on one thread plays all of these parts in turn.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "kadans/config/play_item.h"
#include "kadans/control/catalog.h"
#include "kadans/exchange/latest.h"
#include "kadans/exchange/ring.h"
#include "kadans/remote/configuration_text.h"
#include "kadans/remote/latest_row.h"
#include "kadans/remote/order.h"
#include "kadans/safety/emergency_stop.h"
#include "kadans/signal/fault.h"
#include "kadans/signal/status.h"
#include "kadans/telemetry/event_log.h"

namespace kadans {

struct RecordStatus {
  bool goes_on = false;
  bool failed = false;  // its disk did
  std::uint64_t rows = 0, bytes = 0;
  std::uint32_t dropped = 0;
  std::array<char, 256> file{};
  std::uint32_t flights = 0;       // records that the flight recorder wrote
  std::array<char, 256> flight{};  // the last of them
};

// Published by the supervisor some twenty times a second.
struct InstanceStatus {
  std::uint64_t tick = 0;
  std::int64_t time_ns = 0;
  SafetyStatus safety;
  SetMask control_sets = 0;
  std::uint32_t commands_refused = 0;
  RecordStatus record;
  PowerStatus power;
};
InstanceStatus status_of(const Snapshot& snapshot, const RecordStatus& record) noexcept;

class InstancePort {
 public:
  explicit InstancePort(std::size_t signals) : row_(signals) {}

  // All of it: the client's thread.
  InstanceStatus status() noexcept { return status_.newest(); }
  // The newest row of the catalog's signals, each n-th of which was wanted. 0: none any more.
  void want_signals(std::uint32_t every_ticks) noexcept { row_.want(every_ticks); }
  LatestRow::Reading signals() noexcept { return row_.read(); }
  // Transitions and words of behaviors; false when none waits.
  [[nodiscard]] bool next(Event& event) { return events_.pop(INT64_MAX, event); }
  [[nodiscard]] bool next(Fault& fault) noexcept { return faults_.try_pop(fault); }

  // The order's number, from 1; 0: refused, too many wait for their answers.
  std::uint64_t send(Order order);
  [[nodiscard]] bool next(Answer& answer);
  // Whoever asked is gone or waits no more: the order is not carried out, unless it is being already. Its answer comes.
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

class Instance {
 public:
  static constexpr std::size_t ports_max = 4;

  struct Facts {
    std::string name;                     // of the robot
    std::string mode;                     // "run", "run on virtual time", "simulation"
    std::string version;                  // of the program
    std::filesystem::path configuration;  // of the robot; absolute, "": none
    std::filesystem::path root;           // of the project
    PlayFolders folders;
    std::filesystem::path records;  // folder of records that are asked for
    double control_period_s = 0.001, behavior_period_s = 0.01;
  };
  // When all signals are declared. Catalog and stop must outlive it. Throws InputError when the configuration cannot be
  // read.
  Instance(Facts facts, const Catalog& catalog, EmergencyStop& stop)
      : facts_(std::move(facts)),
        catalog_(catalog),
        stop_(stop),
        configuration_(facts_.configuration, facts_.folders.robot),
        console_row_(catalog.signals.size()) {}

  // Any thread. Of the catalog: names, units, ranges, and parameters.newest(id).
  const Facts& facts() const noexcept { return facts_; }
  const Catalog& catalog() const noexcept { return catalog_; }
  // Threads that serve clients.
  ConfigurationText& configuration() noexcept { return configuration_; }
  // Any thread, without asking anybody: the robot damps from the next tick on, then is off, until faults are cleared.
  void stop_now(const std::string& who) noexcept { stop_.ask(who); }
  void clear_faults() noexcept { stop_.lift(); }  // the emergency stop, too

  // Any thread. The number of the control set; throws InputError with the nearest name.
  std::uint32_t set_named(const std::string& name) const;

  // Before the loop. Throws std::logic_error when there are ports_max.
  InstancePort& open_port();
  const std::vector<std::unique_ptr<InstancePort>>& ports() const noexcept { return ports_; }

  // Behavior thread: the newest row for consoles.
  void want_console_row(bool wanted) noexcept { console_row_.want(wanted ? 1 : 0); }
  LatestRow::Reading console_row() noexcept { return console_row_.read(); }

  // Supervisor.
  void publish(const InstanceStatus& status) noexcept;
  void tell(const Event& event);
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
