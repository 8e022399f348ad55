// The joystick of a live run. A task reads it a hundred times a second, so the engines never wait for it. It also
// reports when the joystick is unplugged.
#pragma once

#include <memory>
#include <string>

#include "engine/behavior_log.h"
#include "engine/tick/control_engine.h"
#include "plant/joystick/joystick_device.h"
#include "realtime/task_thread.h"

namespace kadans {

class JoystickTask final : public Task {
 public:
  // `path` is a device or a recording; "": the one in the settings. Throws InputError when it cannot be read.
  JoystickTask(const JoystickSettings& settings, const std::string& path, JoystickStorage& storage)
      : storage_(storage), source_(make_joystick(settings, path.empty() ? settings.device : path)) {}

  bool beat(const Beat& beat) override {
    storage_.publish(source_->at(beat.due_ns));
    return true;
  }

  // Supervisor: says that the joystick was plugged in or unplugged since the last call.
  void tell_news(const Snapshot& snapshot, BehaviorLog& log) {
    if (snapshot.tick == 0 || snapshot.joystick.connected == connected_) return;
    connected_ = snapshot.joystick.connected;
    log.message(snapshot.time_ns, connected_ ? BehaviorLog::Severity::info : BehaviorLog::Severity::error, "joystick",
                connected_ ? "is there" : "is gone; it reads as centred until it is plugged in again");
  }

 private:
  JoystickStorage& storage_;
  std::unique_ptr<JoystickSource> source_;
  bool connected_ = false;
};

}  // namespace kadans
