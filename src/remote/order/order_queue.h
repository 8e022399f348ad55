// Carries an order from the client's thread to the thread that carries it out, and back. The order travels as a case:
// the client's thread makes it, the thread that owns the changed data carries it out and answers it, and the client's
// thread frees it. The rings carry pointers, so no side waits for the other, and an order may have any length.
//
// Memory order: a case belongs to the client until it is in the ring `asked_`, then to the executing thread, and again
// to the client when it is in the ring `answered_`. The rings order these hand-overs. In between, the client reads only
// the answer's number, which nobody changes. Taking up and withdrawing exchange one bit and publish no other data. So a
// relaxed exchange suffices: it only decides which of the two came first.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "exchange/owned_ring.h"
#include "kadans/exchange/memory.h"

namespace kadans {

// An order and its answer. The client may withdraw an order until it is taken up, so an order expires with its client.
template <typename Order, typename Answer, typename Memory = MachineMemory>
class BasicOrderCase {
 public:
  Order order;
  Answer answer;

  // Executing thread, once. False: the order was withdrawn.
  [[nodiscard]] bool take_up() noexcept { return decide(); }
  // Client's thread. False: the order has already been taken up.
  bool withdraw() noexcept { return decide(); }

 private:
  bool decide() noexcept { return !Memory::at(decided_).exchange(true, std::memory_order_relaxed); }

  typename Memory::template Word<bool> decided_{false};
};

// The greatest number of orders that are on their way.
inline constexpr std::size_t orders_waiting_max = 15;

// `Case` is a BasicOrderCase whose answer has a number and a text. To be destroyed when neither thread uses it any
// more.
template <typename Case, typename Memory = MachineMemory>
class BasicOrderQueue {
 public:
  // Client's thread. False: too many orders wait.
  [[nodiscard]] bool ask(std::unique_ptr<Case> order) {
    if (on_their_way_.size() == orders_waiting_max) return false;
    on_their_way_.push_back(order.get());
    if (asked_.try_push(std::move(order))) return true;
    on_their_way_.pop_back();
    return false;
  }
  // Client's thread: the order of this number is not carried out, unless that has already begun.
  void withdraw(std::uint64_t number) noexcept {
    for (Case* order : on_their_way_) {
      if (order->answer.number == number) (void)order->withdraw();
    }
  }
  // Client's thread. nullptr: no order has been answered.
  std::unique_ptr<Case> answered() noexcept {
    std::unique_ptr<Case> order = answered_.try_pop();
    if (order != nullptr) std::erase(on_their_way_, order.get());
    return order;
  }

  // Executing thread. nullptr: no order is waiting. Withdrawn orders go back without being carried out.
  std::unique_ptr<Case> take() noexcept {
    while (std::unique_ptr<Case> taken = asked_.try_pop()) {
      if (taken->take_up()) return taken;
      taken->answer.text = "withdrawn: its client is gone, or waits no more";
      answer(std::move(taken));
    }
    return nullptr;
  }
  void answer(std::unique_ptr<Case> order) noexcept {
    (void)answered_.try_push(std::move(order));  // there is room for all orders that were asked
  }

 private:
  OwnedRing<Case, 16, Memory> asked_, answered_;
  std::vector<Case*> on_their_way_;  // client's
};

}  // namespace kadans
