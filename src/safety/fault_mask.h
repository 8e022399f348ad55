// A set of fault codes, one bit each: what a watch found in a tick.
#pragma once

#include <bit>
#include <cstdint>

#include "kadans/signal/fault.h"

namespace kadans {

using FaultMask = std::uint64_t;
static_assert(fault_codes <= 64);

constexpr FaultMask bit(FaultCode code) noexcept { return FaultMask{1} << static_cast<unsigned>(code); }
constexpr FaultMask bit_if(bool condition, FaultCode code) noexcept { return condition ? bit(code) : 0; }
// Of a mask that is not empty.
constexpr FaultCode first_of(FaultMask mask) noexcept { return static_cast<FaultCode>(std::countr_zero(mask)); }

}  // namespace kadans
