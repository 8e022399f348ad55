// Charts at random do what SCXML's algorithm does: the runner against the reference interpreter, tick by tick, in the
// order of entries, exits and actions and in the states that are active.
#include "random_chart.h"

#include <doctest/doctest.h>

#include "script/fixture.h"

namespace random_chart_test {

using namespace kadans;
using namespace kadans::script_test;

namespace {

constexpr std::uint32_t charts = 2000;
constexpr int ticks = 20;

// What was printed since `from`. The `during` of the behavior prints what all functions said since it did so before.
std::string said_since(const Log& log, std::size_t from) {
  std::string all;
  for (std::size_t i = from; i < log.messages.size(); ++i) {
    const std::string text = log.messages[i].substr(log.messages[i].find(": ") + 2);
    if (text.starts_with("+") || text.starts_with("-") || text.starts_with("!") || text.starts_with(".")) all += text;
  }
  return all;
}

// "" when both say the same in every tick.
std::string difference(std::uint32_t seed, std::size_t& steps) {
  RandomChart chart(seed);
  const std::string lua = chart.lua();
  ReferenceChart reference(chart.states());
  try {
    Stage stage(lua);
    for (int tick = 0; tick < ticks; ++tick) {
      std::vector<std::string> events = chart.events_of_a_tick();
      const std::size_t before = stage.log.messages.size();
      std::erase_if(events, [&](const std::string& event) { return !stage.behavior->post(event); });
      (void)stage.tick();
      const std::string ours = said_since(stage.log, before), theirs = reference.tick(tick, events);
      steps += static_cast<std::size_t>(std::ranges::count(theirs, '+'));
      if (ours == theirs && !stage.behavior->failed()) continue;
      std::string sent;
      for (const std::string& event : events) sent += event + " ";
      return lua + "tick " + std::to_string(tick) + " events " + sent + "\nours   " + ours + "\ntheirs " + theirs +
             "\n" + stage.behavior->error().text();
    }
  } catch (const InputError& error) {
    return lua + error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("charts at random enter, leave and act as SCXML's algorithm does, in its order") {
  std::size_t entries = 0;
  for (std::uint32_t seed = 1; seed <= charts; ++seed) {
    const std::string text = difference(seed, entries);
    INFO("seed " << seed << "\n" << text);
    REQUIRE(text.empty());
  }
  CHECK(entries > 20 * charts);  // the charts do something
}

}  // namespace random_chart_test
