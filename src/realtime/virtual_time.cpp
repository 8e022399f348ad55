#include "virtual_time.h"

#include <algorithm>
#include <chrono>
#include <limits>

namespace kadans {
namespace {

constexpr std::chrono::milliseconds look_again{50};

}  // namespace

class VirtualTime::Member final : public Wait {
 public:
  Member(VirtualTime& time, Place& place, bool (*give_up)() noexcept) noexcept
      : time_(time), place_(&place), give_up_(give_up) {}
  ~Member() override { end(); }
  Member(const Member&) = delete;
  Member& operator=(const Member&) = delete;

  std::int64_t now_ns() const noexcept override { return time_.now_ns(); }
  void until(std::int64_t time_ns) noexcept override { time_.wait(*place_, time_ns, give_up_); }
  void end() noexcept override {
    if (place_ != nullptr) time_.leave(*place_);
    place_ = nullptr;
  }

 private:
  VirtualTime& time_;
  Place* place_;
  bool (*give_up_)() noexcept;
};

std::unique_ptr<Wait> VirtualTime::make_wait(bool (*give_up)() noexcept) {
  const std::lock_guard lock(mutex_);
  places_.push_back(std::make_unique<Place>());
  return std::make_unique<Member>(*this, *places_.back(), give_up);
}

void VirtualTime::wait(Place& place, std::int64_t time_ns, bool (*give_up)() noexcept) noexcept {
  std::unique_lock lock(mutex_);
  if (time_ns <= now_ns() || released_) return;
  place = {time_ns, true};
  advance();
  const auto moved = [&place] { return !place.waits; };
  if (give_up == nullptr) return moved_.wait(lock, moved);
  while (!moved_.wait_for(lock, look_again, moved)) {
    if (!give_up()) continue;
    place.waits = false;  // it is at work: time stands for it
    return;
  }
}

void VirtualTime::leave(const Place& place) noexcept {
  const std::lock_guard lock(mutex_);
  std::erase_if(places_, [&place](const auto& one) { return one.get() == &place; });
  advance();
}

void VirtualTime::release() noexcept {
  const std::lock_guard lock(mutex_);
  released_ = true;
  for (const auto& place : places_) place->waits = false;
  moved_.notify_all();
}

// With the lock held.
void VirtualTime::advance() noexcept {
  std::int64_t first_ns = std::numeric_limits<std::int64_t>::max();
  for (const auto& place : places_) {
    if (!place->waits) return;
    first_ns = std::min(first_ns, place->due_ns);
  }
  if (places_.empty()) return;
  now_ns_.store(first_ns, std::memory_order_release);
  for (const auto& place : places_) place->waits = place->due_ns > first_ns;
  moved_.notify_all();
}

}  // namespace kadans
