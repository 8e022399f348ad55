// A robot on its bench: its drives without a control system, tick by tick. Whoever has it lets time pass.
#pragma once

#include <cstdint>

#include "kadans/signal/frames.h"

namespace kadans {

class Bench {
 public:
  virtual ~Bench() = default;
  Bench() = default;
  Bench(const Bench&) = delete;
  Bench& operator=(const Bench&) = delete;

  virtual void read(SensorFrame& sensors) = 0;
  // What the drives are asked for from now on; a control period passes.
  virtual void write(const ActuationFrame& actuation) = 0;
  virtual std::int64_t now_ns() const noexcept = 0;  // of the clock on which keys are pressed
};

}  // namespace kadans
