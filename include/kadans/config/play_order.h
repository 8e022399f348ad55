// What the supervisor can ask of what plays.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "kadans/config/play_item.h"

namespace kadans {

struct PlayOrder {
  enum class Kind : std::uint8_t {
    play,     // `list` follows what plays
    replace,  // what plays leaves its states, then `list` begins
    pause,    // charts do not step, motions come to rest
    resume,   // both go on
    stop,     // what plays leaves its states
    reload,   // `behavior` goes on with the text of `file`
  };
  Kind kind = Kind::play;
  std::vector<PlayItem> list{};
  PlacedName behavior{};
  std::filesystem::path file{};
};

// Who takes such orders.
class OrderTaker {
 public:
  virtual ~OrderTaker() = default;
  // Behavior thread, between ticks: takes effect with the next. Throws InputError, and nothing changes, when something
  // in it is wrong.
  virtual void order(const PlayOrder& order) = 0;
};

// The kinds as they are written in files and on the console.
inline const std::array<std::string, 6> play_order_names{"play", "replace", "pause", "resume", "stop", "reload"};

}  // namespace kadans
