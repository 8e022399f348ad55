// A run at a tick, to go on from there: once more as it went, or otherwise.
//
// What a run holds between two ticks cannot be written down exactly: coroutines of scripts cannot be taken out of a Lua
// state, nor Bullet's pairs and contact caches in the order on which its solver depends. A run repeats bit for bit, so
// a checkpoint is what the run was made of, the tick, and the hash of all states until then. To go on is to run to the
// tick again, at full speed and without record, to see that the hash is the same, and then to go on; in between, one
// process may split into many (run_branches.h).
//
// The file is a record without messages: inputs as in run_inputs.h, metadata "checkpoint".
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hash_trail.h"
#include "kadans/telemetry/run_inputs.h"

namespace kadans {

struct Checkpoint {
  RunInputs inputs;
  RunMark at;
  std::vector<HashMark> trail;  // of the way there
};

inline constexpr double checkpoint_trail_s = 0.1;

// Throws InputError when the file cannot be written.
void write_checkpoint(const Checkpoint& checkpoint, const std::string& file);
// Throws InputError when the file is no checkpoint or is damaged.
Checkpoint read_checkpoint(const std::string& file);

// "2.5=crouched.mcap". Throws InputError that names `option`.
struct CheckpointOrder {
  double at_s = 0;
  std::string file;
};
CheckpointOrder parse_checkpoint(const std::string& text);

// Writes checkpoints while a run goes.
class CheckpointWriter final : public RunObserver {
 public:
  CheckpointWriter(RunInputs inputs, std::vector<CheckpointOrder> orders)
      : inputs_(std::move(inputs)), orders_(std::move(orders)) {}
  void tick(double, std::span<const double>) override {}
  void between_ticks(const RunMark& mark) override;

  const std::vector<CheckpointOrder>& missed() const noexcept { return orders_; }  // the run was over before

 private:
  RunInputs inputs_;
  std::vector<CheckpointOrder> orders_;
  HashTrail trail_{checkpoint_trail_s};
};

}  // namespace kadans
