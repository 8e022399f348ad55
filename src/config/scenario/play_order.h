// An order of the supervisor to the behaviors that play.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "play_item.h"

namespace kadans {

struct PlayOrder {
  enum class Kind : std::uint8_t {
    play,     // `list` is appended to what plays
    replace,  // the playing behaviors leave their states, then `list` begins
    pause,    // charts stop stepping, motions come to rest
    resume,   // charts and motions continue
    stop,     // the playing behaviors leave their states
    reload,   // `behavior` continues with the program text of `file`
  };
  Kind kind = Kind::play;
  std::vector<PlayItem> list{};
  PlacedName behavior{};
  std::filesystem::path file{};
};

// Takes such orders.
class OrderTaker {
 public:
  virtual ~OrderTaker() = default;
  // Call on the behavior thread between ticks; the order takes effect in the next tick. Throws InputError when the
  // order is wrong; then nothing changes.
  virtual void order(const PlayOrder& order) = 0;
};

// The kinds as they are written in files and on the console.
inline const std::array<std::string, 6> play_order_names{"play", "replace", "pause", "resume", "stop", "reload"};

}  // namespace kadans
