// Marks the functions that every tick runs, so that the linker puts them side by side: they fill a few pages rather
// than a line or two of many, and WarmUp can read them in one go.
#pragma once

#include <cstddef>
#include <span>

#define KADANS_TICK_CODE [[gnu::section("kadans_tick")]]

namespace kadans {

// The machine code of all functions that are marked.
std::span<const std::byte> tick_code() noexcept;

}  // namespace kadans
