// The way of an order from whoever asks to the thread that carries it out, and back. It travels as a case: made by the
// client's thread, carried out and answered by the thread that owns what it changes, freed where it was made. The rings
// carry pointers, so no side waits for the other and an order may be as long as it is.
//
// Memory order: a case belongs to the client until it is in the ring of those asked, then to the thread that carries
// out, and to the client again when it is in the ring of those answered; the rings order all that. Meanwhile the client
// looks at nothing of it but the answer's number, which nobody changes. Who decides, by taking up or by withdrawing,
// tells the other one bit and nothing else, so that exchange is relaxed: that it is one exchange is all that counts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "kadans/exchange/memory.h"
#include "kadans/exchange/ring.h"

namespace kadans {

// Whoever asked may withdraw an order until it is taken up: it expires with its client.
template <typename Order, typename Answer, typename Memory = MachineMemory>
class BasicOrderCase {
 public:
  Order order;
  Answer answer;

  // The thread that carries out, once. False: it was withdrawn.
  [[nodiscard]] bool take_up() noexcept { return decide(); }
  // Client's thread. False: it is taken up already.
  bool withdraw() noexcept { return decide(); }

 private:
  bool decide() noexcept { return !Memory::at(decided_).exchange(true, std::memory_order_relaxed); }

  typename Memory::template Word<bool> decided_{false};
};

// At most `orders_waiting_max` are on their way.
inline constexpr std::size_t orders_waiting_max = 15;

// `Case` is a BasicOrderCase whose answer has a number and a text.
template <typename Case, typename Memory = MachineMemory>
class BasicOrderQueue {
 public:
  BasicOrderQueue() = default;
  // When neither thread uses it any more.
  ~BasicOrderQueue() {
    for (Cases* cases : {&asked_, &answered_}) {
      for (Case* left = nullptr; cases->try_pop(left);) delete left;
    }
  }
  BasicOrderQueue(const BasicOrderQueue&) = delete;
  BasicOrderQueue& operator=(const BasicOrderQueue&) = delete;

  // Client's thread. False: too many wait.
  [[nodiscard]] bool ask(std::unique_ptr<Case> order) {
    if (on_their_way_.size() == orders_waiting_max) return false;
    on_their_way_.push_back(order.get());
    if (asked_.try_push(order.get())) return order.release() != nullptr;  // now the ring's
    on_their_way_.pop_back();
    return false;
  }
  // Client's thread: the order of this number is not carried out, unless it is being already.
  void withdraw(std::uint64_t number) noexcept {
    for (Case* order : on_their_way_) {
      if (order->answer.number == number) (void)order->withdraw();
    }
  }
  // Client's thread. nullptr: none.
  std::unique_ptr<Case> answered() noexcept {
    Case* order = nullptr;
    if (answered_.try_pop(order)) std::erase(on_their_way_, order);
    return std::unique_ptr<Case>(order);
  }

  // The thread that carries out. nullptr: none; what was withdrawn goes back unanswered.
  std::unique_ptr<Case> take() noexcept {
    for (Case* order = nullptr; asked_.try_pop(order);) {
      std::unique_ptr<Case> taken(order);
      if (taken->take_up()) return taken;
      taken->answer.text = "withdrawn: its client is gone, or waits no more";
      answer(std::move(taken));
    }
    return nullptr;
  }
  void answer(std::unique_ptr<Case> order) noexcept {
    if (answered_.try_push(order.get())) (void)order.release();  // there is room for all that were asked
  }

 private:
  using Cases = Ring<Case*, 16, Memory>;
  Cases asked_, answered_;
  std::vector<Case*> on_their_way_;  // client's
};

}  // namespace kadans
