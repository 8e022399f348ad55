// A serial port of this machine with an emulator behind it: a pseudo-terminal, and a link to it where one is wanted.
// The baud rate is the one that the other end has set its terminal to.
//
// One owner, one thread at a time. read and write do not block.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "signal/owned_descriptor.h"

namespace kadans {

class PseudoTerminal {
 public:
  // Makes a link to the terminal at `link`. Throws InputError for `option`, from which the link is.
  PseudoTerminal(const std::string& link, const char* option);
  ~PseudoTerminal();
  PseudoTerminal(PseudoTerminal&&) noexcept = default;

  int descriptor() const noexcept { return master_.number(); }  // readable when somebody sent something
  std::size_t read(std::span<std::uint8_t> into) const noexcept;
  void write(std::span<const std::uint8_t> bytes) const noexcept;
  std::uint32_t baud() const noexcept;

 private:
  std::string link_;
  OwnedDescriptor master_;
  OwnedDescriptor slave_;  // of our own: it keeps the terminal alive while nobody else has it open
};

}  // namespace kadans
