// Packets from the game controller, from robots to it and from mates: what is read can be written again, all else is
// refused with a sentence. An input is a byte that chooses, then packets: length, bytes.
#include <algorithm>

#include "football/game_control.h"
#include "football/team_message.h"
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

void try_team_message(football::TeamInbox& inbox, football::Bytes packet, double now_s) {
  const auto read = football::read_team_message(packet);
  require_told(read);
  if (read.value) require(football::write_team_message(*read.value).value.has_value(), "it can be sent again");
  if (!inbox.accept(packet, now_s).empty()) return;
  require(inbox.mate(read.value->player, now_s) != nullptr, "a mate that was heard of is there");
  const auto ball = inbox.ball(now_s);
  if (ball) require(finite(ball->at) && ball->sd_m > 0, "the ball is somewhere");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::FuzzInput input(data, size);
  const std::uint8_t choice = input.byte();
  football::TeamInbox inbox(
      {.team = 12, .player = 1, .field = league_field(football::Division::middle, football::FieldSize::middle)});
  for (double now_s = 0; !input.empty(); now_s += 0.7) {
    const std::size_t length = input.length();
    const football::Bytes packet = fuzz::bytes_in(input.take(length));
    switch (choice % 4) {
      case 0:
        try_control(packet, football::ControlReader::player);
        break;
      case 1:
        try_control(packet, football::ControlReader::monitor);
        break;
      case 2:
        try_return(packet);
        break;
      default:
        try_team_message(inbox, packet, now_s);
        break;
    }
  }
  return 0;
}
