// The data on which the functions of `m` work: the catalog, the snapshot and the transaction of the running tick.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <lua.hpp>

#include "engine/transaction.h"
#include "kadans/control/catalog.h"
#include "kadans/control/set_partition.h"
#include "script/chart/chart.h"
#include "script/chart/chart_runner.h"
#include "script/host/play_report.h"
#include "script/lua/lua_core.h"
#include "script/motion/motion.h"

namespace kadans {

// A transaction that this behavior armed, until it ended or its state was left.
struct ArmedHere {
  std::uint32_t sequence = 0;
  std::uint16_t which = 0;
  StateIndex owner = no_state;  // the state whose function armed it; when it is left, the transaction is taken back
  EventId event = no_event;     // to be posted when it acts
  std::uint32_t fired = 0;      // as last seen
};

// The text of a condition of m:on, taken apart: "not foot.right.contact", "joint.l_knee.position_rad > 0.3".
struct ConditionText {
  std::string_view signal;
  double value = 0.5;  // of a signal that is 0 or 1
  bool below = false;
  const char* wrong = nullptr;  // what is no condition in it
};
ConditionText read_condition_text(std::string_view text) noexcept;
bool is_truth_of_simulation(std::string_view signal) noexcept;

// What a behavior has sent, which the version that takes its place goes on from.
struct SentSoFar {
  SetMask sets_sent = 0;                // the control sets that are active once all transactions sent are applied
  bool sets_lost = false;               // a transaction was refused that may have brought sets in
  std::array<std::uint32_t, 8> sent{};  // the newest transactions, a ring indexed by sent_count
  std::uint32_t sent_count = 0;
  std::uint32_t refusals_seen = 0;  // transactions_refused of the last snapshot
  std::uint32_t refused_last = 0;   // the newest transaction of this behavior that was refused
  std::uint32_t switched = 0;       // the newest one that brings sets in
  bool begun = false;
};

struct Bindings : SentSoFar {
  const Catalog* catalog = nullptr;
  std::optional<SetPartition> partition;
  SetMask all_sets = 0;                          // those that any state may run on
  std::vector<SetMask> machine_sets;             // those that the states of each machine run on
  std::vector<ObjectMask> machine_objects{};     // what `m` of each machine shows; empty: every object
  std::vector<std::vector<double>> evaluated{};  // values that functions gave to parameters: Chart::Machine::calls_with
  const Snapshot* snapshot = nullptr;
  CommandSender* sender = nullptr;
  std::int64_t held_ns = 0;  // how much the behaviors' clock is behind the engine's, because of pauses
  std::int64_t now_ns = 0;   // time on the behaviors' clock
  ChartRunner* runner = nullptr;
  bool refused = false;                            // a command of this tick found no place in the queue
  std::array<Motion*, max_transaction> motions{};  // motions asked for in this tick
  std::uint32_t motion_count = 0;
  std::array<Motion*, max_transaction> cancelled{};  // motions cancelled in this tick
  std::uint32_t cancelled_count = 0;
  SetMask wanted = 0;      // sets of which no command has been sent yet that brings them in
  SetMask sets_now = 0;    // as sets_sent, once this tick's transaction is applied, too
  bool recording = false;  // the function of m:on runs: what it asks for is recorded, not sent
  std::array<Command, max_armed_commands> recorded{};
  std::uint32_t recorded_count = 0;  // may be greater than its room
  std::array<ArmedHere, max_armed> armed{};
  std::uint32_t armed_count = 0;
  std::uint16_t armed_in_tick = 0;
  std::vector<SentEvent> sent_events{};  // by this tick, for other behaviors
  // Of a k.decisions (decision_binding.cpp): where behaviors are found, what plays now, and what this tick asked for.
  const PlayFolders* folders = nullptr;
  const PlayReport* plays = nullptr;
  std::vector<PlayOrder> decided{};
  std::string order_text{}, order_problem{};  // kept here, because Lua does not destroy what it leaves by an error

  void go_on_from(const Bindings& other) noexcept { SentSoFar::operator=(other); }
  bool has_object(std::size_t machine, std::uint32_t object) const noexcept {
    return machine >= machine_objects.size() || (machine_objects[machine] >> object & 1U) != 0;
  }
  // To be called in the step of a chart, between its exits and its entries, with the control sets that its active
  // states run on: switches to those of them that are `needed` and not active. The others were switched to when their
  // states were entered; since then a reflex or a person may have taken their joints.
  void want(SetMask sets, SetMask needed) noexcept;
  // To be called after begin(): asks again for sets that could not be sent before, or were refused. A switch of what
  // still dwells (kadans/control/switch_dwell.h) waits until it does not.
  void bring_in_again() noexcept;
  void bring_in(SetMask sets) noexcept;  // those of them that are not active
  bool must_wait(std::uint32_t set) const noexcept;
  // The next refusal in the snapshot of one of this behavior's transactions; nullptr when all have been returned.
  const Refusal* next_refusal() noexcept;
  // Whether what was refused had been taken, and armed something that was refused when its condition was true.
  bool was_armed(std::uint32_t sequence) const noexcept;
  // Notes the transaction that was just armed.
  const ArmedHere& note_armed(EventId event) noexcept;
  // A state was left: takes back what it armed.
  void take_back(StateIndex owner) noexcept;
  // After a reload: takes back what belongs to states that are not active.
  void take_back_orphans() noexcept;
  // The next one that acted, or ended, since the last call; false: there is none.
  bool look_at_armed(ArmedHere& told, ArmedStatus& status) noexcept;
  void forget_armed(std::uint32_t sequence) noexcept;  // its transaction was refused when it arrived
  void drop_armed(std::uint32_t index) noexcept;
  // Where this tick's transaction is: what is asked for behind it can be taken back.
  struct Mark {
    CommandSender::Mark sent;
    bool refused = false;
    std::uint32_t motions = 0, cancelled = 0, armed = 0;
    std::uint16_t armed_in_tick = 0;
    std::size_t decided = 0;
    std::size_t events = 0;  // for other behaviors
  };
  Mark mark() const noexcept;
  // Motions that begin behind it are cancelled, those that are cancelled behind it go on.
  void take_back_to(const Mark& mark) noexcept;
  void note_cancelled(Motion& motion) noexcept;
  // False when the queue has no place; then the whole transaction will be refused.
  bool send(const Command& command) noexcept;
  void begin(CommandSender& to, const Snapshot& seen, std::int64_t time_ns) noexcept;
  std::int64_t engine_ns() const noexcept { return now_ns + held_ns; }
  // Whether the snapshot shows the control sets as this behavior has left them.
  bool sets_known() const noexcept { return std::max(snapshot->transactions_applied, refused_last) >= switched; }
  // Commits the transaction and stores its number in its motions. False: refused.
  bool commit() noexcept;
};

inline Bindings& bindings_of(lua_State* state) noexcept { return *static_cast<Bindings*>(core_of(state).bindings); }

// [-0 +0] Adds play, replace, stop and the other words of a k.decisions to the machine's table at the top of the stack.
void open_decisions(lua_State* state);

// [-0 +1] Pushes the handle of a control object: m.posture.
void push_object(lua_State* state, std::uint32_t object);

// [-0 +0] Adds m:on and m:use to the machine's table at the top of the stack.
void open_armed(lua_State* state, const Chart& chart);
void open_armed_handles(lua_State* state);

// A signal as the table names it: a foot has the name of its link there, and that of `s.feet` here.
using SignalName = std::array<char, 128>;
SignalName condition_signal(const Bindings& bindings, std::string_view name) noexcept;
// The signals that may have been meant by an unknown one.
std::vector<std::string> signals_near(const Bindings& bindings, std::string_view wanted);

// Makes `m` for each machine, and stores their references in the runner's tables. Raises.
void open_machines(lua_State* state, const Chart& chart, const Bindings& bindings, RunnerTables& tables);
// Gives a machine that is being entered its vars and arguments.
void renew_machine(lua_State* state, const Chart& chart, const RunnerTables& tables, std::uint16_t machine);

// [-0 +1] A deep copy of the value at `index` (> 0): plain data only. Raises.
void push_plain_copy(lua_State* state, int index);
// [-0 +1] A list of texts.
void push_texts(lua_State* state, const std::vector<std::string>& texts);

// Helper functions for the methods of a control object: m.<object>:method(...).

// The number of the control object at `index`, a handle; nullptr: it is something else.
const std::uint32_t* to_object(lua_State* state, int index) noexcept;
// The event of this name, when scripts may send it. Raises.
EventId check_event(lua_State* state, Chart& chart, const char* name);
// Raises when the data at `index`, a table or nothing, is not what the event declares.
void check_event_data(lua_State* state, const ScriptEvent& event, int index);
// For m:emit with options: notes the event for other behaviors. `declared` may be nullptr. Raises.
int send_away(lua_State* state, const ScriptEvent* declared, const char* name, int data, int options);
// The same to the receiver `to`.
int send_to(lua_State* state, const ScriptEvent* declared, const char* name, int data, const char* to);
// [-0 +1] Pushes data of an event from outside as a table.
void push_event_data(lua_State* state, const PlayedEvent& event);
// The object on which the method was called. Raises.
const ObjectInfo& check_object(lua_State* state);
std::uint32_t object_number(const Catalog& catalog, const ObjectInfo& object) noexcept;  // its place in the catalog
// The name without the prefix of the object's name.
const char* short_name(const ObjectInfo& object, const std::string& name) noexcept;
void check_range(lua_State* state, const char* name, const char* unit, double value, double min, double max);
// Returns nil, "queue_full" to the script.
int queue_full(lua_State* state);
// The same when it was not sent, else true.
int tell_sent(lua_State* state, bool sent);

// [-0 +0] Adds move, move_through, set and follow to the methods in the table at the top of the stack.
void open_motion_methods(lua_State* state);

}  // namespace kadans
