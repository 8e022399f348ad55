// Clients that leave before they are answered, or ask for much at once: what of it counts.
#include <atomic>
#include <memory>
#include <vector>

#include <doctest/doctest.h>

#include "remote/live_instance.h"

namespace ctl_leaving_test {

using namespace kadans;
using namespace kadans::remote_test;

namespace {

const char* const spare_kp = "spare.hip.kp_Nm_per_rad";

// Of a status: the behavior thread told its part.
bool is_whole(const Json& status) { return !status.contains("behaviors_error"); }

// Its behavior thread ticks, but looks at no orders until it attends.
struct InattentiveInstance {
  std::atomic<bool> attends{false};
  LiveInstance live{{.report_max_ns = 50'000'000}};

  InattentiveInstance() {
    live.robot.script.at = [this, attentive = live.robot.script.at](std::int64_t time_ns) {
      if (attends) return attentive(time_ns);
      const auto snapshot = live.robot.exchange->snapshot.read(0);
      live.host.tick(*snapshot, live.robot.behaviors.sender());
    };
  }
  // Twice: by a client that leaves at once, and by one that leaves when its order is on its way to the behavior thread.
  // A status that is answered afterwards tells that the server has seen what was before it.
  void order_and_leave(const Json& order) const {
    RawClient hasty(live.socket(Role::develop)), waiting(live.socket(Role::develop));
    REQUIRE(hasty.send(order.dump() + "\n"));
    hasty.close();
    REQUIRE(waiting.send(order.dump() + "\n"));
    CHECK_FALSE(is_whole(live.ask({{"verb", "status"}})));
    waiting.close();
    CHECK_FALSE(is_whole(live.ask({{"verb", "status"}})));
  }
};

}  // namespace

TEST_CASE("an order expires with its client: nobody carries out later what nobody waits for any more") {
  LiveInstance live({.report_max_ns = 50'000'000});
  RawClient gone(live.socket(Role::develop));  // before anybody serves
  REQUIRE(gone.send("{\"verb\":\"estop\"}\n{\"verb\":\"pause\"}\n{\"verb\":\"play\",\"list\":\"nod\"}\n"));
  gone.close();
  live.server->start();
  RawClient waits(live.socket(Role::develop)), leaves(live.socket(Role::develop));
  REQUIRE(leaves.send("{\"verb\":\"set\",\"name\":\"" + std::string(hip_kp) + "\",\"value\":77}\n"));
  REQUIRE(waits.send("{\"verb\":\"set\",\"name\":\"" + std::string(spare_kp) + "\",\"value\":66}\n"));
  leaves.close();
  const auto served = [](const Json& a) { return a["clients"]["served"] >= 2; };
  (void)live.ask_until({{"verb", "status"}}, served);
  live.start();
  CHECK(Json::parse(waits.line().value())["ok"] == true);
  CHECK(live.ask({{"verb", "get"}, {"name", hip_kp}})["value"] == 40);
  CHECK(live.ask({{"verb", "get"}, {"name", spare_kp}})["value"] == 66);
  CHECK(live.ask({{"verb", "status"}})["safety"]["faults"] == 0);
  CHECK(live.ask({{"verb", "status"}})["paused"] == false);
  CHECK(live.ask({{"verb", "status"}})["behaviors"].empty());
}

TEST_CASE("what a client asked to play does not play when the client left before the robot heard of it") {
  InattentiveInstance inattentive;
  LiveInstance& live = inattentive.live;
  live.start();
  inattentive.order_and_leave({{"verb", "play"}, {"list", "nod"}});
  inattentive.attends = true;
  CHECK(live.ask_until({{"verb", "status"}}, is_whole)["behaviors"].empty());
  CHECK(live.ask({{"verb", "play"}, {"list", "wait"}})["text"] == "play wait");
  const Json behaviors = live.ask_until({{"verb", "status"}}, is_whole)["behaviors"];
  REQUIRE(behaviors.size() == 1);
  CHECK(behaviors[0]["name"] == "wait");
}

TEST_CASE("faults stay when the client that asked to clear them left before the robot heard of it") {
  InattentiveInstance inattentive;
  LiveInstance& live = inattentive.live;
  live.start();
  CHECK(live.ask({{"verb", "estop"}})["ok"] == true);
  const auto off = [](const Json& a) { return a["safety"]["level"] == "off"; };
  REQUIRE(off(live.ask_until({{"verb", "status"}}, off)));
  inattentive.order_and_leave({{"verb", "clear_faults"}});
  inattentive.attends = true;
  CHECK(is_whole(live.ask_until({{"verb", "status"}}, is_whole)));  // so all earlier orders were looked at
  RawClient watch(live.socket(Role::read));
  REQUIRE(watch.send("{\"verb\":\"watch\",\"signals\":[\"safety.faults\"],\"rate_hz\":100}\n"));
  REQUIRE(Json::parse(watch.line().value())["ok"] == true);
  for (int i = 0; i < 10; ++i) CHECK(Json::parse(watch.line().value())["values"][0] >= 1);
  const Json status = live.ask({{"verb", "status"}})["safety"];
  CHECK(status["level"] == "off");
  CHECK(status["stopped"] == true);
  CHECK(live.ask({{"verb", "clear_faults"}})["ok"] == true);  // of a client that stays
}

TEST_CASE("an emergency stop counts although its client leaves at once, and what played does not go on after it") {
  LiveInstance live;
  live.start();
  CHECK(live.ask({{"verb", "play"}, {"list", "nod"}})["ok"] == true);
  {
    RawClient hasty(live.socket(Role::operate));
    REQUIRE(hasty.send("{\"verb\":\"estop\"}\n"));
    hasty.close();
  }
  const auto off = [](const Json& a) { return a["safety"]["level"] == "off"; };
  REQUIRE(off(live.ask_until({{"verb", "status"}}, off)));
  const auto rests = [](const Json& a) { return a["behaviors"].empty() || a["behaviors"][0]["plays"] == false; };
  CHECK(rests(live.ask_until({{"verb", "status"}}, rests)));
  CHECK(live.ask({{"verb", "clear_faults"}})["ok"] == true);
  const auto well = [](const Json& a) { return a["safety"]["level"] == "normal"; };
  CHECK(rests(live.ask_until({{"verb", "status"}}, well)));
}

TEST_CASE("an emergency stop counts whatever its client, which leaves, asked for before it and waits for") {
  InattentiveInstance inattentive;
  LiveInstance& live = inattentive.live;
  live.start();
  {
    RawClient hasty(live.socket(Role::operate));
    REQUIRE(hasty.send("{\"verb\":\"pause\"}\n{\"verb\":\"estop\"}\n{\"verb\":\"resume\"}\n"));
    CHECK(live.ask({{"verb", "faults"}})["ok"] == true);  // the server has read it all
    hasty.close();
  }
  inattentive.attends = true;
  const auto off = [](const Json& a) { return a["safety"]["level"] == "off" && is_whole(a); };
  const Json status = live.ask_until({{"verb", "status"}}, off);
  CHECK(off(status));
  CHECK(status["paused"] == false);
}

TEST_CASE("those who may only look leave room for the orders of those who may act") {
  InattentiveInstance inattentive;
  LiveInstance& live = inattentive.live;
  live.start();
  std::vector<std::unique_ptr<RawClient>> readers;
  for (int i = 0; i < 16; ++i) {
    readers.push_back(std::make_unique<RawClient>(live.socket(Role::read)));
    REQUIRE(readers.back()->send("{\"verb\":\"status\"}\n"));
  }
  RawClient acts(live.socket(Role::operate));
  REQUIRE(acts.send("{\"verb\":\"pause\"}\n"));
  CHECK(live.ask({{"verb", "faults"}})["ok"] == true);
  inattentive.attends = true;
  CHECK(Json::parse(acts.line().value())["ok"] == true);
}

}  // namespace ctl_leaving_test
