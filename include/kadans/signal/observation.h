// What perception, a message or a record tells of one thing, on its way to the world model.
#pragma once

#include <array>
#include <cstdint>

#include "kadans/signal/sight.h"

namespace kadans {

struct Observation {
  std::uint32_t entry = 0;   // in the order of Catalog::seen
  std::int64_t time_ns = 0;  // when it was so, on the engine's clock
  double confidence = 1;     // 0..1
  // In the order of SeenInfo::fields; a place in the heading frame of that time.
  std::array<double, max_seen_fields> fields{};
  SeenSource source = SeenSource::none;
};

// Who takes observations. Supervisor thread.
class ObservationSink {
 public:
  virtual ~ObservationSink() = default;
  virtual void observe(const Observation& observation) noexcept = 0;
};

}  // namespace kadans
