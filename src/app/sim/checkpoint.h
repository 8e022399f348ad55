// A checkpoint: a run at a tick, from which it can be continued, unchanged or in another way.
//
// The state of a run between two ticks cannot be saved exactly: neither coroutines of scripts can be taken out of a Lua
// state, nor Bullet's pairs and contact caches in the order on which its solver depends. But a run repeats bit for bit.
// So a checkpoint holds the inputs of the run, the tick, and the hash of all states until then. To continue, the
// program runs to that tick again, at full speed and without a record, compares the hash, and then goes on. At that
// point one process may split into many (run_branches.h).
//
// Of each control object a checkpoint holds the hash of its state (state_bytes.h), so that the object which came out
// another way is named, also when no signal shows it yet. The state itself is not held: to run there again is as good
// and needs no bytes from a file.
//
// The file is a record without messages: inputs as in run_inputs.h, metadata "checkpoint" and "control_objects".
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hash_trail.h"
#include "ordered_events.h"
#include "telemetry/record/run_inputs.h"

namespace kadans {

class Assembly;

struct Checkpoint {
  RunInputs inputs;
  RunMark at;
  std::vector<HashMark> trail;  // hashes on the way to the tick
  TextMap objects{};            // hash of the state of each control object, by its name; empty: the file has none
};

inline constexpr double checkpoint_trail_s = 0.1;

// Throws InputError when the file cannot be written.
void write_checkpoint(const Checkpoint& checkpoint, const std::string& file);
// Throws InputError when the file is no checkpoint or is damaged.
Checkpoint read_checkpoint(const std::string& file);

// Between two ticks: the hash of the state of each control object, of further robots as ROBOT.OBJECT.
TextMap object_states(Assembly& assembly);
// The names of the objects in `now` whose state is another one in the checkpoint, "posture, gaze"; "" when there are
// none, or when the checkpoint holds no states.
std::string differing_objects(const TextMap& checkpoint, const TextMap& now);

// A checkpoint to be written: "2.5=crouched.mcap". parse_checkpoint throws InputError.
struct PlannedCheckpoint {
  double at_s = 0;
  std::string file;
};
PlannedCheckpoint parse_checkpoint(const std::string& text);

// Writes checkpoints while a run goes.
class CheckpointWriter final : public RunObserver {
 public:
  CheckpointWriter(RunInputs inputs, std::vector<PlannedCheckpoint> planned, Assembly& assembly,
                   const OrderedEvents& ordered)
      : inputs_(std::move(inputs)), planned_(std::move(planned)), assembly_(assembly), ordered_(ordered) {}
  void between_ticks(const RunMark& mark) override;

  const std::vector<PlannedCheckpoint>& missed() const noexcept { return planned_; }  // the run ended before them

 private:
  RunInputs inputs_;
  std::vector<PlannedCheckpoint> planned_;
  Assembly& assembly_;
  const OrderedEvents& ordered_;
  HashTrail trail_{checkpoint_trail_s};
};

}  // namespace kadans
