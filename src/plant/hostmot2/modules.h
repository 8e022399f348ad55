// What a board's firmware consists of, as its IDROM says: modules with their instances and addresses, and the pins.
// Nothing here is known from the board's name.
//
// Before the loop.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "board_link.h"

namespace kadans::hostmot2 {

// Every HostMot2 board has this word there.
inline constexpr std::uint16_t cookie_at = 0x100;
inline constexpr std::uint32_t cookie = 0x55AACAFE;

enum class ModuleTag : std::uint8_t { watchdog = 2, ioport = 3, encoder = 4, pwmgen = 6, led = 128 };

struct Module {
  std::uint8_t tag = 0, instances = 0, registers = 0;
  std::uint16_t base = 0, register_stride = 256, instance_stride = 4;
  std::uint32_t clock_Hz = 0;

  // Address of a register of an instance.
  std::uint16_t at(unsigned register_number, unsigned instance = 0) const noexcept {
    return static_cast<std::uint16_t>(base + register_number * register_stride + instance * instance_stride);
  }
};
std::string module_name(std::uint8_t tag);  // "encoder"; "module 26" where it is not one that is driven here

struct PinUse {
  std::uint8_t tag = 0;   // of the module that may use it; 0: none
  std::uint8_t unit = 0;  // its instance

  bool is(ModuleTag module, std::uint32_t instance) const noexcept {
    return tag == static_cast<std::uint8_t>(module) && unit == instance;
  }
};

struct Modules {
  std::string board;  // as the IDROM names it, "MESA7I96"
  std::uint32_t ports = 0, port_width = 0;
  std::uint32_t clock_low_Hz = 0, clock_high_Hz = 0;
  std::optional<Module> watchdog, ioport, encoder, pwmgen, led;
  std::vector<Module> others;  // left alone
  std::vector<PinUse> pins;

  std::size_t pin_count() const noexcept { return pins.size(); }
  std::string text() const;  // "3 ioports of 17 pins, 2 encoders, 2 pwmgens; also there: stepgen, module 26"
};

// Throws std::runtime_error with a sentence: it does not answer, is no HostMot2 board, or describes itself in a way
// that cannot be.
Modules read_modules(BoardLink& link);

}  // namespace kadans::hostmot2
