// Counts the steps of work in C and charges the budget for them, one slice at a time. When the budget is used up, the
// work is stopped in the middle. A step is about six machine instructions; tests/script/charge_count.cpp checks that.
#pragma once

#include <cstddef>

#include "script/lua/lua_core.h"

namespace kadans {

class StepMeter {
 public:
  explicit StepMeter(lua_State* state) noexcept : state_(state) {}

  // Raises when the budget is used up.
  void spend(std::size_t steps = 1) {
    left_ -= static_cast<std::ptrdiff_t>(steps);
    if (left_ < 0) [[unlikely]]
      settle();
  }
  // Charges the steps since the last charge; to be called at the end of the work. Raises when the budget is used up.
  void settle() {
    const std::ptrdiff_t spent = slice - left_;
    left_ = slice;
    core_of(state_).budget.charge(state_, static_cast<double>(spent / steps_per_instruction));
  }

  // The steps for bytes that are copied or compared in one go.
  static constexpr std::size_t of_bytes(std::size_t bytes) noexcept { return bytes / bytes_per_step + 1; }

 private:
  static constexpr std::ptrdiff_t steps_per_instruction = 8;
  static constexpr std::ptrdiff_t slice = 4096;  // about 10 us
  static constexpr std::size_t bytes_per_step = 2;
  lua_State* state_;
  std::ptrdiff_t left_ = slice;
};

}  // namespace kadans
