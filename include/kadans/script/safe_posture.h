// Where the robot goes when a script failed: the control set holds its last set-points, then, after a while, moves to
// a pose of the configuration. Joints that a behavior which still plays may move are left to it.
#pragma once

#include <cstdint>
#include <string>

#include "kadans/control/set_partition.h"
#include "kadans/engine/transaction.h"
#include "kadans/signal/status.h"

namespace kadans {

class ByteReader;
class ByteWriter;

class SafePosture {
 public:
  struct Settings {
    std::string pose;      // "": the robot stays as it is
    double after_s = 0.5;  // since the failure
    double time_s = 1.5;   // of the motion
  };
  // Throws InputError on an unknown pose. The catalog must outlive it.
  SafePosture(Settings settings, const Catalog& catalog);

  // Behavior thread. A behavior failed that may have moved these objects.
  void failed(std::int64_t now_ns, ObjectMask objects) noexcept;
  bool due(std::int64_t now_ns) const noexcept { return waiting_ && now_ns >= due_ns_; }
  // Sends the motion for those of them that are active and not `kept`. Tries again in the next tick when the queue is
  // full.
  void move(const Snapshot& snapshot, CommandSender& commands, ObjectMask kept) noexcept;
  // Who failed is back, or it is for another process to go on; as bytes and back.
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
