// A k.decisions that runs: a chart as behaviors are, one level up. It sees what behaviors see, the world model and what
// plays; what it asks for is orders to what plays. It has no control objects, and sends no commands.
//
// Supervisor thread.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engine/behavior_log.h"
#include "engine/transaction.h"
#include "kadans/control/catalog.h"
#include "script/behavior/behavior.h"
#include "script/host/play_report.h"

namespace kadans {

class Decisions {
 public:
  // Loads the file. Throws InputError, also when it is no k.decisions.
  Decisions(Behavior::Settings settings, const Catalog& catalog, BehaviorLog& log);

  // `snapshot` with the world model as it is now. An error that ends it is logged.
  void tick(const Snapshot& snapshot, const PlayReport& report) noexcept;

  // What the last tick asked for, in order: for what plays, and for other robots.
  std::vector<PlayOrder>& orders() noexcept { return orders_; }
  std::vector<PlayedEvent>& messages() noexcept { return messages_; }
  // Orders that went on their way, by their number so far: the end of what they play is an event.
  void sent(std::uint32_t orders) noexcept { sent_ = orders; }
  // An order could not go on its way.
  void refuse(const std::string& why) noexcept;
  // An event of another robot. "", or why it is refused: nobody declares it, or its data is another.
  std::string hear(PlayedEvent event);

  // Reads the files again; the running version goes on when the new one is wrong. After an error it begins anew.
  void reload(const Snapshot& snapshot) noexcept;

  bool failed() const noexcept { return behavior_->failed(); }
  Behavior& behavior() noexcept { return *behavior_; }
  const Behavior& behavior() const noexcept { return *behavior_; }

 private:
  std::unique_ptr<Behavior> load() const;
  void hear(const PlayReport& report) noexcept;
  void tell(const char* event, const std::string& why = "") noexcept;

  Behavior::Settings settings_;
  const Catalog& catalog_;
  BehaviorLog& log_;
  CommandQueue nowhere_;  // decisions send no commands
  CommandSender silence_{nowhere_};
  std::unique_ptr<Behavior> behavior_;
  std::vector<PlayOrder> orders_;
  std::vector<PlayedEvent> messages_;
  std::uint32_t sent_ = 0, refused_ = 0, not_done_ = 0, taken_over_ = 0;  // as the report had them
  bool asked_ = false;  // something was played whose end was not told yet
};

}  // namespace kadans
