#include "bullet_memory.h"

#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdlib>

#include <LinearMath/btAlignedAllocator.h>

namespace kadans::bullet {
namespace {

constexpr std::size_t smallest_bytes = 64, classes = 10;
constexpr std::size_t reserved_bytes = std::size_t{32} << 10U;  // of each size

// Before each block; as long as the strictest alignment.
struct alignas(std::max_align_t) Head {
  std::size_t size_class;
  Head* next;
};

std::size_t class_of(std::size_t bytes) noexcept {
  return bytes <= smallest_bytes ? 0 : static_cast<std::size_t>(std::bit_width(bytes - 1)) - 6;
}

class Blocks {
 public:
  void* take(std::size_t bytes) noexcept {
    const std::size_t size_class = class_of(bytes);
    if (size_class >= classes) return begin(static_cast<Head*>(std::malloc(sizeof(Head) + bytes)), size_class);
    const Turn turn(busy_);
    Head* const waiting = waiting_[size_class];
    if (waiting == nullptr) return begin(fresh(size_class), size_class);
    waiting_[size_class] = waiting->next;
    return waiting + 1;
  }
  void give_back(void* block) noexcept {
    if (block == nullptr) return;
    Head* const head = static_cast<Head*>(block) - 1;
    if (head->size_class >= classes) return std::free(head);
    const Turn turn(busy_);
    head->next = waiting_[head->size_class];
    waiting_[head->size_class] = head;
  }
  void reserve() noexcept {
    for (std::size_t size_class = 0; size_class < classes; ++size_class) {
      for (std::size_t bytes = 0; bytes < reserved_bytes; bytes += smallest_bytes << size_class) {
        give_back(begin(fresh(size_class), size_class));
      }
    }
  }

 private:
  class Turn {
   public:
    explicit Turn(std::atomic_flag& busy) noexcept : busy_(busy) {
      while (busy_.test_and_set(std::memory_order_acquire)) {
      }
    }
    ~Turn() { busy_.clear(std::memory_order_release); }
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;

   private:
    std::atomic_flag& busy_;
  };

  static Head* fresh(std::size_t size_class) noexcept {
    return static_cast<Head*>(std::malloc(sizeof(Head) + (smallest_bytes << size_class)));
  }
  static void* begin(Head* head, std::size_t size_class) noexcept {
    if (head == nullptr) return nullptr;
    head->size_class = size_class;
    return head + 1;
  }

  std::atomic_flag busy_{};
  std::array<Head*, classes> waiting_{};
};

constinit Blocks blocks;

#ifndef KADANS_SANITIZED
// Before main(): what Bullet got from elsewhere must not come back here.
[[maybe_unused]] const bool hooked = [] {
  btAlignedAllocSetCustom([](std::size_t bytes) { return blocks.take(bytes); },
                          [](void* block) { blocks.give_back(block); });
  return true;
}();
#endif

}  // namespace

void reserve_bullet_memory() noexcept {
  static const bool reserved = [] { return blocks.reserve(), true; }();
  (void)reserved;
}

}  // namespace kadans::bullet
