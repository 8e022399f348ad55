// Orders: asked, withdrawn, carried out and answered. Relacy counts the cases too: each is freed, once.
#include <array>
#include <memory>

#include "checker.h"
#include "remote/order/order_queue.h"

namespace kadans::interleavings {
namespace {

struct AskedFor {
  Cell<int> what{0};
};
struct Answered {
  Cell<std::uint64_t> number{0};
  Cell<const char*> text{nullptr};
  Cell<int> result{0};
};
using Case = BasicOrderCase<AskedFor, Answered, ModelMemory>;
using Queue = BasicOrderQueue<Case, ModelMemory>;

bool ask(Queue& queue, std::uint64_t number) {
  auto order = std::make_unique<Case>();
  order->order.what = static_cast<int>(number);
  order->answer.number = number;
  return queue.ask(std::move(order));
}

// Carried out or withdrawn, never both.
bool take_answer(Queue& queue) {
  const std::unique_ptr<Case> order = queue.answered();
  if (!order) return false;
  const bool withdrawn = order->answer.text.get() != nullptr;
  RL_ASSERT(withdrawn ? order->answer.result == 0 : order->answer.result == 10 * order->order.what);
  return true;
}

void carry_out(Queue& queue) {
  while (std::unique_ptr<Case> order = queue.take()) {
    RL_ASSERT(!order->withdraw());  // it is taken up
    order->answer.result = 10 * order->order.what;
    queue.answer(std::move(order));
  }
}

// A client of `Threads` threads that carry out, as of behavior and record thread: asks each so many orders, and
// withdraws the last one when it may be waiting, under way or answered.
template <int Threads, int Orders>
struct OrderModel : rl::test_suite<OrderModel<Threads, Orders>, 1 + Threads> {
  std::array<Queue, Threads> queues;
  rl::atomic<bool> over{false};

  void thread(unsigned index) {
    if (index > 0) {
      while (!over.load(rl::mo_relaxed, RL_INFO)) {
        carry_out(queues[index - 1]);
        look_again();
      }
      return;
    }
    for (std::uint64_t number = 1; number <= Orders; ++number) {
      for (Queue& queue : queues) RL_ASSERT(ask(queue, number));
    }
    for (Queue& queue : queues) queue.withdraw(Orders);
    for (Queue& queue : queues) {
      for (int missing = Orders; missing > 0;) {
        if (take_answer(queue))
          --missing;
        else
          look_again();
      }
    }
    over.store(true, rl::mo_relaxed, RL_INFO);
  }
};

// One of the two decides, whoever comes first.
struct DecisionModel : rl::test_suite<DecisionModel, 2> {
  Case order;
  std::array<bool, 2> decided{};

  void thread(unsigned index) { decided[index] = index == 0 ? order.withdraw() : order.take_up(); }
  void after() { RL_ASSERT(decided[0] != decided[1] && !order.take_up()); }
};

// The client withdraws and goes; what is left the queue frees.
struct ClientGoes : rl::test_suite<ClientGoes, 2> {
  Queue queue;

  void thread(unsigned index) {
    if (index > 0) return carry_out(queue);
    RL_ASSERT(ask(queue, 1) && ask(queue, 2));
    queue.withdraw(1);
    (void)take_answer(queue);
  }
};

// An order that is touched when it was answered already.
struct TouchedTooLate : rl::test_suite<TouchedTooLate, 2> {
  Queue queue;

  void thread(unsigned index) {
    if (index == 0) {
      RL_ASSERT(ask(queue, 1));
      while (!take_answer(queue)) look_again();
      return;
    }
    std::unique_ptr<Case> order = queue.take();
    while (!order) {
      look_again();
      order = queue.take();
    }
    Case& kept = *order;
    kept.answer.result = 10;
    queue.answer(std::move(order));
    kept.answer.result = 10;
  }
};

}  // namespace

void add_order_models(std::vector<Model>& models) {
  models.push_back(model<DecisionModel>("an order, taken up or withdrawn", 4));
  models.push_back(model<OrderModel<1, 2>>("orders, one thread that carries out", 1));
  models.push_back(model<OrderModel<2, 1>>("orders, two threads that carry out", 1));
  models.push_back(model<ClientGoes>("orders, a client that goes", 1));
  models.push_back(misuse<TouchedTooLate>("orders, one touched when it was answered"));
}

}  // namespace kadans::interleavings
