// What plays: lists of behaviors, as people write them, and the supervisor's orders.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "config/json/problems.h"

namespace kadans {

// A list of behaviors to play, as people write it for the supervisor: "get_up, walk{distance_m=2}, kick".
//
//   text      = lane { "|" lane }          lanes play at the same time
//   lane      = item { "," item }          one after the other
//   item      = behavior [ "{" [ argument { "," argument } ] "}" ]
//   behavior  = a name, found as behaviors/<robot>/<name>.lua, or the path of a file, from the project root
//   argument  = name "=" ( number | true | false | 'text' | "text" )
//
// The reader does not know a behavior's parameters: its arguments are checked when the behavior is loaded.
using PlayValue = std::variant<double, bool, std::string>;

struct PlayArgument {
  std::string name;
  PlayValue value;
  TextPlace place{};
};

struct PlayItem {
  std::filesystem::path file;  // of the behavior; it existed when the item was read
  std::uint32_t lane = 0;
  std::vector<PlayArgument> arguments{};
  std::string source{};  // where the item was written, for messages
  TextPlace place{};
};

// The folders in which names and paths are looked up.
struct PlayFolders {
  std::filesystem::path project_file;  // any file of the project; paths start at the project's root
  std::string robot;                   // name of the folder in behaviors/
};

// The names of the behaviors in these folders, for hints and completion.
std::vector<std::string> playable_names(const PlayFolders& folders);

// Adds mistakes to `problems`; an empty text is a mistake. `start` is the place in the file at which the text begins.
std::vector<PlayItem> read_play_items(std::string_view text, TextPlace start, const PlayFolders& folders,
                                      Problems& problems);
// Throws InputError. `source` names the text in messages, such as "--play".
std::vector<PlayItem> read_play_items(std::string_view text, const std::string& source, const PlayFolders& folders);

// An order of the supervisor to the behaviors that play.
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
