// What the supervisor is told to play, as people write it: "get_up, walk{distance_m=2}, kick".
//
//   text      = lane { "|" lane }          lanes play at the same time
//   lane      = item { "," item }          one after the other
//   item      = behavior [ "{" [ argument { "," argument } ] "}" ]
//   behavior  = a name, found as behaviors/<robot>/<name>.lua, or the path of a file, from the project root
//   argument  = name "=" ( number | true | false | 'text' | "text" )
//
// Whether a behavior takes the arguments is for whoever loads it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "kadans/config/problems.h"

namespace kadans {

using PlayValue = std::variant<double, bool, std::string>;

struct PlayArgument {
  std::string name;
  PlayValue value;
  TextPlace place{};
};

struct PlayItem {
  std::filesystem::path file;  // of the behavior; there when the item was read
  std::uint32_t lane = 0;
  std::vector<PlayArgument> arguments{};
  std::string source{};  // where the item was written, for messages
  TextPlace place{};
};

// Where names and paths are looked for.
struct PlayFolders {
  std::filesystem::path project_file;  // any file of the project: paths are meant from its root
  std::string robot;                   // name of the folder in behaviors/
};

// What names are found there, for hints and completion.
std::vector<std::string> playable_names(const PlayFolders& folders);

// Adds the mistakes to `problems`; `start` is where the text begins in that file. An empty text is one.
std::vector<PlayItem> read_play_items(std::string_view text, TextPlace start, const PlayFolders& folders,
                                      Problems& problems);
// Throws InputError; `source` names the text: "--play".
std::vector<PlayItem> read_play_items(std::string_view text, const std::string& source, const PlayFolders& folders);

}  // namespace kadans
