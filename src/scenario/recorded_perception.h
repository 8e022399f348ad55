// Perception of an entry of the world model from a recorded run: what was observed there comes again, at the same time
// of the run and as old. The robot of this run may be elsewhere: it sees the thing from where it is, as that robot did.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "config/scenario/scenario_config.h"
#include "kadans/signal/observation.h"
#include "kadans/signal/seen_info.h"

namespace kadans {

class RecordedPerception {
 public:
  // Throws InputError: there is no such entry, the file cannot be read, or it does not tell of this entry and all of
  // its fields. `file` names the scenario in messages.
  RecordedPerception(const ScenarioPerception& settings, const std::vector<SeenInfo>& seen, const std::string& file);

  // To be called each tick: hands on what has come.
  void look(std::int64_t time_ns, ObservationSink& sink) noexcept;

 private:
  struct Coming {
    std::int64_t at_ns = 0;
    Observation observation;
  };
  std::vector<Coming> coming_;  // by time
  std::size_t next_ = 0;
};

}  // namespace kadans
