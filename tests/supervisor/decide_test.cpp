// Decisions over behaviors, tick by tick as lockstep does it, on a robot made of tables.
#include <memory>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "kadans/signal/input_error.h"
#include "script/fixture.h"
#include "supervisor/decide/supervised_host.h"
#include "supervisor/decide/supervisor.h"
#include "supervisor/messages/simulated_network.h"

namespace decide_test {

using namespace kadans;
using kadans::script_test::Theatre;
using WhenLost = SupervisorConfig::WhenLost;

namespace {

std::string behavior(const std::string& name, const std::string& states) {
  return "local k = require 'kadans'\nk.events { whistle = { loud = k.flag } }\nreturn k.behavior '" + name +
         "' { controls = 'posture', initial = 'a', args = { far_m = { 1, min = 0, max = 5 } },\n" + states + " }\n";
}

std::string decisions(const std::string& states, const std::string& events = "") {
  return "local k = require 'kadans'\n" + events + "return k.decisions 'decide' { initial = 'a', vars = {},\n" +
         states + " }\n";
}

// A host with the behaviors short (0.1 s), long, broken and listener, and what decides over them.
struct Supervised : Theatre {
  explicit Supervised(const std::string& text, SupervisorConfig wanted = {}, MessageChannel* channel = nullptr) {
    scripts.write("config/tulip/robot.json", "{}");
    scripts.write("behaviors/tulip/short.lua",
                  behavior("short", "k.state 'a' { { after = 0.1, to = 'b' } }, k.final 'b' { outcome = 'done' }"));
    scripts.write(
        "behaviors/tulip/long.lua",
        behavior("long", "k.state 'a' { enter = function(m) k.log.info('far %g', m.args.far_m) end, endless = true }"));
    scripts.write("behaviors/tulip/broken.lua",
                  behavior("broken", "k.state 'a' { { after = 0.1, to = 'b' } }, k.final 'b' { outcome = 'lost' }"));
    scripts.write("behaviors/tulip/listener.lua",
                  behavior("listener", "k.state 'a' { { on = 'whistle', to = 'b' } }, k.state 'b' { endless = true }"));
    const auto file = scripts.write("behaviors/tulip/decide.lua", text);
    wanted.given = true;
    wanted.decisions = {{.file = file}};
    wanted.seen = {{.name = "ball", .places = 2, .fields = {{"x_m", "m", "", -9, 9}, {"y_m", "m", "", -9, 9}}}};
    robot.catalog.seen = wanted.seen;
    open({});
    supervisor = std::make_unique<Supervisor>(
        Supervisor::Settings{.config = wanted,
                             .root = scripts.root,
                             .folders = {.project_file = scripts.root / "config/tulip/robot.json", .robot = "tulip"},
                             .messages = channel},
        robot.catalog, link, seen, log);
    supervised = std::make_unique<SupervisedHost>(wanted, *host, SupervisedHost::Players{host.get()}, link, log);
  }

  // In the order of lockstep: a behavior tick each 10 ms, and behind each fifth one the supervisor.
  void pass(int behavior_ticks, bool silent = false) {
    for (int i = 0; i < behavior_ticks; ++i, ++ticks) {
      supervised->before_tick(snapshot);
      supervised->tick(snapshot, sender);
      if (ticks % 5 == 0 && !silent) supervisor->tick(snapshot.time_ns);
      step();
    }
  }
  std::string plays() const {
    PlayReport report;
    host->report(report);
    std::string all;
    for (std::uint32_t i = 0; i < report.count; ++i)
      all += std::string(i == 0 ? "" : " ") + report.playing[i].name.data() + "." + report.playing[i].state.data();
    return all;
  }
  std::string state() const { return supervisor->decisions()->behavior().state(); }
  std::string outcome() const { return supervisor->decisions()->behavior().outcome(); }
  bool said(const std::string& what) const { return log.joined().find(what) != std::string::npos; }

  SupervisorLink link;
  SeenStorage seen;
  std::unique_ptr<Supervisor> supervisor;
  std::unique_ptr<SupervisedHost> supervised;
  int ticks = 0;
};

std::string error_of(const std::string& text) {
  try {
    const Supervised made(text);
  } catch (const InputError& error) {
    return error.problems().front().message;
  }
  return "";
}

}  // namespace

TEST_CASE("a transition for play.* takes each way in which what was played ends") {
  for (const char* played : {"short", "broken", "short{far_m=9}"}) {
    Supervised robot(decisions("k.state 'a' { enter = function(m) m:play('" + std::string(played) +
                               "') end, { on = 'play.*', to = 'b' } }, k.final 'b' { outcome = 'done' }"));
    robot.pass(40);
    CAPTURE(played);
    CHECK(robot.outcome() == "done");
  }
}

TEST_CASE("decisions play behaviors one after the other, and hear how each of them ended") {
  Supervised robot(
      decisions("k.state 'a' { enter = function(m) m:play('short') end, { on = 'play.done', to = 'b' } },\n"
                "k.state 'b' { enter = function(m) m:play('short, broken') end, { on = 'play.failed', to = 'c' } },\n"
                "k.final 'c' { outcome = 'done' }"));
  robot.pass(2);
  CHECK(robot.plays() == "short.a");  // one behavior tick after it was decided
  robot.pass(20);
  CHECK(robot.state() == "b");
  robot.pass(40);
  CHECK(robot.outcome() == "done");
  CHECK(robot.log.errors == 0);
}

TEST_CASE("a table gives the arguments of a behavior, and what is played replaces what played") {
  Supervised robot(decisions(
      "k.state 'a' { enter = function(m) m:replace('long', { far_m = 2.5 }) end, { after = 0.2, to = 'b' } },\n"
      "k.state 'b' { enter = function(m) m:replace('long{far_m=3} | short') end, endless = true }"));
  robot.pass(3);
  CHECK(robot.said("far 2.5"));
  robot.pass(25);
  CHECK(robot.said("far 3"));
}

TEST_CASE("decisions see what plays, by name and state, and may stop, pause and resume it") {
  Supervised robot(decisions(
      "k.state 'a' { enter = function(m) m:play('long') end, { when = function(_, m) return m.vars.seen end, to = 'b' "
      "},\n"
      "  during = function(m) m.vars.seen = m:plays('long') == 'a' and m:plays() == 'a' and m:plays('short') == nil "
      "end },\n"
      "k.state 'b' { enter = function(m) m:pause() end, { after = 0.2, to = 'c' } },\n"
      "k.state 'c' { enter = function(m) m:resume() end, { after = 0.2, to = 'd' } },\n"
      "k.state 'd' { enter = function(m) m:stop() end, endless = true, { on = 'play.*', to = 'e' } }, k.final 'e' {}"));
  robot.pass(18);
  CHECK(robot.state() == "b");
  CHECK(robot.host->paused());
  robot.pass(22);
  CHECK_FALSE(robot.host->paused());
  robot.pass(30);
  CHECK(robot.plays() == "");
  CHECK(robot.state() == "d");  // what they stopped themselves is no end of a play
}

TEST_CASE("an event of the decisions goes to the behavior that it names") {
  Supervised robot(
      decisions("k.state 'a' { enter = function(m) m:play('listener | long') end, { after = 0.2, to = 'b' } },\n"
                "k.state 'b' { endless = true, enter = function(m)\n"
                "  m:emit('whistle', { loud = true }, { to = 'listener' }) end }",
                "k.events { whistle = { loud = k.flag } }\n"));
  robot.pass(40);
  CHECK(robot.log.errors == 0);
  const bool heard = robot.plays().find("listener.b") != std::string::npos;
  CHECK_MESSAGE(heard, robot.log.joined());
}

TEST_CASE("what cannot be played is refused with a sentence, which the decisions hear, and nothing changes") {
  Supervised robot(decisions(
      "k.state 'a' { enter = function(m) m:play('long') end, { after = 0.2, to = 'b' } },\n"
      "k.state 'b' { enter = function(m) m:replace('long{far_m=9}') end,\n"
      "  { on = 'play.refused', to = 'c', action = function(_, s) k.log.info('heard: ' .. s.event.data.why) end } },\n"
      "k.state 'c' { endless = true }"));
  robot.pass(50);
  CHECK(robot.state() == "c");
  CHECK(robot.said("heard: "));
  CHECK(robot.said("outside its range 0..5"));
  CHECK(robot.plays() == "long.a");
}

TEST_CASE("a mistake in a word of the decisions is an error at its line, before anything is ordered") {
  for (const auto& [code, wanted] : std::vector<std::pair<std::string, std::string>>{
           {"m:play('shrt')", "unknown behavior 'shrt' in behaviors/tulip, did you mean 'short'?"},
           {"m:play('short{')", "wanted the name of an argument"},
           {"m:play(3, 4)", "m:play needs a list of behaviors"},
           {"m:play('short, long', { far_m = 1 })", "belongs to a single behavior"},
           {"m:play('long', { far_m = 0/0 })", "argument 'far_m' must be a finite number"},
           {"m:play('long', { far_m = {} })", "argument 'far_m' must be a finite number"},
           {"m:play('long', 'far')", "the arguments are a table"},
           {"m:send('whistle')", "its name must begin with 'robot.'"},
           {"m:send('robot.hello')", "is not declared"},
           {"m.posture:move('stand', {})", "a k.decisions has none"}}) {
    const std::string shown = code;
    CAPTURE(shown);
    Supervised robot(
        decisions("k.state 'a' { endless = true, enter = function(m)\n m:play('long')\n " + code + "\n end }"));
    robot.pass(10);
    CHECK_MESSAGE(robot.said(wanted), robot.log.joined());
    CHECK(robot.said("decide.lua:5: "));
    CHECK(robot.supervisor->decisions()->failed());
    CHECK(robot.plays() == "");  // what it asked for in the same tick is not done either
  }
}

TEST_CASE("a k.decisions has no control sets, and neither it nor a behavior is taken for the other") {
  CHECK(error_of("local k = require 'kadans'\nreturn k.decisions 'a' { controls = 'posture', k.state 'b' {} }\n")
            .find("'controls'") != std::string::npos);
  CHECK(error_of(behavior("a", "k.state 'a' { endless = true }")).find("is a k.behavior; what decides returns") !=
        std::string::npos);
  Theatre theatre;
  theatre.scripts.write("behaviors/d.lua", decisions("k.state 'a' { endless = true }"));
  ScriptHost::Settings settings;
  settings.play = {{.file = "behaviors/d.lua"}};
  CHECK_THROWS_WITH_AS(theatre.open(settings), doctest::Contains("is a k.decisions, which plays behaviors"),
                       InputError);
}

TEST_CASE("decisions see the world model as it is now, carried on by the odometry since the picture") {
  Supervised robot(
      decisions("k.state 'a' { endless = true, during = function(_, s)\n"
                "  if s.seen.ball.confidence > 0 then k.log.info('ball %.3f %.3f %.2f %s', s.seen.ball.x_m,\n"
                "    s.seen.ball.y_m, s.seen.ball.age_s, s.seen.ball.source) end end }"));
  for (int i = 0; i < 41; ++i) {  // it walks 1 cm a tick
    robot.snapshot.status.odometry.path_x_m = 0.01 * i;
    if (i == 38)
      robot.supervisor->observe({.entry = 0,
                                 .time_ns = robot.snapshot.time_ns - 200'000'000,
                                 .fields = {2, 0.5},
                                 .source = SeenSource::scenario});
    robot.pass(1);
  }
  CHECK_MESSAGE(robot.said("ball 1.780 0.500 0.22 scenario"), robot.log.joined());
  CHECK(robot.seen.newest().entries[0].fields[0] == doctest::Approx(2.18));
}

TEST_CASE("when nothing decides any more what plays goes on, stops, or another list takes over") {
  for (const WhenLost when_lost : {WhenLost::go_on, WhenLost::stop, WhenLost::play}) {
    SupervisorConfig config{.lost_after_s = 0.2, .when_lost = when_lost};
    Supervised robot(decisions("k.state 'a' { endless = true, enter = function(m) m:play('long') end }"), config);
    if (when_lost == WhenLost::play) {
      config.lost_list = {{.file = robot.scripts.root / "behaviors/tulip/listener.lua"}};
      robot.supervised = std::make_unique<SupervisedHost>(
          config, *robot.host, SupervisedHost::Players{robot.host.get()}, robot.link, robot.log);
    }
    robot.pass(20);
    CHECK(robot.plays() == "long.a");
    robot.pass(15, true);
    CHECK(robot.plays() == "long.a");
    robot.pass(15, true);
    const std::string left = when_lost == WhenLost::go_on ? "long.a" : when_lost == WhenLost::stop ? "" : "listener.a";
    CHECK(robot.plays() == left);
    CHECK(robot.said("nothing decides any more"));
    robot.pass(10);
    CHECK(robot.said("decides again"));
    CHECK(robot.log.errors == 0);
  }
}

TEST_CASE("two robots hear each other's messages as events, with the sender's name, within the budget") {
  const std::string text = decisions(
      "k.state 'a' { endless = true, enter = function(m) m.vars.n = 0 end,\n"
      "  during = function(m) m.vars.n = m.vars.n + 1 m:send('robot.hello', { n = m.vars.n }) end,\n"
      "  { on = 'robot.hello', action = function(_, s) k.log.info('%s says %d', s.event.data.from, s.event.data.n) end "
      "} }",
      "k.events { ['robot.hello'] = { n = { '', min = 0, max = 100 }, from = { k.text, optional = true } } }\n");
  SimulatedNetwork network({.delay_s = 0.01, .jitter_s = 0}, 2, 1);
  SupervisorConfig red, blue;
  red.messages = {.name = "red", .peers = {"blue"}, .messages_per_minute = 5};
  blue.messages = {.name = "blue", .peers = {"red"}};
  Supervised one(text, red, &network.port(0)), other(text, blue, &network.port(1));
  for (int i = 0; i < 100; ++i) {
    one.pass(1);
    other.pass(1);
  }
  CHECK(other.said("red says 5"));
  CHECK_FALSE(other.said("red says 6"));
  CHECK(other.log.errors == 0);
  CHECK(one.said("blue says 18"));
  CHECK(one.said("was not sent: the budget of this minute is spent: 5 messages"));
}

}  // namespace decide_test
