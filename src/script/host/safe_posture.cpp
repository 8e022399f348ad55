#include "safe_posture.h"

#include <cmath>
#include <vector>

#include "script/check/hint.h"
#include "signal/byte_order.h"
#include "signal/input_file.h"

namespace kadans {

SafePosture::SafePosture(Settings settings, const Catalog& catalog)
    : settings_(std::move(settings)), catalog_(catalog) {
  std::vector<std::string> names;
  for (const PoseInfo& pose : catalog.poses) {
    names.push_back(pose.name);
    if (pose.name == settings_.pose) pose_ = &pose;
  }
  if (pose_ != nullptr || settings_.pose.empty()) return;
  refuse("unknown pose '" + settings_.pose + "' in 'safe'" + hint_text(settings_.pose, names));
}

void SafePosture::failed(std::int64_t now_ns, ObjectMask objects) noexcept {
  if (pose_ == nullptr) return;
  concerned_ |= objects;
  waiting_ = true;
  due_ns_ = now_ns + std::llround(settings_.after_s * 1e9);
}

void SafePosture::keep(ByteWriter& bytes) const {
  bytes.put(concerned_);
  bytes.put<std::uint8_t>(waiting_);
  bytes.put<std::uint8_t>(moved_);
  bytes.put(due_ns_);
}

void SafePosture::restore(ByteReader& bytes) noexcept {
  concerned_ = bytes.take<ObjectMask>();
  waiting_ = bytes.take<std::uint8_t>() != 0 && pose_ != nullptr;
  moved_ = bytes.take<std::uint8_t>() != 0;
  due_ns_ = bytes.take<std::int64_t>();
}

void SafePosture::move(const Snapshot& snapshot, CommandSender& commands, ObjectMask kept) noexcept {
  commands.begin(snapshot.time_ns);
  for (std::uint32_t object = 0; object < catalog_.objects.size(); ++object) {
    const bool meant = ((concerned_ & ~kept) >> object & 1U) != 0;
    if (meant && snapshot.objects[object].active) add(object, commands);
  }
  finish(commands);
}

void SafePosture::add(std::uint32_t object, CommandSender& commands) noexcept {
  for (const SetpointId id : catalog_.objects[object].setpoints) {
    const Setpoint& setpoint = catalog_.setpoints[id];
    if (std::isfinite(setpoint.safe))  // it acts before the motions of the joints, which begin where it leaves them
      full_ = !commands.add({.kind = CommandKind::set_point, .index = id, .value = setpoint.safe}) || full_;
    if (!std::string_view(setpoint.name).ends_with(".position_rad")) continue;
    for (const auto& [joint, position_rad] : pose_->position_rad) {
      if (joint != setpoint.joint || !(position_rad >= setpoint.min && position_rad <= setpoint.max)) continue;
      any_ = true;
      full_ =
          !commands.add(
              {.kind = CommandKind::set_point, .index = id, .value = position_rad, .duration_s = settings_.time_s}) ||
          full_;
    }
  }
}

void SafePosture::finish(CommandSender& commands) noexcept {
  const bool sent = commands.commit() != 0 && !full_;
  waiting_ = any_ && !sent;
  moved_ = moved_ || (any_ && sent);
  full_ = any_ = false;
}

}  // namespace kadans
