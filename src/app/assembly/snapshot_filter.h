// Changes the snapshot that the behaviors of an assembly see. Tests need this, because a robot on the ideal plant never
// falls by itself.
#pragma once

#include "engine/behavior_host.h"

namespace kadans {

class SnapshotFilter {
 public:
  virtual ~SnapshotFilter() = default;
  // Called on the behavior thread before each behavior tick.
  virtual void change(Snapshot& snapshot) noexcept = 0;
};

class FilteredHost final : public BehaviorHost {
 public:
  FilteredHost(BehaviorHost& host, SnapshotFilter& filter) noexcept : host_(host), filter_(filter) {}
  void tick(const Snapshot& snapshot, CommandSender& commands) noexcept override {
    seen_ = snapshot;
    filter_.change(seen_);
    host_.tick(seen_, commands);
  }
  void before_tick(const Snapshot& snapshot) noexcept override { host_.before_tick(snapshot); }
  void prepare(const Snapshot& newest) noexcept override { host_.prepare(newest); }

 private:
  BehaviorHost& host_;
  SnapshotFilter& filter_;
  Snapshot seen_;
};

}  // namespace kadans
