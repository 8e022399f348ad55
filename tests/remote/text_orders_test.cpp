// Orders as texts that come from anybody, and their answers.
#include "remote/ros2/text_orders.h"

#include <string>

#include <doctest/doctest.h>

#include "remote/live_instance.h"

namespace text_orders_test {

using namespace kadans;
using namespace kadans::remote_test;
using kadans::remote_test::Json;

namespace {

bool tells(const Json& answer, const std::string& part) {
  return answer["text"].get<std::string>().find(part) != std::string::npos;
}

struct Desk {
  LiveInstance live;
  LivePace pace;
  TextOrders commands;

  explicit Desk(bool allowed = true)
      : commands({.instance = live.instance,
                  .port = live.instance.open_port(),
                  .pace = &pace,
                  .allowed = allowed,
                  .refusal = "not here",
                  .who = "a topic"}) {}

  Json now(const std::string& text) {
    const auto answer = commands.take(text);
    return answer ? Json::parse(*answer) : Json();
  }
  // Of an order that is on its way; the behavior thread's tick is played here.
  Json later(const std::string& text) {
    CHECK_FALSE(commands.take(text).has_value());
    for (std::int64_t tick = 1; tick < 10; ++tick) {
      live.robot.script.at(tick * 10'000'000);
      live.robot.behaviors.tick(tick * 10'000'000);
      if (const auto answer = commands.next()) return Json::parse(*answer);
    }
    return {};
  }
};

}  // namespace

TEST_CASE("an order as a text is carried out and answered under its own id") {
  Desk desk;
  const Json paused = desk.later(R"({"id": 7, "verb": "pause"})");
  CHECK(paused == Json{{"id", 7}, {"verb", "pause"}, {"done", true}, {"text", "pause"}});
  const Json unknown = desk.later(R"({"id": "a", "verb": "play", "text": "wiat"})");
  CHECK(unknown["id"] == "a");
  CHECK(unknown["done"] == false);
  CHECK(unknown["text"].get<std::string>().find("did you mean 'wait'") != std::string::npos);
}

TEST_CASE("a text emits an event into what plays, and is told in a sentence why it is refused") {
  Desk desk;
  desk.live.project.write("behaviors/bench/listen.lua", R"(local k = require 'kadans'
k.events { seen = { distance_m = { 'm', min = 0, max = 5 } } }
return k.behavior 'listen' { initial = 'a', k.state 'a' { { on = 'seen', to = 'b' } }, k.state 'b' { endless = true } })");
  CHECK(desk.later(R"({"verb": "play", "text": "listen"})")["done"] == true);
  const auto emit = [&](const std::string& event) {
    return desk.later(Json{{"verb", "emit"}, {"text", event}}.dump());
  };
  CHECK(tells(emit("sen distance_m=1"), "unknown event 'sen' for what plays, did you mean 'seen'?"));
  CHECK(tells(emit("seen distance_m=9"), "'distance_m' = 9 is outside its range 0..5 m"));
  CHECK(tells(emit("seen distance_m=1,far=2"), "no field 'far'; there is distance_m: a number in m, 0..5"));
  CHECK(emit("seen {\"distance_m\": 1e999}")["done"] == false);
  CHECK(desk.live.host.behavior(0).state() == "a");
  const Json done = emit("seen {\"distance_m\": 2}");
  CHECK(done["done"] == true);
  CHECK(done["text"] == "event seen {\"distance_m\":2.0} from a topic to listen");
  CHECK(desk.live.host.behavior(0).state() == "b");
}

TEST_CASE("the pace of a simulation is set by texts too") {
  Desk desk;
  CHECK(desk.now(R"({"verb": "hold"})") == Json{{"verb", "hold"}, {"done", true}, {"text", ""}});
  CHECK(desk.pace.held);
  CHECK(desk.now(R"({"verb": "speed", "value": 2})")["done"] == true);
  CHECK(desk.pace.speed == 2);
  CHECK(desk.now(R"({"verb": "speed", "value": 1000})")["done"] == false);
  CHECK(desk.pace.speed == 2);
}

TEST_CASE("whatever comes as an order is answered, and nothing of it is done") {
  Desk desk;
  for (const std::string& rubbish :
       {std::string(), std::string("{"), std::string("[1]"), std::string("\xff\xfe"), std::string(16'000, '['),
        std::string(1'000'000, 'x'), std::string(R"({"id": 1e999, "verb": "estop"})"), std::string(R"({"text": "x"})"),
        std::string(R"({"verb": 7})"), std::string(R"({"verb": "play", "text": 7})"),
        std::string(R"({"verb": "speed", "value": "fast"})"), "{\"verb\": \"" + std::string(5000, 'v') + "\"}",
        std::string(R"x({"verb": "line", "text": "os.exit()"})x")}) {
    const Json answer = desk.now(rubbish);
    CAPTURE(rubbish.substr(0, 80));
    CHECK(answer["done"] == false);
    CHECK(answer["text"].get<std::string>().size() > 10);
    CHECK(answer.dump().size() < 1000);
  }
}

TEST_CASE("orders that nobody carries out do not pile up") {
  Desk desk;
  std::size_t on_their_way = 0, refused = 0;
  for (int i = 0; i < 1000; ++i) (desk.now(R"({"verb": "pause"})").is_null() ? on_their_way : refused) += 1;
  CHECK(on_their_way == orders_waiting_max);
  CHECK(refused == 1000 - orders_waiting_max);
}

TEST_CASE("where orders are not allowed even the emergency stop is refused, with what to do") {
  Desk desk(false);
  const Json answer = desk.now(R"({"id": 1, "verb": "estop"})");
  CHECK(answer == Json{{"id", 1}, {"verb", "estop"}, {"done", false}, {"text", "not here"}});
  desk.now(R"({"verb": "hold"})");
  CHECK_FALSE(desk.pace.held);
}

}  // namespace text_orders_test
