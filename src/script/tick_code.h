// Marks the functions that every tick runs, so that the linker places them together. They then fill a few pages,
// instead of one or two cache lines of many pages, and WarmUp can read them in one go.
#pragma once

#include <cstddef>
#include <span>

#define KADANS_TICK_CODE [[gnu::section("kadans_tick")]]

namespace kadans {

// The machine code of all marked functions.
std::span<const std::byte> tick_code() noexcept;

}  // namespace kadans
