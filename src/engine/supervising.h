// The seam between lockstep and what decides what behaviors play. engine does not know it; supervisor implements this.
#pragma once

#include <cstdint>

namespace kadans {

class Supervising {
 public:
  virtual ~Supervising() = default;
  virtual std::int64_t period_ns() const noexcept = 0;
  // Supervisor thread, once a period.
  virtual void tick(std::int64_t time_ns) noexcept = 0;
};

}  // namespace kadans
