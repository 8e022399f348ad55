// Moves the robot to a pose of the configuration after a script has failed. At first the control set holds its last
// set-points; after after_s the motion begins. Objects that a still playing behavior may move are left to that
// behavior.
#pragma once

#include <cstdint>
#include <string>

#include "engine/transaction.h"
#include "kadans/control/set_partition.h"
#include "kadans/signal/status.h"

namespace kadans {

class ByteReader;
class ByteWriter;

class SafePosture {
 public:
  struct Settings {
    std::string pose;      // "": the robot keeps its last set-points
    double after_s = 0.5;  // time since the failure
    double time_s = 1.5;   // duration of the motion
  };
  // Throws InputError on an unknown pose. `catalog` must outlive it.
  SafePosture(Settings settings, const Catalog& catalog);

  // Behavior thread. To be called when a behavior failed that may have moved these objects.
  void failed(std::int64_t now_ns, ObjectMask objects) noexcept;
  bool due(std::int64_t now_ns) const noexcept { return waiting_ && now_ns >= due_ns_; }
  // Sends the motion for those of the objects that are active and not in `kept`. When the queue is full, due() stays
  // true for another try in the next tick.
  void move(const Snapshot& snapshot, CommandSender& commands, ObjectMask kept) noexcept;
  // forget: the failed behaviors are back. keep and restore: the state as bytes, for another process that continues.
  void forget() noexcept { waiting_ = false, concerned_ = 0; }
  void keep(ByteWriter& bytes) const;
  void restore(ByteReader& bytes) noexcept;
  bool moved() const noexcept { return moved_; }

 private:
  void add(std::uint32_t object, CommandSender& commands) noexcept;
  void finish(CommandSender& commands) noexcept;

  Settings settings_;
  const Catalog& catalog_;
  const PoseInfo* pose_ = nullptr;
  ObjectMask concerned_ = 0;
  bool waiting_ = false, moved_ = false, full_ = false, any_ = false;
  std::int64_t due_ns_ = 0;
};

}  // namespace kadans
