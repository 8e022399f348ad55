// What happened to a behavior becomes events of its chart: refused transactions and faults (chart_reports.h).
#include <algorithm>

#include "behavior_parts.h"
#include "engine/refusal_text.h"

namespace kadans {
namespace {

// [-0 +0] Makes the table at the top of the stack, which is popped, the data of an event.
void post(lua_State* state, Behavior::Parts& parts, EventId event) {
  const std::int8_t place = parts.runner->events().free_place();
  if (parts.runner->post(event, place)) {
    lua_rawgeti(state, LUA_REGISTRYINDEX, parts.tables.event_data);
    lua_pushvalue(state, -2);
    lua_rawseti(state, -2, place + 1);
    lua_pop(state, 1);
  }
  lua_pop(state, 1);
}

const char* word(RefusalReason reason) noexcept {
  constexpr const char* words[] = {"none",    "malformed",  "unknown",    "out_of_range", "motion",
                                   "too_old", "robot_held", "joint_held", "armed_full"};  // as RefusalReason
  return words[static_cast<std::size_t>(reason)];
}

void post_refusal(lua_State* state, Behavior::Parts& parts, const char* reason, const char* what) {
  lua_createtable(state, 0, 2);
  lua_pushstring(state, reason);
  lua_setfield(state, -2, "reason");
  lua_pushstring(state, what);
  lua_setfield(state, -2, "what");
  post(state, parts, parts.chart.refused_event);
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
    post_refusal(state, parts, word(reports.refused[i].reason), text.data());
  }
}

void post_fault(lua_State* state, Behavior::Parts& parts, const NewFault& fault, EventId event) {
  const auto& joints = parts.catalog.model->joints;
  lua_createtable(state, 0, 3);
  if (fault.joint < joints.size()) {
    lua_pushstring(state, joints[fault.joint].name.c_str());
    lua_setfield(state, -2, "joint");
  }
  lua_pushnumber(state, fault.value);
  lua_setfield(state, -2, "value");
  lua_pushnumber(state, fault.limit);
  lua_setfield(state, -2, "limit");
  post(state, parts, event);
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
