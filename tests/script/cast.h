// Behaviors on a robot with the control sets "posture" (legs and arms), "gesture" (arms) and "legs".
#pragma once

#include <string>
#include <vector>

#include "kadans/signal/input_error.h"
#include "script/fixture.h"

namespace kadans::script_test {

enum Set : std::uint32_t { posture, gesture, legs };

// The robot of the fixture with a set of its legs beside that of its arms; what is called is in behaviors/lib.
struct Cast : Theatre {
  Cast() { robot.add_legs(); }
  void write(const std::string& name, const std::string& text) {
    scripts.write("behaviors/" + name + ".lua", "local k = require 'kadans'\n" + text);
  }
  // Plays these, each in a lane of its own.
  void play(const std::vector<std::string>& names) {
    ScriptHost::Settings settings;
    for (const PlayItem& item : list(names)) {
      settings.play.push_back(item);
      settings.play.back().lane = static_cast<std::uint32_t>(settings.play.size() - 1);
    }
    open(settings);
  }
  std::string refusal(const std::vector<std::string>& names) {
    try {
      play(names);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  // Lets a tick pass whose transactions the control engine refuses.
  void refuse_tick(RefusalReason reason) {
    applying = false;
    tick();
    Command command;
    while (queue.try_pop(command)) {
      if (command.kind == CommandKind::transaction)
        snapshot.refusals[0] = {.sequence = command.sequence, .reason = reason};
    }
    snapshot.transactions_refused = 1;
    applying = true;
  }
  std::vector<std::uint32_t> switches() const {
    std::vector<std::uint32_t> all;
    for (const Command& command : applied) {
      if (command.kind == CommandKind::switch_set) all.push_back(command.index);
    }
    return all;
  }
};

}  // namespace kadans::script_test
