#include "signals.h"

#include <string>

#include "signal/status_fields.h"

namespace kadans {

void declare_signals(SignalTable& table, const RobotModel& model, const EstimateSettings& settings,
                     const Snapshot& snapshot) {
  using enum StatusField::Part;
  for (std::size_t i = 0; i < model.joints.size(); ++i)
    declare_part(table, joint, "joint." + model.joints[i].name, snapshot, i);
  declare_part(table, base, "base", snapshot);
  declare_part(table, rate, "base", snapshot);
  for (std::size_t i = 0; i < settings.feet.size(); ++i)
    declare_part(table, foot, "foot." + settings.feet[i].link, snapshot, i);
  declare_part(table, support, "support", snapshot);
  for (std::size_t i = 0; i < settings.channels.size(); ++i) {
    const SensorChannel& channel = settings.channels[i];
    table.add({"sensor." + channel.name, channel.unit, channel.doc}, &snapshot.status.channels[i]);
  }
}

}  // namespace kadans
