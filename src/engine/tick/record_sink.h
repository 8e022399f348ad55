// The seam to what keeps records. engine does not know files; telemetry implements this.
#pragma once

#include <cstdint>
#include <span>

namespace kadans {

class RecordSink {
 public:
  virtual ~RecordSink() = default;
  // Control thread, once a tick, with one value per signal in the order of the signal table. Never blocks; what does
  // not fit is dropped and counted.
  virtual void record(std::uint64_t tick, std::int64_t time_ns, std::span<const double> row) noexcept = 0;
};

}  // namespace kadans
