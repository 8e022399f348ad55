// For a behavior that is loaded to be looked at and does not play.
#pragma once

#include "kadans/engine/behavior_host.h"

namespace kadans {

class SilentLog final : public BehaviorLog {
 public:
  void transition(const Transition& /*transition*/) override {}
  void message(std::int64_t /*time_ns*/, Severity /*severity*/, const std::string& /*behavior*/,
               const std::string& /*text*/) override {}
};

}  // namespace kadans
