// What a control tick took from outside, beside its sensors and the commands: together they decide all that it
// computes. The engine keeps them for whoever records the tick; nothing else reads them.
#pragma once

#include <cstdint>

#include "kadans/signal/fault.h"

namespace kadans {

struct alignas(8) TickInputs {
  double dt_s = 0;
  std::int64_t heartbeat_ns = 0;  // of the behavior engine, as it was found
  std::uint32_t missed = 0;
  std::uint32_t commands = 0;  // that waited in the queue, headers included
  std::uint32_t stop = 0;      // StopHeard
  std::uint32_t reserved = 0;
};
static_assert(sizeof(TickInputs) == 32, "the same on 32-bit machines");

}  // namespace kadans
