// A state's switch that came before the dwell of a control set was over (switch_dwell_s): refused once, asked for once.
#include <doctest/doctest.h>

#include "script/cast.h"

namespace set_dwell_test {

using namespace kadans;
using namespace kadans::script_test;

namespace {

void play(Cast& cast, const std::string& text) {
  cast.write("main", text);
  cast.play({"main"});
}

}  // namespace

TEST_CASE("a switch that came before the dwell was over is refused once, and asked for again once it is over") {
  Cast cast;
  play(cast,
       "return k.behavior 'main' { controls = 'posture', initial = 'a', k.state 'a' { { after = 0.02, to = 'b' } "
       "}, k.state 'b' { controls = 'legs', endless = true,\n"
       "enter = function(m) m.legs:move('lean', { time_s = 0.1 }) end } }");
  cast.tick(2);
  cast.refuse_tick(RefusalReason::set_dwells);
  cast.snapshot.object_count = 3;
  cast.snapshot.objects[posture].dwell_s = 0.05F;
  const std::uint32_t sent = cast.sender.last_sequence();
  cast.tick(5);
  CHECK(cast.switches().empty());
  CHECK(cast.sender.last_sequence() == sent);  // nothing that would be refused is sent meanwhile
  CHECK(cast.host->behavior(0).state() == "b");
  CHECK(cast.host->behavior(0).transactions_refused() == 1);
  cast.snapshot.objects[posture].dwell_s = 0;
  cast.tick();
  CHECK(cast.switches() == std::vector<std::uint32_t>{legs});
  cast.tick(5);
  CHECK(cast.switches() == std::vector<std::uint32_t>{legs});
}

TEST_CASE("a switch that waits for the dwell is forgotten with its state, and what comes next is sent at once") {
  Cast cast;
  play(cast,
       "return k.behavior 'main' { controls = 'posture', initial = 'a', k.state 'a' { { after = 0.02, to = 'b' } "
       "}, k.state 'b' { controls = 'legs', { after = 0.03, to = 'c' } },\n"
       "k.state 'c' { endless = true, enter = function(m) m.posture:set_gains('soft') end } }");
  cast.tick(2);
  cast.refuse_tick(RefusalReason::set_dwells);
  cast.snapshot.object_count = 3;
  cast.snapshot.objects[posture].dwell_s = 9;
  cast.tick(5);
  CHECK(cast.host->behavior(0).state() == "c");
  CHECK(cast.commands(CommandKind::set_parameter) > 0);
  cast.snapshot.objects[posture].dwell_s = 0;
  cast.tick(5);
  CHECK(cast.switches().empty());
}

}  // namespace set_dwell_test
