// The control engine: the hard-real-time core. tick() is one period of it.
//
// Sample, actuate, compute: what is written in a tick was computed in the last one, so the actuators are written a
// constant time after the tick began, whatever the algorithms cost. tick() does not allocate, lock, throw, log or call
// Lua, and makes no system call but the plant's.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "command_inbox.h"
#include "engine/settings.h"
#include "estimate/estimator.h"
#include "fault_state.h"
#include "kadans/control/control_sets.h"
#include "kadans/exchange/latest.h"
#include "kadans/plant/plant.h"
#include "kadans/signal/command.h"
#include "kadans/signal/frames.h"
#include "kadans/signal/status.h"
#include "record_sink.h"
#include "safety/safety.h"

namespace kadans {

// What a control tick took from outside, beside its sensors and the commands: together they decide all that it
// computes. The engine keeps them for whoever records the tick; nothing else reads them.
struct alignas(8) TickInputs {
  double dt_s = 0;
  std::int64_t heartbeat_ns = 0;  // of the behavior engine, as it was found
  std::uint32_t missed = 0;
  std::uint32_t commands = 0;  // that waited in the queue, headers included
  std::uint32_t stop = 0;      // StopHeard
  std::uint32_t reserved = 0;
};
static_assert(sizeof(TickInputs) == 32, "the same on 32-bit machines");

// What a rehearsal of the tick works on. Between two ticks the CPU works for others, and afterwards the tick's code and
// memory are no longer in its caches: a tick of one microsecond takes five. Therefore, in the last part of its wait,
// the control thread goes through the tick beforehand: it calls the same functions, on copies of what they would
// change.
//
// A rehearsal changes nothing that counts. It reads and writes no plant, takes no command and publishes nothing. So a
// run with rehearsals computes the same as a run without (tests/engine/rehearsal_test.cpp). It allocates nothing and
// makes no system call. Control thread.
struct Rehearsal {
  Rehearsal(double period_s, const Estimator& estimated, const Safety& guarded, const RobotModel& model)
      : dt_s(period_s), estimator(estimated), safety(guarded.settings(), model) {}

  // The last sample once more, as if it were a new one.
  void sample(const SensorFrame& last) noexcept {
    copy_used(last, sensors);
    for (std::uint32_t i = 0; i < last.joint_count; ++i) ++sensors.joints[i].sequence;
    for (std::uint32_t i = 0; i < last.foot_count; ++i) ++sensors.feet[i].sequence;
    ++sensors.imu.sequence;
  }

  double dt_s;
  SensorFrame sensors;
  Estimator estimator;
  Safety safety;
  Snapshot snapshot;
  ActuationFrame actuation;
};

inline constexpr std::size_t snapshot_readers = 2;  // 0: behavior engine, 1: supervisor
using SnapshotStorage = Latest<Snapshot, snapshot_readers>;
using HeartbeatStorage = Latest<std::int64_t>;  // time of the behavior engine's last tick
using JoystickStorage = Latest<JoystickState>;
using BallStorage = Latest<SeenBall>;
using SeenStorage = Latest<SeenEntries>;

// The storages between the threads. Position independent; may live in shared memory.
struct EngineExchange {
  SnapshotStorage snapshot;    // written by the control thread
  CommandQueue commands;       // pushed by the behavior thread, popped by the control thread
  HeartbeatStorage heartbeat;  // written by the behavior thread
  JoystickStorage joystick;    // written by the thread that reads a joystick, read by the control thread
  BallStorage ball;            // written by the thread of perception, read by the control thread
  SeenStorage seen;            // the world model: written by the supervisor, read by the control thread
};

class ControlEngine {
 public:
  // Keeps references to all of it. Declares the engine's own signals in the catalog; before the loop.
  ControlEngine(const EngineSettings& settings, Plant& plant, Estimator& estimator, Safety& safety, ControlSets& sets,
                Catalog& catalog, EngineExchange& exchange);

  // Before the loop, or between ticks by the control thread. Without a sink nothing is recorded.
  void record_to(RecordSink* sink) noexcept { sink_ = sink; }

  // Control thread. `missed` ticks were skipped before this one; dt_s is the true time since the last tick.
  void tick(std::int64_t time_ns, double dt_s, std::uint32_t missed = 0) noexcept;

  // Control thread, in the wait before a tick: goes through it on copies (Rehearsal). Changes nothing that counts.
  void rehearse() noexcept;

  // Between ticks, or in the sink of the tick: all by which the next ticks depend on those before and that is not their
  // input, without what waits in the storages and in the queue. Another engine of the same files that gets it goes on
  // bit for bit (kadans/control/state_bytes.h); there `ticks` are over. False: it is damaged or of another robot; then
  // the engine must not be used.
  void pass_state(StateBytes& bytes) noexcept;
  [[nodiscard]] bool restore(std::uint64_t ticks, std::span<const std::byte> state) noexcept;
  // What the byte at `offset` of the state belongs to: "safety", "control object posture".
  std::string part_of_state(std::size_t offset);

  std::uint64_t ticks() const noexcept { return tick_; }
  std::span<const double> row() const noexcept { return row_; }  // signals of the last tick
  const Snapshot& state() const noexcept { return snapshot_; }
  const ActuationFrame& actuation() const noexcept { return actuation_; }
  const CommandInbox& inbox() const noexcept { return inbox_; }
  const FaultState& fault_state() const noexcept { return fault_state_; }
  // Of the last tick; valid until the next one.
  const TickInputs& inputs() const noexcept { return inputs_; }
  const SensorFrame& sensors() const noexcept { return sensors_; }
  // The world model that the last tick showed, as it was published.
  const SeenEntries& seen() const noexcept { return seen_; }
  Safety& safety() noexcept { return safety_; }
  const Safety& safety() const noexcept { return safety_; }
  EngineExchange& exchange() noexcept { return exchange_; }

 private:
  const ActuationFrame& drive(std::int64_t time_ns, double dt_s) noexcept;
  void heed_stop() noexcept;
  void tell_drives() noexcept;
  void publish(std::int64_t time_ns) noexcept;
  void pass_own_state(StateBytes& bytes) noexcept;
  void declare_signals(Catalog& catalog);

  Plant& plant_;
  Estimator& estimator_;
  Safety& safety_;
  ControlSets& sets_;
  EngineExchange& exchange_;
  CommandInbox inbox_;
  FaultState fault_state_;
  const Catalog& catalog_;
  const SignalTable& signals_;
  RecordSink* sink_ = nullptr;

  std::uint64_t tick_ = 0;
  bool stopped_ = false;  // by the emergency stop, in the last tick
  TickInputs inputs_;
  SensorFrame sensors_;
  SeenEntries seen_;
  Snapshot snapshot_;         // joints and status are estimated in place
  ActuationFrame actuation_;  // computed in the last tick, written in this one
  ActuationFrame written_;    // in this tick: what is wanted of the joints
  ActuationFrame motors_;     // what went to the plant instead, when there are actuator-level objects
  std::vector<double> row_;
  Rehearsal rehearsal_;
};

}  // namespace kadans
