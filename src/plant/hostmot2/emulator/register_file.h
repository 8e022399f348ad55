// An emulated board's registers as a mapped file, as a PCI card's are. What the host wrote there is seen at the next
// take(), register by register in the order of their addresses; show() puts there what it reads.
//
// One owner, one thread at a time; the host may write meanwhile.
#pragma once

#include <string>
#include <vector>

#include "emulated_board.h"

namespace kadans::hostmot2 {

class RegisterFile {
 public:
  RegisterFile(EmulatedBoard& board, const std::string& path);  // makes the file; throws InputError
  ~RegisterFile();
  RegisterFile(const RegisterFile&) = delete;
  RegisterFile& operator=(const RegisterFile&) = delete;

  void take() noexcept;
  void show() noexcept;

 private:
  EmulatedBoard& board_;
  volatile std::uint32_t* registers_ = nullptr;
  std::vector<std::uint32_t> shown_;
};

}  // namespace kadans::hostmot2
