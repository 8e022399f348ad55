// The behaviors' side of the supervisor: it shows the supervisor what the behaviors see and what plays, carries out its
// orders between two behavior ticks, and notices when it is lost. The behaviors themselves do not notice: they go on,
// until the configuration's answer to the loss changes what plays.
//
// Behavior thread.
#pragma once

#include <cstdint>
#include <deque>

#include "config/robot/supervisor_config.h"
#include "engine/behavior_host.h"
#include "engine/behavior_log.h"
#include "script/host/script_host.h"
#include "script/process/process_host.h"
#include "supervisor_link.h"

namespace kadans {

class SupervisedHost final : public BehaviorHost {
 public:
  // What plays behaviors: this host ...
  // ... or this process; the other pointer is nullptr.
  struct Players {
    ScriptHost* host = nullptr;
    ProcessHost* process = nullptr;
  };
  // Keeps references. `played`: what gets the ticks, before `players`.
  SupervisedHost(const SupervisorConfig& config, BehaviorHost& played, const Players& players, SupervisorLink& link,
                 BehaviorLog& log);

  void before_tick(const Snapshot& snapshot) noexcept override;
  void tick(const Snapshot& snapshot, CommandSender& commands) noexcept override;
  void prepare(const Snapshot& newest) noexcept override { played_.prepare(newest); }

  // Any thread: the run ends, and somebody else decides what plays from now on.
  void leave() noexcept { link_.leaving.store(true, std::memory_order_relaxed); }

 private:
  // An order to the behaviors' process, which answers with its next tick, or later when it dies.
  struct Asked {
    std::uint32_t number = 0;
    bool of_decisions = false;
  };

  void take_orders(std::int64_t time_ns, bool leaving) noexcept;
  void carry_out(const PlayOrder& order, std::int64_t time_ns, bool of_decisions) noexcept;
  void refuse(const char* why, std::int64_t time_ns, bool of_decisions) noexcept;
  void take_replies(std::int64_t time_ns) noexcept;
  void watch(std::int64_t time_ns) noexcept;
  void answer_loss(std::int64_t time_ns) noexcept;
  void say(std::int64_t time_ns, BehaviorLog::Severity severity, const std::string& text) noexcept;

  SupervisorConfig config_;
  BehaviorHost& played_;
  Players players_;
  SupervisorLink& link_;
  BehaviorLog& log_;
  PlayReport report_;
  std::deque<Asked> asked_;
  std::uint32_t beat_ = 0;      // the last heartbeat that was seen
  std::int64_t since_ns_ = -1;  // when it was seen; -1: no tick yet
  bool lost_ = false;
  Event line_;
};

}  // namespace kadans
