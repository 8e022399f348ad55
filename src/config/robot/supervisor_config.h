// The supervisor of a robot: what it knows of the world, what decides, and what happens when nothing decides any more.
// The robot's configuration has it under `supervisor`; a scenario may have another one in its place.
#pragma once

#include <string>
#include <vector>

#include "config/json/fields.h"
#include "config/scenario/play_item.h"
#include "kadans/signal/seen_info.h"

namespace kadans {

// Events whose names begin so go to other robots, and come from them.
inline constexpr const char* message_event_prefix = "robot.";

// Messages between robots.
struct MessagesConfig {
  std::string name;                // of this robot among them; "": it sends and hears nothing
  std::vector<std::string> peers;  // names of those that it hears
  std::string listen;              // "host:port" of a run; a simulation has a network of its own
  std::vector<std::string> to;     // where it sends
  std::uint32_t messages_per_minute = 240, bytes_per_minute = 60'000;
  double age_max_s = 0.5;  // how much longer than the fastest one a message may take
};

struct SupervisorConfig {
  enum class WhenLost : std::uint8_t { go_on, stop, play };

  bool given = false;               // there is a supervisor
  std::vector<PlayItem> decisions;  // one, or none
  double rate_Hz = 20;
  double lost_after_s = 0.5;  // without a tick of it; an error of the decisions counts at once
  WhenLost when_lost = WhenLost::go_on;
  std::vector<PlayItem> lost_list;  // what is played then
  std::vector<SeenInfo> seen;       // entries of the world model
  std::string perception;           // "host:port" at which a run listens for what is seen; "": nowhere
  MessagesConfig messages;
};

// `folders`: where the decisions and the behaviors are found.
void supervisor_fields(Fields& f, SupervisorConfig& config, const PlayFolders& folders);

}  // namespace kadans
