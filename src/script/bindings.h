// What the functions of `m` act on: the catalog, the snapshot and the transaction of the running tick.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <lua.hpp>

#include "kadans/control/catalog.h"
#include "kadans/control/set_partition.h"
#include "kadans/engine/transaction.h"
#include "kadans/script/chart.h"
#include "kadans/script/chart_runner.h"
#include "lua_core.h"
#include "motion.h"

namespace kadans {

struct Bindings {
  const Catalog* catalog = nullptr;
  std::vector<const ControlSetInfo*> sets;  // by machine, its own or its caller's; nullptr: every object
  const Snapshot* snapshot = nullptr;
  CommandSender* sender = nullptr;
  std::int64_t held_ns = 0;  // how far the behaviors' clock is behind the engine's: pauses
  std::int64_t now_ns = 0;   // of the behaviors' clock
  ChartRunner* runner = nullptr;
  bool refused = false;                            // a command of this tick found no place
  std::array<Motion*, max_transaction> motions{};  // asked for in this tick
  std::uint32_t motion_count = 0;
  SetMask wanted = 0;                   // sets that came to be needed, and no transaction says so yet
  std::array<std::uint32_t, 8> sent{};  // the newest transactions, by sent_count modulo their number
  std::uint32_t sent_count = 0;
  std::uint32_t refusals_seen = 0;  // of the snapshot's transactions_refused

  const ControlSetInfo* set_of(std::size_t machine) const noexcept {
    return machine < sets.size() ? sets[machine] : nullptr;
  }
  bool has_object(std::size_t machine, std::uint32_t object) const noexcept;
  SetMask all_sets() const noexcept;
  // A machine is entered: asks for its control set, unless that is active.
  void bring_in(std::size_t machine) noexcept;
  // Behind begin(): what could not be sent before.
  void bring_in_again() noexcept;
  // The next refusal of a transaction of this behavior's in the snapshot; nullptr when all were told.
  const Refusal* next_refusal() noexcept;
  // False when the queue has no place: the whole transaction will be refused.
  bool send(const Command& command) noexcept;
  void begin(CommandSender& to, const Snapshot& seen, std::int64_t time_ns) noexcept;
  std::int64_t engine_ns() const noexcept { return now_ns + held_ns; }
  // Commits; motions learn their transaction. False: refused.
  bool commit() noexcept;
};

inline Bindings& bindings_of(lua_State* state) noexcept { return *static_cast<Bindings*>(core_of(state).bindings); }

void open_log(lua_State* state);  // [-1 +1] adds `log` to the module's table at the top

// [-0 +1] The handle of a control object: m.posture.
void push_object(lua_State* state, std::uint32_t object);
void open_objects(lua_State* state);

// Makes `m` of each machine and `s`; leaves references in the runner's tables. Raises.
void open_machines(lua_State* state, const Chart& chart, const Bindings& bindings, RunnerTables& tables);
// Gives a machine that is being entered its vars and arguments.
void renew_machine(lua_State* state, const Chart& chart, const RunnerTables& tables, std::uint16_t machine);

}  // namespace kadans
