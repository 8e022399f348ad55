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

// An event from outside the chart that takes it. Whether its data is right is checked by the declaration of each
// behavior that takes it (k.events).
struct PlayedEvent {
  std::string name;                  // words of letters, digits and '_', separated by dots
  std::vector<PlayArgument> data{};  // its fields, each name once
  std::string who{};                 // who sent it: "scenario", "uid 1000 (develop)", "joystick.button_1"
  bool ordered = false;              // given while the run went on: only the record knows of it
  bool of_input = false;             // a button or a sensor sent it
  TextPlace place{};                 // of the name
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

// Reads `name=value,name=value`, arguments as in an item, at most count_max. Throws InputError.
std::vector<PlayArgument> read_play_arguments(std::string_view text, std::size_t count_max, const std::string& source);

// An order of the supervisor to the behaviors that play.
struct PlayOrder {
  enum class Kind : std::uint8_t {
    play,     // `list` is appended to what plays
    replace,  // the playing behaviors leave their states, then `list` begins
    pause,    // charts stop stepping, motions come to rest
    resume,   // charts and motions continue
    stop,     // the playing behaviors leave their states
    reload,   // `behavior` continues with the program text of `file`
    emit,     // `event` goes to what plays and declares it; to `behavior` alone when that is named
  };
  Kind kind = Kind::play;
  std::vector<PlayItem> list{};
  PlacedName behavior{};
  std::filesystem::path file{};
  PlayedEvent event{};
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
inline const std::array<std::string, 7> play_order_names{"play", "replace", "pause", "resume",
                                                         "stop", "reload",  "emit"};

}  // namespace kadans
