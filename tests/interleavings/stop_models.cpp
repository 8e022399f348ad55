// The emergency stop, asked for by one or two while the control thread takes it.
#include "checker.h"
#include "safety/emergency_stop.h"

namespace kadans::interleavings {
namespace {

using Stop = BasicEmergencyStop<Cell<int>, ModelMemory>;  // 0: nobody is named

// Who asks once and alone is named, and stops the robot once.
struct AloneModel : rl::test_suite<AloneModel, 2> {
  Stop stop;
  int taken = 0;

  void take() {
    Cell<int> who(0);
    if (!stop.take(who)) return;
    ++taken;
    RL_ASSERT(who == 1);
  }
  void thread(unsigned index) {
    if (index == 0) return stop.ask(1);
    take();
    take();
  }
  void after() {
    take();
    RL_ASSERT(taken == 1);
  }
};

// Each of two is heard, and the words are of one of them.
struct TogetherModel : rl::test_suite<TogetherModel, 3> {
  Stop stop;
  bool heard = false;

  void take() {
    Cell<int> who(0);
    if (!stop.take(who)) return;
    heard = true;
    RL_ASSERT(who == 0 || who == 1 || who == 2);
  }
  void thread(unsigned index) {
    for (int i = 0; i < 2; ++i) index == 0 ? take() : stop.ask(static_cast<int>(index));
  }
  void after() {
    take();
    Cell<int> who(0);
    RL_ASSERT(heard && !stop.take(who));
    stop.ask(3);
    RL_ASSERT(stop.take(who) && who == 3);  // and the next one is named again
  }
};

}  // namespace

void add_stop_models(std::vector<Model>& models) {
  models.push_back(model<AloneModel>("emergency stop, one who asks", 3));
  models.push_back(model<TogetherModel>("emergency stop, two who ask", 2));
}

}  // namespace kadans::interleavings
