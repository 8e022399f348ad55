// What clients of a live server do to a running robot beyond what ctl's tests cover: set-points that a hand leads, and
// the description of behaviors that came later.
#include <algorithm>
#include <chrono>

#include <doctest/doctest.h>

#include "remote/live_instance.h"
#include "remote/page/live_client.h"
#include "remote/page/live_hub.h"

namespace live_order_test {

using namespace kadans;
using namespace kadans::remote_test;

namespace {

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

// Of the wall clock, for what threads on virtual time do soon.
template <typename Condition>
bool comes(Condition&& condition) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
  }
  return true;
}

Answer answer_to(InstancePort& port, Order order) {
  Answer answer;
  REQUIRE(port.send(std::move(order)) != 0);
  CHECK(comes([&] { return port.next(answer); }));
  return answer;
}

}  // namespace

TEST_CASE("set-points of one order move together, and one that is wrong moves none") {
  LiveInstance live;
  InstancePort& port = live.instance.open_port();
  live.start();
  const auto order = [](const char* text) {
    return Order{.kind = Order::Kind::set_point, .text = text, .value = 0.1, .who = "hand"};
  };
  const SetpointTable& table = live.robot.catalog.setpoints;
  REQUIRE(table.find("posture.hip.position_rad").has_value());
  CHECK(answer_to(port, order("posture.hip.position_rad=0.2,posture.knee.position_rad=0.1")).done);
  const auto reference = [&] {
    return live.ask({{"verb", "get"}, {"name", "control.posture.hip.reference_rad"}}).value("value", 0.0);
  };
  CHECK(comes([&] { return reference() > 0.19; }));
  const Answer unknown = answer_to(port, order("posture.hip.position_rad=-0.2,posture.nee.position_rad=0"));
  CHECK_FALSE(unknown.done);
  CHECK(has(unknown.text, "posture.knee.position_rad"));
  CHECK(has(answer_to(port, order("posture.hip.position_rad=1e9")).text, "outside its range"));
  CHECK(has(answer_to(port, order("posture.hip.position_rad")).text, "NAME=NUMBER"));
  CHECK_FALSE(answer_to(port, order("")).done);
  CHECK(reference() > 0.19);
}

TEST_CASE("a behavior that is played later is described to who looks") {
  LiveInstance live;
  LiveHub hub({.instance = live.instance,
               .port = live.instance.open_port(),
               .texts = {.name = "bench", .urdf = "<robot name=\"bench\"/>", .description = "{\"robot\":{}}"},
               .urdf_file = "bench.urdf",
               .timing = {}});
  live.start();
  LiveClient client(hub, 1, false, "test");
  const auto& channels = hub.channels().all();
  const auto described = std::ranges::find(channels, "/description", &LiveChannel::topic);
  REQUIRE(described != channels.end());
  const auto text = [&] {
    hub.beat();
    const auto& payload = described->messages.back().payload;
    return std::string(reinterpret_cast<const char*>(payload.data()), payload.size());
  };
  CHECK_FALSE(has(text(), "\"nod\""));
  CHECK(live.ask({{"verb", "play"}, {"list", "nod"}})["ok"] == true);
  CHECK(comes([&] { return has(text(), "\"nod\""); }));
  CHECK(has(text(), "\"robot\""));
}

}  // namespace live_order_test
