// A large chart costs nothing beyond what its script does.
#include <doctest/doctest.h>

#include "kadans/testing/allocation_count.h"
#include "script/fixture.h"
#include "script/host/file_watch.h"

using namespace kadans;
using namespace kadans::script_test;

namespace {

// 8 regions of a ring of 24 states each, every region left behind with its own period: 1 + 1 + 8 * 25 states.
std::string large() {
  std::string text = "local k = require 'kadans'\nreturn k.behavior 'large' { k.parallel 'all' {\n";
  for (int region = 0; region < 8; ++region) {
    text += "k.region 'r" + std::to_string(region) + "' { initial = 's0',\n";
    for (int i = 0; i < 24; ++i) {
      text += "k.state 's" + std::to_string(i) + "' { { after = 0.0" + std::to_string(region + 1) + ", to = 's" +
              std::to_string((i + 1) % 24) + "' } },\n";
    }
    text += "},\n";
  }
  return text + "} }\n";
}

class TransitionCount final : public LineSink {
 public:
  void tell(const Line& line) override { transitions += line.transition != nullptr ? 1 : 0; }
  std::uint64_t transitions = 0;
};

}  // namespace

TEST_CASE("a chart of 200 states and 8 regions ticks without allocation, in C++ and in Lua") {
  Scripts scripts;
  Robot robot;
  TransitionCount count;
  BehaviorLog log{&count};
  CommandQueue queue;
  CommandSender sender(queue);
  Snapshot snapshot;
  Behavior behavior({.root = scripts.root, .file = scripts.write("behaviors/large.lua", large())}, robot.catalog, log);
  REQUIRE(behavior.chart().size() == 202);
  const auto tick = [&](int times) {
    for (int i = 0; i < times; ++i) {
      (void)behavior.tick(snapshot, sender);
      snapshot.time_ns += 10'000'000;
    }
  };
  tick(200);
  const std::uint64_t before = count.transitions;
  const std::size_t heap_bytes = behavior.heap_bytes();
  std::uint64_t allocations = 0;
  {
    const testing::AllocationCount heap;
    tick(840);
    allocations = static_cast<std::uint64_t>(heap.count());
  }
  CHECK(allocations == 0);
  CHECK(behavior.heap_bytes() == heap_bytes);
  CHECK(count.transitions - before == 840 + 420 + 280 + 210 + 168 + 140 + 120 + 105);
}

TEST_CASE("the watch tells of files that are written or moved into place, once they are quiet, and of no others") {
  const Scripts scripts;
  FileWatch watch;
  REQUIRE(watch.add(scripts.root));
  CHECK_FALSE(watch.add(scripts.root / "none"));
  CHECK_FALSE(watch.poll());
  scripts.write("a.txt", "x");
  CHECK_FALSE(watch.poll());
  CHECK_FALSE(watch.poll());
  scripts.write("a.lua", "x");
  CHECK_FALSE(watch.poll());  // it may go on
  scripts.write("a.lua", "y");
  CHECK_FALSE(watch.poll());
  CHECK(watch.poll());
  CHECK_FALSE(watch.poll());
  scripts.write("b.swp", "z");
  std::filesystem::rename(scripts.root / "b.swp", scripts.root / "a.lua");
  CHECK_FALSE(watch.poll());
  CHECK(watch.poll());
}

TEST_CASE("a file that is open for writing is not looked at before it is closed") {
  const Scripts scripts;
  FileWatch watch;
  REQUIRE(watch.add(scripts.root));
  std::ofstream file(scripts.root / "a.lua");
  file << "half";
  file.flush();
  CHECK_FALSE(watch.poll());
  CHECK_FALSE(watch.poll());
  file.close();
  CHECK_FALSE(watch.poll());
  CHECK(watch.poll());
}
