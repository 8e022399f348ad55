// Packets from the game controller and from robots to it: what is read can be written again, all else is refused with a
// sentence. An input is a byte that chooses, then packets: length, bytes.
#include <algorithm>

#include "football/game_control.h"
#include "fuzz_input.h"

namespace {

using namespace kadans;
using fuzz::require;

template <typename T>
void require_told(const football::Checked<T>& read) {
  require(read.value.has_value() == read.refusal.empty(), "a packet is read, or refused with a sentence");
}

void try_control(football::Bytes packet, football::ControlReader reader) {
  const auto read = football::read_game_control(packet, reader);
  require_told(read);
  if (read.value)
    require(std::ranges::equal(football::write_game_control(*read.value, reader), packet), "it is written as it was");
}

void try_return(football::Bytes packet) {
  const auto read = football::read_robot_return(packet);
  require_told(read);
  if (read.value) require(finite(read.value->pose) && finite(read.value->ball), "numbers are finite");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::FuzzInput input(data, size);
  const std::uint8_t choice = input.byte();
  while (!input.empty()) {
    const std::size_t length = input.length();
    const football::Bytes packet = fuzz::bytes_in(input.take(length));
    switch (choice % 3) {
      case 0:
        try_control(packet, football::ControlReader::player);
        break;
      case 1:
        try_control(packet, football::ControlReader::monitor);
        break;
      default:
        try_return(packet);
        break;
    }
  }
  return 0;
}
