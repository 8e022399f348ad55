// Ring, alone and as commands beside the snapshot.
#include <array>
#include <memory>

#include "checker.h"
#include "kadans/exchange/latest.h"
#include "kadans/exchange/ring.h"

namespace kadans::interleavings {
namespace {

using Number = Cell<int>;
using SmallRing = Ring<Number, 2, ModelMemory>;

void push(SmallRing& ring, std::span<const Number> batch) {
  while (!ring.try_push(batch)) look_again();
}

int pop(SmallRing& ring) {
  Number found(0);
  while (!ring.try_pop(found)) look_again();
  return found;
}

// One number, then batches of two, the last one in pieces, which are never seen half, once around the ring and more.
struct RingModel : rl::test_suite<RingModel, 2> {
  const std::unique_ptr<SmallRing> ring = std::make_unique<SmallRing>();

  void thread(unsigned index) {
    if (index == 0) {
      push(*ring, std::array{Number(1)});
      push(*ring, std::array{Number(2), Number(3)});
      const std::array four{Number(4)}, five{Number(5)};
      const std::array<std::span<const Number>, 2> pieces{four, five};
      while (!ring->try_push_all(pieces)) look_again();
      return;
    }
    RL_ASSERT(pop(*ring) == 1);
    for (const int first : {2, 4}) {
      while (ring->size() == 0) look_again();
      RL_ASSERT(ring->size() == 2);
      RL_ASSERT(ring->peek(0) == first && ring->peek(1) == first + 1);
      ring->drop(2);
    }
  }
  void after() { RL_ASSERT(ring->size() == 0 && ring->free() == 2); }
};

// What the last one gets went through both rings.
struct ChainModel : rl::test_suite<ChainModel, 3> {
  const std::unique_ptr<SmallRing> first = std::make_unique<SmallRing>(), second = std::make_unique<SmallRing>();

  void thread(unsigned index) {
    for (int i = 1; i <= 3; ++i) {
      if (index == 0) push(*first, std::array{Number(i)});
      if (index == 1) push(*second, std::array{Number(10 * pop(*first))});
      if (index == 2) RL_ASSERT(pop(*second) == 10 * i);
    }
  }
};

// An element looked at when it was dropped already.
struct PeekedTooLong : rl::test_suite<PeekedTooLong, 2> {
  const std::unique_ptr<SmallRing> ring = std::make_unique<SmallRing>();

  void thread(unsigned index) {
    for (int i = 1; i <= 4; ++i) {
      if (index == 0) {
        push(*ring, std::array{Number(i)});
        continue;
      }
      while (ring->size() == 0) look_again();
      const Number& kept = ring->peek();
      ring->drop(1);
      (void)kept.get();
    }
  }
};

// The control thread publishes a snapshot for two; one of them commands, and tells in the command what it knew.
struct TickModel : rl::test_suite<TickModel, 3> {
  using Snapshots = Latest<Number, 2, ModelMemory>;
  const std::unique_ptr<Snapshots> snapshot = std::make_unique<Snapshots>(Number(0));
  const std::unique_ptr<SmallRing> commands = std::make_unique<SmallRing>();

  void thread(unsigned index) {
    for (int tick = 1, last = 0; tick <= 3; ++tick) {
      if (index == 0) {
        Number command(0);
        while (commands->try_pop(command)) {
          RL_ASSERT(command.get() >= last && command.get() < tick);
          last = command;
        }
        snapshot->publish(Number(tick));
        continue;
      }
      const auto reading = snapshot->read(index - 1);
      RL_ASSERT(reading->get() >= last);
      last = *reading;
      if (index == 1) (void)commands->try_push(*reading);  // full: refused
    }
  }
};

}  // namespace

void add_queue_models(std::vector<Model>& models) {
  models.push_back(model<RingModel>("Ring, batches", 2));
  models.push_back(model<ChainModel>("Ring, three threads in a row", 1));
  models.push_back(misuse<PeekedTooLong>("Ring, an element kept when it was dropped"));
  models.push_back(model<TickModel>("a snapshot for two threads, commands of one", 2));
}

}  // namespace kadans::interleavings
