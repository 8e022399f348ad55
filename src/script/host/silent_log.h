// A log that drops everything, for a behavior that is only loaded to be inspected.
#pragma once

#include "engine/behavior_host.h"

namespace kadans {

class SilentLog final : public BehaviorLog {
 public:
  void transition(const Transition& /*transition*/) override {}
  void message(std::int64_t /*time_ns*/, Severity /*severity*/, const std::string& /*behavior*/,
               const std::string& /*text*/) override {}
};

}  // namespace kadans
