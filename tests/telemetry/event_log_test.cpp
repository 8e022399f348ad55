// What one thread says and another one says again.
#include "telemetry/record/event_log.h"

#include <doctest/doctest.h>

using namespace kadans;

TEST_CASE("a line, an event and the active states pass an event log as what they are") {
  struct Told final : LineSink {
    std::string all;
    void tell(const Line& line) override { all += "line " + std::string(line.text) + "; "; }
    void tell_emitted(const EmittedEvent& event) override {
      all += "event " + event.event + " " + event.data + " of " + event.who + " in tick " + std::to_string(event.tick) +
             (event.ordered ? " ordered" : "") + "; ";
    }
    void tell_active(const ActiveStates& active) override {
      for (const std::string_view state : active.states) all += "in " + std::string(state) + "; ";
    }
  } told;
  EventLog passed;
  BehaviorLog from({&passed}), to({&told});
  from.message(5, BehaviorLog::Severity::info, "squat", "on my way");
  from.emitted({.time_ns = 6, .tick = 3, .event = "ball_seen", .data = "{\"x_m\":1}", .who = "ctl", .ordered = true});
  const std::string_view states[] = {"act.arm", "act.leg"};
  from.active({7, "squat", states});
  Event event;
  while (passed.pop(7, event)) event.say_to(to);
  CHECK(told.all == "line on my way; event ball_seen {\"x_m\":1} of ctl in tick 3 ordered; in act.arm; in act.leg; ");
}

TEST_CASE("events from outside leave half of an event log to all else, and what does not fit is counted") {
  EventLog log;
  const EmittedEvent large{.time_ns = 1, .tick = 1, .event = "large", .data = std::string(24'000, 'x'), .who = "ctl"};
  for (int i = 0; i < 100; ++i) log.tell_emitted(large);
  const std::uint32_t dropped = log.dropped();
  CHECK(dropped >= 94);
  CHECK(dropped < 98);
  const std::string said(1000, 'y');
  for (int i = 0; i < 100; ++i) log.tell({.time_ns = 1, .behavior = "squat", .text = said});
  CHECK(log.dropped() == dropped);
}
