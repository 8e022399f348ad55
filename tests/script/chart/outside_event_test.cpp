// Events from outside a chart: declared in k.events, brought by the host, sent by other behaviors.
#include <doctest/doctest.h>

#include "kadans/signal/input_error.h"
#include "script/fixture.h"
#include "script/host/event_delivery.h"
#include "signal/byte_order.h"

namespace outside_event_test {

using namespace kadans;
using namespace kadans::script_test;

namespace {

const std::string head = "local k = require 'kadans'\n";
const std::string events =
    "k.events { ball_seen = { 'the camera sees it', distance_m = { 'm', min = 0, max = 5 },\n"
    "left = { k.flag, optional = true }, label = { k.text, optional = true } }, whistle = {} }\n";

// Prints what it gets of these events.
std::string listener(const std::string& name) {
  return head + events + "return k.behavior '" + name + R"(' { initial = 'a', k.state 'a' {
    { on = 'ball_seen', to = 'b' }, { on = 'whistle', to = 'c' } },
    k.state 'b' { enter = function(_, s) print(s.event.name, s.event.data.distance_m, s.event.data.left, s.event.data.label) end,
      { after = 0, to = 'a' } },
    k.state 'c' { enter = function(_, s) print(s.event.name, s.event.data) end, { after = 0, to = 'a' } } })";
}

PlayOrder emit(const std::string& name, std::vector<PlayArgument> data = {}, const std::string& who = "uid 1") {
  return {.kind = PlayOrder::Kind::emit, .event = {.name = name, .data = std::move(data), .who = who, .ordered = true}};
}

std::string refusal(Theatre& theatre, const PlayOrder& order) {
  try {
    theatre.host->order(order);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

std::string lines_of(const Theatre& theatre, const std::string& behavior) {
  std::string all;
  for (const std::string& line : theatre.log.messages)
    if (line.starts_with(behavior + ": ")) all += line.substr(behavior.size() + 2) + "\n";
  return all;
}

std::uint32_t taken(const Theatre& theatre) { return theatre.host->status().events; }
std::uint32_t refused(const Theatre& theatre) { return theatre.host->status().events_refused; }

}  // namespace

TEST_CASE("an event from outside reaches what plays and declares it, with its data, in the next tick") {
  Theatre theatre({listener("one"), listener("two"), head + "return k.behavior 'deaf' { k.state 'a' {} }"}, {0, 1, 2});
  theatre.tick();
  theatre.host->order(emit("ball_seen", {{"distance_m", 1.5}, {"left", true}, {"label", std::string("orange")}}));
  CHECK(lines_of(theatre, "one").empty());
  theatre.tick();
  CHECK(lines_of(theatre, "one") == "ball_seen 1.5 true orange\n");
  CHECK(lines_of(theatre, "two") == "ball_seen 1.5 true orange\n");
  CHECK(has(lines_of(theatre, "supervisor"),
            "event ball_seen {\"distance_m\":1.5,\"left\":true,\"label\":\"orange\"} from uid 1 to one, two\n"));
  theatre.tick();
  theatre.host->order(emit("whistle"));
  theatre.tick();
  CHECK(has(lines_of(theatre, "one"), "whistle nil\n"));
  CHECK(taken(theatre) == 2);
  CHECK(refused(theatre) == 0);
}

TEST_CASE("an event from outside that nobody declares, or with wrong data, is refused with a sentence and counted") {
  Theatre theatre(
      {listener("one"), head + "return k.behavior 'inner' { initial = 'a', k.state 'a' { enter = function(m) "
                               "m:emit 'own' end, { on = 'own', to = 'b' } }, k.state 'b' {} }"},
      {0, 1});
  theatre.tick();
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
  CHECK(has(refusal(theatre, emit("bal_seen")), "unknown event 'bal_seen' for what plays, did you mean 'ball_seen'?"));
  CHECK(has(refusal(theatre, emit("own")), "'inner' does not let the event 'own' in: it lacks k.events { own = {} }"));
  CHECK(has(refusal(theatre, emit("done")), "unknown event 'done'"));
  CHECK(has(refusal(theatre, emit("ball_seen")), "field 'distance_m' is missing; distance_m: a number in m, 0..5"));
  CHECK(has(refusal(theatre, emit("ball_seen", {{"distance_m", true}})), "field 'distance_m' must be a number in m"));
  CHECK(has(refusal(theatre, emit("ball_seen", {{"distance_m", 5.5}})),
            "field 'distance_m' = 5.5 is outside its range 0..5 m"));
  CHECK(has(refusal(theatre, emit("ball_seen", {{"distance_m", nan}})), "field 'distance_m' is not finite"));
  CHECK(has(refusal(theatre, emit("ball_seen", {{"distance_m", infinite}})), "field 'distance_m' is not finite"));
  CHECK(has(refusal(theatre, emit("ball_seen", {{"distance_m", 1.0}, {"far", 2.0}})),
            "no field 'far'; there is distance_m: a number in m, 0..5; label: a text, optional; left: true or false, "
            "optional"));
  CHECK(has(refusal(theatre, emit("whistle", {{"loud", true}})), "no field 'loud'; it has no data"));
  CHECK(has(refusal(theatre, emit("ball_seen", {{"distance_m", 1.0}, {"label", std::string(257, 'x')}})),
            "field 'label' is longer than 256 bytes"));
  std::vector<PlayArgument> many;
  for (int i = 0; i < 65; ++i) many.push_back({"f" + std::to_string(i), 1.0});
  CHECK(has(refusal(theatre, emit("ball_seen", many)), "more than 64 fields"));
  theatre.tick(2);
  CHECK(lines_of(theatre, "one").empty());
  CHECK(taken(theatre) == 0);
  CHECK(refused(theatre) == 12);
}

TEST_CASE("an event from outside that only a pattern takes is taken") {
  Theatre theatre({head + "k.events { ['game.whistle'] = {} }\nreturn k.behavior 'one' { initial = 'a',\n"
                          "k.state 'a' { { on = 'game.*', to = 'b' } },\n"
                          "k.state 'b' { enter = function(_, s) print(s.event.name) end } }"});
  theatre.tick();
  theatre.host->order(emit("game.whistle"));
  theatre.tick();
  CHECK(lines_of(theatre, "one") == "game.whistle\n");
  CHECK(taken(theatre) == 1);
}

TEST_CASE("a flood of events is refused visibly: 32 wait for a tick, and the next tick takes 32 more") {
  Theatre theatre({listener("one")});
  theatre.tick();
  std::string last;
  for (int i = 0; i < 100; ++i) {
    last = refusal(theatre, emit("whistle"));
    CHECK(last.empty() == (i < 32));
  }
  CHECK(has(last, "32 events wait for the next tick already"));
  theatre.tick();
  CHECK(taken(theatre) == 32);
  CHECK(refused(theatre) == 68);
  CHECK(refusal(theatre, emit("whistle")).empty());
  theatre.tick();
  CHECK(taken(theatre) == 33);
  CHECK_FALSE(theatre.host->finished());
}

TEST_CASE(
    "the data of events in one tick is bounded: what is beyond it is refused and told, and nothing else is lost") {
  const std::string many = [] {
    std::string fields;
    for (int i = 0; i < 16; ++i) fields += "t" + std::to_string(i) + " = { k.text, optional = true }, ";
    return head + "k.events { long = { " + fields +
           "} }\nreturn k.behavior 'one' { k.state 'a' { endless = true, { on = 'long', action = function(_, s) "
           "print(#s.event.data.t0) end } } }";
  }();
  Theatre theatre({many});
  struct Record final : LineSink {
    void tell(const Line& /*line*/) override {}
    void tell_emitted(const EmittedEvent& event) override { bytes += event.data.size(); }
    std::size_t bytes = 0;
  } record;
  theatre.log.add(record);
  theatre.tick();
  std::vector<PlayArgument> data;
  for (int i = 0; i < 16; ++i) data.push_back({"t" + std::to_string(i), std::string(i < 15 ? 250 : 100, '\1')});
  for (int i = 0; i < 32; ++i)
    CHECK(refusal(theatre, emit("long", data)).empty());  // "\\u0001": 22 kB each in the record
  theatre.tick();
  const std::uint32_t fit = taken(theatre);
  CHECK(fit == EventDelivery::data_bytes_max / 23'400);
  CHECK(refused(theatre) == 32 - fit);
  CHECK(has(lines_of(theatre, "supervisor"), "'long' from uid 1 was refused: the events of this tick bring more than"));
  CHECK(lines_of(theatre, "one").size() == 4 * std::min<std::size_t>(fit, 16));
  CHECK(record.bytes <= EventDelivery::data_bytes_max);
  CHECK(refusal(theatre, emit("long", data)).empty());
  theatre.tick();
  CHECK(taken(theatre) == fit + 1);
}

TEST_CASE("an event that comes in a pause is refused, and what behaviors have sent each other waits for its end") {
  Theatre theatre(
      {listener("one"), head + events +
                            "return k.behavior 'sender' { initial = 'w', k.state 'w' { { after = 0.02, to = "
                            "'a' } }, k.state 'a' { enter = function(m) m:emit('whistle', nil, { to = "
                            "'one' }) end } }"},
      {0, 1});
  theatre.tick(3);  // the last one sends
  theatre.host->order({.kind = PlayOrder::Kind::pause});
  theatre.host->order(emit("ball_seen", {{"distance_m", 1.0}}));  // the pause has not begun yet, but will
  theatre.tick();
  CHECK(has(refusal(theatre, emit("whistle")), "the behaviors are paused"));
  CHECK(refused(theatre) == 2);
  theatre.tick(3);
  CHECK_FALSE(has(lines_of(theatre, "one"), "ball_seen"));
  theatre.host->order({.kind = PlayOrder::Kind::resume});
  theatre.tick(4);
  CHECK(has(lines_of(theatre, "one"), "whistle"));
  CHECK_FALSE(has(lines_of(theatre, "one"), "ball_seen"));
}

TEST_CASE("behaviors send each other events, which come in the next tick in the order of the list and of the calls") {
  const auto sender = [](const std::string& name, const std::string& to) {
    return head + events + "return k.behavior '" + name +
           R"(' { initial = 'a', k.state 'a' { { after = 0.02, to = 'b' } },
      k.state 'b' { enter = function(m, s) print('sends', s.time_s) m:emit('ball_seen', { distance_m = 1, label = ')" +
           name + "' }, { to = '" + to + "' }) m:emit('ball_seen', { distance_m = 2, label = '" + name +
           "' }, { to = '" + to + "' }) end } }";
  };
  const std::string hearer = head + events + R"(return k.behavior 'hearer' { k.state 'a' {
    { on = 'ball_seen', to = 'a', action = function(_, s) print(s.time_s, s.event.data.label, s.event.data.distance_m) end } } })";
  Theatre theatre({sender("one", "hearer"), hearer, sender("two", "all")}, {0, 1, 2});
  theatre.tick(5);
  CHECK(lines_of(theatre, "one").starts_with("sends 0.02\n"));
  CHECK(lines_of(theatre, "hearer") == "0.03 one 1\n0.03 one 2\n0.03 two 1\n0.03 two 2\n");
  CHECK(taken(theatre) == 4);
}

TEST_CASE("an event to others does not come back to its sender, and one that finds nobody is counted and told once") {
  Theatre theatre({head + events + R"(return k.behavior 'alone' { k.state 'a' { during = function(m)
      m:emit('whistle', nil, { to = 'all' }) m:emit('whistle', nil, { to = 'nobody' }) end,
      { on = 'whistle', to = 'b' } }, k.state 'b' {}, initial = 'a' })"});
  theatre.tick(5);
  CHECK(theatre.host->behavior(0).state() == "a");
  CHECK(refused(theatre) == 8);
  CHECK(lines_of(theatre, "alone") ==
        "event 'whistle' to 'all' was refused: no other behavior that plays declares it (told once)\n"
        "event 'whistle' to 'nobody' was refused: nobody of that name plays and declares it (told once)\n");
}

TEST_CASE("a caller and what it calls are one chart: each takes the other's events in the same tick") {
  Theatre theatre;
  theatre.scripts.write("behaviors/lib/inner.lua", head + R"(return k.behavior 'inner' { initial = 'i',
    k.state 'i' { enter = function(m) m:emit 'up' end, { on = 'down', to = 'j' } }, k.state 'j' { endless = true } })");
  theatre.scripts.write("behaviors/outer.lua", head + R"(return k.behavior 'outer' { k.parallel 'p' {
    k.region 'l' { initial = 'call', k.state 'call' { k.call 'inner' } },
    k.region 'r' { initial = 'a', k.state 'a' { { on = 'up', to = 'b' } },
      k.state 'b' { enter = function(m) m:emit 'down' end, endless = true } } } })");
  theatre.open({.play = theatre.list({"outer"})});
  theatre.tick();
  CHECK(theatre.log.transitions.back() == "p.l.call.inner.i>p.l.call.inner.j:down");
  CHECK(theatre.log.transitions.size() == 2);  // up, down
}

TEST_CASE("m:emit of a declared event raises on wrong data, with the line and a hint") {
  struct Case {
    std::string call, message;
  };
  for (const Case& one : std::vector<Case>{
           {"m:emit('ball_seen', { distnce_m = 1 })",
            "event 'ball_seen' has no key 'distnce_m', did you mean 'distance_m'?"},
           {"m:emit('ball_seen')", "event 'ball_seen': field 'distance_m' is missing: a number in m"},
           {"m:emit('ball_seen', { distance_m = 'near' })",
            "event 'ball_seen': field 'distance_m' must be a number in m, not a string"},
           {"m:emit('ball_seen', { distance_m = 9 })",
            "event 'ball_seen': field 'distance_m' = 9 is outside its range"},
           {"m:emit('ball_seen', { distance_m = 0 / 0 })", "event 'ball_seen': field 'distance_m' is not finite"},
           {"m:emit('ball_seen', { distance_m = 1, left = 1 })", "field 'left' must be true or false, not a number"},
           {"m:emit('ball_seen', { 3, distance_m = 1 })", "event 'ball_seen': every field needs a name"},
           {"m:emit('heard', {}, { to = 'all' })", "the event 'heard' is not declared: k.events { heard = {} }"},
           {"m:emit('whistle', nil, { too = 'all' })", "m:emit has no key 'too', did you mean 'to'?"},
           {"m:emit('whistle', nil, { to = 3 })", "m:emit: 'to' must be the name of a behavior"},
           {"m:emit('ball_seen', { distance_m = 1, label = ('x'):rep(300) }, { to = 'all' })",
            "event 'ball_seen': field 'label' is longer than 256 bytes"},
       }) {
    Stage stage(head + events + "return k.behavior 't' { k.state 'a' { enter = function(m)\n" + one.call +
                "\nend, { on = 'ball_seen', to = 'a' }, { on = 'whistle', to = 'a' } } }");
    stage.tick();
    CAPTURE(one.call);
    CAPTURE(stage.behavior->error().text());
    CHECK(has(stage.behavior->error().text(), one.message));
    CHECK(has(stage.behavior->error().text(), ":5: "));
  }
}

TEST_CASE("an event to others is bounded like one from outside: 32 in a tick, then nil and queue_full") {
  Theatre theatre({head + events + R"(return k.behavior 'one' { k.state 'a' { enter = function(m)
      for i = 1, 33 do local ok, why = m:emit('whistle', nil, { to = 'two' }) if not ok then print(i, why) end end end } })",
                   listener("two")},
                  {0, 1});
  theatre.tick(2);
  CHECK(lines_of(theatre, "one") == "33 queue_full\n");
  CHECK(taken(theatre) == 32);
}

TEST_CASE("a mistake in k.events is found when the file is loaded, with its line") {
  struct Case {
    std::string declared, message;
  };
  for (const Case& one : std::vector<Case>{
           {"k.events 'x'", ":2: k.events needs a table { name = { field = type } }"},
           {"k.events {\n['a b'] = {} }", ":3: an event's name is words of letters, digits and '_'"},
           {"k.events {\ndone = {} }", ":3: the event 'done' is made by the runtime alone"},
           {"k.events {\n['fault.knee'] = {} }", ":3: the event 'fault.knee' is made by the runtime alone"},
           {"k.events {\nseen = 'm' }", ":3: event 'seen' must be a table { field = type }, not a string"},
           {"k.events {\nseen = { far = 3 } }",
            ":3: event 'seen': field 'far' must be a unit such as \"m\", k.flag or"},
           {"k.events {\nseen = { far = { 'm', mn = 3 } } }",
            "a field of an event has no key 'mn', did you mean 'min'?"},
           {"k.events {\nseen = { far = { 'm', min = 3, max = 1 } } }", "min and max are a number's"},
           {"k.events {\nseen = { far = { k.flag, min = 3 } } }", "min and max are a number's"},
           {"k.events {\nseen = { ['far off'] = 'm' } }", "event 'seen': a field is named with letters"},
           {"k.events { seen = { far = 'm' } }\nk.events {\nseen = { far = k.text } }",
            ":4: event 'seen' is declared in behaviors/test.lua:2 with other fields"},
           {"k.events {\nover = {} }", ":3: event 'over' is how a state ends: give it another name"},
       }) {
    const std::string message = load_error(head + one.declared +
                                           "\nreturn k.behavior 't' { initial = 'a', k.state 'a' {}, k.final 'b' { "
                                           "outcome = 'over' } }");
    CAPTURE(one.declared);
    CAPTURE(message);
    CHECK(has(message, one.message));
  }
  CHECK(load_error(head +
                   "k.events { seen = { far = 'm' } }\nk.events { seen = { far = 'm' } }\nreturn k.behavior 't' { "
                   "k.state 'a' {} }") == "");
}

TEST_CASE("tables that run code when they are read run none in k.events and m:emit") {
  const std::string reads =
      "local t = setmetatable({ 'm' }, { __index = function() k.events { more = {} } return 1 end })\n";
  CHECK(load_error(
            head + reads +
            "k.events { seen = { far = t } }\nreturn k.behavior 't' { k.state 'a' { { on = 'seen', to = 'a' } } }") ==
        "");
  Stage stage(head + events + R"(local t = setmetatable({}, { __index = function(_, key) print(key) return 1 end })
    return k.behavior 't' { k.state 'a' { enter = function(m) m:emit('ball_seen', t) end, { on = 'ball_seen', to = 'a' } } })");
  stage.tick();
  CHECK(has(stage.behavior->error().text(), "field 'distance_m' is missing"));
  CHECK(stage.said() == "");
}

TEST_CASE("buttons and sensors send their events on each rise and fall, not for what was on at the start") {
  Theatre theatre;
  theatre.scripts.write("behaviors/one.lua", head + R"(k.events { kick = {}, rest = {}, bumped = {} }
    return k.behavior 'one' { k.state 'a' { { on = { 'kick', 'rest', 'bumped' }, to = 'a',
      action = function(_, s) print(s.event.name, s.time_s) end } } })");
  theatre.snapshot.status.channel_count = 1;
  theatre.snapshot.status.channels[0] = std::numeric_limits<double>::quiet_NaN();
  theatre.snapshot.joystick.buttons[2] = true;
  theatre.open(
      {.play = theatre.list({"one"}),
       .inputs = {
           {.of = InputEvent::Of::button, .index = 0, .input = "joystick.button_1", .rise = "kick", .fall = "rest"},
           {.of = InputEvent::Of::button, .index = 2, .input = "joystick.button_3", .rise = "kick"},
           {.of = InputEvent::Of::button, .index = 1, .input = "joystick.button_2", .rise = "unknown"},
           {.of = InputEvent::Of::sensor, .index = 0, .input = "sensors.bumper", .rise = "bumped"}}});
  theatre.tick();
  theatre.snapshot.joystick.buttons[0] = true;
  theatre.snapshot.status.channels[0] = 1;  // it was NaN: it may have been pressed since the start
  theatre.tick(3);
  theatre.snapshot.joystick.buttons[0] = false;
  theatre.snapshot.status.channels[0] = 0;
  theatre.snapshot.joystick.buttons[1] = true;
  theatre.tick();
  theatre.snapshot.joystick.buttons[1] = false;
  theatre.snapshot.status.channels[0] = 1;
  theatre.tick();
  theatre.snapshot.joystick.buttons[1] = true;
  theatre.tick();
  const std::string said = lines_of(theatre, "one");
  CAPTURE(said);
  CHECK(has(said, "kick 0.01\n"));
  CHECK(has(said, "rest 0.04\n"));
  CHECK(has(said, "bumped 0.05\n"));
  CHECK(std::ranges::count(said, '\n') == 3);
  CHECK(has(lines_of(theatre, "supervisor"), "event kick from joystick.button_1 to one\n"));
  CHECK(has(lines_of(theatre, "supervisor"),
            "event 'unknown' from joystick.button_2: no behavior that plays declares it (told once)\n"));
}

TEST_CASE("a host that goes on after another one gets what was sent and has not come, and tells no edge twice") {
  Theatre theatre;
  theatre.scripts.write("behaviors/one.lua", head + events + R"(return k.behavior 'one' { initial = 'w',
    k.state 'w' { { after = 0.01, to = 'a' } },
    k.state 'a' { enter = function(m) m:emit('ball_seen', { distance_m = 4 }, { to = 'two' }) end, endless = true } })");
  theatre.scripts.write("behaviors/two.lua", listener("two"));
  std::vector<PlayItem> play = theatre.list({"one", "two"});
  play[1].lane = 1;
  const std::vector<InputEvent> inputs{{.input = "joystick.button_1", .rise = "whistle"}};
  theatre.open({.play = play, .inputs = inputs});
  theatre.tick();
  theatre.snapshot.joystick.buttons[0] = true;
  theatre.tick();  // `one` sends
  const std::uint32_t before = taken(theatre);
  ByteWriter bytes;
  REQUIRE(theatre.host->keep(bytes, theatre.snapshot.time_ns) == "");
  const std::vector<std::byte> kept(bytes.bytes().begin(), bytes.bytes().end());
  theatre.host.reset();
  theatre.open({.inputs = inputs, .kept = kept});
  theatre.tick();
  CHECK(theatre.host->lost() == "");
  CHECK(has(lines_of(theatre, "two"), "ball_seen 4 "));
  CHECK(taken(theatre) == before + 1);
}

}  // namespace outside_event_test
