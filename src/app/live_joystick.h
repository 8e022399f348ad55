// The joystick of a live run: a task that reads it a hundred times a second beside the engines, so that neither waits
// for it; and what is said when it is pulled out.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "kadans/engine/control_engine.h"
#include "kadans/plant/joystick/joystick_device.h"
#include "kadans/realtime/task_thread.h"
#include "kadans/telemetry/event_log.h"

namespace kadans {

class LiveJoystick final : public Task {
 public:
  // `path`: of a device or a recording; "": the settings' own. Throws InputError when it cannot be read.
  LiveJoystick(const JoystickSettings& settings, const std::string& path, JoystickStorage& storage)
      : storage_(storage), source_(make_joystick(settings, path.empty() ? settings.device : path)) {}

  bool beat(const Beat& beat) override {
    storage_.publish(source_->at(beat.due_ns));
    return true;
  }

  // Supervisor: what there is to say since the last time.
  std::optional<Event> news(const Snapshot& snapshot) {
    if (snapshot.tick == 0 || snapshot.joystick.connected == connected_) return std::nullopt;
    connected_ = snapshot.joystick.connected;
    Event event;
    event.transition.time_ns = snapshot.time_ns;
    event.transition.behavior = "joystick";
    event.severity = connected_ ? BehaviorLog::Severity::info : BehaviorLog::Severity::error;
    event.text = connected_ ? "is there" : "is gone; it reads as centred until it is plugged in again";
    return event;
  }

 private:
  JoystickStorage& storage_;
  std::unique_ptr<JoystickSource> source_;
  bool connected_ = false;
};

}  // namespace kadans
