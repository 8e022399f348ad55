// What a process of its own plays, as its server asks it (behavior_server.h): behaviors, or the decisions over them.
// The thread of that process.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "behavior_link.h"
#include "engine/transaction.h"
#include "script/behavior/behavior.h"
#include "script/host/behavior_tables.h"
#include "script/host/play_list.h"
#include "script/host/play_report.h"
#include "script/host/script_host.h"

namespace kadans {

class ServedHost : public OrderTaker {
 public:
  // Those of which it reports the status.
  virtual std::size_t size() const noexcept = 0;
  virtual const Behavior& behavior(std::size_t index) const noexcept = 0;
  virtual const PlayStatus& status() const noexcept = 0;

  // Before the orders of a tick.
  virtual void begin_tick(const Snapshot& /*snapshot*/) noexcept {}
  // `plays`: of decisions, what plays now.
  virtual void tick(const Snapshot& snapshot, const PlayReport& plays, CommandSender& commands) noexcept = 0;
  // After the first tick: why it could not continue from the kept bytes; "" when it could.
  virtual const std::string& lost() const noexcept = 0;
  // Throws InputError.
  virtual BehaviorReply reply(const BehaviorQuestion& question, const Snapshot& snapshot) = 0;
  // Writes what the next process goes on with. Returns "", or why it is impossible.
  virtual std::string keep(ByteWriter& bytes, std::int64_t time_ns) = 0;
  // Of behaviors: what plays after the tick. Of decisions: what they decided in it, as bytes.
  virtual void report(PlayReport& /*plays*/) const noexcept {}
  virtual std::span<const std::byte> decided() const noexcept { return {}; }
  // Of decisions whose run is recorded: what they took in it, and before.
  virtual std::span<const std::byte> told() noexcept { return {}; }
};

// Behaviors.
class ServedBehaviors final : public ServedHost {
 public:
  // `describe` is as that of ScriptHost::reply().
  ServedBehaviors(ScriptHost& host, ScriptHost::Describe describe) noexcept : host_(host), describe_(describe) {}

  void order(const PlayOrder& order) override { host_.order(order); }
  std::size_t size() const noexcept override { return host_.size(); }
  const Behavior& behavior(std::size_t index) const noexcept override { return host_.behavior(index); }
  const PlayStatus& status() const noexcept override { return host_.status(); }
  void tick(const Snapshot& snapshot, const PlayReport& /*plays*/, CommandSender& commands) noexcept override {
    host_.tick(snapshot, commands);
  }
  const std::string& lost() const noexcept override { return host_.lost(); }
  BehaviorReply reply(const BehaviorQuestion& question, const Snapshot& snapshot) override {
    return host_.reply(question, snapshot, describe_);
  }
  std::string keep(ByteWriter& bytes, std::int64_t time_ns) override { return host_.keep(bytes, time_ns); }
  void report(PlayReport& plays) const noexcept override { host_.report(plays); }

 private:
  ScriptHost& host_;
  ScriptHost::Describe describe_;
};

}  // namespace kadans
