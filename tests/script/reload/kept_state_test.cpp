// What plays, as bytes, and another host that goes on with it: what it would be after the death of a process.
#include <doctest/doctest.h>

#include "kadans/signal/input_error.h"
#include "kadans/signal/random.h"
#include "script/fixture.h"
#include "script/process/behavior_server.h"
#include "script/process/process_host.h"
#include "signal/byte_order.h"

using namespace kadans;
using namespace kadans::script_test;

namespace {

// Remembers whatever there is to be remembered.
const char* const rememberer = R"(
local k = require 'kadans'
return k.behavior 'one' {
  controls = 'posture', initial = 'a',
  vars = { count = 0, list = { 1, 2, deep = { yes = true } }, word = 'none' },
  k.state 'a' {
    enter = function(m) m.vars.motion = m.posture:move('lean', { time_s = 0.1 }) m.vars.first = math.random() end,
    { after = 0.05, to = 'b' },
  },
  k.parallel 'b' {
    k.region 'left' { initial = 'l1',
      k.state 'l1' { { after = 0.03, to = 'l2' } },
      k.state 'l2' { endless = true, run = function(m) m.vars.runs = (m.vars.runs or 0) + 1 m:wait(100) end },
    },
    k.region 'right' { initial = 'r1',
      k.state 'r1' { endless = true, during = function(m)
        m.vars.count = m.vars.count + 1
        m.vars.word = 'w' .. m.vars.count
        m.vars.list.deep[m.vars.count] = math.random()
        print(string.format('%s %d %s %.9f %d %s %s', m.vars.word, #m.vars.list, tostring(m.vars.list.deep.yes),
          m.vars.list.deep[m.vars.count], m.vars.runs or 0, tostring(m.vars.motion.done), m.time_s))
      end },
    },
  },
}
)";

std::vector<std::byte> kept_of(Theatre& theatre) {
  ByteWriter bytes;
  CHECK(theatre.host->keep(bytes, theatre.snapshot.time_ns) == "");
  return {bytes.bytes().begin(), bytes.bytes().end()};
}

// The host dies between two ticks; the robot does not.
void replace_host(Theatre& theatre, const std::vector<std::byte>& kept) {
  theatre.host.reset();
  theatre.open({.kept = kept});
  theatre.tick();
  CHECK(theatre.host->lost() == "");
}

}  // namespace

TEST_CASE("vars that hold one table many times are told as too much before they fill the memory") {
  Theatre theatre(
      {"local k = require 'kadans' return k.behavior 'one' { k.state 'a' { endless = true, enter = function(m)\n"
       "local t = {} for i = 1, 15 do local u = {} for j = 1, 100 do u[j] = t end t = u end m.vars.t = t\n"
       "end } }"});
  theatre.tick();
  ByteWriter bytes;
  CHECK(theatre.host->keep(bytes, theatre.snapshot.time_ns) == "one: vars hold too much");
  CHECK(bytes.size() < std::size_t{1} << 20);
}

TEST_CASE("states, their time, vars, motions and random numbers are the same after another host took over") {
  Theatre whole({rememberer}), broken({rememberer});
  whole.tick(30);
  broken.tick(12);
  for (int i = 0; i < 6; ++i) {
    const std::vector<std::byte> kept = kept_of(broken);
    replace_host(broken, kept);
    broken.tick(2);
  }
  REQUIRE(whole.log.messages.size() == 25);
  REQUIRE(broken.log.messages.size() == whole.log.messages.size());
  CHECK(whole.log.transitions == broken.log.transitions);
  for (std::size_t i = 0; i < whole.log.messages.size(); ++i) {
    // A `run` begins anew with each host: its count is the only one that differs.
    const auto words = [](std::string line, int which) {
      for (; which > 0; --which) line.erase(0, line.find(' ') + 1);
      return line.substr(0, line.find(' '));
    };
    for (const int which : {0, 1, 2, 3, 4, 6, 7})
      CHECK(words(whole.log.messages[i], which) == words(broken.log.messages[i], which));
  }
}

TEST_CASE("nothing is kept anew while nothing changes") {
  Theatre theatre({"local k = require 'kadans'\nreturn k.behavior 'one' { k.state 'a' { endless = true } }"});
  theatre.tick(2);
  const std::vector<std::byte> kept = kept_of(theatre);
  theatre.tick(20);
  CHECK(kept_of(theatre) == kept);
}

TEST_CASE("a list goes on where it was, and what is over stays over") {
  const auto says = [](const std::string& name) {
    return "local k = require 'kadans'\nreturn k.behavior '" + name +
           "' { initial = 'a', k.state 'a' { enter = " + "function() print '" + name +
           "' end, { after = 0.04, to = 'done' } }, k.final 'done' {} }";
  };
  Theatre theatre({says("one"), says("two"), says("three")});
  for (int i = 0; i < 20; ++i) {
    theatre.tick();
    replace_host(theatre, kept_of(theatre));
  }
  CHECK(theatre.log.joined() == "one\ntwo\nthree\n");
  CHECK(theatre.host->finished());
  CHECK(theatre.host->status().done.load() == 3);
}

TEST_CASE("a pause stays one, and motions that it stopped go on behind it") {
  Theatre theatre(
      {"local k = require 'kadans'\nreturn k.behavior 'one' { controls = 'posture', k.state 'a' { endless "
       "= true, enter = function(m) m.posture:move('lean', { time_s = 1 }) end } }"});
  theatre.tick(10);
  theatre.host->order({.kind = PlayOrder::Kind::pause});
  theatre.tick(5);
  replace_host(theatre, kept_of(theatre));
  CHECK(theatre.host->paused());
  const std::size_t asked = theatre.commands(CommandKind::set_point);
  theatre.host->order({.kind = PlayOrder::Kind::resume});
  theatre.tick(5);
  CHECK_FALSE(theatre.host->paused());
  CHECK(theatre.commands(CommandKind::set_point) == 2 * asked);
  CHECK(theatre.applied.back().duration_s == doctest::Approx(0.9).epsilon(0.02));
}

TEST_CASE("history, waiting events and changed parameters are kept") {
  Theatre theatre({R"(
local k = require 'kadans'
local P = k.params { n = { 1, min = 0, max = 10, doc = 'a number' } }
return k.behavior 'one' { initial = 'in',
  k.state 'in' { initial = 'x', k.history 'h' { to = 'x' },
    k.state 'x' { { after = 0.02, to = 'in.y' } },
    k.state 'y' { endless = true, { after = 0.02, to = 'out', on = 'go' } },
    { on = 'leave', to = 'out' } },
  k.state 'out' { enter = function() print('n ' .. P.n) end, { on = 'back', to = 'in.h' } },
}
)"});
  theatre.tick(5);
  CHECK(theatre.host->behavior(0).set_parameter("n", 7));
  CHECK(theatre.host->behavior(0).post("leave"));
  replace_host(theatre, kept_of(theatre));
  CHECK(theatre.host->behavior(0).state() == "out");
  CHECK(theatre.log.joined() == "n 7\n");
  CHECK(theatre.host->behavior(0).post("back"));
  replace_host(theatre, kept_of(theatre));
  CHECK(theatre.host->behavior(0).state() == "in.y");
}

TEST_CASE("when the file changed meanwhile, states that are gone lead to the initial state around them") {
  Theatre theatre(
      {"local k = require 'kadans'\nreturn k.behavior 'one' { vars = { n = 0 }, initial = 'a', k.state 'a' "
       "{ enter = function(m) m.vars.n = 4 end, { after = 0, to = 'old' } }, k.state 'old' { endless = "
       "true } }"});
  theatre.tick(3);
  REQUIRE(theatre.host->behavior(0).state() == "old");
  const std::vector<std::byte> kept = kept_of(theatre);
  theatre.scripts.write("behaviors/b0.lua",
                        "local k = require 'kadans'\nreturn k.behavior 'one' { vars = { n = 0 }, initial = 'b', "
                        "k.state 'b' { endless = true, enter = function(m) print('n ' .. m.vars.n) end } }");
  replace_host(theatre, kept);
  CHECK(theatre.host->behavior(0).state() == "b");
  CHECK(theatre.log.joined() == "n 4\n");
}

TEST_CASE("events that wait are kept with their data") {
  Theatre theatre({R"(local k = require 'kadans'
    return k.behavior 'one' { initial = 'a', k.state 'a' { during = function(m) m:emit('go', { n = 7, to = { 'x' } }) m:emit 'on' end,
      { on = 'go', action = function(m, s) print(s.event.data.n, s.event.data.to[1]) end, to = 'b' } },
      k.state 'b' { { on = 'on', to = 'c' } }, k.state 'c' { endless = true } })"});
  theatre.tick();
  const std::vector<std::byte> kept = kept_of(theatre);
  replace_host(theatre, kept);
  CHECK(theatre.log.joined() == "7 x\n");
  CHECK(theatre.host->behavior(0).state() == "c");
}

TEST_CASE("vars that are no plain data cannot be kept, and keep() says so") {
  Theatre theatre(
      {"local k = require 'kadans'\nreturn k.behavior 'one' { vars = { f = 0 }, k.state 'a' { endless = "
       "true, enter = function(m) m.vars.f = { function() end } end } }"});
  theatre.tick();
  ByteWriter bytes;
  CHECK(theatre.host->keep(bytes, 0) == "one: vars hold a function");
}

TEST_CASE("rubbish in place of what was kept is refused or played, and never harms the host") {
  Theatre theatre({rememberer});
  theatre.tick(15);
  const std::vector<std::byte> kept = kept_of(theatre);
  RandomStream random(5, "rubbish");
  const auto attempt = [&](const std::vector<std::byte>& bytes) {
    Theatre other;
    other.scripts.write("behaviors/b0.lua", rememberer);
    other.snapshot = theatre.snapshot;
    try {
      other.open({.kept = bytes});
      other.tick(3);
      return other.host->lost().empty();
    } catch (const InputError&) {
      return false;
    }
  };
  // Names in it are of the first theatre's folder: that is still there.
  CHECK(attempt(kept));
  for (std::size_t size = 1; size < kept.size(); ++size)
    CHECK_MESSAGE(!attempt({kept.begin(), kept.begin() + static_cast<std::ptrdiff_t>(size)}), size, " of ",
                  kept.size());
  for (int i = 0; i < 200; ++i) {
    std::vector<std::byte> bytes = kept;
    for (auto left = 1 + random.next() % 4; left > 0; --left)
      bytes[random.next() % bytes.size()] = std::byte(random.next() & 0xff);
    (void)attempt(bytes);
  }
}

TEST_CASE("what lists a state twice is refused: what is in it would be active without it") {
  const auto nest = [](const std::string& name) {
    return "k.region '" + name + "' { initial = 'q', k.state 'q' { initial = 'r', k.state 'r' { endless = true } } }";
  };
  Theatre theatre({"local k = require 'kadans'\nreturn k.behavior 'one' { initial = 'p', k.parallel 'p' { " +
                   nest("x") + ", " + nest("y") + " } }"});
  theatre.tick(2);
  std::vector<std::byte> kept = kept_of(theatre);
  ByteWriter listed;
  listed.put_string("p.y.q");
  const std::span<const std::byte> wanted = listed.bytes();
  const auto found = std::search(kept.begin(), kept.end(), wanted.begin(), wanted.end());
  REQUIRE(found != kept.end());
  *(found + static_cast<std::ptrdiff_t>(wanted.size()) - 3) = std::byte{'x'};  // p.x.q.r stands between the two
  theatre.host.reset();
  theatre.open({.kept = kept});
  theatre.tick();
  CHECK(theatre.host->lost() != "");
}

TEST_CASE("the count of lines that found no place stays until it is told") {
  const auto link = std::make_unique<BehaviorLink>();
  SpokenLines lines(*link);
  BehaviorLog log{&lines};
  const auto say = [&](std::size_t size) {
    log.message(0, BehaviorLog::Severity::info, "one", std::string(size, 'x'));
  };
  const std::size_t free = link->lines.free();
  say(0);
  const std::size_t head = free - link->lines.free();  // of each line
  say(link->lines.free() - 2 * head);
  say(head);
  say(head);  // dropped, as the one before
  say(0);     // takes the last place, and none is left for the count
  CHECK(link->lines.free() == 0);
  say(0);
  link->lines.drop(link->lines.size());
  say(0);
  std::string text;
  for (std::size_t i = 0; i < link->lines.size(); ++i) text.push_back(static_cast<char>(link->lines.peek(i)));
  CHECK_MESSAGE(text.ends_with("3 lines found no place"), text);
}

TEST_CASE("the count of lines that found no place is told when there is place, also if no line follows") {
  const auto link = std::make_unique<BehaviorLink>();
  SpokenLines lines(*link);
  BehaviorLog log{&lines};
  log.message(0, BehaviorLog::Severity::info, "one", std::string(link->lines.free() - 50, 'x'));
  log.message(0, BehaviorLog::Severity::info, "one", std::string(100, 'x'));
  const std::size_t full = link->lines.free();
  lines.tell_dropped(0);
  CHECK(link->lines.free() == full);  // there is no place for it yet
  link->lines.drop(link->lines.size());
  lines.tell_dropped(0);
  std::string text;
  for (std::size_t i = 0; i < link->lines.size(); ++i) text.push_back(static_cast<char>(link->lines.peek(i)));
  CHECK_MESSAGE(text.ends_with("1 lines found no place"), text);
  link->lines.drop(link->lines.size());
  lines.tell_dropped(0);
  CHECK(link->lines.size() == 0);  // once
}

TEST_CASE("a process is replaced at once, then later and later, and not at all after too many deaths in a row") {
  RestartPolicy policy({.deaths_max = 6, .proved_ticks = 3, .delay_ns = 100, .delay_max_ns = 300});
  CHECK(policy.died(1000) == 1000);
  CHECK(policy.died(1000) == 1100);
  CHECK(policy.died(1000) == 1200);
  CHECK(policy.died(1000) == 1300);
  for (int i = 0; i < 3; ++i) policy.answered();
  CHECK(policy.died(2000) == 2000);
  for (int i = 0; i < 2; ++i) policy.answered();
  for (int i = 0; i < 4; ++i) CHECK(policy.died(3000).has_value());
  CHECK_FALSE(policy.died(3000).has_value());
  CHECK(policy.deaths() == 10);
}
