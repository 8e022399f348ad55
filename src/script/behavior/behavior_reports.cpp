// What happened to a behavior becomes events of its chart: refused transactions and faults (chart.h).
#include <algorithm>

#include "behavior_parts.h"
#include "engine/refusal_text.h"

namespace kadans {
namespace {

void post_refusal(lua_State* state, Behavior::Parts& parts, const char* reason, const char* what) {
  lua_createtable(state, 0, 2);
  set_field(state, "reason", reason);
  set_field(state, "what", what);
  parts.runner->post_with_data(state, parts.chart.refused_event);
}

void post_refusals(lua_State* state, Behavior::Parts& parts) {
  Behavior::Parts::Reports& reports = parts.reports;
  const std::uint32_t count = std::exchange(reports.refused_count, 0);
  const bool queue_full = std::exchange(reports.queue_full, false);
  if (!parts.runner->waits_for(parts.chart.refused_event)) return;
  if (queue_full) post_refusal(state, parts, "queue_full", "the commands of a tick found no place in the queue");
  for (std::uint32_t i = 0; i < count; ++i) {
    std::array<char, 256> text{};
    copy_refusal_text(reports.refused[i], parts.catalog, text);
    post_refusal(state, parts, refusal_word(reports.refused[i].reason), text.data());
  }
}

void post_fault(lua_State* state, Behavior::Parts& parts, const NewFault& fault, EventId event) {
  const auto& joints = parts.catalog.model->joints;
  lua_createtable(state, 0, 3);
  if (fault.joint < joints.size()) set_field(state, "joint", joints[fault.joint].name.c_str());
  set_field(state, "value", fault.value);
  set_field(state, "limit", fault.limit);
  parts.runner->post_with_data(state, event);
}

// Those since the last tick, as far as the snapshot shows them. In the first tick nobody waits yet.
void post_faults(lua_State* state, Behavior::Parts& parts) {
  const SafetyStatus& safety = parts.bindings.snapshot->status.safety;
  std::uint64_t& seen = parts.reports.faults_seen;
  if (safety.faults_raised < seen) seen = 0;  // another control engine
  seen = std::max(seen, safety.faults_raised - std::min<std::uint64_t>(safety.faults_raised, new_faults_shown));
  for (; seen < safety.faults_raised; ++seen) {
    const NewFault& fault = safety.new_faults[seen % new_faults_shown];
    for (const auto& [code, event] : parts.chart.fault_events) {
      if (code == fault.code && parts.runner->waits_for(event)) post_fault(state, parts, fault, event);
    }
  }
}

}  // namespace

void post_reports(lua_State* state, Behavior::Parts& parts) {
  if (parts.chart.refused_event != no_event) post_refusals(state, parts);
  if (!parts.chart.fault_events.empty()) post_faults(state, parts);
}

}  // namespace kadans
